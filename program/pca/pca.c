/* pca.c - `lacquer pca`: a table into small textures, with the error a GPU will see. */
#include "program/pca/pca.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/settings.h"

/* ======================================================================================
 *                                        Request
 * ====================================================================================== */

enum {
    OPTION_OUTPUT = 'o',
    OPTION_SEPARATE = 's',
    OPTION_SCHEME = 256,
    OPTION_VALUE,
    OPTION_BASES,
    OPTION_PAIRS,
    OPTION_POWER,
    OPTION_SWEEPS,
    OPTION_CRITICAL,
    OPTION_TEXELS,
    OPTION_SPLIT,
    OPTION_CHANNEL,
    OPTION_BUDGET,
    OPTION_NORM,
    OPTION_BYTES,
    OPTION_RANDOM,
    OPTION_SEED,
    OPTION_NODES,
    OPTION_AGAINST,
    OPTION_CSV,
    OPTION_SVG
};

/* Modes: factors as asked for, or searched within an error or a size; each with errors against the solver or
 * against what is in files. */
enum { ASKED_SOLVED = 1, SEARCHED_SOLVED = 2, ASKED_STORED = 4, SEARCHED_STORED = 8 };
enum { ASKED = ASKED_SOLVED | ASKED_STORED, SEARCHED = SEARCHED_SOLVED | SEARCHED_STORED };
enum { SOLVED = ASKED_SOLVED | SEARCHED_SOLVED, STORED = ASKED_STORED | SEARCHED_STORED };

static const char *const schemes[] = {[LQ_SEQUENTIAL] = "sequential", [LQ_JOINT] = "joint", NULL};
static const char *const value_names[] = {
    [LQ_VALUE_PLAIN] = "plain", [LQ_VALUE_SQUARE] = "square", [LQ_VALUE_BEER] = "beer", NULL};
static const char *const norms[] = {[LQ_PCA_MAX] = "max", [LQ_PCA_RMS] = "rms", [LQ_PCA_P99] = "p99", NULL};

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "FILE", "where to write the factors, an EXR file",
     CLI_TEXT(pca_request, output), .silent = true},
    {OPTION_SEPARATE, "separate", "A:N,B:M", "axes to take out, in this order, and bases; A+B:N: as a plane",
     CLI_TEXT(pca_request, separate), .modes = ASKED},
    {OPTION_SCHEME, "scheme", "joint|sequential", "all factors together (default), or D22's iterated PCA",
     CLI_CHOICE(pca_request, options.scheme, schemes), .modes = ASKED},
    {OPTION_VALUE, "value", "plain|square|beer", "what is factored, see below (default plain)",
     CLI_CHOICE(pca_request, options.value, value_names), .modes = ASKED},
    {OPTION_BASES, "bases", "N[,M]", "bases of the plane; beer: of energy and path (default: the product)",
     CLI_TEXT(pca_request, bases), .modes = ASKED},
    {OPTION_PAIRS, "pairs", "N", "products of lines that make a base of two separated axes (default 2)",
     CLI_COUNT(pca_request, options.pairs, 1, 8)},
    {OPTION_CRITICAL, "critical", NULL, "measure mu from the critical cosine; the plane is mu, eta",
     CLI_FLAG(pca_request, options.critical), .modes = ASKED},
    {OPTION_TEXELS, "texels", "AXIS=N[:MAP]", "texels along an axis (default: its nodes); may be repeated",
     CLI_LIST(pca_request, texels), .modes = ASKED},
    {OPTION_SPLIT, "split", "AXIS=X[,Y]", "pieces with factors of their own, cut at nodes: eta=1",
     CLI_TEXT(pca_request, split)},
    {OPTION_BUDGET, "budget", "E", "search the smallest factors with an error of at most E",
     CLI_NUMBER(pca_request, budget, 1e-9, 1.0)},
    {OPTION_BYTES, "bytes", "N", "search the most exact factors within N bytes of half floats",
     CLI_COUNT(pca_request, bytes, 64, (size_t)1 << 40)},
    {OPTION_NORM, "norm", "max|rms|p99", "the error that counts (default max)",
     CLI_CHOICE(pca_request, norm, norms)},
    {OPTION_POWER, "power", "P", "of the error that is minimised (default: 8 for max, 2 rms, 4 p99)",
     CLI_NUMBER(pca_request, options.power, 2.0, 64.0)},
    {OPTION_SWEEPS, "sweeps", "N", "passes over all factors (default 30)",
     CLI_COUNT(pca_request, sweeps, 0, 10000)},
    {OPTION_CHANNEL, "channel", "NAME", "which channel of the table (default: the first)",
     CLI_TEXT(pca_request, channel)},
    {OPTION_RANDOM, "random", "N", "exact values at N random alpha and eta, 2 N of others (default 12)",
     CLI_COUNT(pca_request, random, 2, 128), .modes = SOLVED},
    {OPTION_SEED, "seed", "N", "of the random points (default 1)",
     CLI_COUNT(pca_request, seed, 0, (size_t)1 << 40), .modes = SOLVED},
    {OPTION_NODES, "nodes-only", NULL, "errors at the table's own nodes: no solver is run",
     CLI_FLAG(pca_request, nodes_only)},
    {OPTION_AGAINST, "against", "FILE", "errors at the nodes of this table of the same axes",
     CLI_TEXT(pca_request, against)},
    {OPTION_CSV, "csv", "FILE", "all that was tried: bytes, errors, worst point", CLI_TEXT(pca_request, csv),
     .silent = true},
    {OPTION_SVG, "svg", "FILE", "error against bytes", CLI_TEXT(pca_request, svg), .silent = true},
    CLI_THREADS_OPTION(pca_request, 0),
    CLI_TRUST_OPTIONS(pca_request, SOLVED),
    {0},
};

static bool take_word(void *user, const char *word) {
    pca_request *r = user;
    if (r->input) cli_message("two tables, '%s' and '%s'; accepted is one", r->input, word);
    else r->input = word;
    return r->input == word;
}

/* Whether the search picks what options of the mode ASKED would set. */
static bool searches(const pca_request *r) {
    return r->budget > 0.0 || r->bytes > 0;
}

static bool suits(const pca_request *r, const cli_given *given) {
    const bool stored = r->nodes_only || r->against;
    if (r->nodes_only && r->against) {
        cli_message("both --nodes-only and --against; accepted is one of them");
        return false;
    }
    if (stored && !cli_suits(given, STORED, r->against ? "with --against" : "with --nodes-only"))
        return false;
    if (searches(r)) return cli_suits(given, SEARCHED, "with --budget and --bytes, which search it");
    return cli_suits(given, ASKED, "without --budget and --bytes");
}

static bool check(pca_request *r, const cli_given *given) {
    if (!r->input) cli_message("no table; usage: lacquer pca FILE [options] -o FILE");
    else if (!r->output && !r->csv && !r->svg)
        cli_message("no output file; add -o FILE.exr, --csv FILE or --svg FILE");
    else if (!suits(r, given)) return false;
    else if (!searches(r) && !r->separate && r->options.scheme == LQ_SEQUENTIAL)
        cli_message("--scheme sequential without --separate; write --separate tau:2,alpha:4");
    else
        return (!r->output || cli_output_check(r->output)) && (!r->csv || cli_output_check(r->csv)) &&
               (!r->svg || cli_output_check(r->svg));
    return false;
}

static bool read_arguments(pca_request *r, cli_given *given, int argc, char **argv) {
    static const double powers[] = {[LQ_PCA_MAX] = 8.0, [LQ_PCA_RMS] = 2.0, [LQ_PCA_P99] = 4.0};
    if (!cli_parse(&cli_verb_pca, argc, argv, r, take_word, given)) return false;
    if (!cli_given_text(given, OPTION_POWER)) r->options.power = powers[r->norm];
    r->options.sweeps = (int)r->sweeps;
    return check(r, given);
}

/* ======================================================================================
 *                                         Work
 * ====================================================================================== */

typedef struct result {
    lq_factored *factored;
    lq_pca_try *tries;
    size_t count;
    lq_pca_errors whole; /* over all pieces */
} result;

/* What was asked for, as one try a piece. */
static lq_status fit_asked(const pca_request *r, const lq_table *table, int channel, pca_exact *exact,
                           const lq_progress *progress, result *out, lq_error *error) {
    lq_status status = lq_pca(table, channel, &r->options, progress, &out->factored, error);
    if (status != LQ_OK) return status;
    out->tries = calloc((size_t)out->factored->piece_count, sizeof *out->tries);
    if (!out->tries) return LQ_NO_MEMORY;
    for (int p = 0; p < out->factored->piece_count && status == LQ_OK; p++) {
        const lq_piece *piece = &out->factored->pieces[p];
        lq_pca_try *try = &out->tries[out->count++];
        lq_table *values = NULL;
        *try = (lq_pca_try){.piece = p, .options = r->options, .chosen = true};
        for (int f = 0; f < piece->factor_count; f++)
            try->bytes += lq_factor_texels(&piece->factors[f]) * piece->factors[f].base_count * 2;
        status = pca_exact_values(exact, piece->min, piece->max, &values, error);
        if (status == LQ_OK) status = lq_factored_errors(out->factored, values, channel, &try->errors, error);
        lq_table_free(values);
    }
    return status;
}

static lq_status work(const pca_request *r, const lq_table *table, int channel, pca_exact *exact, result *out,
                      lq_error *error) {
    lq_pca_goal goal = {sizeof goal, r->norm, r->budget, r->bytes, pca_exact_values, exact};
    cli_progress bar;
    cli_progress_begin(&bar, "pca");
    const lq_status status = searches(r) ? lq_pca_search(table, channel, &r->options, &goal, &bar.progress,
                                                         &out->factored, &out->tries, &out->count, error)
                                         : fit_asked(r, table, channel, exact, &bar.progress, out, error);
    cli_progress_end(&bar);
    return status;
}

/* Over all pieces: the largest of the largest and of the p99, the mean of the squares. */
static lq_pca_errors combine(const result *out) {
    lq_pca_errors whole = {0};
    double squares = 0.0;
    for (size_t t = 0; t < out->count; t++) {
        const lq_pca_errors *e = &out->tries[t].errors;
        if (!out->tries[t].chosen) continue;
        squares += e->rms * e->rms * (double)e->points;
        whole.points += e->points;
        whole.p99 = fmax(whole.p99, e->p99);
        if (e->max >= whole.max) {
            whole.max = e->max;
            memcpy(whole.worst, e->worst, sizeof whole.worst);
        }
    }
    whole.rms = whole.points > 0 ? sqrt(squares / (double)whole.points) : 0.0;
    return whole;
}

static lq_status set_facts(const pca_request *r, const pca_exact *exact, const lq_table *table, result *out,
                           lq_error *error) {
    char text[LQ_MAX_AXES * 64] = "";
    const struct {
        const char *key;
        double value;
    } numbers[] = {{"pca-rms", out->whole.rms},
                   {"pca-p99", out->whole.p99},
                   {"pca-max", out->whole.max},
                   {"pca-points", (double)out->whole.points}};
    lq_status status = lq_factored_set_fact(out->factored, "pca-command", r->command, error);
    if (status == LQ_OK) status = lq_factored_set_fact(out->factored, "pca-against", exact->from, error);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers && status == LQ_OK; i++) {
        snprintf(text, sizeof text, i < 3 ? "%.3e" : "%.0f", numbers[i].value);
        status = lq_factored_set_fact(out->factored, numbers[i].key, text, error);
    }
    for (int a = 0, used = 0; a < table->axis_count; a++)
        used += snprintf(text + used, sizeof text - (size_t)used, "%s%.31s=%.9g", a > 0 ? " " : "",
                         table->axes[a].name, out->whole.worst[a]);
    return status == LQ_OK ? lq_factored_set_fact(out->factored, "pca-worst", text, error) : status;
}

static int deliver(const pca_request *r, const lq_table *table, const pca_exact *exact, result *out,
                   lq_status found, const lq_error *cause, double seconds) {
    lq_error error = {""};
    out->whole = combine(out);
    if (!pca_report(r, table, out->tries, out->count, exact)) return CLI_FAILED;
    lq_status status = set_facts(r, exact, table, out, &error);
    if (status == LQ_OK && r->output) status = lq_factored_write(out->factored, r->output, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    printf("%s: %zu bytes, rms %.2e, p99 %.2e, max %.2e over %zu points, %.3g s\n",
           r->output ? r->output : "not written", lq_factored_bytes(out->factored), out->whole.rms,
           out->whole.p99, out->whole.max, out->whole.points, seconds);
    if (found == LQ_NOT_CONVERGED) cli_message("%s; this is the best there was", cause->text);
    return found == LQ_NOT_CONVERGED ? CLI_EXCEEDED : CLI_DONE;
}

static int pca(pca_request *r, const lq_table *table, const lq_table *against) {
    lq_error error = {""};
    result out = {0};
    pca_exact exact;
    int channel, code;
    if (!pca_resolve(r, table, &channel)) return CLI_FAILED;
    if (!pca_exact_choose(&exact, r, table, against)) return CLI_FAILED;
    const double start = cli_seconds();
    const lq_status status = work(r, table, channel, &exact, &out, &error);
    if (status == LQ_OK || status == LQ_NOT_CONVERGED)
        code = deliver(r, table, &exact, &out, status, &error, cli_seconds() - start);
    else code = cli_fail_status(status, &error);
    lq_factored_free(out.factored);
    free(out.tries);
    return code;
}

/* ======================================================================================
 *                                         Verb
 * ====================================================================================== */

static int run(int argc, char **argv) {
    pca_request r = {.options = lq_pca_options_default(), .random = 12, .seed = 1, .sweeps = 30};
    cli_given given;
    lq_error error = {""};
    lq_table *table = NULL, *against = NULL;
    if (!read_arguments(&r, &given, argc, argv)) return CLI_FAILED;
    omp_set_num_threads(r.threads > 0 ? (int)r.threads : omp_get_num_procs()); /* also of the errors */
    r.options.threads = (int)r.threads;
    lq_status status = lq_table_read_exr(&table, r.input, &error);
    if (status == LQ_OK && r.against) status = lq_table_read_exr(&against, r.against, &error);
    r.command = cli_command(&given, &r, r.input);
    const int code = status != LQ_OK ? cli_fail_status(status, &error)
                     : r.command     ? pca(&r, table, against)
                                     : cli_fail("out of memory");
    free(r.command);
    lq_table_free(table);
    lq_table_free(against);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "VALUES  plain: the table; square: its root; beer: T = A tau^(2^s), energy A (no tau in it) and path "
        "s\n"
        "        of a crossing, for transmission tables with tau separated.\n"
        "ERRORS  are those of a GPU: half floats, linear filtering with 8 fractional bits, the clamp to the\n"
        "        physical range. Exact values come from the solver at random points between the nodes, "
        "where\n"
        "        the table says how it was made; otherwise from its nodes.\n"
        "OUTPUT  one EXR with every factor; bits do not depend on the number of threads. Exit 2: written, "
        "but\n"
        "        no factorisation tried met the budget. docs/compression.md has the formulas and figures.\n");
}

const cli_verb cli_verb_pca = {
    .name = "pca",
    .summary = "a table into small textures, with the error a GPU will see",
    .usage = "FILE [--separate A:N,B:M | --budget E | --bytes N] [options] -o FILE",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples =
        "lacquer pca t01.exr --separate tau:2,alpha:4 --scheme sequential -o t01-d22.exr\n"
        "lacquer pca t01.exr --separate tau,eta --value beer --bases 4,8 --pairs 3 -o t01-factors.exr\n"
        "lacquer pca t01.exr --split eta=1 --budget 5e-3 --csv tries.csv --svg tries.svg -o t01-factors.exr\n"
        "lacquer pca fgd.exr --separate n+kappa:8 --norm rms -o fgd-factors.exr\n"
        "lacquer pca fgd.exr --bytes 65536 -o fgd-factors.exr",
    .run = run,
};

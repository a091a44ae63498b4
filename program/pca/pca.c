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

static bool take_word(pca_request *r, const char *value) {
    if (r->input) cli_message("two tables, '%s' and '%s'; accepted is one", r->input, value);
    else r->input = value;
    return r->input == value;
}

static bool take_texels(pca_request *r, const char *value) {
    if (r->texel_count == LQ_MAX_AXES) cli_message("--texels is given more than %d times", (int)LQ_MAX_AXES);
    else r->texels[r->texel_count++] = value;
    return r->texels[r->texel_count - 1] == value;
}

/* Options that are a text for later. */
static const char **text_of(pca_request *r, int id) {
    switch (id) {
    case OPTION_OUTPUT:
        return &r->output;
    case OPTION_SEPARATE:
        return &r->separate;
    case OPTION_BASES:
        return &r->bases;
    case OPTION_SPLIT:
        return &r->split;
    case OPTION_CHANNEL:
        return &r->channel;
    case OPTION_AGAINST:
        return &r->against;
    case OPTION_CSV:
        return &r->csv;
    case OPTION_SVG:
        return &r->svg;
    default:
        return NULL;
    }
}

static bool take_choice(const char *what, const char *value, const char *const *choices, size_t count,
                        int *choice) {
    *choice = cli_parse_choice(what, value, choices, count);
    return *choice >= 0;
}

static bool take_number(pca_request *r, int id, const char *value) {
    static const char *const schemes[] = {"sequential", "joint"},
                             *const values[] = {"plain", "square", "beer"},
                             *const norms[] = {"max", "rms", "p99"};
    lq_pca_options *o = &r->options;
    size_t sweeps = 0;
    int choice = 0;
    bool good = true;
    switch (id) {
    case OPTION_SCHEME:
        good = take_choice("--scheme", value, schemes, 2, &choice);
        o->scheme = (lq_scheme)choice;
        return good;
    case OPTION_VALUE:
        good = take_choice("--value", value, values, 3, &choice);
        o->value = (lq_value)choice;
        return good;
    case OPTION_NORM:
        good = take_choice("--norm", value, norms, 3, &choice);
        r->norm = (lq_pca_norm)choice;
        return good;
    case OPTION_PAIRS:
        return cli_parse_count("--pairs", value, 1, 8, &o->pairs);
    case OPTION_POWER:
        r->power_given = true;
        return cli_parse_number("--power", value, 2.0, 64.0, &o->power);
    case OPTION_SWEEPS:
        good = cli_parse_count("--sweeps", value, 0, 10000, &sweeps);
        o->sweeps = (int)sweeps;
        return good;
    case OPTION_BUDGET:
        return cli_parse_number("--budget", value, 1e-9, 1.0, &r->budget);
    case OPTION_BYTES:
        return cli_parse_count("--bytes", value, 64, (size_t)1 << 40, &r->bytes);
    case OPTION_RANDOM:
        return cli_parse_count("--random", value, 2, 128, &r->random);
    case OPTION_SEED:
        return cli_parse_count("--seed", value, 0, (size_t)1 << 40, &r->seed);
    case CLI_THREADS:
        return cli_parse_count("--threads", value, 1, 1024, &r->threads);
    default:
        return false;
    }
}

static bool take(pca_request *r, int id, const char *value) {
    const char **text = text_of(r, id);
    if (text) *text = value;
    else if (id == CLI_WORD) return take_word(r, value);
    else if (id == OPTION_TEXELS) return take_texels(r, value);
    else if (id == OPTION_CRITICAL) r->options.critical = true;
    else if (id == OPTION_NODES) r->nodes_only = true;
    else return take_number(r, id, value);
    return true;
}

/* Whether the search picks what these options would set. */
static bool searches(const pca_request *r) {
    return r->budget > 0.0 || r->bytes > 0;
}

static bool check(pca_request *r) {
    if (!r->input) cli_message("no table; usage: lacquer pca FILE [options] -o FILE");
    else if (!r->output && !r->csv && !r->svg)
        cli_message("no output file; add -o FILE.exr, --csv FILE or --svg FILE");
    else if (searches(r) && (r->separate || r->bases || r->texel_count > 0 || r->options.critical ||
                             r->options.value != LQ_VALUE_PLAIN || r->options.scheme != LQ_JOINT))
        cli_message(
            "--budget and --bytes search separations, bases, values and texels; leave those options out");
    else if (!searches(r) && !r->separate && r->options.scheme == LQ_SEQUENTIAL)
        cli_message("--scheme sequential without --separate; write --separate tau:2,alpha:4");
    else
        return (!r->output || cli_output_check(r->output)) && (!r->csv || cli_output_check(r->csv)) &&
               (!r->svg || cli_output_check(r->svg));
    return false;
}

static bool read_arguments(pca_request *r, int argc, char **argv) {
    cli_args args = cli_args_begin(&cli_verb_pca, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;)
        if (id == CLI_BAD || !take(r, id, args.value)) return false;
    if (!r->power_given) r->options.power = r->norm == LQ_PCA_RMS ? 2.0 : r->norm == LQ_PCA_P99 ? 4.0 : 8.0;
    return check(r);
}

/* The command line without what does not change the numbers. NULL: out of memory. */
static char *write_command(int argc, char **argv) {
    static const char *const left_out[] = {"-o", "--output", "--csv", "--svg", "--threads"};
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("lacquer pca", out);
    for (int i = 1; i < argc; i++) {
        bool skip = false;
        for (size_t k = 0; k < sizeof left_out / sizeof *left_out; k++)
            skip = skip || strcmp(argv[i], left_out[k]) == 0;
        if (skip) i++;
        else fprintf(out, " %s", argv[i]);
    }
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
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
    pca_exact_choose(&exact, r, table, against);
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
    pca_request r = {.options = lq_pca_options_default(), .random = 12, .seed = 1};
    lq_error error = {""};
    lq_table *table = NULL, *against = NULL;
    if (!read_arguments(&r, argc, argv)) return CLI_FAILED;
    omp_set_num_threads(r.threads > 0 ? (int)r.threads : omp_get_num_procs());
    lq_status status = lq_table_read_exr(&table, r.input, &error);
    if (status == LQ_OK && r.against) status = lq_table_read_exr(&against, r.against, &error);
    r.command = write_command(argc, argv);
    const int code = status != LQ_OK ? cli_fail_status(status, &error)
                     : r.command     ? pca(&r, table, against)
                                     : cli_fail("out of memory");
    free(r.command);
    lq_table_free(table);
    lq_table_free(against);
    return code;
}

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "FILE", "where to write the factors, an EXR file"},
    {OPTION_SEPARATE, "separate", "A:N,B:M", "axes to take out, in this order, and bases; A+B:N: as a plane"},
    {OPTION_SCHEME, "scheme", "joint|sequential", "all factors together (default), or D22's iterated PCA"},
    {OPTION_VALUE, "value", "plain|square|beer", "what is factored, see below (default plain)"},
    {OPTION_BASES, "bases", "N[,M]", "bases of the plane; beer: of energy and path (default: the product)"},
    {OPTION_PAIRS, "pairs", "N", "products of lines that make a base of two separated axes (default 2)"},
    {OPTION_CRITICAL, "critical", NULL, "measure mu from the critical cosine; the plane is mu, eta"},
    {OPTION_TEXELS, "texels", "AXIS=N[:MAP]", "texels along an axis (default: its nodes); may be repeated"},
    {OPTION_SPLIT, "split", "AXIS=X[,Y]", "pieces with factors of their own, cut at nodes: eta=1"},
    {OPTION_BUDGET, "budget", "E", "search the smallest factors with an error of at most E"},
    {OPTION_BYTES, "bytes", "N", "search the most exact factors within N bytes of half floats"},
    {OPTION_NORM, "norm", "max|rms|p99", "the error that counts (default max)"},
    {OPTION_POWER, "power", "P", "of the error that is minimised (default: 8 for max, 2 rms, 4 p99)"},
    {OPTION_SWEEPS, "sweeps", "N", "passes over all factors (default 30)"},
    {OPTION_CHANNEL, "channel", "NAME", "which channel of the table (default: the first)"},
    {OPTION_RANDOM, "random", "N", "exact values at N random alpha and eta, 2 N of others (default 12)"},
    {OPTION_SEED, "seed", "N", "of the random points (default 1)"},
    {OPTION_NODES, "nodes-only", NULL, "errors at the table's own nodes: no solver is run"},
    {OPTION_AGAINST, "against", "FILE", "errors at the nodes of this table of the same axes"},
    {OPTION_CSV, "csv", "FILE", "all that was tried: bytes, errors, worst point"},
    {OPTION_SVG, "svg", "FILE", "error against bytes"},
    CLI_THREADS_OPTION,
    {0},
};

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
    .notes = print_notes,
    .examples =
        "lacquer pca t01.exr --separate tau:2,alpha:4 --scheme sequential -o t01-d22.exr\n"
        "lacquer pca t01.exr --separate tau,eta --value beer --bases 4,8 --pairs 3 -o t01-factors.exr\n"
        "lacquer pca t01.exr --split eta=1 --budget 5e-3 --csv tries.csv --svg tries.svg -o t01-factors.exr\n"
        "lacquer pca fgd.exr --separate n+kappa:8 --norm rms -o fgd-factors.exr\n"
        "lacquer pca fgd.exr --bytes 65536 -o fgd-factors.exr",
    .run = run,
};

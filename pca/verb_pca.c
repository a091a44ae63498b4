/* verb_pca.c - `lacquer pca`: a table into small textures, with the error a GPU will see. */
#include "pca/verb_pca.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress.h"

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
    OPTION_AGAINST,
    OPTION_CHANNEL
};

static bool take(pca_request *r, int id, const char *value) {
    static const char *const schemes[] = {"sequential", "joint"}, *const values[] = {"plain", "square",
                                                                                     "beer"};
    size_t count;
    int choice;
    switch (id) {
    case CLI_WORD:
        if (r->input) return cli_fail("two tables, '%s' and '%s'; accepted is one", r->input, value), false;
        r->input = value;
        return true;
    case OPTION_OUTPUT:
        r->output = value;
        return true;
    case OPTION_SEPARATE:
        r->separate = value;
        return true;
    case OPTION_SPLIT:
        r->split = value;
        return true;
    case OPTION_BASES:
        r->bases = value;
        return true;
    case OPTION_AGAINST:
        r->against = value;
        return true;
    case OPTION_CHANNEL:
        r->channel = value;
        return true;
    case OPTION_CRITICAL:
        r->options.critical = true;
        return true;
    case OPTION_TEXELS:
        if (r->texel_count == LQ_MAX_AXES) return cli_fail("--texels is given too often"), false;
        r->texels[r->texel_count++] = value;
        return true;
    case OPTION_SCHEME:
        choice = cli_parse_choice("--scheme", value, schemes, 2);
        r->options.scheme = (lq_scheme)choice;
        return choice >= 0;
    case OPTION_VALUE:
        choice = cli_parse_choice("--value", value, values, 3);
        r->options.value = (lq_value)choice;
        return choice >= 0;
    case OPTION_PAIRS:
        return cli_parse_count("--pairs", value, 1, 8, &r->options.pairs);
    case OPTION_POWER:
        return cli_parse_number("--power", value, 2.0, 64.0, &r->options.power);
    case OPTION_SWEEPS:
        if (!cli_parse_count("--sweeps", value, 0, 10000, &count)) return false;
        r->options.sweeps = (int)count;
        return true;
    case CLI_THREADS:
        if (!cli_parse_count("--threads", value, 1, 1024, &count)) return false;
        r->threads = (int)count;
        return true;
    default:
        return false;
    }
}

static int factor(pca_request *request, lq_table *table, const lq_table *against) {
    lq_error error = {""};
    lq_factored *factored;
    int channel;
    if (!pca_resolve(request, table, &channel)) return CLI_FAILED;
    cli_progress bar;
    cli_progress_begin(&bar, "pca");
    const double start = cli_seconds();
    lq_status status = lq_pca(table, channel, &request->options, &bar.progress, &factored, &error);
    cli_progress_end(&bar);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    lq_pca_errors e;
    status = lq_factored_errors(factored, against ? against : table, channel, &e, &error);
    printf("%zu bytes, rms %.3g, p99 %.3g, max %.3g at", lq_factored_bytes(factored), e.rms, e.p99, e.max);
    for (int a = 0; a < table->axis_count; a++) printf(" %s=%.4g", table->axes[a].name, e.worst[a]);
    printf(", %.2f s\n", cli_seconds() - start);
    if (status == LQ_OK && request->output) status = lq_factored_write(factored, request->output, &error);
    lq_factored_free(factored);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

static int run(int argc, char **argv) {
    pca_request request = {.options = lq_pca_options_default()};
    cli_args args = cli_args_begin(&cli_verb_pca, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;)
        if (id == CLI_BAD || !take(&request, id, args.value)) return CLI_FAILED;
    if (!request.input) return cli_fail("no table; usage: lacquer pca FILE [options] -o FILE");
    if (request.output && !cli_output_check(request.output)) return CLI_FAILED;
    if (request.threads > 0) omp_set_num_threads(request.threads);
    lq_error error = {""};
    lq_table *table, *against = NULL;
    lq_status status = lq_table_read_exr(&table, request.input, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    if (request.against) status = lq_table_read_exr(&against, request.against, &error);
    const int code = status == LQ_OK ? factor(&request, table, against) : cli_fail_status(status, &error);
    lq_table_free(table);
    lq_table_free(against);
    return code;
}

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "FILE", "where to write the factors, an EXR file"},
    {OPTION_SEPARATE, "separate", "A:N,B:M",
     "axes taken out, in this order, into so many bases; A+B:N as a plane"},
    {OPTION_SCHEME, "scheme", "joint|sequential",
     "all factors fitted together, or D22's plain scheme (default joint)"},
    {OPTION_VALUE, "value", "plain|square|beer", "what is factored (default plain)"},
    {OPTION_BASES, "bases", "N[,M]",
     "bases of the plane: of the value, or of energy and path (default: product)"},
    {OPTION_PAIRS, "pairs", "N", "products of lines in a base of two separated axes (default 2)"},
    {OPTION_POWER, "power", "P", "of the error that is minimised: 2 rms, 8 nearly the largest (default 8)"},
    {OPTION_SWEEPS, "sweeps", "N", "passes over all factors (default 30)"},
    {OPTION_CRITICAL, "critical", NULL, "measure mu from the critical cosine (plane mu, eta)"},
    {OPTION_TEXELS, "texels", "AXIS=N", "texels along an axis (default: one a node); may be repeated"},
    {OPTION_SPLIT, "split", "AXIS=X,..", "pieces, cut at nodes"},
    {OPTION_CHANNEL, "channel", "NAME", "which channel of the table (default: the first)"},
    {OPTION_AGAINST, "against", "FILE", "errors against this table of the same axes"},
    CLI_THREADS_OPTION,
    {0},
};

const cli_verb cli_verb_pca = {
    .name = "pca",
    .summary = "a table into small textures, with the error a GPU will see",
    .usage = "FILE [--separate A:N,B:M] [options] -o FILE",
    .options = options,
    .examples = "lacquer pca fgd.exr --separate n+kappa:8 -o fgd-factors.exr",
    .run = run,
};

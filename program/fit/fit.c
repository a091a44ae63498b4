/* fit.c - `lacquer fit`: the mappings of B18 refitted, with their errors. */
#include "program/fit/bounces.h"

#include "program/message.h"
#include "program/options.h"
#include "program/output.h"
#include "program/settings.h"
#include "program/verb.h"
#include "system/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 256, FAMILY, RANGE, POINTS, NORM, LOSS, REPORT, TEXTURE, SNIPPET };

/* Modes, by what is fitted or tabulated. */
enum { VARIANCE = 1, MAPPING = 2, BOUNCES = 4, ANISOTROPIC = 8, TRANSMITTED = 16 };

static const char *const norms[] = {"max", "rms", NULL};

static bool read_range(void *field, const char *text) {
    double *range = field;
    char low[32] = "";
    const char *colon = strchr(text, ':');
    if (colon && (size_t)(colon - text) < sizeof low) memcpy(low, text, (size_t)(colon - text));
    if (colon && cli_number(low, &range[0]) && cli_number(colon + 1, &range[1]) && range[0] >= 1e-4 &&
        range[1] < 1.0 && range[0] < range[1])
        return true;
    cli_message("--range: '%s' is not A:B with 0.0001 <= A < B < 1", text);
    return false;
}

static const cli_option options[] = {
    {'o', "output", "FILE.json", "coefficients, covariance, errors, the paper's fit on the same points",
     CLI_TEXT(fit_request, output), .silent = true},
    {CLI_NDF, "ndf", "NDF", "distribution of microfacet normals, see `lacquer list` (default ggx)",
     CLI_TEXT(fit_request, ndf_text)},
    {FAMILY, "family", "F", "parametric form, below (default: the last of its mapping)",
     CLI_TEXT(fit_request, family_name), .modes = VARIANCE | MAPPING | BOUNCES},
    {RANGE, "range", "A:B",
     "of alpha, or g (default 0.01:0.8, or 0.9 of f's pole; hg 0.05:0.99; transmission 0.02:0.4)",
     CLI_READ(fit_request, range, read_range), .modes = VARIANCE | MAPPING | BOUNCES},
    {POINTS, "points", "N", "points over the range (default 256)", CLI_COUNT(fit_request, points, 8, 2000),
     .modes = VARIANCE | MAPPING | BOUNCES},
    {NORM, "norm", "max|rms", "what is made small: the largest relative error or the rms (default max)",
     CLI_CHOICE(fit_request, norm, norms), .modes = VARIANCE | MAPPING | BOUNCES},
    {LOSS, "loss", "S", "Cauchy loss of that scale on relative residuals (with --norm rms)",
     CLI_NUMBER(fit_request, loss, 1e-6, 1e3), .modes = VARIANCE | MAPPING | BOUNCES},
    {REPORT, "report", "DIR", "write a web page, DIR/index.html: errors, curve and fits, coefficients",
     CLI_TEXT(fit_request, report), .modes = VARIANCE | MAPPING},
    {TEXTURE, "texture", "FILE", "variance: log2 f over alpha, .exr or .npy; FILE-inverse",
     CLI_TEXT(fit_request, texture), .modes = VARIANCE},
    {SAMPLES, "samples", "N", "bounces, anisotropic: rays a row (default 200000)",
     CLI_COUNT(fit_request, samples, 1000, 1000000000), .modes = BOUNCES | ANISOTROPIC},
    {SNIPPET, "snippet", "FILE", "the function and its inverse: .glsl, .hlsl or .h",
     CLI_TEXT(fit_request, snippet), .modes = VARIANCE | MAPPING},
    {0},
};

static void print_notes(FILE *out) {
    fprintf(
        out,
        "MAPPING is\n"
        "  variance      f(alpha), in which bounces add: f(phi) = 2 f, f ~ v1 at 0 (B18 sec. 4.1)\n"
        "  hg            sigma_g = f(v1^-1(v_HG(g))), a Henyey-Greenstein lobe as f (B18 eq. 21)\n"
        "  transmission  alpha_t, whose reflected lobe is as wide as the transmitted one (B18 eq. 10)\n"
        "  tail          kurtosis E[sin^4] / E[sin^2]^2 of the lobe of v1: 6/5 is the uniform hemisphere,\n"
        "                2 a Gaussian\n"
        "or a table:\n"
        "  bounces       variance of 2, 4, 8 bounces, simulated: exact f, its fit, B18's f\n"
        "  anisotropic   two bounces of anisotropic GGX, frames turned: f per axis (Y19), simulated\n"
        "  transmitted   variance of the transmitted lobe over eta, mu, alpha; B18 eq. 10, eq. "
        "13\n\nFamilies\n");
    for (int i = 0; i < LQ_FAMILIES; i++) {
        const lq_family *family = lq_family_at(i);
        fprintf(out, "  %-12s %-11s %s\n", lq_mapping_name(family->mapping), family->name, family->formula);
    }
    fprintf(out, "\nThe fit itself is done by lacquer-fit, a program of its own that needs Ceres.\n");
}

static int run(int argc, char **argv);

const cli_verb cli_verb_fit = {
    .name = "fit",
    .summary = "fit the mappings of roughness, phase function and transmission",
    .usage = "MAPPING -o FILE.json [options]\nbounces|anisotropic [--samples N] [-o FILE.json]\ntransmitted "
             "[-o FILE.json]",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer fit variance -o variance.json --snippet variance.glsl --report variance\n"
                "lacquer fit variance --ndf gtr:gamma=3 --texture f.exr -o gtr.json\n"
                "lacquer fit hg --family b18 -o hg.json\n"
                "lacquer fit transmission -o transmission.json\n"
                "lacquer fit bounces --samples 1000000",
    .run = run,
};

static bool take_mapping(void *user, const char *text) {
    fit_request *request = user;
    const char *names[LQ_MAPPINGS + 3] = {[LQ_MAPPINGS] = "bounces", "anisotropic", "transmitted"};
    for (int i = 0; i < LQ_MAPPINGS; i++) names[i] = lq_mapping_name((lq_mapping)i);
    if (request->has_mapping) {
        cli_message("unexpected '%s'; fit takes one MAPPING", text);
        return false;
    }
    const int choice = cli_parse_choice("MAPPING", text, names, LQ_MAPPINGS + 3);
    request->table = choice < LQ_MAPPINGS ? FIT_NO_TABLE : (fit_table)(FIT_BOUNCES + choice - LQ_MAPPINGS);
    request->mapping = request->table == FIT_NO_TABLE ? (lq_mapping)choice : LQ_MAP_VARIANCE;
    return request->has_mapping = choice >= 0;
}

static bool find_family(fit_request *request) {
    request->family = lq_family_find(request->mapping, request->family_name);
    if (request->family >= 0) return true;
    char list[LQ_MESSAGE_SIZE] = "";
    for (int i = 0; i < LQ_FAMILIES; i++)
        if (lq_family_at(i)->mapping == request->mapping)
            lq_list_add(list, sizeof list, lq_family_at(i)->name);
    cli_message("--family: '%s' is not one of: %s", request->family_name, list);
    return false;
}

static bool suits(const fit_request *request, const cli_given *given) {
    static const struct {
        unsigned mode;
        const char *where;
    } tables[] = {[FIT_BOUNCES] = {BOUNCES, "for bounces"},
                  [FIT_ANISOTROPIC] = {ANISOTROPIC, "for anisotropic"},
                  [FIT_TRANSMITTED] = {TRANSMITTED, "for transmitted"}};
    if (request->table != FIT_NO_TABLE)
        return cli_suits(given, tables[request->table].mode, tables[request->table].where);
    if (request->mapping == LQ_MAP_VARIANCE) return cli_suits(given, VARIANCE, "for the mapping variance");
    return cli_suits(given, MAPPING, "for this mapping");
}

static bool files_can_be_written(const fit_request *request) {
    const char *const files[] = {request->output, request->texture, request->snippet};
    for (int i = 0; i < 3; i++)
        if (files[i] && !cli_output_check(files[i])) return false;
    return !request->report || cli_report_folder(request->report);
}

static bool parse(fit_request *request, int argc, char **argv) {
    static const double ranges[LQ_MAPPINGS][2] = {{0.01, 0.8}, {0.05, 0.99}, {0.02, 0.4}, {0.01, 0.8}};
    cli_given given;
    *request = (fit_request){.ndf_text = "ggx", .points = 256};
    if (!cli_parse(&cli_verb_fit, argc, argv, request, take_mapping, &given)) return false;
    request->smallest_rms = request->norm == 1;
    request->pole_ends_range = request->range[1] == 0.0;
    if (!request->has_mapping) cli_message("MAPPING is missing; see `lacquer fit --help`");
    else if (!suits(request, &given)) return false;
    else if (request->table == FIT_ANISOTROPIC && strcmp(request->ndf_text, "ggx") != 0)
        cli_message("anisotropic knows no NDF but ggx");
    else if (request->table == FIT_NO_TABLE && !request->output) cli_message("-o FILE.json is missing");
    else if (request->loss > 0.0 && !request->smallest_rms) cli_message("--loss needs --norm rms");
    else {
        const double *range = request->pole_ends_range ? ranges[request->mapping] : request->range;
        request->low = range[0];
        request->high = range[1];
        return files_can_be_written(request) && find_family(request);
    }
    return false;
}

/* The paper's own constants; the scale of f cancels, so it is set to agree at alpha = 0.237, where B18's
 * does. */
static void compare(fit_job *job) {
    job->errors = fit_errors_of(job, job->request.family, job->answer.p);
    job->published = lq_family_find(job->request.mapping, "b18");
    if (job->published < 0) return;
    const lq_family *paper = lq_family_at(job->published);
    memcpy(job->published_p, paper->published, (size_t)paper->parameters * sizeof(double));
    if (job->request.mapping == LQ_MAP_VARIANCE || job->request.mapping == LQ_MAP_HG)
        job->published_p[0] = lq_curve_f(&job->curve, 0.237) * (pow(0.237, -1.1) - 1.0);
    job->published_errors = fit_errors_of(job, job->published, job->published_p);
}

static void print(const fit_job *job) {
    const lq_family *family = lq_family_at(job->request.family);
    printf("%s of %s, family %s\n  %s\n ", lq_mapping_name(job->request.mapping), lq_ndf_text(job->ndf),
           family->name, family->formula);
    for (int k = 0; k < family->parameters; k++) printf(" %c = %.6g", family->names[k], job->answer.p[k]);
    printf("\n  relative error on [%g, %g], %zu points: rms %.3g, max %.3g at %.3g\n", job->request.low,
           job->request.high, job->count, job->errors.rms, job->errors.max, job->errors.max_at);
    if (job->published >= 0)
        printf("  %s: rms %.3g, max %.3g at %.3g\n", lq_family_at(job->published)->source,
               job->published_errors.rms, job->published_errors.max, job->published_errors.max_at);
}

static bool tabulate(const fit_job *job) {
    const fit_request *request = &job->request;
    const size_t samples = request->samples ? request->samples : 200000;
    static const char *const names[] = {"", "bounces", "anisotropic", "transmitted"};
    json_t *rows = request->table == FIT_BOUNCES       ? fit_bounces(job, samples)
                   : request->table == FIT_ANISOTROPIC ? fit_anisotropic(job, samples)
                                                       : fit_transmitted(job);
    if (!rows) return false; /* a line was printed */
    if (request->output)
        return fit_write_rows(job, names[request->table], request->table == FIT_TRANSMITTED ? 0 : samples,
                              rows);
    json_decref(rows);
    return true;
}

static bool work(fit_job *job) {
    const fit_request *request = &job->request;
    if (request->table == FIT_TRANSMITTED) return tabulate(job);
    if (!fit_measure(job)) return false;
    if (request->table == FIT_ANISOTROPIC) return tabulate(job);
    const lq_fit_problem problem = {request->family, job->count,    job->x,
                                    job->y,          request->loss, request->smallest_rms ? 0 : 40};
    if (!fit_run_engine(&problem, &job->answer)) return false;
    compare(job);
    if (request->table == FIT_BOUNCES) return tabulate(job);
    if (request->report && !fit_write_report(job)) return false;
    if (request->texture && !fit_write_texture(job)) return false;
    if (request->snippet && !fit_write_snippet(job)) return false;
    if (!fit_write_json(job)) return false;
    print(job);
    return true;
}

static int run(int argc, char **argv) {
    fit_job *job = calloc(1, sizeof *job);
    if (!job) return cli_fail("no memory");
    bool done = false;
    if (parse(&job->request, argc, argv)) {
        lq_error error = {""};
        const lq_status status = lq_ndf_open(&job->ndf, job->request.ndf_text, &error);
        if (status == LQ_OK) done = work(job);
        else cli_fail_status(status, &error);
    }
    lq_ndf_close(job->ndf);
    free(job->x);
    free(job->y);
    free(job);
    return done ? CLI_DONE : CLI_FAILED;
}

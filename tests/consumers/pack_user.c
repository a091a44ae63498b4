/* Makes a pack from a recipe, certifies it, and reads a value back, with lacquer.h and the installed library
 * alone: pack_user RECIPE FOLDER. Prints the value, the exact one and the error the certificate found. */
#include <lacquer.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int fail(const lq_error *error) {
    fprintf(stderr, "%s\n", error->text);
    return 1;
}

static bool report(void *user, double fraction) {
    *(double *)user = fraction;
    return true;
}

static bool stop(void *user) {
    (void)user;
    return false;
}

/* A budget that is missed writes nothing; a watch that stops it, neither. */
static int refusals(const char *recipe, const char *folder) {
    lq_pack_options options = lq_pack_options_default();
    lq_error error = {""};
    const lq_watch watch = {.struct_size = sizeof watch, .go_on = stop};
    options.watch = &watch;
    if (lq_pack_make(recipe, folder, &options, NULL, &error) != LQ_CANCELLED) return 2;
    if (lq_pack_found(folder)) return 3;
    options.struct_size = 8;
    if (lq_pack_make(recipe, folder, &options, NULL, &error) != LQ_BAD_INPUT) return 4;
    if (!strstr(error.text, "version")) return 5;
    return lq_pack_make("no-such-recipe", folder, NULL, NULL, NULL) == LQ_IO ? 0 : 6;
}

static int make(const char *recipe, const char *folder, lq_error *error) {
    double seen = 0.0;
    lq_pack_options options = lq_pack_options_default();
    const lq_watch watch = {.struct_size = sizeof watch, .report = report, .user = &seen};
    lq_pack_report *made;
    options.watch = &watch;
    if (lq_pack_make(recipe, folder, &options, &made, error) != LQ_OK) return fail(error);
    const lq_pack_entry *entry = lq_pack_report_entry(made, 0);
    const bool good = seen > 0.0 && lq_pack_report_count(made) == 1 && strcmp(entry->name, "albedo") == 0 &&
                      entry->max > 0.0 && entry->max <= entry->budget_max;
    lq_pack_report_free(made);
    return good ? 0 : 7;
}

static int certify(const char *folder, double *max, lq_error *error) {
    lq_certify_options options = lq_certify_options_default();
    lq_certificates *list;
    lq_certificate one;
    options.points = 2000;
    if (lq_certify(folder, &options, &list, error) != LQ_OK) return fail(error);
    const bool good = lq_certificates_count(list) == 1 && lq_certificates_passed(list) &&
                      lq_certificates_get(list, 0, &one) && one.check_count > 0 && !one.failure;
    *max = good ? one.max : 0.0;
    lq_certificates_free(list);
    options.budget = "max=1e-9";
    if (lq_certify(folder, &options, &list, error) != LQ_OK) return fail(error);
    const bool refused = !lq_certificates_passed(list);
    lq_certificates_free(list);
    return good && refused ? 0 : 8;
}

/* Random walks agree with the solver, and a table says what made it. */
static int check_value(const lq_kind *kind, const double *point, double exact, lq_error *error) {
    lq_settings settings = lq_settings_default(), made;
    const lq_kind *found;
    lq_axis axes[2];
    lq_table *table;
    double mean, noise;
    if (lq_eval_walk(kind, &settings, point, 20000, 1, &mean, &noise, error) != LQ_OK) return fail(error);
    if (!(noise > 0.0 && fabs(mean - exact) < 5.0 * noise)) return 11;
    if (lq_axis_parse(&axes[0], "mu", "0.2:1:3", error) != LQ_OK) return fail(error);
    if (lq_axis_parse(&axes[1], "alpha", "0.2:1:3", error) != LQ_OK) return fail(error);
    settings.ndf = "beckmann";
    settings.tolerance = 1e-3;
    if (lq_precompute(kind, &settings, axes, NULL, &table, error) != LQ_OK) return fail(error);
    if (lq_table_settings(table, NULL, &found, &made, error) != LQ_OK) return fail(error);
    const bool same = found == kind && strcmp(made.ndf, "beckmann") == 0 && made.tolerance == 1e-3;
    lq_table_free(table);
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
    return same ? 0 : 12;
}

int main(int argc, char **argv) {
    lq_error error = {""};
    lq_pack *pack;
    size_t function;
    double max, value, exact, estimate;
    const double point[] = {0.4, 0.3};
    const lq_settings settings = lq_settings_default();
    if (argc != 3 || strcmp(lq_version(), LQ_VERSION) != 0) return 9;
    int code = refusals(argv[1], argv[2]);
    if (code == 0) code = make(argv[1], argv[2], &error);
    if (code == 0) code = certify(argv[2], &max, &error);
    if (code != 0) return code;
    if (lq_pack_open(&pack, argv[2], &error) != LQ_OK) return fail(&error);
    if (lq_pack_find(pack, "lacquer_albedo", &function, &error) != LQ_OK) return fail(&error);
    lq_pack_decode(pack, function, point, &value);
    lq_pack_close(pack);
    const lq_kind *kind = lq_kind_find("albedo", &error);
    if (!kind || lq_eval(kind, &settings, point, &exact, &estimate, &error) != LQ_OK) return fail(&error);
    code = check_value(kind, point, exact, &error);
    if (code != 0) return code;
    printf("%.6f %.6f %.2e\n", value, exact, max);
    return fabs(value - exact) <= max + estimate ? 0 : 10;
}

/* test_estimates_long.c - every estimate covers the truth: each kind with each family of NDF (the built-in
 * ones, a tabulated one, a plugin), random points uniform and in the corners, against a tolerance ten times
 * finer. 20 points each, or LACQUER_POINTS; LACQUER_KIND and LACQUER_NDF (the start of its name) pick. 5000
 * points of all take hours. The shares that CI runs are in the other tests of estimates. */
#include "tests/expect.h"

#include "lacquer.h"
#include "tests/measured.h"
#include "tests/uniform.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const ndfs[] = {"ggx",       "beckmann",      "gtr:gamma=1.5", "student-t:gamma=30",
                                   "file:%s/m", "plugin:%s/p.so"};
enum { NDFS = sizeof ndfs / sizeof *ndfs };

static int points_asked(void) {
    const char *asked = getenv("LACQUER_POINTS");
    return asked ? atoi(asked) : 20;
}

static bool picked(const char *variable, const char *name) {
    const char *asked = getenv(variable);
    return !asked || strncmp(name, asked, strlen(asked)) == 0;
}

/* In `folder`: "m", Beckmann's shape at one roughness, as somebody would measure it; "p.so", the plugin of
 * the docs. */
static void make_ndfs(const char *folder) {
    char text[1024];
    snprintf(text, sizeof text, "%s/m", folder);
    FILE *out = fopen(text, "w");
    write_measured(out);
    const char *source = getenv("LACQUER_SOURCE");
    snprintf(text, sizeof text, "cc -O2 -shared -fPIC -I%s %s/docs/ndf_plugin.c -o %s/p.so -lm",
             source ? source : ".", source ? source : ".", folder);
    assert_int_equal(system(text), 0);
}

/* An axis at u in [0,1): even over what a scene asks, or towards the ends where integrals are hard. */
static double coordinate(const lq_axis_info *axis, double u, bool corner) {
    if (strcmp(axis->name, "mu") == 0) return corner ? pow(10.0, -6.0 * u) : u;
    if (strcmp(axis->name, "alpha") == 0) return corner ? pow(10.0, -4.0 * u) : 0.02 + 0.98 * u;
    if (strcmp(axis->name, "eta") == 0) {
        const double eta = corner ? 0.9 + 0.2 * u : pow(4.0, 2.0 * u - 1.0);
        return axis->highest <= 1.0 ? fmin(eta, 2.0 - eta) : eta;
    }
    if (strcmp(axis->name, "n") == 0) return corner ? 0.9 + 0.2 * u : 4.0 * u;
    if (strcmp(axis->name, "kappa") == 0) return corner ? 0.1 * u : 6.0 * u * u;
    return u; /* tau, rho */
}

/* How far a point is beyond its estimate, as a ratio; the reference has an error too, which counts for it. */
static double beyond(const lq_kind *kind, lq_settings settings, const double *point) {
    double value[LQ_MAX_CHANNELS], fine[LQ_MAX_CHANNELS], estimate, rest, worst = 0.0;
    settings.tolerance = kind->tolerance;
    lq_error error = {""};
    const lq_status status = lq_eval(kind, &settings, point, value, &estimate, &error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) {
        print_error("%s, %s: %s\n", kind->id, settings.ndf, error.text);
        return INFINITY;
    }
    settings.tolerance = fmax(0.1 * kind->tolerance, kind->finest_tolerance);
    lq_eval(kind, &settings, point, fine, &rest, NULL);
    for (int c = 0; c < kind->channel_count; c++) {
        const double off = fabs(value[c] - fine[c]);
        if (!(off <= 0.0)) worst = fmax(worst, off / (estimate + rest));
    }
    if (!(worst <= 1.0))
        print_error("%s, %s at %.9g %.9g %.9g %.9g: %.3g beyond %.3g + %.3g\n", kind->id, settings.ndf,
                    point[0], point[1], point[2], point[3], fabs(value[0] - fine[0]), estimate, rest);
    return worst;
}

static int lies_of(const lq_kind *kind, lq_settings settings, double alpha_max, bool corner) {
    const int points = points_asked();
    int lies = 0;
    double worst = 0.0;
    settings.scattering = LQ_MULTIPLE;
    settings.threads = 1;
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : lies) reduction(max : worst)
    for (int i = 0; i < points; i++) {
        double point[LQ_MAX_AXES] = {0.0};
        for (int a = 0; a < kind->axis_count; a++) {
            const double u = uniform(8 * (unsigned long long)i + (unsigned long long)a);
            const bool fixed = alpha_max < 1.0 && strcmp(kind->axes[a].name, "alpha") == 0;
            point[a] = fixed ? alpha_max : coordinate(&kind->axes[a], u, corner);
        }
        const double ratio = beyond(kind, settings, point);
        lies += !(ratio <= 1.0);
        worst = fmax(worst, ratio);
    }
    print_message("%s, %s, %s: %d points, %d beyond, largest ratio %.2g\n", kind->id, settings.ndf,
                  corner ? "corners" : "uniform", points, lies, worst);
    return lies;
}

static int lies_with(const char *ndf) {
    lq_settings settings = lq_settings_default();
    double low, high;
    int lies = 0;
    lq_error error = {""};
    if (lq_ndf_open(&settings.opened, ndf, &error) != LQ_OK) fail_msg("%s", error.text);
    lq_ndf_range(settings.opened, &low, &high);
    settings.ndf = lq_ndf_text(settings.opened);
    for (size_t k = 0; k < lq_kind_count(); k++)
        for (int corner = 0; picked("LACQUER_KIND", lq_kind_at(k)->id) && corner < 2; corner++)
            lies += lies_of(lq_kind_at(k), settings, low < high ? 1.0 : high, corner == 1);
    lq_ndf_close(settings.opened);
    return lies;
}

static void estimates_cover_the_truth(void **state) {
    (void)state;
    char folder[] = "/tmp/lacquer-ndf-XXXXXX", text[1024];
    int lies = 0;
    assert_non_null(mkdtemp(folder));
    make_ndfs(folder);
    for (int n = 0; n < NDFS; n++)
        if (picked("LACQUER_NDF", ndfs[n])) {
            snprintf(text, sizeof text, ndfs[n], folder);
            lies += lies_with(text);
        }
    snprintf(text, sizeof text, "%s/m", folder);
    unlink(text);
    snprintf(text, sizeof text, "%s/p.so", folder);
    unlink(text);
    rmdir(folder);
    assert_int_equal(lies, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_cover_the_truth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_estimates_first_bounce_slow.c - estimates of the kinds of one bounce cover the truth: random points,
 * uniform and in the corners, of every kind and family of NDF against a tolerance ten times finer. 100 points
 * each, or LACQUER_POINTS: 5000 takes some minutes. */
#include "tests/expect.h"

#include "lacquer.h"
#include "tests/measured.h"
#include "tests/uniform.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const kinds[] = {"albedo", "dfg", "albedo-average", "tir-pass", "tir-loss", "fgd"};
static const char *const ndfs[] = {"ggx", "beckmann", "gtr:gamma=1.5", "student-t:gamma=30", "file:%s"};
enum { KINDS = sizeof kinds / sizeof *kinds, NDFS = sizeof ndfs / sizeof *ndfs };

static size_t points_asked(void) {
    const char *asked = getenv("LACQUER_POINTS");
    return asked ? (size_t)strtoul(asked, NULL, 10) : 50;
}

/* Axis `a` at u in [0,1): even over what a scene asks, or towards the ends where integrals are hard. */
static double coordinate(const lq_kind *kind, int a, double u, bool corner) {
    const lq_axis_info *axis = &kind->axes[a];
    if (strcmp(axis->name, "mu") == 0) return corner ? pow(10.0, -6.0 * u) : u;
    if (strcmp(axis->name, "alpha") == 0) return corner ? pow(10.0, -4.0 * u) : 0.02 + 0.98 * u;
    const double low = axis->lowest + 0.05, high = fmin(axis->highest, 4.0);
    return low + (high - low) * u;
}

static int count_lies(const lq_kind *kind, lq_settings settings, double alpha_max, size_t points,
                      bool corner) {
    int lies = 0;
    const double tolerance = kind->tolerance;
    settings.scattering = kind->takes & LQ_TAKES_SCATTERING ? LQ_SINGLE : LQ_MULTIPLE;
    for (size_t i = 0; i < points; i++) {
        double point[LQ_MAX_AXES], value[LQ_MAX_CHANNELS], fine[LQ_MAX_CHANNELS], estimate, rest;
        for (int a = 0; a < kind->axis_count; a++)
            point[a] = coordinate(kind, a, uniform(8 * i + (size_t)a), corner);
        const int alpha = kind->axis_count > 1 ? 1 : 0;
        if (alpha_max < 1.0) point[alpha] = alpha_max;
        settings.tolerance = tolerance;
        lq_error error = {""};
        const lq_status status = lq_eval(kind, &settings, point, value, &estimate, &error);
        if (status != LQ_OK && status != LQ_NOT_CONVERGED)
            fail_msg("%s, %s: %s", kind->id, settings.ndf, error.text);
        settings.tolerance = fmax(0.1 * tolerance, kind->finest_tolerance);
        lq_eval(kind, &settings, point, fine, &rest, NULL);
        for (int c = 0; c < kind->channel_count; c++)
            if (!(fabs(value[c] - fine[c]) <= estimate + rest)) {
                lies++;
                print_error("%s, %s, mu %.6g alpha %.6g: error %.2g, estimate %.2g\n", kind->id, settings.ndf,
                            point[0], point[alpha], fabs(value[c] - fine[c]), estimate);
            }
    }
    return lies;
}

static void estimates_cover_the_truth(void **state) {
    (void)state;
    char path[] = "/tmp/lacquer-ndf-XXXXXX", text[64];
    int lies = 0;
    const int file = mkstemp(path);
    assert_true(file >= 0);
    write_measured(fdopen(file, "w"));
    for (int n = 0; n < NDFS; n++) {
        lq_settings settings = lq_settings_default();
        double low, high;
        snprintf(text, sizeof text, ndfs[n], path);
        assert_int_equal(lq_ndf_open(&settings.opened, text, NULL), LQ_OK);
        lq_ndf_range(settings.opened, &low, &high);
        settings.ndf = lq_ndf_text(settings.opened);
        for (int k = 0; k < KINDS; k++)
            for (int corner = 0; corner < 2; corner++)
                lies += count_lies(lq_kind_find(kinds[k], NULL), settings, low < high ? 1.0 : high,
                                   k == 2 ? points_asked() / 10 : points_asked(), corner == 1);
        lq_ndf_close(settings.opened);
    }
    unlink(path);
    assert_int_equal(lies, 0);
}

/* Two points whose two levels agreed by chance; values from 48 x 64 nodes. */
static void levels_that_agree_by_chance(void **state) {
    (void)state;
    lq_settings settings = lq_settings_default();
    double value, estimate;
    settings.ndf = "beckmann";
    settings.tolerance = 1e-6;
    lq_eval(lq_kind_find("albedo", NULL), &settings, (double[]){0.18896770165506718, 0.29525943626707812},
            &value, &estimate, NULL);
    assert_near(value, 0.9124040956, estimate);
    assert_true(estimate <= 1e-6);
}

/* The error of both levels is that of the total, to which facets that send no light out belong, or of an
 * azimuth that both resolved alike: points that were beyond their estimate by up to 15 times. */
static void beckmann_of_large_alpha(void **state) {
    (void)state;
    static const struct {
        const char *kind;
        double tolerance, point[4];
    } asked[] = {{"albedo", 1e-4, {0.841750481309109, 0.912016669963372}},
                 {"albedo", 1e-4, {0.834634121651449, 0.958065958107514}},
                 {"albedo", 1e-5, {0.962003770003993, 0.994932924107531}},
                 {"fgd", 1e-5, {0.818181818181818, 0.909090909090909, 2.0, 1.0}},
                 {"fgd", 1e-5, {0.544079926066229, 0.73844171037054, 3.67707694876013, 3.66309387540301}}};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        lq_settings settings = lq_settings_default();
        double value, fine, estimate, rest;
        settings.ndf = "beckmann";
        settings.tolerance = asked[i].tolerance;
        lq_eval(lq_kind_find(asked[i].kind, NULL), &settings, asked[i].point, &value, &estimate, NULL);
        settings.tolerance = 0.01 * asked[i].tolerance;
        lq_eval(lq_kind_find(asked[i].kind, NULL), &settings, asked[i].point, &fine, &rest, NULL);
        assert_near(value, fine, estimate + rest);
    }
}

static void covers(const char *id, const char *ndf, const double *point, double tolerance) {
    const lq_kind *kind = lq_kind_find(id, NULL);
    lq_settings settings = lq_settings_default();
    double value, fine, estimate, rest;
    settings.ndf = ndf;
    lq_eval(kind, &settings, point, &value, &estimate, NULL);
    settings.tolerance = 1e-8;
    lq_eval(kind, &settings, point, &fine, &rest, NULL);
    assert_near(value, fine, estimate + rest);
    assert_true(estimate <= tolerance);
}

/* Of 5,000 points some were beyond their estimate: along the horizon levels converge slowly, and rings of two
 * levels were off alike. */
static void along_the_horizon(void **state) {
    (void)state;
    static const struct {
        const char *ndf;
        double mu, alpha;
    } albedo[] = {{"ggx", 3.50228e-06, 0.912651},
                  {"gtr:gamma=1.5", 6.76883e-06, 0.427378},
                  {"gtr:gamma=1.5", 5.95928e-06, 0.582967}};
    static const double loss[][3] = {{0.010092579198164154, 0.7791996258262777, 0.7131040174929053},
                                     {7.152072447696902e-05, 0.8551241249803693, 0.5912540535004268},
                                     {4.318129596236647e-05, 0.8550228846653971, 0.5543473066881519},
                                     {0.004744303435095021, 0.8183446867070937, 0.5221581855388157}};
    for (size_t i = 0; i < sizeof albedo / sizeof *albedo; i++)
        covers("albedo", albedo[i].ndf, (const double[]){albedo[i].mu, albedo[i].alpha}, 1e-6);
    for (size_t i = 0; i < sizeof loss / sizeof *loss; i++)
        covers("tir-loss", "student-t:gamma=30", loss[i], 1e-5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beckmann_of_large_alpha),
        cmocka_unit_test(along_the_horizon),
        cmocka_unit_test(levels_that_agree_by_chance),
        cmocka_unit_test(estimates_cover_the_truth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

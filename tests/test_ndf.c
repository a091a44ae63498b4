/* Every NDF that --ndf names: normalised, its projected areas right, its distribution inverted, energy kept.
 */
#include "microfacet/facets.h"
#include "microfacet/profile.h"
#include "tests/ndf.h"

static const char *const formulas[] = {"ggx",
                                       "beckmann",
                                       "gtr:gamma=1",
                                       "gtr:gamma=1.5",
                                       "gtr:gamma=2",
                                       "gtr:gamma=3",
                                       "gtr:gamma=10",
                                       "student-t:gamma=2",
                                       "student-t:gamma=2.5",
                                       "student-t:gamma=8",
                                       "student-t:gamma=100"};
enum { FORMULAS = sizeof formulas / sizeof formulas[0] };

static const double alphas[] = {1e-6, 1e-4, 0.01, 0.1, 0.4, 0.8, 1.0};
enum { ALPHAS = sizeof alphas / sizeof alphas[0] };
static const double pi = 3.14159265358979323846;

/* integral m_z D dm over normals within `theta`; the last panel is singular, for D ~ cos^(2 gamma - 4). */
static double held_within(const lq_ndf *ndf, double alpha, double theta) {
    lq_gauss rule;
    lq_panels panels;
    lq_gauss_make(&rule, 40);
    lq_panels_start(&panels, 0.0, theta);
    lq_panels_grade(&panels, 0.0, 0.5 * alpha, 2.0);
    for (double gap = 0.3; gap > 1e-5; gap *= 0.25) lq_panels_add(&panels, theta - gap * theta, false);
    double sum = 0.0;
    for (int p = 0; p + 1 < panels.count; p++)
        for (int q = 0; q < rule.count; q++) {
            double slope, d;
            const double at = lq_panels_map(&panels, p, rule.node[q], &slope);
            const double s = sin(at), c = cos(at), s2 = s * s, c2 = c * c;
            ndf->density(ndf, alpha, 1, &c2, &s2, &d);
            sum += rule.weight[q] * slope * 2.0 * pi * s * c * d;
        }
    return sum;
}

static void each_is_normalised(void **state) {
    (void)state;
    for (int i = 0; i < FORMULAS; i++) {
        const lq_ndf *ndf = open_ndf(formulas[i]);
        for (int a = 0; a < ALPHAS; a++) assert_near(held_within(ndf, alphas[a], 0.5 * pi), 1.0, 1e-9);
        lq_ndf_close(ndf);
    }
}

static void quantiles_invert_the_distribution(void **state) {
    (void)state;
    static const double parts[] = {0.0, 1e-6, 0.01, 0.3, 0.7, 0.99, 0.99999};
    for (int i = 0; i < FORMULAS; i++) {
        const lq_ndf *ndf = open_ndf(formulas[i]);
        for (int a = 0; a < ALPHAS; a++)
            for (int k = 0; k < 7; k++) {
                const double slope = ndf->slope_quantile(ndf, alphas[a], parts[k]);
                assert_near(held_within(ndf, alphas[a], atan(slope)), parts[k], 1e-9);
            }
        lq_ndf_close(ndf);
    }
}

typedef struct seen {
    double area;
} seen;

static void add(void *user, const lq_fan *fan) {
    for (int i = 0; i < fan->count; i++) ((seen *)user)->area += fan->weight[i];
}

/* sigma(omega) - sigma(-omega) = mu, both by the facets seen, and each the area that the NDF states: closed
 * form or table against an integral over the sphere that knows D alone. */
static void areas_are_those_of_the_facets(void **state) {
    (void)state;
    static const double cosines[] = {0.0, 1e-4, 0.01, 0.1, 0.5, 0.9, 1.0};
    lq_facet_rule rule;
    lq_facet_rule_make(&rule, 24, 40);
    for (int i = 0; i < FORMULAS; i++) {
        const lq_ndf *ndf = open_ndf(formulas[i]);
        for (int a = 0; a < ALPHAS; a++)
            for (int m = 0; m < 7; m++) {
                const double mu = cosines[m], s = lq_sine(mu), below = ndf->area_below(ndf, alphas[a], mu, s);
                seen front = {0.0}, back = {0.0};
                lq_facets_visit(ndf, alphas[a], mu, s, &rule, NULL, add, &front);
                lq_facets_visit(ndf, alphas[a], -mu, s, &rule, NULL, add, &back);
                if (!(fabs(front.area - back.area - mu) < 1e-6) || !(fabs(back.area - below) < 1e-6))
                    fail_msg("%s alpha %g mu %g: front %.9g back %.9g stated %.9g", formulas[i], alphas[a],
                             mu, front.area, back.area, below);
                double many;
                ndf->areas_below(ndf, alphas[a], 1, &mu, &many);
                assert_near(many, below, 1e-15 + 1e-12 * below);
            }
        lq_ndf_close(ndf);
    }
}

/* The table that a quadrature over D fills, against the closed forms. */
static void quadrature_agrees_with_closed_areas(void **state) {
    (void)state;
    static const char *const closed[] = {"ggx", "beckmann", "student-t:gamma=2.5", "student-t:gamma=8"};
    for (int i = 0; i < 4; i++) {
        const lq_ndf *ndf = open_ndf(closed[i]);
        for (int a = 0; a < ALPHAS; a++)
            for (double mu = 0.0; mu < 1.0; mu += 0.05) {
                const double s = lq_sine(mu), want = ndf->area_below(ndf, alphas[a], mu, s);
                assert_near(lq_area_by_quadrature(ndf, alphas[a], mu, s), want,
                            5e-8 * alphas[a] + 1e-7 * want);
            }
        lq_ndf_close(ndf);
    }
}

/* Two names of one distribution, and the limit of another. */
static void families_meet(void **state) {
    (void)state;
    static const struct {
        const char *first, *second;
        double within;
    } pairs[] = {{"gtr:gamma=2", "ggx", 1e-8},
                 {"student-t:gamma=2", "ggx", 1e-8},
                 {"gtr:gamma=1", "gtr:gamma=1.0000001", 1e-5},
                 {"student-t:gamma=100", "beckmann", 2e-2}};
    for (int i = 0; i < 4; i++) {
        const lq_ndf *one = open_ndf(pairs[i].first), *two = open_ndf(pairs[i].second);
        for (int a = 0; a < ALPHAS; a++)
            for (double mu = 0.0; mu <= 1.0; mu += 0.1) {
                const double s = lq_sine(mu), c2 = mu * mu, s2 = s * s, alpha = alphas[a];
                const double area = two->area_below(two, alpha, mu, s);
                double d, e;
                assert_near(one->area_below(one, alpha, mu, s), area, pairs[i].within * (area + 0.1 * alpha));
                one->density(one, alpha, 1, &c2, &s2, &d);
                two->density(two, alpha, 1, &c2, &s2, &e);
                assert_near(d, e, pairs[i].within * (e + 0.3 / (alpha * alpha)));
            }
        lq_ndf_close(one);
        lq_ndf_close(two);
    }
}

/* F = 1 (n = 0): all light comes back; and a dielectric keeps it. */
static void energy_is_kept(void **state) {
    (void)state;
    double estimate;
    for (int i = 0; i < FORMULAS; i++)
        for (double alpha = 0.1; alpha < 1.0; alpha += 0.6) {
            const double white[] = {0.3, alpha, 0.0, 2.0}, glass[] = {0.3, alpha, 1.5, 1.0};
            assert_near(value_of("fgd", formulas[i], white, &estimate), 1.0, 1e-12);
            const double r = value_of("fgd-dielectric", formulas[i], glass, &estimate);
            const double t = value_of("transmission", formulas[i], glass, &estimate);
            assert_near(r + t, 1.0, 1e-9);
        }
}

/* Solver against random walks that share its NDF and Fresnel code alone. */
static void walks_agree(void **state) {
    (void)state;
    for (int i = 0; i < FORMULAS; i++) {
        expect_walk_agrees("fgd", formulas[i], (const double[]){0.4, 0.3, 0.2, 3.9}, 0.0);
        expect_walk_agrees("fgd-dielectric", formulas[i], (const double[]){0.4, 0.5, 1.5}, 0.0);
        expect_walk_agrees("tir-pass", formulas[i], (const double[]){0.6, 0.2, 0.75}, 0.0);
        expect_walk_agrees("albedo", formulas[i], (const double[]){0.2, 0.6}, 0.0);
    }
}

static void bad_names_are_refused(void **state) {
    (void)state;
    expect_refused("phong", LQ_BAD_INPUT, "unknown NDF 'phong'; known: ggx, beckmann, gtr:gamma=G");
    expect_refused("ggx:gamma=2", LQ_BAD_INPUT, "takes no parameters");
    expect_refused("gtr", LQ_BAD_INPUT, "write gtr:gamma=G");
    expect_refused("gtr:gamma=", LQ_BAD_INPUT, "write gtr:gamma=G");
    expect_refused("gtr:gamma=2x", LQ_BAD_INPUT, "write gtr:gamma=G");
    expect_refused("gtr:gamma=nan", LQ_BAD_INPUT, "out of range; accepted: 1 to 10");
    expect_refused("gtr:gamma=0.5", LQ_BAD_INPUT, "out of range; accepted: 1 to 10");
    expect_refused("student-t:gamma=1.5", LQ_BAD_INPUT, "out of range; accepted: 2 to 100");
}

/* The text of an NDF opens the same one again. */
static void texts_open_again(void **state) {
    (void)state;
    for (int i = 0; i < FORMULAS; i++) {
        const lq_ndf *first = open_ndf(formulas[i]), *second = open_ndf(lq_ndf_text(first));
        assert_string_equal(lq_ndf_text(first), lq_ndf_text(second));
        lq_ndf_close(first);
        lq_ndf_close(second);
    }
    assert_string_equal(formulas[2], "gtr:gamma=1");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_is_normalised),
        cmocka_unit_test(quantiles_invert_the_distribution),
        cmocka_unit_test(areas_are_those_of_the_facets),
        cmocka_unit_test(quadrature_agrees_with_closed_areas),
        cmocka_unit_test(families_meet),
        cmocka_unit_test(energy_is_kept),
        cmocka_unit_test(walks_agree),
        cmocka_unit_test(bad_names_are_refused),
        cmocka_unit_test(texts_open_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

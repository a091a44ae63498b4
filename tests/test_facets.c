/* NDFs, Smith's areas and the facet quadrature: exact identities, at every roughness. */
#include "microfacet/facets.h"
#include "tests/expect.h"

#include "microfacet/kernels.h"

static const double alphas[] = {1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0};
static const double cosines[] = {0.0, 1e-6, 1e-3, 0.05, 0.3, 0.7, 1.0};
enum { ALPHAS = sizeof alphas / sizeof alphas[0], COSINES = sizeof cosines / sizeof cosines[0] };

static void areas_differ_by_the_cosine_and_agree(void **state) {
    (void)state;
    for (size_t i = 0; i < lq_ndf_builtin_count(); i++)
        for (int a = 0; a < ALPHAS; a++)
            for (int m = 0; m < COSINES; m++) {
                const lq_ndf *ndf = lq_ndf_builtin(i);
                const double mu = cosines[m], s = lq_sine(mu), alpha = alphas[a];
                double many;
                const double below = ndf->area_below(ndf, alpha, mu, s);
                ndf->areas_below(ndf, alpha, 1, &mu, &many);
                assert_near(many, below, 1e-15 + 1e-12 * below);
                assert_near(lq_area_above(ndf, alpha, mu, s) - below, mu, 1e-15);
            }
}

static void quantile_inverts_the_distribution(void **state) {
    (void)state;
    for (double xi = 0.0; xi < 1.0; xi += 0.1) {
        const lq_ndf *ndf = lq_ndf_find("ggx");
        const double t = ndf->slope_quantile(ndf, 0.4, xi);
        assert_near(t * t / (0.16 + t * t), xi, 1e-14);
    }
}

typedef struct total {
    double weight;
    double normal_z; /* weight times m_z / (v.m): integrates to the visible part of 1 */
    double v_z;
} total;

static void add(void *user, const lq_fan *fan) {
    total *t = user;
    for (int i = 0; i < fan->count; i++) {
        t->weight += fan->weight[i];
        t->normal_z += fan->weight[i] / fan->cos_d * (fan->cos_d * t->v_z + fan->sin_d * fan->e_z[i]);
    }
}

/* The weights add up to sigma(v), the closed form, for v on the whole sphere. */
static void weights_add_up_to_the_projected_area(void **state) {
    (void)state;
    lq_facet_rule rule;
    lq_gauss_make(&rule.outer, 16);
    lq_gauss_make(&rule.inner, 24);
    const lq_ndf *ndf = lq_ndf_find("ggx");
    for (int a = 0; a < ALPHAS; a++)
        for (int m = 0; m < COSINES; m++)
            for (int side = -1; side <= 1; side += 2) {
                const double mu = cosines[m], s = lq_sine(mu);
                const double area =
                    side > 0 ? lq_area_above(ndf, alphas[a], mu, s) : ndf->area_below(ndf, alphas[a], mu, s);
                if (area == 0.0) continue;
                total t = {0.0, 0.0, side * mu};
                lq_facets_visit(ndf, alphas[a], side * mu, s, &rule, NULL, add, &t);
                assert_near(t.weight / area, 1.0, 1e-6);
            }
}

/* Seen from straight above every facet is visible: integral m_z D = 1 again, through the fans. */
static void everything_is_visible_from_above(void **state) {
    (void)state;
    lq_facet_rule rule;
    lq_gauss_make(&rule.outer, 16);
    lq_gauss_make(&rule.inner, 16);
    for (int a = 0; a < ALPHAS; a++) {
        total t = {0.0, 0.0, 1.0};
        lq_facets_visit(lq_ndf_find("ggx"), alphas[a], 1.0, 0.0, &rule, NULL, add, &t);
        assert_near(t.weight, 1.0, 1e-8);
        assert_near(t.normal_z, 1.0, 1e-8);
    }
}

/* A step in d, put on a break point, costs no accuracy: the area beyond it is complementary. */
typedef struct step {
    double at, below, above;
} step;

static void add_step(void *user, const lq_fan *fan) {
    step *s = user;
    for (int i = 0; i < fan->count; i++) *(fan->d < s->at ? &s->below : &s->above) += fan->weight[i];
}

static void break_points_isolate_a_step(void **state) {
    (void)state;
    double before = 0.0;
    for (int n = 12; n <= 24; n += 12) {
        lq_facet_rule rule;
        lq_gauss_make(&rule.outer, n);
        lq_gauss_make(&rule.inner, 24);
        lq_panels extra;
        lq_panels_start(&extra, 0.0, 1.5707963267948966);
        lq_panels_add(&extra, 0.6123, true);
        step s = {0.6123, 0.0, 0.0};
        lq_facets_visit(lq_ndf_find("ggx"), 0.4, 0.8, 0.6, &rule, &extra, add_step, &s);
        if (n > 12) assert_near(s.below, before, 1e-9);
        before = s.below;
    }
}

/* Every copy of the kernels that this processor runs gives the same facets. */
static void kernel_copies_agree(void **state) {
    (void)state;
    const lq_microfacet_kernels *base = lq_microfacet_kernels_base(), *widest = lq_microfacet_kernels_get();
    double n[37], kappa[37], a[37], b[37];
    for (int i = 0; i < 37; i++) {
        n[i] = 0.1 * i;
        kappa[i] = 0.07 * (36 - i);
    }
    for (double c = 0.0; c <= 1.0; c += 0.125) {
        base->conductors(c, 37, n, kappa, a);
        widest->conductors(c, 37, n, kappa, b);
        for (int i = 0; i < 37; i++) assert_near(a[i], b[i], 1e-13);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(areas_differ_by_the_cosine_and_agree),
        cmocka_unit_test(quantile_inverts_the_distribution),
        cmocka_unit_test(weights_add_up_to_the_projected_area),
        cmocka_unit_test(everything_is_visible_from_above),
        cmocka_unit_test(break_points_isolate_a_step),
        cmocka_unit_test(kernel_copies_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

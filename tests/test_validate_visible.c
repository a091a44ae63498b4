/* Visible normals: both samplers against quadrature over the normals, for GGX and for an NDF with no closed
 * form, from directions above, at and below the horizon. */
#include "microfacet/beckmann.h"
#include "microfacet/ggx.h"
#include "validate/sample_visible.h"
#include "validate/walk.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SAMPLES = 40000, MOMENTS = 4 };

/* m_x, m_z, v.m and its square: what walks depend on. */
static void moments_of(const lq_facet *f, double *moments) {
    moments[0] = f->x;
    moments[1] = f->z;
    moments[2] = f->cosine;
    moments[3] = f->cosine * f->cosine;
}

/* The same means by a midpoint rule over xi = 1 - q^2 and the azimuth, weight v.m / m_z. */
static void integrate(const lq_ndf *ndf, double alpha, double v_z, double v_s, double *mean) {
    enum { Q = 600, PHI = 600 };
    double weights = 0.0;
    for (int k = 0; k < MOMENTS; k++) mean[k] = 0.0;
    for (int i = 0; i < Q; i++) {
        const double q = (i + 0.5) / Q;
        const double slope = ndf->slope_quantile(ndf, alpha, 1.0 - q * q);
        const double z = 1.0 / sqrt(1.0 + slope * slope);
        for (int j = 0; j < PHI; j++) {
            const double x = slope * z * cos(3.14159265358979323846 * (j + 0.5) / PHI);
            const lq_facet facet = {.x = x, .z = z, .cosine = v_z * z + v_s * x};
            if (facet.cosine <= 0.0) continue;
            double moments[MOMENTS];
            moments_of(&facet, moments);
            const double weight = q * facet.cosine / z;
            weights += weight;
            for (int k = 0; k < MOMENTS; k++) mean[k] += weight * moments[k];
        }
    }
    for (int k = 0; k < MOMENTS; k++) mean[k] /= weights;
}

static void check_direction(const lq_visible *visible, double v_z, uint64_t purpose) {
    const double v_s = sqrt((1.0 - v_z) * (1.0 + v_z));
    double sum[MOMENTS] = {0.0}, square[MOMENTS] = {0.0}, want[MOMENTS];
    for (uint64_t i = 0; i < SAMPLES; i++) {
        lq_stream stream = lq_stream_open(1, purpose, i);
        lq_facet facet;
        double moments[MOMENTS];
        lq_visible_sample(visible, v_z, v_s, &stream, &facet);
        assert_true(fabs(facet.x * facet.x + facet.y * facet.y + facet.z * facet.z - 1.0) < 1e-12);
        assert_true(fabs(v_z * facet.z + v_s * facet.x - facet.cosine) < 1e-12);
        assert_true(facet.cosine >= 0.0 && facet.z >= 0.0);
        moments_of(&facet, moments);
        for (int k = 0; k < MOMENTS; k++) {
            sum[k] += moments[k];
            square[k] += moments[k] * moments[k];
        }
    }
    integrate(visible->ndf, visible->alpha, v_z, v_s, want);
    for (int k = 0; k < MOMENTS; k++) {
        const double mean = sum[k] / SAMPLES;
        const double error = sqrt(fmax(square[k] / SAMPLES - mean * mean, 0.0) / SAMPLES);
        if (!(fabs(mean - want[k]) <= 4.5 * error + 2e-4))
            fail_msg("%s alpha %g v_z %g moment %d: %.5f +- %.5f, expected %.5f", visible->ndf->id,
                     visible->alpha, v_z, k, mean, error, want[k]);
    }
}

static void check(const lq_ndf *ndf, bool closed_form) {
    static const double alphas[] = {0.1, 0.5, 1.0}, cosines[] = {1.0, 0.7, 0.1, 0.0, -0.05, -0.3, -0.8};
    for (size_t a = 0; a < 3; a++) {
        lq_visible visible;
        lq_visible_make(&visible, ndf, alphas[a], closed_form);
        for (size_t c = 0; c < 7; c++) {
            /* Steeper than 3 alpha a Beckmann surface shows nothing from below. */
            if (cosines[c] < -0.5 && alphas[a] < 0.5) continue;
            check_direction(&visible, cosines[c], 100 * a + c);
        }
    }
}

static void test_ggx_closed_form(void **state) {
    (void)state;
    check(&lq_ggx, true);
}

static void test_ggx_by_rejection(void **state) {
    (void)state;
    check(&lq_ggx, false);
}

static void test_beckmann_by_rejection(void **state) {
    (void)state;
    check(&lq_beckmann, false);
}

/* Nothing may break at the ends of the range, where 1 + v_z and the slopes underflow. */
static void test_extremes(void **state) {
    (void)state;
    static const double alphas[] = {1e-4, 1e-3, 1.0}, sines[] = {1e-12, 1e-6, 1e-2};
    for (size_t a = 0; a < 3; a++)
        for (size_t s = 0; s < 3; s++)
            for (int below = 0; below < 2; below++) {
                lq_visible visible;
                lq_visible_make(&visible, &lq_ggx, alphas[a], true);
                const double z = sqrt((1.0 - sines[s]) * (1.0 + sines[s]));
                for (uint64_t i = 0; i < 500; i++) {
                    lq_stream stream = lq_stream_open(2, a, i);
                    lq_facet f;
                    lq_visible_sample(&visible, below ? -z : z, sines[s], &stream, &f);
                    assert_true(f.cosine >= 0.0 && f.cosine <= 1.0 + 1e-12 && f.z >= 0.0);
                    assert_true(fabs(f.x * f.x + f.y * f.y + f.z * f.z - 1.0) < 1e-12);
                }
            }
}

/* A whole walk over an NDF with no closed form: the furnace is exact, the first order agrees with single
 * scattering, and reciprocity holds for a dielectric. */
static void test_walk_on_beckmann(void **state) {
    (void)state;
    lq_walk walk = lq_walk_default();
    walk.ndf = &lq_beckmann;
    walk.mu = 0.4;
    walk.alpha = 0.6;
    walk.samples = 40000;
    lq_walk_mean energy, first, single;
    assert_int_equal(lq_walk_reflect(&walk, &energy, &first, 1, NULL), LQ_OK);
    assert_int_equal(lq_walk_single(&walk, LQ_CORRELATED, &single, NULL), LQ_OK);
    assert_true(energy.mean == 1.0);
    assert_true(fabs(first.mean - single.mean) < 4.0 * hypot(first.error, single.error));
    walk.cosine = true;
    walk.fresnel = LQ_WALK_DIELECTRIC;
    walk.n = 1.5;
    lq_walk_sides outside, inside;
    assert_int_equal(lq_walk_two_sided(&walk, &outside, NULL), LQ_OK);
    walk.n = 1.0 / 1.5;
    assert_int_equal(lq_walk_two_sided(&walk, &inside, NULL), LQ_OK);
    const double want = 1.0 - (1.0 - outside.reflected.mean) / 2.25;
    assert_true(fabs(inside.reflected.mean - want) <
                4.0 * hypot(inside.reflected.error, outside.reflected.error / 2.25));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ggx_closed_form),       cmocka_unit_test(test_ggx_by_rejection),
        cmocka_unit_test(test_beckmann_by_rejection), cmocka_unit_test(test_extremes),
        cmocka_unit_test(test_walk_on_beckmann),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

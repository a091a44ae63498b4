/* Weidlich and Wilkie's model, as printed and corrected, and first lobes that are the top interface's BRDF:
 * limits where each is known. */
#include <math.h>

#include "microfacet/fresnel.h"
#include "tests/model_shape.h"

enum { PRINTED, CORRECTED, BOTH };

static lq_shape_query rays(int which) {
    return (lq_shape_query){.model = which == PRINTED ? LQ_MODEL_WEIDLICH_WILKIE
                                                      : LQ_MODEL_WEIDLICH_WILKIE_CORRECTED,
                            .f = LQ_MODEL_F_B18};
}

/* Some directions, one in the plane of incidence. */
static const double somewhere[][3] = {{0.6, 0.0, 0.8}, {-0.1, 0.3, 0.9486833}, {0.0, -0.8, 0.6}};

static double value(const shaped *s, size_t k, const double *to) {
    return lq_model_shape_lobe(&s->shape, 0, k, to[0], to[1], to[2]);
}

/* An interface between equal indices is not there: over a base, and below another. */
static void test_no_interface(void **state) {
    (void)state;
    for (int which = 0; which < BOTH; which++)
        for (double mu = 0.3; mu < 1.0; mu += 0.3) {
            shaped bare = make(LAYERS(CONDUCTOR(0.2, 3.9, 0.1)), rays(which), mu);
            shaped under = make(LAYERS(DIELECTRIC(1, 0.3) "," CONDUCTOR(0.2, 3.9, 0.1)), rays(which), mu);
            shaped one = make(LAYERS(DIELECTRIC(1.5, 0.3) "," LAMBERTIAN(0.5)), rays(which), mu);
            shaped two = make(LAYERS(DIELECTRIC(1.5, 0.3) "," DIELECTRIC(1.5, 0.2) "," LAMBERTIAN(0.5)),
                              rays(which), mu);
            for (int i = 0; i < 3; i++) {
                assert_near(value(&under, 0, somewhere[i]), 0.0, 0.0);
                assert_near(value(&under, 1, somewhere[i]) / value(&bare, 0, somewhere[i]), 1.0, 1e-9);
                assert_near(value(&two, 1, somewhere[i]), 0.0, 0.0);
                assert_near(value(&two, 2, somewhere[i]) / value(&one, 1, somewhere[i]), 1.0, 1e-12);
            }
            drop(&bare);
            drop(&under);
            drop(&one);
            drop(&two);
        }
}

/* One bounce off a Lambertian base under a smooth coat is T(mu) tau^(1/mu_t) rho times what leaves of the
 * base's light, known to eight digits. */
static void test_smooth_coat_is_exact(void **state) {
    (void)state;
    for (double mu = 0.2; mu <= 1.0; mu += 0.4) {
        double below;
        const double lost = lq_fresnel_dielectric(mu, 1.5, &below);
        shaped s = make(LAYERS(COATING(1.5, 0, 0.9) "," LAMBERTIAN(0.7)), rays(CORRECTED), mu);
        const double expected = (1.0 - lost) * pow(0.9, 1.0 / below) * 0.7 * 0.35806443;
        assert_near(lq_model_shape_moments(&s.shape, 0, 1).energy, expected, 1e-3 * expected);
        drop(&s);
    }
}

/* As printed, straight down and up: what spreads as it leaves is not thinned, eta^2 too much. */
static void test_printed_is_too_bright(void **state) {
    (void)state;
    const char *text = LAYERS(COATING(1.5, 0.2, 0.8) "," LAMBERTIAN(0.7));
    const double up[] = {0.0, 0.0, 1.0};
    shaped printed = make(text, rays(PRINTED), 1.0), corrected = make(text, rays(CORRECTED), 1.0);
    assert_near(value(&printed, 1, up) / value(&corrected, 1, up), 2.25, 1e-9);
    assert_near(value(&corrected, 1, up), 0.96 * 0.96 / 2.25 * 0.64 * 0.7 / 3.14159265358979, 1e-9);
    drop(&printed);
    drop(&corrected);
}

static void test_reciprocal(void **state) {
    (void)state;
    for (int which = 0; which < BOTH; which++) {
        shaped s = make(FROSTED, rays(which), 0.8), t = make(FROSTED, rays(which), 0.6);
        const double there[] = {0.8, 0.0, 0.6}, back[] = {0.6, 0.0, 0.8};
        for (size_t k = 0; k < 2; k++)
            assert_near(value(&s, k, there) / 0.6 / (value(&t, k, back) / 0.8), 1.0, 1e-10);
        drop(&s);
        drop(&t);
    }
}

static double single(double mu, double alpha, double n, double kappa) {
    lq_settings settings = lq_settings_default();
    double energy = 0.0, estimate;
    settings.scattering = LQ_SINGLE;
    const lq_status status = lq_eval(lq_kind_find("fgd", NULL), &settings, (double[]){mu, alpha, n, kappa},
                                     &energy, &estimate, NULL);
    assert_int_equal(status, LQ_OK);
    return energy;
}

/* The first lobe has the energy of one scattering at the top: of these models, and of any by its option, by
 * which nothing else changes. */
static void test_first_lobe(void **state) {
    (void)state;
    for (double mu = 0.4; mu <= 1.0; mu += 0.3) {
        const double energy = single(mu, 0.2, 1.5, 0.0);
        lq_shape_query query = {.variant = LQ_MODEL_RELEASED, .f = LQ_MODEL_F_B18};
        shaped ray = make(FROSTED, rays(CORRECTED), mu), model = make(FROSTED, query, mu);
        query.first = LQ_FIRST_EXACT;
        shaped exact = make(FROSTED, query, mu);
        query.first = LQ_FIRST_SCALED;
        shaped scaled = make(FROSTED, query, mu);
        assert_near(lq_model_shape_moments(&ray.shape, 0, 0).energy, energy, 1e-3 * energy);
        assert_near(lq_model_shape_moments(&exact.shape, 0, 0).energy, energy, 1e-3 * energy);
        assert_near(exact.shape.lobes[0].energy, energy, 1e-9);
        const double all = model.shape.lobes[0].energy;
        assert_near(lq_model_shape_moments(&scaled.shape, 0, 0).energy, all, 1e-3 * all);
        for (int i = 0; i < 3; i++) {
            assert_near(value(&exact, 0, somewhere[i]), value(&ray, 0, somewhere[i]), 1e-12);
            assert_near(value(&exact, 1, somewhere[i]), value(&model, 1, somewhere[i]), 0.0);
        }
        drop(&ray);
        drop(&model);
        drop(&exact);
        drop(&scaled);
    }
}

static void test_refused(void **state) {
    (void)state;
    lq_shape_query first = rays(PRINTED), bare = {.first = LQ_FIRST_EXACT, .f = LQ_MODEL_F_B18};
    first.first = LQ_FIRST_SCALED;
    assert_refused(SLAB, rays(PRINTED), 0.5, "the last layer lets light through");
    assert_refused(LAYERS("{\"conductor\": {\"n\": 1, \"kappa\": 1, \"alpha\": 0.1, \"ndf\": \"beckmann\"}}"),
                   rays(CORRECTED), 0.5, "layer 1 has the NDF beckmann");
    assert_refused(FROSTED, rays(CORRECTED), 1.5, "mu = 1.5");
    assert_refused(FROSTED, first, 0.5, "is the top interface's BRDF already");
    assert_refused(LAYERS(LAMBERTIAN(0.5)), bare, 0.5, "a bare lambertian surface");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_interface),
        cmocka_unit_test(test_smooth_coat_is_exact),
        cmocka_unit_test(test_printed_is_too_bright),
        cmocka_unit_test(test_reciprocal),
        cmocka_unit_test(test_first_lobe),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

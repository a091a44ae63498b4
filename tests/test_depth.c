/* Travel between facets: u is itself a polynomial of degree 15 in t, so that the weights must carry it
 * exactly. */
#include "precompute/depth.h"
#include "tests/expect.h"

#include <math.h>

enum { COUNT_OF_DEPTHS = 24 };

static const double lambdas[] = {0.0, 1e-6, 0.01, 0.37, 2.5, 40.0, 1e3, 1e5};

static double sum(const lq_depths *d, const double *weights, int power) {
    double total = 0.0;
    for (int k = 0; k < d->count; k++) total += weights[k] * (power ? d->u[k] : 1.0);
    return total;
}

static void depths_mirror(void **state) {
    (void)state;
    lq_depths d;
    lq_depths_make(&d, COUNT_OF_DEPTHS);
    for (int k = 0; k < d.count; k++) assert_true(d.u[k] + d.u[d.count - 1 - k] == 1.0);
    for (int k = 1; k < d.count; k++) assert_true(d.t[k] > d.t[k - 1]);
}

static void arrivals_have_their_mean(void **state) {
    (void)state;
    lq_depths d;
    double weights[LQ_DEPTHS_MAX];
    lq_depths_make(&d, COUNT_OF_DEPTHS);
    for (size_t i = 0; i < sizeof lambdas / sizeof *lambdas; i++) {
        lq_arrival(&d, lambdas[i], weights);
        assert_near(sum(&d, weights, 0), 1.0, 1e-13);
        assert_near(sum(&d, weights, 1), (1.0 + lambdas[i]) / (2.0 + lambdas[i]), 1e-9);
    }
}

static void travel_carries_the_depth(void **state) {
    (void)state;
    lq_depths d;
    double weights[LQ_DEPTHS_MAX];
    lq_depths_make(&d, COUNT_OF_DEPTHS);
    for (size_t i = 0; i < sizeof lambdas / sizeof *lambdas; i++)
        for (int k = 0; k < d.count; k++) {
            const double l = lambdas[i], u = d.u[k];
            lq_travel_down(&d, l, k, weights);
            assert_near(sum(&d, weights, 0), 1.0, 1e-13);
            assert_near(sum(&d, weights, 1), u * (1.0 + l) / (2.0 + l), 1e-9);
            lq_travel_up(&d, l, k, weights);
            /* log u of u next to 1, times 1e5 */
            assert_near(sum(&d, weights, 0), -expm1(l * log(u)), 1e-11);
            assert_near(sum(&d, weights, 1), l / (1.0 - l) * (pow(u, l) - u), 1e-9);
        }
}

/* Of the light that arrives with density (1 + a) (1 - v)^a and rises with b, in beta functions. */
static void refracted_light_hits_where_it_must(void **state) {
    (void)state;
    lq_depths d;
    double weights[LQ_DEPTHS_MAX];
    lq_depths_make(&d, COUNT_OF_DEPTHS);
    const double a[] = {0.0, 0.3, 5.0, 300.0, 1e6}, b[] = {0.003, 0.37, 2.5, 40.0};
    for (size_t i = 0; i < sizeof a / sizeof *a; i++)
        for (size_t j = 0; j < sizeof b / sizeof *b; j++) {
            const double leaves = lq_refracted_escape(a[i], b[j]);
            lq_refracted_hits(&d, a[i], b[j], weights);
            assert_near(sum(&d, weights, 0), 1.0 - leaves, 1e-12);
            /* 3-point rules between the nodes: the shape is good to 3e-4, its sum exact. */
            assert_near(sum(&d, weights, 1), b[j] / (1.0 - b[j]) * (leaves - 1.0 / (2.0 + a[i])), 3e-4);
        }
    assert_near(lq_refracted_escape(2.0, 3.0), 3.0 / 60.0, 1e-15);
    assert_near(lq_reflected_escape(2.0, 3.0), 0.5, 1e-15);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depths_mirror),
        cmocka_unit_test(arrivals_have_their_mean),
        cmocka_unit_test(travel_carries_the_depth),
        cmocka_unit_test(refracted_light_hits_where_it_must),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

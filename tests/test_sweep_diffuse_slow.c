/* Cosine-weighted means between the sweep's own roughnesses and indices. */
#include "tests/sweep.h"

static void check_both(const char *kind, const char *tau) {
    sweep_check(&(sweep_case){kind, NULL, {"1:2.5:28", NULL, tau}, 1e-4, 3, 20, LQ_MULTIPLE});
    sweep_check(&(sweep_case){kind, NULL, {"1:2.5:28", NULL, tau}, 1e-3, 3, 20, LQ_MULTIPLE});
}

static void test_means(void **state) {
    (void)state;
    check_both("diffuse-transmission", "0:1:7");
    check_both("diffuse-reflection", "0:1:7");
}

static void test_variance(void **state) {
    (void)state;
    sweep_check(&(sweep_case){"variance", NULL, {"1:2.5:28", NULL}, 1e-4, 18, 20, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"variance", NULL, {"1:2.5:28", NULL}, 1e-3, 18, 20, LQ_MULTIPLE});
}

static void test_coated(void **state) {
    (void)state;
    sweep_check(&(sweep_case){"coated-lambertian",
                              NULL,
                              {"0:1:5", "0:1:40", "0.8,1.5", "0.1,0.5,1", "0,0.5,1"},
                              1e-3,
                              6,
                              20,
                              LQ_MULTIPLE});
    sweep_check(&(sweep_case){"coated-lambertian",
                              NULL,
                              {"0:1:5", "0:1:40", "1.5", "0.1,0.5,1", "0,0.5,1"},
                              3e-3,
                              12,
                              20,
                              LQ_MULTIPLE});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_means), cmocka_unit_test(test_variance),
                                       cmocka_unit_test(test_coated)};
    return cmocka_run_group_tests_name("sweep-diffuse", tests, NULL, NULL);
}

/* fgd-dielectric and transmission between the sweep's own roughnesses and indices. */
#include "tests/sweep.h"

static void test_reflection(void **state) {
    (void)state;
    const char *const eta = "0.5,0.95,1,1.03,1.06,1.1,1.15,1.2,1.3,1.4,1.5,1.6,1.8,2,2.5,3";
    sweep_check(&(sweep_case){"fgd-dielectric", NULL, {"0:1:21", NULL, eta}, 1e-4, 6, 20, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"fgd-dielectric", NULL, {"0:1:21", NULL, eta}, 1e-3, 6, 20, LQ_MULTIPLE});
    sweep_check(&(sweep_case){
        "fgd-dielectric", "beckmann", {"0:1:9", "0:1:40:sqrt", "0.8,1.2,1.8"}, 1e-3, 20, 20, LQ_MULTIPLE});
}

static void test_transmission(void **state) {
    (void)state;
    const char *const eta = "0.7,1.03,1.5";
    sweep_check(
        &(sweep_case){"transmission", NULL, {"0:1:21", NULL, eta, "0:1:5"}, 1e-4, 6, 20, LQ_MULTIPLE});
    sweep_check(
        &(sweep_case){"transmission", NULL, {"0:1:21", NULL, eta, "0:1:5"}, 1e-3, 6, 20, LQ_MULTIPLE});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_reflection),
                                       cmocka_unit_test(test_transmission)};
    return cmocka_run_group_tests_name("sweep-dielectric", tests, NULL, NULL);
}

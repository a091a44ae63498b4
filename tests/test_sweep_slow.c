/* Conductors, first bounces and lobes between the sweep's own roughnesses. */
#include "tests/sweep.h"

static void test_conductor(void **state) {
    (void)state;
    const char *const n = "0,0.2,0.6,0.95,1.3,2.5", *const kappa = "0,0.06,0.5,2";
    sweep_check(&(sweep_case){"fgd", NULL, {"0:1:21", NULL, n, kappa}, 1e-5, 5, 40, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"fgd", NULL, {"0:1:21", NULL, n, kappa}, 1e-3, 5, 40, LQ_MULTIPLE});
    sweep_check(&(sweep_case){
        "fgd", "gtr:gamma=1.5", {"0:1:21", "0.001:1:50:sqrt", "0.2", "2,3.9"}, 1e-4, 15, 40, LQ_MULTIPLE});
}

/* Grids of indices that are cut into cells, the last of which ends far away. */
static void test_cells(void **state) {
    (void)state;
    const char *const mu = "0,0.02,0.1,0.3,0.6,1", *const grid = "0:4:33", *const wide = "0.5:60:60";
    sweep_check(&(sweep_case){"fgd", NULL, {mu, "0.05,0.2,0.5,1", grid, grid}, 1e-5, 1, 250, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"fgd", NULL, {mu, "0,0.05,0.2,0.5,1", grid, grid}, 1e-3, 1, 250, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"fgd", NULL, {mu, "0.1,0.7", wide, wide}, 1e-4, 1, 250, LQ_MULTIPLE});
    sweep_check(&(sweep_case){"fgd", NULL, {mu, "0.1,0.7", grid, grid}, 1e-5, 1, 250, LQ_SINGLE});
}

static void test_first_bounce(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        sweep_check(&(sweep_case){"albedo", NULL, {NULL}, i ? 1e-4 : 1e-6, 10, 40, LQ_MULTIPLE});
        sweep_check(&(sweep_case){"dfg", NULL, {NULL}, i ? 1e-4 : 1e-6, 10, 40, LQ_MULTIPLE});
    }
}

static void test_lobes(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        sweep_check(
            &(sweep_case){"tir-pass", NULL, {NULL, NULL, "0:4:33"}, i ? 1e-3 : 1e-5, 4, 40, LQ_MULTIPLE});
        sweep_check(&(sweep_case){"tir-loss", NULL, {NULL}, i ? 1e-3 : 1e-5, 6, 40, LQ_MULTIPLE});
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_conductor), cmocka_unit_test(test_cells),
                                       cmocka_unit_test(test_first_bounce), cmocka_unit_test(test_lobes)};
    return cmocka_run_group_tests_name("sweep", tests, NULL, NULL);
}

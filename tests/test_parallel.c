/* test_parallel.c - the parallel loop: every turn once, the lowest failure whatever the threads, misses that
 * do not stop it, cancelling. */
#include "tests/expect.h"

#include <stdio.h>

#include "system/parallel.h"
#include "system/status.h"

enum { TURNS = 1000 };

typedef struct turns {
    int runs[TURNS];
    size_t fails[2], misses; /* turns; TURNS: none */
} turns;

static lq_status turn(void *user, size_t index, int thread, lq_error *error) {
    turns *t = user;
    t->runs[index]++;
    (void)thread;
    if (index == t->fails[0] || index == t->fails[1])
        return lq_fail(error, LQ_FORMAT, "turn %zu failed", index);
    return index == t->misses ? LQ_NOT_CONVERGED : LQ_OK;
}

static void every_turn_runs_once(void **state) {
    (void)state;
    for (int threads = 0; threads <= 4; threads++) {
        turns t = {.fails = {TURNS, TURNS}, .misses = TURNS};
        assert_int_equal(lq_parallel(TURNS, threads, turn, &t, NULL, NULL), LQ_OK);
        for (size_t i = 0; i < TURNS; i++) assert_int_equal(t.runs[i], 1);
    }
}

static void the_lowest_failure_is_told(void **state) {
    (void)state;
    for (int threads = 1; threads <= 4; threads++) {
        turns t = {.fails = {700, 300}, .misses = 10};
        lq_error error;
        assert_int_equal(lq_parallel(TURNS, threads, turn, &t, NULL, &error), LQ_FORMAT);
        assert_string_equal(error.text, "turn 300 failed");
        for (size_t i = 0; i <= 300; i++) assert_int_equal(t.runs[i], 1);
        assert_int_equal(t.runs[TURNS - 1], 0);
    }
}

static void a_miss_stops_nothing(void **state) {
    (void)state;
    turns t = {.fails = {TURNS, TURNS}, .misses = 3};
    assert_int_equal(lq_parallel(TURNS, 2, turn, &t, NULL, NULL), LQ_NOT_CONVERGED);
    for (size_t i = 0; i < TURNS; i++) assert_int_equal(t.runs[i], 1);
}

static bool until_half(void *user, double fraction) {
    *(double *)user = fraction;
    return fraction < 0.5;
}

static void progress_can_cancel(void **state) {
    (void)state;
    turns t = {.fails = {TURNS, TURNS}, .misses = TURNS};
    double last = 0.0;
    assert_int_equal(lq_parallel(TURNS, 2, turn, &t, &(lq_progress){until_half, &last}, NULL), LQ_CANCELLED);
    assert_near(last, 0.5, 0.0);
    assert_int_equal(t.runs[TURNS - 1], 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_turn_runs_once),
        cmocka_unit_test(the_lowest_failure_is_told),
        cmocka_unit_test(a_miss_stops_nothing),
        cmocka_unit_test(progress_can_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Differences of known make: noise, offset, bias, shared noise and misplaced nodes are told apart. */
#include "tests/expect.h"

#include "validate/pattern.h"
#include "validate/stream.h"

enum { MU = 48, ALPHA = 40 };

/* A smooth table, and a second one on the same nodes for the caller to spoil. */
static void make_pair(lq_table **table, lq_table **reference) {
    const char *channel = "value";
    lq_axis axes[2];
    lq_error error;
    lq_axis_make(&axes[0], "mu", 0.0, 1.0, MU, LQ_MAP_LINEAR, 0.0, &error);
    lq_axis_make(&axes[1], "alpha", 0.0, 1.0, ALPHA, LQ_MAP_LINEAR, 0.0, &error);
    assert_int_equal(lq_table_create(table, axes, 2, &channel, 1, &error), LQ_OK);
    assert_int_equal(lq_table_create(reference, axes, 2, &channel, 1, &error), LQ_OK);
    for (size_t i = 0; i < MU * ALPHA; i++) {
        const double mu = axes[0].nodes[i % MU], alpha = axes[1].nodes[i / MU];
        (*table)->channels[0][i] = (*reference)->channels[0][i] =
            (float)(0.5 + 0.3 * sin(3.0 * mu) * cos(alpha));
    }
    lq_axis_free(&axes[0]);
    lq_axis_free(&axes[1]);
}

/* About normal: the sum of 12 uniform deviates. */
static double deviate(uint64_t seed, uint64_t i) {
    lq_stream stream = lq_stream_open(seed, 0, i);
    double sum = -6.0;
    for (int k = 0; k < 12; k++) sum += lq_stream_uniform(&stream);
    return sum;
}

static lq_pattern judge(lq_table *table, lq_table *reference) {
    lq_pattern pattern;
    lq_error error;
    assert_int_equal(lq_pattern_of(table, reference, 0, 1e-6, &pattern, &error), LQ_OK);
    lq_table_free(table);
    lq_table_free(reference);
    return pattern;
}

static void equal_tables_agree(void **state) {
    (void)state;
    lq_table *table, *reference;
    make_pair(&table, &reference);
    assert_int_equal(judge(table, reference).verdict, LQ_AGREES);
}

static void independent_noise_is_noise(void **state) {
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        lq_table *table, *reference;
        make_pair(&table, &reference);
        for (size_t i = 0; i < MU * ALPHA; i++) table->channels[0][i] += (float)(1e-3 * deviate(seed, i));
        table->channels[0][777] = 1.0f; /* one entry that went wrong is not part of the pattern */
        const lq_pattern p = judge(table, reference);
        assert_int_equal(p.verdict, LQ_NOISE);
        assert_int_equal(p.outliers, 1);
        assert_near(p.rms, 1e-3, 1e-4);
        assert_true(p.independent > 1000.0);
    }
}

static void an_offset_under_noise_is_seen(void **state) {
    (void)state;
    lq_table *table, *reference;
    make_pair(&table, &reference);
    for (size_t i = 0; i < MU * ALPHA; i++) table->channels[0][i] += (float)(1e-3 * deviate(1, i) + 2e-4);
    const lq_pattern p = judge(table, reference);
    assert_int_equal(p.verdict, LQ_OFFSET);
    assert_near(p.mean, 2e-4, 1e-4);
}

static void smooth_errors_are_no_independent_noise(void **state) {
    (void)state;
    lq_table *table, *reference;
    make_pair(&table, &reference);
    for (size_t i = 0; i < MU * ALPHA; i++)
        table->channels[0][i] += (float)(1e-3 * sin(0.2 * (double)(i % MU)) * sin(0.3 * (double)(i / MU)));
    const lq_pattern p = judge(table, reference);
    assert_int_equal(p.verdict, LQ_SHARED);
    assert_true(p.correlation[0] > 0.8 && p.correlation[1] > 0.8);
    /* noise that is the same along mu: nothing but the alphas are independent */
    make_pair(&table, &reference);
    for (size_t i = 0; i < MU * ALPHA; i++) table->channels[0][i] += (float)(1e-3 * deviate(3, i / MU));
    const lq_pattern shared = judge(table, reference);
    assert_int_equal(shared.verdict, LQ_SHARED);
    assert_true(shared.correlation[0] > 0.99 && fabs(shared.correlation[1]) < 0.5);
}

static void errors_of_one_sign_are_a_bias(void **state) {
    (void)state;
    lq_table *table, *reference;
    make_pair(&table, &reference);
    for (size_t i = 0; i < MU * ALPHA; i++) table->channels[0][i] += (float)(1e-3 + 2e-3 * deviate(4, i));
    assert_int_equal(judge(table, reference).verdict, LQ_BIAS);
}

static void other_nodes_are_recognised(void **state) {
    (void)state;
    for (int sampling = 0; sampling < LQ_SAMPLINGS; sampling++) {
        lq_table *table, *reference;
        make_pair(&table, &reference);
        for (size_t i = 0; i < MU * ALPHA; i++) {
            const double n = MU, at = (double)(i % MU);
            const double u[LQ_SAMPLINGS] = {(at + 0.5) / n, at / n, (at + 1.0) / n, (at + 0.5) / (n - 1.0),
                                            (at - 0.5) / (n - 1.0)};
            const double mu = fmin(fmax(u[sampling], 0.0), 1.0), alpha = reference->axes[1].nodes[i / MU];
            table->channels[0][i] = (float)(0.5 + 0.3 * sin(3.0 * mu) * cos(alpha));
        }
        const lq_pattern p = judge(table, reference);
        assert_int_equal(p.verdict, LQ_MISPLACED);
        assert_int_equal(p.best_axis, 0);
        assert_int_equal(p.best_sampling, sampling);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_tables_agree),
        cmocka_unit_test(independent_noise_is_noise),
        cmocka_unit_test(an_offset_under_noise_is_seen),
        cmocka_unit_test(smooth_errors_are_no_independent_noise),
        cmocka_unit_test(errors_of_one_sign_are_a_bias),
        cmocka_unit_test(other_nodes_are_recognised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

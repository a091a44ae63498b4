/* Fitted texels: a function that is linear in each cell is kept, any other is nearer between the nodes than
 * by values at the nodes, and nothing leaves the range of what was sampled. */
#include "pack/fit_texels.h"
#include "pack/measure.h"
#include "tests/expect.h"

static lq_table *compute(const lq_axis *axes) {
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find("dfg", &error);
    lq_settings settings = lq_settings_default();
    lq_table *table;
    settings.ndf = "ggx";
    settings.tolerance = 1e-5;
    if (lq_precompute(kind, &settings, axes, NULL, &table, &error) != LQ_OK) fail_msg("%s", error.text);
    return table;
}

static double largest(const lq_table *table, const lq_axis *axes, int channel) {
    enum { POINTS = 2000 };
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find("dfg", &error);
    lq_settings settings = lq_settings_default();
    lq_table *exact;
    lq_texture texture;
    double most = 0.0;
    settings.ndf = "ggx";
    assert_int_equal(lq_measure_exact(kind, &settings, axes, POINTS, NULL, &exact, &error), LQ_OK);
    assert_int_equal(lq_texture_make(&texture, table, "dfg", &error), LQ_OK);
    for (size_t i = 0; i < POINTS; i++) {
        double point[LQ_MAX_AXES], values[4];
        lq_measure_point(axes, 2, i, point);
        lq_texture_sample(&texture, point, 8, values);
        most = fmax(most, fabs(values[channel] - (double)exact->channels[channel][i]));
    }
    lq_texture_free(&texture);
    lq_table_free(exact);
    return most;
}

/* The split sum in 1 KB, for the figures of docs/packs.md. */
static void test_split_sum(void **state) {
    (void)state;
    lq_error error = {""};
    lq_axis axes[2] = {0}, finer[2] = {0};
    assert_int_equal(lq_axis_parse(&axes[0], "mu", "0.02:1:16:sqrt", &error), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "alpha", "0.02:1:16:sqrt", &error), LQ_OK);
    assert_int_equal(lq_fit_axes(axes, 2, finer, &error), LQ_OK);
    assert_int_equal((int)finer[0].size, 46);
    lq_table *table = compute(axes), *samples = compute(finer);
    double moved;
    const double before[] = {largest(table, axes, 0), largest(table, axes, 1)};
    assert_int_equal(lq_fit_texels(table, samples, LQ_MEASURE_FROM, &moved, &error), LQ_OK);
    for (int c = 0; c < 2; c++) {
        const double after = largest(table, axes, c);
        print_message("%c: largest error %.2e by nodes, %.2e fitted\n", "AB"[c], before[c], after);
        assert_true(after < 0.5 * before[c]);
        assert_true(after <= (c == 0 ? 1.7e-2 : 8.5e-3));
        for (size_t i = 0; i < lq_table_entries(table); i++) assert_true(table->channels[c][i] >= 0.0f);
    }
    lq_table_free(table);
    lq_table_free(samples);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]), lq_axis_free(&finer[a]);
}

/* What linear filtering can hold is held. */
static void test_linear(void **state) {
    (void)state;
    static const char *const channel[] = {"x"};
    lq_error error = {""};
    lq_axis axes[2] = {0}, finer[2] = {0};
    lq_table *table, *samples;
    double moved;
    lq_axis_parse(&axes[0], "u", "0:1:5", &error);
    lq_axis_parse(&axes[1], "v", "0:1:4", &error);
    assert_int_equal(lq_fit_axes(axes, 2, finer, &error), LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 2, channel, 1, &error), LQ_OK);
    assert_int_equal(lq_table_create(&samples, finer, 2, channel, 1, &error), LQ_OK);
    for (size_t i = 0; i < lq_table_entries(samples); i++) {
        const double u = finer[0].nodes[i % finer[0].size], v = finer[1].nodes[i / finer[0].size];
        samples->channels[0][i] = (float)(0.2 + 0.5 * u - 0.1 * v + 0.25 * u * v);
    }
    assert_int_equal(lq_fit_texels(table, samples, 0.0, &moved, &error), LQ_OK);
    for (size_t i = 0; i < lq_table_entries(table); i++) {
        const double u = axes[0].nodes[i % axes[0].size], v = axes[1].nodes[i / axes[0].size];
        assert_near((double)table->channels[0][i], 0.2 + 0.5 * u - 0.1 * v + 0.25 * u * v, 1e-6);
    }
    lq_table_free(table);
    lq_table_free(samples);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]), lq_axis_free(&finer[a]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_split_sum), cmocka_unit_test(test_linear)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

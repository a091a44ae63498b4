/* test_certificate_factors_slow.c - certificates of factored tables: the parts of the error, and one texel of
 * thousands that is off by 2 %. */
#include "tests/expect.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "tables/half.h"
#include "validate/certificate_checks.h"

/* tir-pass into a plane (mu, alpha) and lines along eta. */
static lq_table *make_table(void) {
    const lq_kind *kind = lq_kind_find("tir-pass", NULL);
    const lq_settings settings = lq_settings_default();
    lq_axis axes[3];
    assert_int_equal(lq_axis_parse(&axes[0], "mu", "0.05:1:33", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "alpha", "0.1:1:25", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[2], "eta", "1.1:2.5:17", NULL), LQ_OK);
    lq_table *table;
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, NULL), LQ_OK);
    for (int a = 0; a < 3; a++) lq_axis_free(&axes[a]);
    return table;
}

static lq_factored *factor(const lq_table *table) {
    lq_pca_options options = lq_pca_options_default();
    lq_factored *factored;
    options.separation_count = 1;
    options.separations[0] = (lq_separation){.axis_count = 1, .axes = {2}, .bases = 4};
    assert_int_equal(lq_pca(table, 0, &options, NULL, &factored, NULL), LQ_OK);
    return factored;
}

static const char path[] = "test_certificate_factors.exr", table_path[] = "test_certificate_table.exr";

static void certify(lq_certified *certified, bool with_table, size_t points) {
    lq_judging options = {.points = points, .seed = 1};
    memset(certified, 0, sizeof *certified);
    assert_int_equal(lq_subject_read(&certified->subject, path, NULL, NULL), LQ_OK);
    if (with_table)
        assert_int_equal(lq_subject_add_table(&certified->subject, table_path, NULL, NULL), LQ_OK);
    assert_int_equal(lq_budget_parse(&options.rule.budget, "max=5e-2,p99=1e-2", NULL), LQ_OK);
    assert_int_equal(lq_certified_make(certified, &options, NULL, NULL), LQ_OK);
}

static const lq_check *check_named(const lq_certified *certified, const char *name) {
    for (int i = 0; i < certified->check_count; i++)
        if (strcmp(certified->checks[i].name, name) == 0) return &certified->checks[i];
    return NULL;
}

/* The parts add up to the whole, the half-float part is what rounding to half is expected to leave, the
 * filter's is bounded by a 512th of a texel. */
static void test_parts_add_up(void **state) {
    (void)state;
    lq_certified *certified = malloc(sizeof *certified);
    certify(certified, true, 20000);
    const lq_sampled *c = &certified->certificate;
    assert_int_equal(c->request.stage_count, 4);
    const char *const parts[] = {"interpolation", "factorisation", "half-float", "filter"};
    double bias = 0.0;
    for (int s = 0; s < 4; s++) {
        assert_string_equal(c->request.stages[s].part, parts[s]);
        bias += c->part[s][0].bias;
    }
    assert_near(bias, c->total.bias, 1e-15);
    assert_near(c->error[3][0].max, c->total.max, 0.0);
    assert_null(lq_certified_failure(certified));
    assert_true(c->part[2][0].rms > 2e-5 && c->part[2][0].max < 2e-3);
    /* slope: the largest step between texels, of values below 1 */
    assert_true(c->part[3][0].max > 1e-5 && c->part[3][0].max < 2e-3);
    /* a table without its factors: the first part alone */
    assert_true(c->part[0][0].rms < c->total.rms);
    assert_true(certified->integration.count > 0 && certified->integration.max <= 1.1e-5);
    lq_certified_free(certified);
    free(certified);
}

/* The base that carries most, at four places of its image. */
static void test_one_texel_is_caught(void **state) {
    (void)state;
    lq_certified *certified = malloc(sizeof *certified);
    certify(certified, false, 2000);
    const lq_check *texels = check_named(certified, "single texels");
    assert_non_null(texels);
    assert_int_equal(texels->outcome, LQ_PASSED);
    lq_certified_free(certified);
    lq_factored *factored;
    assert_int_equal(lq_factored_read(&factored, path, NULL), LQ_OK);
    const size_t places[][2] = {{16, 12}, {30, 2}, {2, 22}, {25, 20}};
    for (size_t i = 0; i < 4; i++) {
        lq_factor *plane = &factored->pieces[0].factors[0];
        const size_t texel_count = lq_factor_texels(plane), at = places[i][1] * 33 + places[i][0];
        size_t base = 0;
        for (size_t b = 1; b < plane->base_count; b++)
            if (fabsf(plane->data[b * texel_count + at]) > fabsf(plane->data[base * texel_count + at]))
                base = b;
        float *texel = &plane->data[base * texel_count + at], kept = *texel;
        *texel = lq_half_round(1.02f * kept);
        assert_int_equal(lq_factored_write(factored, path, NULL), LQ_OK);
        certify(certified, false, 2000);
        texels = check_named(certified, "single texels");
        if (texels->outcome != LQ_FAILED)
            fail_msg("texel %zu %zu: %.3g <= %.3g; %s", places[i][0], places[i][1], texels->value,
                     texels->limit, texels->detail);
        /* and found where it is */
        char column[32];
        snprintf(column, sizeof column, "mu=%.5g ", 0.05 + 0.95 * (double)places[i][0] / 32.0);
        if (!strstr(texels->detail, column)) fail_msg("not at %s: %s", column, texels->detail);
        *texel = kept;
        lq_certified_free(certified);
    }
    lq_factored_free(factored);
    free(certified);
}

/* Texels made for places half a cell up. */
static void test_half_a_cell_is_named(void **state) {
    (void)state;
    lq_certified *certified = malloc(sizeof *certified);
    lq_factored *factored;
    assert_int_equal(lq_factored_read(&factored, path, NULL), LQ_OK);
    lq_factor *plane = &factored->pieces[0].factors[0];
    const size_t texel_count = lq_factor_texels(plane);
    for (size_t b = 0; b < plane->base_count; b++)
        for (size_t row = 0; row < 25; row++) {
            float *line = plane->data + b * texel_count + row * 33, kept[33];
            memcpy(kept, line, sizeof kept);
            for (size_t i = 0; i < 33; i++) {
                const double from = fmin((double)i + 0.5, 32.0);
                const size_t below = from < 31.0 ? (size_t)from : 31;
                const float part = (float)(from - (double)below);
                line[i] = lq_half_round(kept[below] + part * (kept[below + 1] - kept[below]));
            }
        }
    assert_int_equal(lq_factored_write(factored, path, NULL), LQ_OK);
    lq_factored_free(factored);
    lq_judging options = {.points = 20000, .seed = 1};
    memset(certified, 0, sizeof *certified);
    assert_int_equal(lq_subject_read(&certified->subject, path, NULL, NULL), LQ_OK);
    assert_int_equal(lq_budget_parse(&options.rule.budget, "max=1e-3", NULL), LQ_OK);
    assert_int_equal(lq_certified_make(certified, &options, NULL, NULL), LQ_OK);
    assert_non_null(lq_certified_failure(certified));
    const lq_check *misplaced = check_named(certified, "looks misplaced");
    assert_non_null(misplaced);
    assert_non_null(strstr(misplaced->detail, "mu sampled at half a cell up"));
    lq_certified_free(certified);
    free(certified);
}

static int set_up(void **state) {
    (void)state;
    lq_table *table = make_table();
    lq_factored *factored = factor(table);
    const bool good = lq_factored_write(factored, path, NULL) == LQ_OK &&
                      lq_table_write_exr(table, table_path, NULL) == LQ_OK;
    lq_factored_free(factored);
    lq_table_free(table);
    return good ? 0 : -1;
}

static int tear_down(void **state) {
    (void)state;
    remove(path);
    remove(table_path);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_parts_add_up, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_one_texel_is_caught, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_half_a_cell_is_named, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

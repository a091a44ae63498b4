/* test_pca.c - factoring tables whose factors are known, whose best error is known, and refusing the rest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cblas.h>
#include <cmocka.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/low_rank.h"
#include "tests/uniform.h"

/* Half-float rounding of a value near 1, of the plane and of each of its partners. */
#define HALVES 1.5e-3

typedef double function(const double *x);

static lq_table *tabulate(function *f, const char *const *axes, int count) {
    lq_axis made[LQ_MAX_AXES] = {0};
    lq_table *table;
    const char *channel = "value";
    for (int a = 0; a < count; a++) {
        char name[16];
        const size_t length = strcspn(axes[a], "=");
        memcpy(name, axes[a], length);
        name[length] = '\0';
        assert_int_equal(lq_axis_parse(&made[a], name, axes[a] + length + 1, NULL), LQ_OK);
    }
    assert_int_equal(lq_table_create(&table, made, count, &channel, 1, NULL), LQ_OK);
    const size_t entries = lq_table_entries(table);
    for (size_t i = 0; i < entries; i++) {
        double x[LQ_MAX_AXES];
        for (size_t a = 0, rest = i; a < (size_t)count; rest /= made[a].size, a++)
            x[a] = made[a].nodes[rest % made[a].size];
        table->channels[0][i] = (float)f(x);
    }
    for (int a = 0; a < count; a++) lq_axis_free(&made[a]);
    return table;
}

static lq_pca_options separate(int count, const int *axes, const size_t *bases) {
    lq_pca_options options = lq_pca_options_default();
    options.separation_count = count;
    for (int i = 0; i < count; i++) options.separations[i] = (lq_separation){1, {axes[i], 0}, bases[i]};
    return options;
}

static lq_pca_errors factor(const lq_table *table, const lq_pca_options *options, size_t *bytes) {
    lq_factored *factored;
    lq_pca_errors errors;
    lq_error error = {""};
    if (lq_pca(table, 0, options, NULL, &factored, &error) != LQ_OK) fail_msg("%s", error.text);
    assert_int_equal(lq_factored_errors(factored, table, 0, &errors, NULL), LQ_OK);
    if (bytes) *bytes = lq_factored_bytes(factored);
    lq_factored_free(factored);
    return errors;
}

/* ------------------------------------------------------------------ singular vectors */

/* An orthonormal cosine over n points (DCT-II). */
static double mode(size_t k, size_t i, size_t n) {
    return sqrt((k == 0 ? 1.0 : 2.0) / (double)n) * cos(M_PI * ((double)i + 0.5) * (double)k / (double)n);
}

/* A matrix with singular values 2^-k: what is cut off is what they say. */
static void test_low_rank_is_the_best(void **state) {
    (void)state;
    enum { ROWS = 300, COLUMNS = 90, TERMS = 30, RANK = 5 };
    float *m = calloc(ROWS * COLUMNS, sizeof *m);
    double *left = malloc(ROWS * RANK * sizeof *left), *right = malloc(COLUMNS * RANK * sizeof *right);
    assert_true(m && left && right);
    for (size_t i = 0; i < ROWS * COLUMNS; i++)
        for (size_t k = 0; k < TERMS; k++)
            m[i] += (float)(ldexp(1.0, -(int)k) * mode(k, i / COLUMNS, ROWS) * mode(k, i % COLUMNS, COLUMNS));
    assert_int_equal(lq_low_rank(m, ROWS, COLUMNS, RANK, left, right, NULL), LQ_OK);
    double squares = 0.0;
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < RANK; k++) sum += left[i / COLUMNS * RANK + k] * right[i % COLUMNS * RANK + k];
        squares += ((double)m[i] - sum) * ((double)m[i] - sum);
    }
    assert_float_equal(sqrt(squares), sqrt(4.0 / 3.0) * ldexp(1.0, -RANK), 1e-6);
    for (size_t k = 0; k < RANK; k++) { /* the vectors themselves, and their signs */
        double dot = 0.0, largest = 0.0;
        for (size_t c = 0; c < COLUMNS; c++) {
            dot += right[c * RANK + k] * mode(k, c, COLUMNS);
            if (fabs(right[c * RANK + k]) > fabs(largest)) largest = right[c * RANK + k];
        }
        assert_float_equal(fabs(dot), 1.0, 1e-6);
        assert_true(largest > 0.0);
    }
    free(m);
    free(left);
    free(right);
}

/* ------------------------------------------------------------------ known factors */

static double two_terms(const double *x) {
    return 0.5 * cos(x[0] * x[1]) * exp(-x[2]) * sqrt(x[3]) + 0.3 * (x[0] + x[1]) * x[2] * x[3] / 2.0;
}

static const char *const four_axes[] = {"mu=0:1:9", "alpha=0:1:7:sqrt", "eta=1:2:8", "tau=0:1:6"};

static void test_two_terms_are_found(void **state) {
    (void)state;
    lq_table *table = tabulate(two_terms, four_axes, 4);
    size_t bytes;
    lq_pca_options options = separate(2, (int[]){3, 2}, (size_t[]){2, 1});
    options.scheme = LQ_SEQUENTIAL;
    assert_true(factor(table, &options, &bytes).max > 1e-2); /* each base of tau needs two of eta */
    options.separations[1].bases = 2;
    assert_true(factor(table, &options, &bytes).max < HALVES);
    assert_int_equal(bytes, 2 * (4 * 9 * 7 + 2 * 6 + 4 * 8));
    options = separate(2, (int[]){3, 2}, (size_t[]){2, 1});
    options.power = 2.0; /* jointly two bases of the plane are enough: half the textures */
    assert_true(factor(table, &options, &bytes).max < HALVES);
    assert_int_equal(bytes, 2 * (2 * 9 * 7 + 4 * 6 + 4 * 8));
    options = separate(1, (int[]){3}, (size_t[]){2});
    options.separations[0] = (lq_separation){2, {2, 3}, 2};
    assert_true(factor(table, &options, &bytes).max < HALVES);
    assert_int_equal(bytes, 2 * (2 * 9 * 7 + 2 * 6 * 8));
    lq_table_free(table);
}

/* Energy and path of a crossing, each a product: exactly two bases where the plain value needs many. */
static double crossing(const double *x) {
    const double energy = (1.0 - 0.3 * x[0] * x[1]) * (1.2 - 0.2 * x[2]) / 1.2;
    return energy * pow(x[3], exp2((1.0 - x[0] / 2.0) * (1.0 + x[1]) * (1.3 - 0.5 * x[2])));
}

static void test_crossings_are_found(void **state) {
    (void)state;
    const char *const axes[] = {"mu=0:1:12", "alpha=0:1:10", "eta=1:2:8", "tau=0:1:11"};
    lq_table *table = tabulate(crossing, axes, 4);
    size_t plain_bytes, bytes;
    lq_pca_options options = separate(2, (int[]){3, 2}, (size_t[]){2, 1});
    options.pairs = 1;
    const lq_pca_errors plain = factor(table, &options, &plain_bytes);
    options.value = LQ_VALUE_BEER;
    options.value_axis = 3;
    options.bases[0] = options.bases[1] = 1;
    const lq_pca_errors beer = factor(table, &options, &bytes);
    assert_true(bytes <= plain_bytes + 2 * 8);
    assert_true(beer.max < HALVES);
    assert_true(plain.max > 10.0 * beer.max);
    lq_table_free(table);
}

/* ------------------------------------------------------------------ better than plain */

/* A rise over a cosine that moves with eta, like that of light from the denser side. */
static double edge(const double *x) {
    const double critical = x[1] < 1.0 ? sqrt(1.0 - x[1] * x[1]) : 0.0;
    const double above = (x[0] - critical) / (1.0 - critical);
    return above > 0.0 ? above * x[2] : 0.0;
}

static void test_critical_cosine_straightens_the_edge(void **state) {
    (void)state;
    const char *const axes[] = {"mu=0:1:512", "eta=0.4:0.95:64", "tau=0.1:1:4"};
    lq_table *table = tabulate(edge, axes, 3);
    lq_pca_options options = separate(1, (int[]){2}, (size_t[]){1});
    options.texels[0] = options.texels[1] = 32;
    const lq_pca_errors plain = factor(table, &options, NULL);
    options.critical = true;
    const lq_pca_errors moved = factor(table, &options, NULL);
    assert_true(moved.max < 0.03);
    assert_true(plain.max > 4.0 * moved.max);
    lq_table_free(table);
}

static double smooth(const double *x) {
    return exp(-3.0 * fabs(x[0] - x[1] * x[2]) - x[3] * x[1]) / (1.0 + x[2] * x[3]);
}

static void test_joint_beats_sequential(void **state) {
    (void)state;
    lq_table *table = tabulate(smooth, four_axes, 4);
    size_t bytes, joint_bytes;
    lq_pca_options options = separate(2, (int[]){3, 2}, (size_t[]){2, 3});
    options.scheme = LQ_SEQUENTIAL;
    const lq_pca_errors plain = factor(table, &options, &bytes);
    options.scheme = LQ_JOINT;
    options.pairs = 1;
    options.power = 2.0;
    const lq_pca_errors rms = factor(table, &options, &joint_bytes);
    options.power = 8.0;
    const lq_pca_errors max = factor(table, &options, &joint_bytes);
    assert_in_range(joint_bytes, 1, bytes + 2 * 4 * 6);
    assert_true(rms.rms < 0.8 * plain.rms);
    assert_true(max.max < rms.max);
    assert_true(max.max < 0.6 * plain.max);
    lq_table_free(table);
}

/* ------------------------------------------------------------------ the same for any number of threads */

static void test_threads_do_not_change_a_bit(void **state) {
    (void)state;
    lq_table *table = tabulate(smooth, four_axes, 4);
    lq_pca_options options = separate(2, (int[]){3, 2}, (size_t[]){2, 3});
    options.sweeps = 5;
    lq_factored *factored[2];
    const int threads = omp_get_max_threads();
#ifdef OPENBLAS_VERSION
    openblas_set_num_threads(2);
#endif
    for (int i = 0; i < 2; i++) {
        options.threads = 1 + 2 * i;
        assert_int_equal(lq_pca(table, 0, &options, NULL, &factored[i], NULL), LQ_OK);
    }
    assert_int_equal(omp_get_max_threads(), threads); /* the caller's settings stay */
#ifdef OPENBLAS_VERSION
    assert_int_equal(openblas_get_num_threads(), 2);
#endif
    for (int f = 0; f < factored[0]->pieces[0].factor_count; f++) {
        const lq_factor *a = &factored[0]->pieces[0].factors[f], *b = &factored[1]->pieces[0].factors[f];
        assert_memory_equal(a->data, b->data, lq_factor_texels(a) * a->base_count * sizeof(float));
    }
    for (int i = 0; i < 2; i++) lq_factored_free(factored[i]);
    lq_table_free(table);
}

/* Every value is in the physical range, in and outside the axes. */
static void test_values_stay_physical(void **state) {
    (void)state;
    lq_table *table = tabulate(smooth, four_axes, 4);
    assert_int_equal(lq_table_set_fact(table, "table", "transmission", NULL), LQ_OK);
    lq_pca_options options = separate(2, (int[]){3, 2}, (size_t[]){1, 1});
    lq_factored *factored;
    assert_int_equal(lq_pca(table, 0, &options, NULL, &factored, NULL), LQ_OK);
    for (unsigned i = 0; i < 4000; i++) {
        double x[4];
        for (unsigned a = 0; a < 4; a++) x[a] = -0.5 + 3.0 * uniform(4 * i + a);
        const double value = lq_factored_lookup_gpu(factored, x);
        assert_true(value >= 0.0 && value <= 1.0);
    }
    lq_factored_free(factored);
    lq_table_free(table);
}

/* ------------------------------------------------------------------ what is refused */

static void refuse(const lq_table *table, lq_pca_options options, const char *word) {
    lq_factored *factored;
    lq_error error = {""};
    assert_int_equal(lq_pca(table, 0, &options, NULL, &factored, &error), LQ_BAD_INPUT);
    assert_null(factored);
    if (!strstr(error.text, word)) fail_msg("'%s' does not say '%s'", error.text, word);
}

static void test_bad_options_are_refused(void **state) {
    (void)state;
    lq_table *table = tabulate(smooth, four_axes, 4);
    const lq_pca_options good = separate(2, (int[]){3, 2}, (size_t[]){1, 1});
    lq_pca_options bad = good;
    bad.separation_count = 1;
    refuse(table, bad, "separate more");
    bad = good;
    bad.separations[1].axes[0] = 3;
    refuse(table, bad, "twice");
    bad = good;
    bad.separations[0].bases = 0;
    refuse(table, bad, "bases");
    bad = good;
    bad.value = LQ_VALUE_BEER;
    bad.value_axis = 0;
    refuse(table, bad, "tau");
    bad = good;
    bad.critical = true;
    refuse(table, bad, "in one plane");
    bad = good;
    bad.split_count = 1;
    bad.split_axis = 2;
    bad.splits[0] = 1.5;
    refuse(table, bad, "nodes inside");
    bad = good;
    bad.split_count = 1;
    bad.split_axis = 4;
    refuse(table, bad, "axis 4 to split; accepted are 0 to 3");
    bad.split_axis = -1;
    refuse(table, bad, "axis -1 to split");
    bad.struct_size = 0; /* nothing else is looked at */
    bad.split_axis = 1 << 20;
    refuse(table, bad, "version");
    bad.split_axis = 1;
    bad.struct_size = sizeof bad + 8;
    refuse(table, bad, "version");
    bad = good;
    bad.power = 1.0;
    refuse(table, bad, "power");
    bad = good;
    bad.threads = -1;
    refuse(table, bad, "threads");
    bad.struct_size = offsetof(lq_pca_options, threads); /* a header that had no such member */
    lq_factored *factored;
    assert_int_equal(lq_pca(table, 0, &bad, NULL, &factored, NULL), LQ_OK);
    lq_factored_free(factored);
    bad = good;
    bad.struct_size = 8;
    refuse(table, bad, "version");
    table->channels[0][7] = NAN;
    refuse(table, good, "finite");
    lq_table_free(table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_low_rank_is_the_best),
        cmocka_unit_test(test_two_terms_are_found),
        cmocka_unit_test(test_crossings_are_found),
        cmocka_unit_test(test_critical_cosine_straightens_the_edge),
        cmocka_unit_test(test_joint_beats_sequential),
        cmocka_unit_test(test_threads_do_not_change_a_bit),
        cmocka_unit_test(test_values_stay_physical),
        cmocka_unit_test(test_bad_options_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

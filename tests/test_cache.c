/* The cache of packs: an entry is found under its key and over its axes, and under no others. */
#include "expect.h"
#include "scratch.h"

#include "lacquer.h"
#include "pack/cache.h"

static lq_error error;

static void make_axes(lq_axis *axes, const char *mu, const char *alpha) {
    assert_int_equal(lq_axis_parse(&axes[0], "mu", mu, &error), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "alpha", alpha, &error), LQ_OK);
}

static void free_axes(lq_axis *axes) {
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
}

static lq_table *make_table(const lq_axis *axes) {
    lq_table *table;
    const char *channel = "value";
    assert_int_equal(lq_table_create(&table, axes, 2, &channel, 1, &error), LQ_OK);
    for (size_t i = 0; i < lq_table_entries(table); i++) table->channels[0][i] = 1.0f / (float)(i + 1);
    return table;
}

/* Other axes than those that were stored: more nodes, another end, another node between, another name. */
static const char *const others[][2] = {
    {"0:1:5", "0.1:1:3"}, {"0:0.9:4", "0.1:1:3"}, {"0:1:4:sqrt", "0.1:1:3"}, {"0:1:4", "0.2:1:3"}};

static void test_tables(void **state) {
    (void)state;
    lq_axis axes[2], other[2];
    make_axes(axes, "0:1:4", "0.1:1:3");
    lq_table *table = make_table(axes), *found;
    assert_int_equal(lq_cache_store(at("store"), "key", table, &error), LQ_OK);
    found = lq_cache_find(at("store"), "key", axes, 2);
    assert_non_null(found);
    lq_table_free(found);
    assert_null(lq_cache_find(at("store"), "another key", axes, 2));
    assert_null(lq_cache_find(at("store"), "key", axes, 1));
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        make_axes(other, others[i][0], others[i][1]);
        assert_null(lq_cache_find(at("store"), "key", other, 2));
        free_axes(other);
    }
    lq_table_free(table);
    free_axes(axes);
}

static void test_factors(void **state) {
    (void)state;
    lq_axis axes[2], other[2];
    make_axes(axes, "0:1:4", "0.1:1:3");
    lq_table *table = make_table(axes);
    lq_pca_options options = lq_pca_options_default();
    options.separation_count = 1;
    options.separations[0] = (lq_separation){1, {1}, 2};
    lq_factored *factored, *found;
    assert_int_equal(lq_pca(table, 0, &options, NULL, &factored, &error), LQ_OK);
    assert_int_equal(lq_cache_store_factored(at("store"), "factors", factored, &error), LQ_OK);
    found = lq_cache_find_factored(at("store"), "factors", axes, 2);
    assert_non_null(found);
    lq_factored_free(found);
    assert_null(lq_cache_find_factored(at("store"), "factors", axes, 1));
    for (int i = 1; i < 4; i += 2) {
        make_axes(other, others[i][0], others[i][1]);
        assert_null(lq_cache_find_factored(at("store"), "factors", other, 2));
        free_axes(other);
    }
    lq_factored_free(factored);
    lq_table_free(table);
    free_axes(axes);
}

static int remove_store(void **state) {
    char command[600];
    snprintf(command, sizeof command, "rm -r '%s'", at("store"));
    return system(command) == 0 ? remove_folder(state) : -1;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_factors),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_store);
}

/* A host program that speaks German: numbers in files, specifications, recipes and decode source keep their
 * point. Every output is made twice, in the C locale and in one with a decimal comma, and has to be the same.
 */
#include "expect.h"
#include "scratch.h"

#include <locale.h>
#include <string.h>

#include "lacquer.h"
#include "pack/recipe.h"
#include "pack/source.h"
#include "stack/description.h"
#include "system/input.h"
#include "system/status.h"
#include "tables/origin.h"
#include "validate/certificate_budget.h"

static lq_error error;

static void expect_ok(lq_status status) {
    if (status != LQ_OK) fail_msg("%s", error.text);
}

static void write_text(const char *path, const char *text) {
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_true(fputs(text, out) >= 0 && fclose(out) == 0);
}

static lq_table *make_table(void) {
    const lq_kind *kind = lq_kind_find("albedo", &error);
    lq_settings settings = lq_settings_default();
    settings.tolerance = 1.5e-5;
    settings.ndf = "student-t:gamma=2.5";
    settings.threads = 1;
    lq_axis axes[2];
    lq_table *table;
    expect_ok(lq_axis_parse(&axes[0], "mu", "0.05:0.95:4:power2.5", &error));
    expect_ok(lq_axis_parse(&axes[1], "alpha", "0.25:0.5:3", &error));
    expect_ok(lq_precompute(kind, &settings, axes, NULL, &table, &error));
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    return table;
}

static void write_source(const lq_table *table, const char *path) {
    lq_texture texture;
    expect_ok(lq_texture_make(&texture, table, "albedo", &error));
    const lq_source_table entry = {lq_kind_find("albedo", &error), &texture, NULL};
    expect_ok(lq_source_write(LQ_C, &entry, 1, path, &error));
    lq_texture_free(&texture);
}

static void write_factors(const lq_table *table, const char *path) {
    lq_pca_options options = lq_pca_options_default();
    options.separation_count = 1;
    options.separations[0] = (lq_separation){1, {1}, 2};
    lq_factored *factored, *back;
    expect_ok(lq_pca(table, 0, &options, NULL, &factored, &error));
    expect_ok(lq_factored_write(factored, path, &error));
    expect_ok(lq_factored_read(&back, path, &error));
    assert_near(back->axes[1].min, 0.25, 0.0);
    lq_factored_free(factored);
    lq_factored_free(back);
}

static void write_stack(const char *path) {
    static const char text[] = "{\"layers\": [{\"dielectric\": {\"n\": 1.52, \"alpha\": 0.125}}, "
                               "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": 0.05}}]}";
    lq_stack *stack;
    char *made;
    expect_ok(lq_stack_parse(&stack, text, "stack", 0, &error));
    expect_ok(lq_stack_text(stack, &made, &error));
    write_text(path, made);
    free(made);
    lq_stack_free(stack);
}

static void read_recipe(const char *path) {
    lq_recipe recipe;
    write_text(
        path,
        "{\"name\": \"small\", \"formats\": [\"npy\"], \"points\": 100, \"budget\": {\"max\": 2.5e-3},\n"
        " \"tables\": [{\"table\": \"albedo\", \"axes\": {\"mu\": \"0.5:1:8\", \"alpha\": \"0:0.5:4\"},"
        " \"tolerance\": 1.5e-3}]}");
    expect_ok(lq_recipe_read(&recipe, path, NULL, &error));
    assert_near(recipe.tables[0].axes[0].min, 0.5, 0.0);
    assert_near(recipe.tables[0].settings.tolerance, 1.5e-3, 0.0);
    lq_recipe_free(&recipe);
}

static void read_range(void) {
    lq_rule rule = {.range_count = 0};
    expect_ok(lq_ranges_parse(&rule, "mu=0.25:0.75,alpha=0.5:1", &error));
    assert_int_equal(rule.range_count, 2);
    assert_near(rule.ranges[0].min, 0.25, 0.0);
}

/* All of it, under names that begin with `prefix`. */
static void make_all(const char *prefix) {
    char name[64];
    lq_table *made = make_table(), *table;
    snprintf(name, sizeof name, "%s.exr", prefix);
    expect_ok(lq_table_write_exr(made, at(name), &error));
    lq_table_free(made);
    expect_ok(lq_table_read_exr(&table, at(name), &error));
    assert_string_equal(lq_table_fact(table, "ndf"), "student-t:gamma=2.5");
    assert_string_equal(lq_table_fact(table, "tolerance"), "1.5e-05");
    lq_origin origin;
    expect_ok(lq_origin_of(table, NULL, &origin, &error));
    assert_near(origin.settings.tolerance, 1.5e-5, 0.0);
    snprintf(name, sizeof name, "%s.h", prefix);
    write_source(table, at(name));
    snprintf(name, sizeof name, "%s.factors", prefix);
    write_factors(table, at(name));
    snprintf(name, sizeof name, "%s.npy", prefix);
    expect_ok(lq_table_write_npy(table, at(name), &error));
    snprintf(name, sizeof name, "%s.stack", prefix);
    write_stack(at(name));
    snprintf(name, sizeof name, "%s.recipe", prefix);
    read_recipe(at(name));
    read_range();
    lq_fail(&error, LQ_BAD_INPUT, "%g", 0.5);
    assert_string_equal(error.text, "0.5");
    lq_table_free(table);
}

static void expect_same(const char *ending) {
    char name[64], *one, *two;
    size_t one_size, two_size;
    snprintf(name, sizeof name, "point%s", ending);
    expect_ok(lq_input_read(at(name), &one, &one_size, &error));
    unlink(at(name));
    snprintf(name, sizeof name, "comma%s", ending);
    expect_ok(lq_input_read(at(name), &two, &two_size, &error));
    unlink(at(name));
    if (one_size != two_size || memcmp(one, two, one_size) != 0) fail_msg("%s differs", ending);
    free(one);
    free(two);
}

static bool speaks_comma(void) {
    return localeconv()->decimal_point[0] == ',';
}

/* One that is installed, or one made for the test. */
static bool set_comma(void) {
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    for (int i = 0; i < 4; i++)
        if (setlocale(LC_ALL, names[i]) && speaks_comma()) return true;
    char command[1400];
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s' >/dev/null 2>&1", at("de_DE.UTF-8"));
    if (system(command) != 0) return false;
    setenv("LOCPATH", folder, 1);
    return setlocale(LC_ALL, "de_DE.UTF-8") && speaks_comma();
}

static void test_point_and_comma(void **state) {
    (void)state;
    static const char *const endings[] = {".exr", ".h", ".factors", ".npy", ".stack", ".recipe"};
    setlocale(LC_ALL, "C");
    make_all("point");
    assert_true(set_comma());
    make_all("comma");
    assert_true(speaks_comma()); /* it is the host's, and stays */
    setlocale(LC_ALL, "C");
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) expect_same(endings[i]);
}

static int remove_locale(void **state) {
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", at("de_DE.UTF-8"));
    if (system(command) != 0) return -1;
    return remove_folder(state);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_point_and_comma)};
    if (make_folder(NULL) != 0) return 1;
    const bool there = set_comma();
    setlocale(LC_ALL, "C");
    if (!there) return remove_locale(NULL) == 0 ? 77 : 1;
    return cmocka_run_group_tests(tests, NULL, remove_locale);
}

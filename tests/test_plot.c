/* Charts: the file is whole, text is escaped, undrawable points are left out, hopeless input is refused. */
#include "picture/plot.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/lacquer-plot-XXXXXX";
static char path[64];

static int make_folder(void **state) {
    (void)state;
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/chart.svg", folder);
    return 0;
}

static int remove_folder(void **state) {
    (void)state;
    unlink(path);
    return rmdir(folder);
}

static char *read_chart(void) {
    static char text[65536];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

static size_t occurrences(const char *text, const char *what) {
    size_t count = 0;
    for (; (text = strstr(text, what)); text += strlen(what)) count++;
    return count;
}

static const double x[4] = {1e-6, 1e-4, 1e-2, 1.0}, y[4] = {1e-2, 0.0, 1e-4, NAN};

static lq_plot chart(const lq_plot_line *series) {
    const lq_plot plot = {.title = "a < b & c",
                          .x = {"seconds", true},
                          .y = {"error", true},
                          .series = series,
                          .series_count = 1};
    return plot;
}

static void test_chart(void **state) {
    (void)state;
    const lq_plot_line series = {.name = "solver", .count = 4, .x = x, .y = y, .hue = 1};
    const lq_plot plot = chart(&series);
    lq_error error = {""};
    assert_int_equal(lq_plot_write(&plot, path, &error), LQ_OK);
    const char *text = read_chart();
    assert_non_null(strstr(text, "a &lt; b &amp; c"));
    assert_non_null(strstr(text, "</svg>\n"));
    assert_non_null(strstr(text, "10⁻⁶"));
    assert_null(strstr(text, "nan"));
    assert_int_equal(occurrences(text, "translate("), 2 + 1); /* two points and the legend */
}

static void test_linear_axes(void **state) {
    (void)state;
    const double a[3] = {-1.0, 0.0, 2.0}, b[3] = {3.0, 3.0, 3.0};
    const lq_plot_line series = {.name = "flat", .count = 3, .x = a, .y = b};
    lq_plot plot = chart(&series);
    plot.x.logarithmic = plot.y.logarithmic = false;
    assert_int_equal(lq_plot_write(&plot, path, NULL), LQ_OK);
    const char *text = read_chart();
    assert_non_null(strstr(text, ">-1<"));
    assert_null(strstr(text, "inf"));
}

/* Ten points in one place: their names would lie on each other. */
static void test_labels_keep_apart(void **state) {
    (void)state;
    const double a[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 2.0}, b[6] = {1.0, 1.0, 1.0, 1.0, 1.0, 2.0};
    const char *const labels[6] = {"AAAAAAAAAA", "AAAAAAAAAA", "AAAAAAAAAA",
                                   "AAAAAAAAAA", "AAAAAAAAAA", NULL};
    const lq_plot_line series = {
        .name = "crowd", .count = 6, .x = a, .y = b, .labels = labels, .curve = true};
    lq_plot plot = chart(&series);
    plot.title = "a title of more than a hundred and twenty characters, which would be cut off at the right "
                 "edge if it "
                 "were not put on two lines";
    assert_int_equal(lq_plot_write(&plot, path, NULL), LQ_OK);
    const char *text = read_chart();
    double last_x[6], last_y[6];
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, "class=\"soft halo\"")); at++) {
        const char *start = at;
        while (strncmp(start, "<text", 5) != 0) start--;
        assert_int_equal(sscanf(start, "<text x=\"%lf\" y=\"%lf\"", &last_x[count], &last_y[count]), 2);
        for (size_t k = 0; k < count; k++)
            assert_true(fabs(last_x[k] - last_x[count]) > 6.0 || fabs(last_y[k] - last_y[count]) > 12.0);
        count++;
    }
    assert_true(count >= 2 && count <= 5);
    assert_int_equal(occurrences(text, "translate("),
                     5); /* the sixth has no name, and the curve no marker there */
    assert_int_equal(occurrences(text, "font-weight:600"), 2);
}

static void test_refusals(void **state) {
    (void)state;
    lq_error error;
    lq_plot_line series = {.name = "nothing", .count = 1, .x = &x[3], .y = &y[3]};
    const lq_plot plot = chart(&series);
    assert_int_equal(lq_plot_write(&plot, path, &error), LQ_BAD_INPUT);
    series = (lq_plot_line){.name = "hue", .count = 1, .x = x, .y = y, .hue = LQ_PLOT_HUES};
    assert_int_equal(lq_plot_write(&plot, path, &error), LQ_BAD_INPUT);
    series.hue = 0;
    assert_int_equal(lq_plot_write(&plot, "/nonexistent/chart.svg", &error), LQ_IO);
    assert_non_null(strstr(error.text, "/nonexistent"));
}

static void test_powers(void **state) {
    (void)state;
    char text[24];
    lq_plot_power(text, -10);
    assert_string_equal(text, "10⁻¹⁰");
    lq_plot_power(text, 300);
    assert_string_equal(text, "10³⁰⁰");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chart),
        cmocka_unit_test(test_linear_axes),
        cmocka_unit_test(test_labels_keep_apart),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_powers),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

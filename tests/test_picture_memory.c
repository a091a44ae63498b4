/* A figure and its page where any one allocation fails: an error, nothing left, and no file that is not
 * whole. */
#include "tests/failing_malloc.h"

#include <string.h>
#include <sys/stat.h>

#include "picture/page.h"
#include "tests/expect.h"
#include "tests/scratch.h"

static lq_table *make_table(void) {
    static const char *const channel = "v";
    lq_axis axes[2];
    lq_table *table = NULL;
    assert_int_equal(lq_axis_parse(&axes[0], "x", "0:1:5:sqrt", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "y", "0:1:4", NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 2, &channel, 1, NULL), LQ_OK);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    return table;
}

/* Panels on the page, or the table itself. */
static lq_status make_page(const lq_slice *slice, bool whole, const char *path) {
    lq_figure *figure = NULL;
    lq_status status = lq_figure_create(&figure, "title", "subtitle", NULL);
    if (status == LQ_OK) status = lq_figure_tell(figure, "key", "value", NULL);
    if (status == LQ_OK) status = lq_figure_add_slice(figure, slice, NULL);
    if (status == LQ_OK) status = lq_figure_add_slice(figure, slice, NULL);
    if (status == LQ_OK) status = lq_page_write(&(lq_page){figure, whole ? slice : NULL, false}, path, NULL);
    lq_figure_free(figure);
    return status;
}

static long size_of(const char *path) {
    struct stat there;
    return stat(path, &there) == 0 ? (long)there.st_size : -1;
}

static void every_failure_is_an_error(void **state) {
    (void)state;
    if (!can_fail()) skip();
    lq_table *table = make_table();
    const double point[] = {0.0, 0.0};
    const lq_slice slice = {.table = table, .x = 0, .y = 1, .at = point};
    for (int whole = 0; whole < 2; whole++) {
        assert_int_equal(make_page(&slice, whole, at("whole.html")), LQ_OK);
        long failures = 0;
        lq_status status = LQ_NO_MEMORY;
        for (; status != LQ_OK && failures < 1000; failures++) {
            countdown = failures;
            status = make_page(&slice, whole, at("page.html"));
            countdown = -1;
            if (status != LQ_OK) assert_int_equal(size_of(at("page.html")), -1);
        }
        assert_true(failures > 20);
        assert_int_equal(size_of(at("page.html")), size_of(at("whole.html")));
        unlink(at("page.html"));
        unlink(at("whole.html"));
    }
    lq_table_free(table);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_failure_is_an_error)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* stack.c - `lacquer precompute stack`: the table of one layered material. */
#include "program/precompute/precompute.h"

#include <string.h>

#include "program/light.h"
#include "program/message.h"
#include "program/output.h"
#include "program/progress.h"
#include "program/verb.h"

static void free_axes(lq_axis *axes, int count) {
    for (int i = 0; i < count; i++) lq_axis_free(&axes[i]);
}

/* An axis of a parameter must lie in what the parameter accepts. */
static bool read_axis(const lq_stack *stack, const char *text, lq_axis *axis) {
    char name[LQ_NAME_SIZE];
    lq_error error = {""};
    double lowest = 0.0, highest = 1.0;
    const size_t length = strcspn(text, "=");
    if (text[length] == '\0' || length >= sizeof name) {
        cli_message("--axis: '%.60s' has no nodes; write NAME=min:max:n or NAME=min:max:n:map", text);
        return false;
    }
    memcpy(name, text, length);
    name[length] = '\0';
    if (strcmp(name, "mu") != 0 && lq_stack_range(stack, name, &lowest, &highest, &error) != LQ_OK) {
        cli_message("--axis: %s", error.text);
        return false;
    }
    if (lq_axis_parse(axis, name, text + length + 1, &error) != LQ_OK) {
        cli_message("%s", error.text);
        return false;
    }
    if (axis->min >= lowest && axis->max <= highest) return true;
    cli_message("--axis: %s from %g to %g is out of range; accepted: %g to %g", name, axis->min, axis->max,
                lowest, highest);
    lq_axis_free(axis);
    return false;
}

/* The axes in the order they were given; their number, or -1. */
static int read_axes(const table_request *request, const lq_stack *stack, lq_axis *axes) {
    if (request->axes.count > LQ_MAX_AXES) {
        cli_message("--axis: a table has at most %d axes", LQ_MAX_AXES);
        return -1;
    }
    for (int i = 0; i < (int)request->axes.count; i++) {
        if (read_axis(stack, request->axes.text[i], &axes[i])) continue;
        free_axes(axes, i);
        return -1;
    }
    return (int)request->axes.count;
}

static int compute(const table_request *request, const lq_stack *stack, const lq_axis *axes, int count) {
    const lq_stack_query query = {.from_below = request->from == 1,
                                  .single = request->interfaces == 1,
                                  .tolerance = request->settings.settings.tolerance,
                                  .threads = (int)request->threads};
    lq_table *table = NULL;
    lq_error error = {""};
    cli_progress bar;
    const double start = cli_seconds();
    cli_progress_begin(&bar, "stack");
    const lq_status status = lq_stack_precompute(stack, &query, axes, count, &bar.progress, &table, &error);
    cli_progress_end(&bar);
    if (!table) return cli_fail_status(status, &error);
    const lq_rows rows = lq_table_rows(table);
    bool written;
    const int code =
        precompute_finish(request, &rows, table, 0, status, &error, cli_seconds() - start, &written);
    lq_table_free(table);
    return code;
}

/* The option itself accepts what any table does; 0: it was not given. */
static bool tolerance_suits(double tolerance) {
    if (tolerance == 0.0 || (tolerance >= CLI_STACK_TOLERANCE_MIN && tolerance <= CLI_STACK_TOLERANCE_MAX))
        return true;
    cli_message("--tolerance: a stack accepts %g to %g, not %g", CLI_STACK_TOLERANCE_MIN,
                CLI_STACK_TOLERANCE_MAX, tolerance);
    return false;
}

int precompute_stack(const table_request *request) {
    lq_axis axes[LQ_MAX_AXES];
    lq_stack *stack = NULL;
    lq_error error = {""};
    if (!tolerance_suits(request->settings.settings.tolerance)) return CLI_FAILED;
    if (request->format >= FORMAT_ENDINGS)
        return cli_fail("--format: a published layout holds no stack; accepted: exr, npy");
    if (!request->stack) return cli_fail("no layers; add --stack FILE.json");
    if (!cli_output_check(request->output)) return CLI_FAILED;
    const lq_status status =
        lq_stack_read(&stack, request->stack, request->trusted ? LQ_STACK_TRUSTED : 0, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    const int count = read_axes(request, stack, axes);
    const int code = count < 0 ? CLI_FAILED : compute(request, stack, axes, count);
    free_axes(axes, count);
    lq_stack_free(stack);
    return code;
}

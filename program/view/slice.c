/* slice.c - which part of a table `lacquer view` shows: --x, --y, --at, --channel, --range. */
#include "program/view/view.h"

#include <string.h>

#include "program/message.h"
#include "program/options.h"
#include "system/status.h"

static bool find_axis(const char *option, const char *name, const lq_table *table, bool drawn, int *axis) {
    char list[LQ_MESSAGE_SIZE] = "";
    *axis = lq_table_axis(table, name);
    if (*axis >= 0 && (!drawn || table->axes[*axis].size > 1)) return true;
    for (int a = 0; a < table->axis_count; a++)
        if (!drawn || table->axes[a].size > 1) lq_list_add(list, sizeof list, table->axes[a].name);
    if (*axis < 0) cli_message("%s: no axis '%s'; accepted: %s", option, name, list);
    else cli_message("%s: axis '%s' has one node; accepted: %s", option, name, list[0] ? list : "none");
    return false;
}

/* --x and --y, or the first axes of several nodes that are not taken. */
static bool find_axes(const view_request *request, const lq_table *table, lq_slice *slice) {
    int first[2];
    lq_slice_axes(table, &first[0], &first[1]);
    if (first[0] < 0) {
        cli_message("%s: every axis has one node: it is one number, see `lacquer info`", request->input);
        return false;
    }
    slice->x = first[0];
    slice->y = first[1];
    if (request->x && !find_axis("--x", request->x, table, true, &slice->x)) return false;
    if (request->y && !find_axis("--y", request->y, table, true, &slice->y)) return false;
    if (slice->x != slice->y) return true;
    if (request->x && request->y) {
        cli_message("--y: '%s' is the axis of --x; accepted: another one", request->y);
        return false;
    }
    if (request->x) slice->y = slice->x == first[0] ? first[1] : first[0];
    else slice->x = slice->y == first[0] ? first[1] : first[0];
    if (slice->x >= 0) return true;
    cli_message("--y: %s has one axis of several nodes, '%s', which is drawn along --x", request->input,
                request->y);
    return false;
}

/* One "name=value" of --at. */
static bool take_point(const char *text, const lq_slice *slice, double *at, bool *given) {
    char name[LQ_NAME_SIZE], what[LQ_NAME_SIZE + 8];
    const char *equals = strchr(text, '=');
    int axis = -1;
    if (!equals || (size_t)(equals - text) >= sizeof name) {
        cli_message("--at: '%.100s' is not NAME=VALUE", text);
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)(equals - text), text);
    snprintf(what, sizeof what, "--at %s", name);
    if (!find_axis("--at", name, slice->table, false, &axis)) return false;
    if (axis == slice->x || axis == slice->y) {
        cli_message("%s: that axis is drawn; accepted: axes other than those of --x and --y", what);
        return false;
    }
    if (given[axis]) {
        cli_message("%s: given twice", what);
        return false;
    }
    given[axis] = true;
    const lq_axis *range = &slice->table->axes[axis];
    return cli_parse_number(what, equals + 1, range->min, range->max, &at[axis]);
}

static bool find_channel(const view_request *request, lq_slice *slice) {
    char list[LQ_MESSAGE_SIZE] = "";
    const lq_table *table = slice->table;
    for (slice->channel = 0; request->channel && slice->channel < table->channel_count; slice->channel++) {
        if (strcmp(request->channel, table->channel_names[slice->channel]) == 0) return true;
        lq_list_add(list, sizeof list, table->channel_names[slice->channel]);
    }
    if (request->channel) cli_message("--channel: no channel '%s'; accepted: %s", request->channel, list);
    return !request->channel;
}

bool view_slice(const view_request *request, const lq_table *table, lq_slice *slice, double *at) {
    bool given[LQ_MAX_AXES] = {false};
    *slice = (lq_slice){.table = table, .at = at};
    if (!find_axes(request, table, slice) || !find_channel(request, slice)) return false;
    for (int a = 0; a < table->axis_count; a++) at[a] = table->axes[a].nodes[table->axes[a].size / 2];
    for (size_t i = 0; i < request->at.count; i++)
        if (!take_point(request->at.text[i], slice, at, given)) return false;
    slice->range = request->range.given ? request->range.ends : NULL;
    return true;
}

/* source.c - points and their values for `lacquer eval`, from a kind or from a stored table. */
#include "program/eval/eval.h"

#include "program/options.h"
#include "system/status.h"

#include <stdlib.h>
#include <string.h>

void eval_source_kind(eval_source *source, const lq_kind *kind, const lq_settings *settings) {
    *source = (eval_source){.kind = kind, .settings = *settings};
    source->axis_count = kind->axis_count;
    for (int i = 0; i < kind->axis_count; i++)
        source->axes[i] = (eval_axis){kind->axes[i].name, kind->axes[i].lowest, kind->axes[i].highest};
    /* An NDF of one roughness leaves no choice. */
    double low = 0.0, high = 1.0;
    if (settings->opened) lq_ndf_range(settings->opened, &low, &high);
    for (int i = 0; i < kind->axis_count; i++)
        if (low == high && strcmp(kind->axes[i].name, "alpha") == 0)
            source->axes[i].lowest = source->axes[i].highest = low;
    source->channel_count = kind->channel_count;
    for (int i = 0; i < kind->channel_count; i++) source->channels[i] = kind->channels[i];
}

static void factors_axes(eval_source *source) {
    const lq_factored *factored = source->factored;
    source->axis_count = factored->axis_count;
    for (int i = 0; i < factored->axis_count; i++)
        source->axes[i] = (eval_axis){factored->axes[i].name, factored->axes[i].min, factored->axes[i].max};
    source->channel_count = 1;
    source->channels[0] = "value";
}

lq_status eval_source_file(eval_source *source, const char *path, lq_error *error) {
    *source = (eval_source){.path = path};
    /* A file of factors is also a table, of texels. */
    if (lq_factored_read(&source->factored, path, NULL) == LQ_OK) {
        factors_axes(source);
        return LQ_OK;
    }
    lq_status status = lq_table_read_exr(&source->table, path, error);
    if (status != LQ_OK) return status;
    const lq_table *table = source->table;
    source->axis_count = table->axis_count;
    for (int i = 0; i < table->axis_count; i++)
        source->axes[i] = (eval_axis){table->axes[i].name, table->axes[i].min, table->axes[i].max};
    source->channel_count = table->channel_count;
    for (int i = 0; i < table->channel_count; i++) source->channels[i] = table->channel_names[i];
    return LQ_OK;
}

void eval_source_free(eval_source *source) {
    lq_table_free(source->table);
    lq_factored_free(source->factored);
    lq_pack_close(source->pack);
    source->pack = NULL;
    source->table = NULL;
    source->factored = NULL;
}

static const char *source_name(const eval_source *source) {
    return source->kind ? source->kind->id : source->path;
}

int eval_find_axis(const eval_source *source, const char *name, lq_error *error) {
    char list[LQ_MESSAGE_SIZE] = "";
    for (int i = 0; i < source->axis_count; i++) {
        if (strcmp(name, source->axes[i].name) == 0) return i;
        lq_list_add(list, sizeof list, source->axes[i].name);
    }
    lq_fail(error, LQ_BAD_INPUT, "unknown axis '%s'; %s has: %s", name, source_name(source), list);
    return -1;
}

bool eval_coordinate(const eval_source *source, eval_point *point, int axis, const char *text,
                     lq_error *error) {
    const eval_axis *range = &source->axes[axis];
    double value = 0;
    lq_status status = LQ_OK;
    if (point->given[axis]) status = lq_fail(error, LQ_BAD_INPUT, "axis %s is given twice", range->name);
    else if (!cli_number(text, &value))
        status = lq_fail(error, LQ_BAD_INPUT, "%s: '%s' is not a number", range->name, text);
    else if (value < range->lowest || value > range->highest)
        status = lq_fail(error, LQ_BAD_INPUT, "%s = %s is out of range; accepted: %g to %g", range->name,
                         text, range->lowest, range->highest);
    if (status != LQ_OK) return false;
    point->at[axis] = value;
    point->given[axis] = true;
    return true;
}

eval_point eval_start(const eval_source *source) {
    eval_point point = {0};
    for (int i = 0; i < source->axis_count; i++) point.at[i] = source->axes[i].lowest;
    return point;
}

bool eval_complete(const eval_source *source, const eval_point *point, lq_error *error) {
    char list[LQ_MESSAGE_SIZE] = "";
    for (int i = 0; i < source->axis_count; i++)
        if (!point->given[i] && source->axes[i].lowest < source->axes[i].highest)
            lq_list_add(list, sizeof list, source->axes[i].name);
    if (list[0]) lq_fail(error, LQ_BAD_INPUT, "missing axis values for %s: %s", source_name(source), list);
    return list[0] == '\0';
}

void eval_compute(const eval_source *source, const lq_settings *settings, const eval_point *point,
                  eval_result *result) {
    *result = (eval_result){.status = LQ_OK};
    if (source->kind) {
        result->status =
            lq_eval(source->kind, settings, point->at, result->values, &result->estimate, &result->error);
        return;
    }
    if (source->pack) {
        lq_pack_decode(source->pack, source->function, point->at, result->values);
        return;
    }
    if (source->factored) {
        result->values[0] = lq_factored_lookup_gpu(source->factored, point->at);
        return;
    }
    for (int i = 0; i < source->channel_count; i++)
        result->values[i] = lq_table_lookup(source->table, i, point->at);
}

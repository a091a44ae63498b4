/* slice.c - a plane or a line through a table, as a panel. */
#include "picture/figure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/number.h"
#include "system/status.h"

void lq_slice_axes(const lq_table *table, int *x, int *y) {
    *x = *y = -1;
    for (int a = 0; a < table->axis_count; a++) {
        if (table->axes[a].size < 2) continue;
        if (*x < 0) *x = a;
        else if (*y < 0) *y = a;
    }
}

/* "alpha 0.5, n 0.2": where the slice lies. */
static void describe(const lq_slice *slice, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int a = 0; a < slice->table->axis_count; a++) {
        if (a == slice->x || a == slice->y || used >= size) continue;
        used += (size_t)lq_print(text + used, size - used, "%s%s %.4g", used ? ", " : "",
                                 slice->table->axes[a].name, slice->at[a]);
    }
    if (slice->note && used < size)
        snprintf(text + used, size - used, "%s%s", used ? " · " : "", slice->note);
}

static float *gather(const lq_slice *slice, size_t columns, size_t rows) {
    const lq_table *table = slice->table;
    float *values = malloc(columns * rows * sizeof *values);
    double point[LQ_MAX_AXES];
    memcpy(point, slice->at, (size_t)table->axis_count * sizeof *point);
    for (size_t i = 0; values && i < columns * rows; i++) {
        point[slice->x] = table->axes[slice->x].nodes[i % columns];
        if (slice->y >= 0) point[slice->y] = table->axes[slice->y].nodes[i / columns];
        values[i] = (float)lq_table_lookup(table, slice->channel, point);
    }
    return values;
}

lq_status lq_figure_add_slice(lq_figure *figure, const lq_slice *slice, lq_error *error) {
    const lq_table *table = slice->table;
    const char *channel = table->channel_names[slice->channel];
    const lq_axis *x = &table->axes[slice->x], *y = slice->y >= 0 ? &table->axes[slice->y] : NULL;
    char caption[LQ_MESSAGE_SIZE];
    describe(slice, caption, sizeof caption);
    float *values = gather(slice, x->size, y ? y->size : 1);
    if (!values) return lq_fail(error, LQ_NO_MEMORY, "no memory for a picture");
    const lq_panel_parts parts = {.form = y ? LQ_PANEL_MAP : LQ_PANEL_LINES,
                                  .title = slice->title ? slice->title : channel,
                                  .caption = caption,
                                  .quantity = channel,
                                  .x = x,
                                  .y = y,
                                  .series_count = 1,
                                  .series = &channel,
                                  .values = values,
                                  .range = slice->range};
    const lq_status status = lq_figure_add(figure, &parts, error);
    free(values);
    return status;
}

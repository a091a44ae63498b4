/* model_source.c - which table of a pack has a point, and its value there. */
#include "pack/model_source.h"

#include <math.h>
#include <string.h>

#include "pack/measure.h"
#include "system/number.h"
#include "system/status.h"

typedef struct range {
    double min, max;
} range;

static range range_of(const lq_shipped *t, int a) {
    return t->factored ? (range){t->factored->axes[a].min, t->factored->axes[a].max}
                       : (range){t->table->axes[a].min, t->table->axes[a].max};
}

/* The first axis whose range the point is out of, by more than rounding; -1: none. Cosines below the least
 * one have the table's edge. */
static int outside(const lq_shipped *table, const double *point) {
    for (int a = 0; a < table->kind->axis_count; a++) {
        const range axis = range_of(table, a);
        const double slack = 1e-9 * fmax(fabs(axis.max), 1.0);
        const bool horizon = strcmp(table->kind->axes[a].name, "mu") == 0;
        if (point[a] > axis.max + slack || (!horizon && point[a] < axis.min - slack)) return a;
    }
    return -1;
}

/* Values between texels may leave what an energy can be. */
static void sample(const lq_shipped *table, const double *point, double *values) {
    double at[LQ_MAX_AXES];
    for (int a = 0; a < table->kind->axis_count; a++)
        at[a] = fmin(fmax(point[a], range_of(table, a).min), range_of(table, a).max);
    if (table->factored) values[0] = lq_factored_lookup_gpu(table->factored, at);
    else lq_texture_sample(&table->texture, at, LQ_FILTER_BITS, values);
    for (int c = 0; c < table->kind->channel_count; c++) values[c] = fmin(fmax(values[c], 0.0), 1.0);
}

static lq_status refuse(const lq_pack *pack, const lq_shipped *nearest, const char *kind, const double *point,
                        lq_error *error) {
    char where[120];
    if (!nearest)
        return lq_fail(error, LQ_BAD_INPUT, "pack %.60s has no table of %.40s, which the model looks up",
                       pack->name, kind);
    const int a = outside(nearest, point);
    lq_print(where, sizeof where, "%s = %g; accepted: %g to %g", nearest->kind->axes[a].name, point[a],
             range_of(nearest, a).min, range_of(nearest, a).max);
    return lq_fail(error, LQ_BAD_INPUT, "the model looks %.40s up where pack %.60s has none, at %s", kind,
                   pack->name, where);
}

static lq_status value(void *user, const lq_kind *kind, const double *point, double *values,
                       lq_error *error) {
    const lq_pack *pack = user;
    const lq_shipped *nearest = NULL;
    for (size_t i = 0; i < pack->count; i++) {
        const lq_shipped *table = &pack->tables[i];
        const bool whole = !table->factored || kind->channel_count == 1;
        if (strcmp(table->kind->id, kind->id) != 0 || !whole) continue;
        nearest = table;
        if (outside(table, point) >= 0) continue;
        sample(table, point, values);
        return LQ_OK;
    }
    return refuse(pack, nearest, kind->id, point, error);
}

lq_model_source lq_pack_source(const lq_pack *pack) {
    return (lq_model_source){(void *)pack, value};
}

/* pack.c - a function of a pack as the source of `lacquer eval`. */
#include "pack/measure.h"
#include "pack/names.h"
#include "program/eval/eval.h"
#include "system/status.h"

#include <stdlib.h>
#include <string.h>

/* "lacquer_car_paint", "car_paint" and "car-paint" are one. */
static bool is_called(const char *name, const char *asked) {
    static const char prefix[] = "lacquer_";
    char one[LQ_NAME_SIZE], other[LQ_NAME_SIZE];
    if (strncmp(asked, prefix, sizeof prefix - 1) == 0) asked += sizeof prefix - 1;
    lq_make_identifier(one, name);
    lq_make_identifier(other, asked);
    return strcmp(one, other) == 0;
}

static void take_table(eval_source *source, const lq_shipped *shipped) {
    source->shipped = shipped;
    source->axis_count = shipped->kind->axis_count;
    for (int a = 0; a < source->axis_count; a++) {
        const double min = shipped->factored ? shipped->factored->axes[a].min : shipped->table->axes[a].min;
        const double max = shipped->factored ? shipped->factored->axes[a].max : shipped->table->axes[a].max;
        source->axes[a] = (eval_axis){shipped->kind->axes[a].name, min, max};
    }
    source->channel_count = shipped->factored ? 1 : shipped->kind->channel_count;
    for (int c = 0; c < source->channel_count; c++)
        source->channels[c] = shipped->factored ? "value" : shipped->kind->channels[c];
}

static void take_material(eval_source *source, const lq_shipped_material *m) {
    static const char *const channels[EVAL_CHANNELS] = {"top.r",   "top.g",   "top.b",   "top_alpha",
                                                        "inner.r", "inner.g", "inner.b", "inner_alpha",
                                                        "base.r",  "base.g",  "base.b",  "base_alpha"};
    static const char *const rho[] = {"rho.r", "rho.g", "rho.b"};
    source->material = m;
    source->axes[source->axis_count++] = (eval_axis){"mu", 0.0, 1.0};
    for (int r = 0; r < m->material.range_count; r++)
        source->axes[source->axis_count++] =
            (eval_axis){m->material.ranges[r].name, m->material.ranges[r].min, m->material.ranges[r].max};
    for (int c = 0; c < 3 && m->material.open_rho; c++)
        source->axes[source->axis_count++] = (eval_axis){rho[c], m->material.rho_min, m->material.rho_max};
    source->channel_count = EVAL_CHANNELS;
    memcpy(source->channels, channels, sizeof channels);
}

void eval_material(const lq_shipped_material *material, const double *at, double *values) {
    const lq_material *m = &material->material;
    const double *rho = at + 1 + m->range_count;
    double n[LQ_MATERIAL_NUMBERS];
    lq_lobes_sample(&material->lobes, at[0], at + 1, LQ_FILTER_BITS, n);
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) {
        values[c] = n[LQ_MATERIAL_TOP + c];
        values[4 + c] = n[LQ_MATERIAL_INNER + c];
        values[8 + c] = lq_material_base(n, c, m, m->open_rho ? rho[c] : 0.0);
    }
    values[3] = lq_material_top_alpha(m, at + 1);
    values[7] = n[LQ_MATERIAL_INNER_ALPHA];
    values[11] = n[LQ_MATERIAL_BASE_ALPHA];
}

/* The list of what there is, for messages. */
static void list_names(const lq_pack *pack, char *list, size_t size) {
    for (size_t i = 0; i < pack->count; i++) lq_list_add(list, size, pack->tables[i].name);
    for (size_t i = 0; i < pack->material_count; i++) lq_list_add(list, size, pack->materials[i].name);
}

lq_status eval_source_pack(eval_source *source, const char *folder, const char *name, lq_error *error) {
    char list[LQ_MESSAGE_SIZE - 128] = "";
    *source = (eval_source){.path = folder, .pack = calloc(1, sizeof *source->pack)};
    if (!source->pack) return lq_fail(error, LQ_NO_MEMORY, "no memory for a pack");
    const lq_status status = lq_pack_read(source->pack, folder, error);
    if (status != LQ_OK) return status;
    list_names(source->pack, list, sizeof list);
    if (!name) return lq_fail(error, LQ_BAD_INPUT, "which function of %.60s? accepted: %s", folder, list);
    for (size_t i = 0; i < source->pack->count; i++)
        if (is_called(source->pack->tables[i].name, name))
            return take_table(source, &source->pack->tables[i]), LQ_OK;
    for (size_t i = 0; i < source->pack->material_count; i++)
        if (is_called(source->pack->materials[i].name, name))
            return take_material(source, &source->pack->materials[i]), LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "%.60s has no function '%.40s'; accepted: %s", folder, name, list);
}

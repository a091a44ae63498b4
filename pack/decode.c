/* decode.c - a pack as the functions of its decode source: what they take, and what they return on a GPU. */
#include "pack/measure.h"
#include "pack/names.h"
#include "pack/read.h"
#include "system/status.h"

#include <stdlib.h>
#include <string.h>

static void describe_table(lq_pack_function *f, const lq_shipped *shipped) {
    const lq_kind *kind = shipped->kind;
    f->name = shipped->name;
    f->kind = kind;
    f->axis_count = kind->axis_count;
    for (int a = 0; a < f->axis_count; a++) {
        const double min = shipped->factored ? shipped->factored->axes[a].min : shipped->table->axes[a].min;
        const double max = shipped->factored ? shipped->factored->axes[a].max : shipped->table->axes[a].max;
        f->axes[a] = (lq_pack_axis){kind->axes[a].name, min, max};
    }
    f->value_count = shipped->factored ? 1 : kind->channel_count;
    for (int c = 0; c < f->value_count; c++) f->values[c] = shipped->factored ? "value" : kind->channels[c];
}

static void describe_material(lq_pack_function *f, const lq_shipped_material *shipped) {
    static const char *const values[LQ_PACK_VALUES] = {"top.r",   "top.g",   "top.b",   "top_alpha",
                                                       "inner.r", "inner.g", "inner.b", "inner_alpha",
                                                       "base.r",  "base.g",  "base.b",  "base_alpha"};
    static const char *const rho[] = {"rho.r", "rho.g", "rho.b"};
    const lq_material *m = &shipped->material;
    f->name = shipped->name;
    f->axes[f->axis_count++] = (lq_pack_axis){"mu", 0.0, 1.0};
    for (int r = 0; r < m->range_count; r++)
        f->axes[f->axis_count++] = (lq_pack_axis){m->ranges[r].name, m->ranges[r].min, m->ranges[r].max};
    for (int c = 0; c < LQ_MATERIAL_COLOURS && m->open_rho; c++)
        f->axes[f->axis_count++] = (lq_pack_axis){rho[c], m->rho_min, m->rho_max};
    f->value_count = LQ_PACK_VALUES;
    memcpy(f->values, values, sizeof values);
}

static lq_status describe(lq_pack *pack, const char *folder, lq_error *error) {
    const size_t count = pack->count + pack->material_count;
    pack->folder = strdup(folder);
    pack->functions = calloc(count, sizeof *pack->functions);
    if (!pack->folder || !pack->functions) return lq_fail(error, LQ_NO_MEMORY, "no memory for a pack");
    for (size_t i = 0; i < pack->count; i++) describe_table(&pack->functions[i], &pack->tables[i]);
    for (size_t i = 0; i < pack->material_count; i++)
        describe_material(&pack->functions[pack->count + i], &pack->materials[i]);
    return LQ_OK;
}

lq_status lq_pack_open(lq_pack **pack, const char *folder, lq_error *error) {
    lq_pack *p = *pack = calloc(1, sizeof *p);
    if (!p) return lq_fail(error, LQ_NO_MEMORY, "no memory for a pack");
    lq_status status = lq_pack_read(p, folder, error);
    if (status == LQ_OK) status = describe(p, folder, error);
    if (status == LQ_OK) return LQ_OK;
    lq_pack_close(p);
    *pack = NULL;
    return status;
}

void lq_pack_close(lq_pack *pack) {
    if (pack) lq_pack_free(pack);
    free(pack);
}

size_t lq_pack_function_count(const lq_pack *pack) {
    return pack->count + pack->material_count;
}

const lq_pack_function *lq_pack_function_at(const lq_pack *pack, size_t i) {
    return i < lq_pack_function_count(pack) ? &pack->functions[i] : NULL;
}

/* "lacquer_car_paint", "car_paint" and "car-paint" are one. */
static bool is_called(const char *name, const char *asked) {
    static const char prefix[] = "lacquer_";
    char one[LQ_NAME_SIZE], other[LQ_NAME_SIZE];
    if (strncmp(asked, prefix, sizeof prefix - 1) == 0) asked += sizeof prefix - 1;
    lq_make_identifier(one, name);
    lq_make_identifier(other, asked);
    return strcmp(one, other) == 0;
}

lq_status lq_pack_find(const lq_pack *pack, const char *name, size_t *function, lq_error *error) {
    char list[LQ_MESSAGE_SIZE - 128] = "";
    for (size_t i = 0; i < lq_pack_function_count(pack); i++) {
        if (name && is_called(pack->functions[i].name, name)) return *function = i, LQ_OK;
        lq_list_add(list, sizeof list, pack->functions[i].name);
    }
    if (!name)
        return lq_fail(error, LQ_BAD_INPUT, "which function of %.60s? accepted: %s", pack->folder, list);
    return lq_fail(error, LQ_BAD_INPUT, "%.60s has no function '%.40s'; accepted: %s", pack->folder, name,
                   list);
}

/* Lobe after lobe: three colours and a roughness. */
static void decode_material(const lq_shipped_material *shipped, const double *at, double *values) {
    const lq_material *m = &shipped->material;
    const double *rho = at + 1 + m->range_count;
    double n[LQ_MATERIAL_NUMBERS];
    lq_lobes_sample(&shipped->lobes, at[0], at + 1, LQ_FILTER_BITS, n);
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) {
        values[c] = n[LQ_MATERIAL_TOP + c];
        values[4 + c] = n[LQ_MATERIAL_INNER + c];
        values[8 + c] = lq_material_base(n, c, m, m->open_rho ? rho[c] : 0.0);
    }
    values[3] = lq_material_top_alpha(m, at + 1);
    values[7] = n[LQ_MATERIAL_INNER_ALPHA];
    values[11] = n[LQ_MATERIAL_BASE_ALPHA];
}

/* Half floats and filter weights of 8 bits, of a texture and of factors alike. */
void lq_pack_decode(const lq_pack *pack, size_t function, const double *point, double *values) {
    const lq_shipped *table = function < pack->count ? &pack->tables[function] : NULL;
    if (!table) decode_material(&pack->materials[function - pack->count], point, values);
    else if (table->factored) values[0] = lq_factored_lookup_gpu(table->factored, point);
    else lq_texture_sample(&table->texture, point, LQ_FILTER_BITS, values);
}

/* info_pack.c - what a manifest says, once the pack is read and its files are as they were made. */
#include "program/info_pack.h"

#include "pack/read.h"
#include "program/message.h"
#include "program/output.h"
#include "program/verb.h"

#include <math.h>
#include <stdio.h>

static double number_at(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static void print_range(const char *name, double min, double max) {
    if (min < max) printf("    %-14s %g to %g\n", name, min, max);
}

static void print_error(const json_t *item) {
    const json_t *error = json_object_get(item, "error");
    const char *kind = json_string_value(json_object_get(error, "kind"));
    const double p99 = number_at(error, "budget-p99"), max = number_at(error, "budget-max");
    printf("    %s error: p99 %.2g, max %.2g at %.0f points", kind ? kind : "absolute",
           number_at(error, "p99"), number_at(error, "max"), number_at(error, "points"));
    if (isfinite(p99)) printf("; budget p99 %g", p99);
    if (isfinite(max)) printf("%s max %g", isfinite(p99) ? "," : "; budget", max);
    putchar('\n');
}

/* Where its texels are: tiles of the atlas, or the textures that its arguments bind. */
static void print_bindings(const json_t *item) {
    const json_t *tiles = json_object_get(item, "tiles"), *textures = json_object_get(item, "textures");
    const size_t count = json_array_size(textures);
    if (tiles) {
        printf("    %zu tile%s of the atlas\n", json_array_size(tiles),
               json_array_size(tiles) == 1 ? "" : "s");
        return;
    }
    printf("    bind ");
    if (count == 0) printf("table\n");
    for (size_t i = 0; i < count; i++)
        printf("%s%s", json_string_value(json_object_get(json_array_get(textures, i), "argument")),
               i + 1 < count ? ", " : "\n");
}

static void print_head(const json_t *item, double fetches) {
    const char *function = json_string_value(json_object_get(item, "function"));
    printf("  %s: %.0f bytes", function ? function : "?", number_at(item, "bytes"));
    if (isfinite(fetches)) printf(", %.0f fetch%s", fetches, fetches == 1.0 ? "" : "es");
    putchar('\n');
}

static void print_table(const lq_shipped *s, const json_t *item) {
    print_head(item, s->factored ? number_at(item, "fetches") : 1.0);
    for (int a = 0; a < s->kind->axis_count; a++)
        print_range(s->kind->axes[a].name, s->factored ? s->factored->axes[a].min : s->table->axes[a].min,
                    s->factored ? s->factored->axes[a].max : s->table->axes[a].max);
    print_bindings(item);
    print_error(item);
}

static void print_material(const lq_shipped_material *m, const json_t *item) {
    print_head(item, number_at(item, "fetches"));
    print_range("mu", 0.0, 1.0);
    for (int r = 0; r < m->material.range_count; r++)
        print_range(m->material.ranges[r].name, m->material.ranges[r].min, m->material.ranges[r].max);
    if (m->material.open_rho) print_range("rho", m->material.rho_min, m->material.rho_max);
    print_bindings(item);
    print_error(item);
}

/* The first file that is not as it was made; NULL: all are. */
static const char *altered(const lq_pack *pack) {
    for (size_t i = 0; i < pack->count; i++)
        if (pack->tables[i].altered + pack->tables[i].differing > 0) return pack->tables[i].suspect;
    return NULL;
}

static void print_text(const char *folder, const lq_pack *pack) {
    const json_t *manifest = pack->manifest;
    const json_t *atlas = json_object_get(manifest, "atlas"), *decode = json_object_get(manifest, "decode");
    printf("%s: pack %s, %.0f bytes of textures", folder, pack->name, number_at(manifest, "texture-bytes"));
    if (atlas) printf(" in one of %.0f x %.0f texels", number_at(atlas, "width"), number_at(atlas, "height"));
    printf("\nsource ");
    for (size_t i = 0; i < json_array_size(decode); i++)
        printf("%s%s", i > 0 ? ", " : "", json_string_value(json_array_get(decode, i)));
    printf("\nfunctions\n");
    for (size_t i = 0; i < pack->count; i++)
        print_table(&pack->tables[i], json_array_get(json_object_get(manifest, "tables"), i));
    for (size_t i = 0; i < pack->material_count; i++)
        print_material(&pack->materials[i], json_array_get(json_object_get(manifest, "materials"), i));
    const char *suspect = altered(pack);
    printf(suspect ? "files: %s is not as it was made\n" : "files: as they were made\n", suspect);
}

int info_pack(const char *folder, bool as_json) {
    lq_pack pack;
    lq_error error = {""};
    bool printed = true;
    const lq_status status = lq_pack_read(&pack, folder, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    if (as_json)
        printed = cli_print_json(json_incref(pack.manifest), JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    else print_text(folder, &pack);
    lq_pack_free(&pack);
    return printed ? CLI_DONE : CLI_FAILED;
}

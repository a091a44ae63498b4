/* pack.c - `lacquer pack`: from a recipe to a folder of textures, decode source and a manifest. */
#include "program/pack/pack.h"

#include "pack/cache.h"
#include "pack/folder.h"
#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_OUTPUT = 'o', OPTION_CACHE = 256, OPTION_THREADS };

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "DIR", "the folder to make, or the pack to replace (required)",
     CLI_TEXT(pack_request, output), .silent = true},
    {OPTION_CACHE, "cache", "DIR", "tables computed before (default: lacquer in XDG_CACHE_HOME or ~/.cache)",
     CLI_TEXT(pack_request, cache_given), .silent = true},
    {OPTION_THREADS, "threads", "N", "threads; the files do not depend on it (default: one per core)",
     CLI_COUNT(pack_request, threads, 1, 4096), .silent = true},
    CLI_TRUST_OPTIONS(pack_request, 0),
    {0},
};

static bool take_word(void *user, const char *word) {
    pack_request *r = user;
    if (r->recipe_path) return cli_fail("two recipes; accepted is one"), false;
    r->recipe_path = word;
    return true;
}

static bool read_arguments(pack_request *r, int argc, char **argv) {
    cli_given given;
    if (!cli_parse(&cli_verb_pack, argc, argv, r, take_word, &given)) return false;
    if (!r->recipe_path) return cli_fail("no recipe; usage: lacquer pack RECIPE.json -o DIR"), false;
    if (!r->output) return cli_fail("no output folder; add -o DIR"), false;
    if (r->cache_given) snprintf(r->cache, sizeof r->cache, "%s", r->cache_given);
    else if (!lq_cache_default(r->cache, sizeof r->cache))
        return cli_fail("no cache folder: neither XDG_CACHE_HOME nor HOME is set; add --cache DIR"), false;
    lq_cache_build(r->build, sizeof r->build);
    return true;
}

/* ------------------------------------------------------------------------------------------ files */

static lq_status write_image(const lq_recipe *recipe, const lq_image *image, const char *stem,
                             const char *array, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (int c = 0; c < LQ_CONTAINERS && status == LQ_OK; c++) {
        if (!recipe->containers[c]) continue;
        snprintf(path, sizeof path, "%s/%s%s", folder, stem, lq_container_ending((lq_container)c));
        status = lq_image_write(image, (lq_container)c, array, path, error);
    }
    return status;
}

static lq_status write_one(const lq_recipe *recipe, const lq_packed *p, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64], stem[64], array[96];
    lq_status status = LQ_OK;
    for (size_t i = 0; i < lq_packed_images(p) && status == LQ_OK; i++) {
        lq_packed_stem(p, i, stem, sizeof stem);
        lq_packed_array(p, i, array, sizeof array);
        status = write_image(recipe, lq_packed_image(p, i), stem, array, folder, error);
    }
    for (int l = 0; l < LQ_LAYOUTS && status == LQ_OK; l++) {
        if (!p->from->layouts[l]) continue;
        snprintf(path, sizeof path, "%s/%s.%s.bin", folder, p->from->name, lq_layout_name((lq_layout)l));
        status = lq_published_write(p->table, path, (lq_layout)l, error);
    }
    return status;
}

static lq_status write_sources(const lq_recipe *recipe, const lq_packed *packed, const char *folder,
                               lq_error *error) {
    lq_source_table tables[LQ_RECIPE_TABLES];
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (size_t i = 0; i < recipe->count; i++) {
        const lq_packed *p = &packed[i];
        tables[i] = (lq_source_table){p->from->kind, p->factored ? NULL : &p->texture, &p->factors};
    }
    for (int l = 0; l < LQ_LANGUAGES && status == LQ_OK; l++) {
        snprintf(path, sizeof path, "%s/%s", folder, lq_source_file((lq_language)l));
        status = lq_source_write((lq_language)l, tables, recipe->count, path, error);
    }
    return status;
}

static lq_status write_all(const lq_recipe *recipe, const lq_packed *packed, const char *target,
                           lq_error *error) {
    lq_folder folder;
    lq_status status = lq_folder_open(&folder, target, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        status = write_one(recipe, &packed[i], folder.staging, error);
        if (status == LQ_OK && cli_interrupted()) status = LQ_CANCELLED;
    }
    if (status == LQ_OK) status = write_sources(recipe, packed, folder.staging, error);
    if (status == LQ_OK) status = lq_manifest_write(recipe, packed, folder.staging, error);
    if (status == LQ_OK && cli_interrupted()) status = LQ_CANCELLED;
    if (status == LQ_OK) status = lq_folder_commit(&folder, error);
    if (status != LQ_OK) lq_folder_abandon(&folder);
    return status;
}

/* A signal does not end the program while there is a folder to clear. */
static lq_status write_held(const lq_recipe *recipe, const lq_packed *packed, const char *target,
                            lq_error *error) {
    cli_signals_hold();
    const lq_status status = write_all(recipe, packed, target, error);
    cli_signals_release();
    return status;
}

/* ------------------------------------------------------------------------------------------- verb */

/* One line a table; exit code 2 and its reason where a budget is missed. */
static int judge(const pack_request *r, const lq_recipe *recipe, const lq_packed *packed) {
    size_t bytes = 0;
    int code = CLI_DONE;
    printf("%-22s %9s %9s %9s %9s\n", "table", "bytes", "rms", "p99", "max");
    for (size_t i = 0; i < recipe->count; i++) {
        const lq_measure *m = &packed[i].measure;
        const lq_recipe_table *t = packed[i].from;
        bytes += lq_packed_bytes(&packed[i]);
        printf("%-22s %9zu %9.2e %9.2e %9.2e\n", t->name, lq_packed_bytes(&packed[i]), m->rms, m->p99,
               m->max);
        if (code != CLI_DONE || (m->p99 <= t->p99 && m->max <= t->max)) continue;
        char asked[64] = "";
        if (isfinite(t->p99)) snprintf(asked, sizeof asked, " p99 %.3g", t->p99);
        if (isfinite(t->max)) snprintf(asked + strlen(asked), 32, "%s max %.3g", *asked ? "," : "", t->max);
        cli_message("%s:%d: %s misses its budget: best reached p99 %.3g, max %.3g; asked%s", r->recipe_path,
                    t->line, t->name, m->p99, m->max, asked);
        code = CLI_EXCEEDED;
    }
    printf("%-22s %9zu\n", "all textures", bytes);
    if (code == CLI_DONE && recipe->max_bytes && bytes > recipe->max_bytes) {
        cli_message("%s: the textures take %zu bytes; asked are at most %zu", r->recipe_path, bytes,
                    recipe->max_bytes);
        code = CLI_EXCEEDED;
    }
    return code;
}

static int pack(pack_request *r, const lq_recipe *recipe, lq_packed *packed) {
    lq_error error = {""};
    cli_signals_hold();
    lq_status status = lq_folder_check(r->output, &error); /* before the work */
    cli_signals_release();
    if (status == LQ_OK) status = lq_cache_check(r->cache, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    for (size_t i = 0; i < recipe->count; i++) {
        packed[i].from = &recipe->tables[i];
        status = pack_make(r, &packed[i], &error);
        if (status != LQ_OK) return cli_fail_status(status, &error);
    }
    const int code = judge(r, recipe, packed);
    if (code != CLI_DONE) return code; /* the target stays as it was */
    status = write_held(recipe, packed, r->output, &error);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

static int run(int argc, char **argv) {
    pack_request request = {0};
    lq_recipe recipe;
    lq_error error = {""};
    if (!read_arguments(&request, argc, argv)) return CLI_FAILED;
    if (request.threads) omp_set_num_threads((int)request.threads);
    lq_status status = lq_recipe_read(&recipe, request.recipe_path, &request.trust, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    lq_packed *packed = calloc(recipe.count, sizeof *packed);
    const int code = packed ? pack(&request, &recipe, packed) : cli_fail("out of memory");
    for (size_t i = 0; packed && i < recipe.count; i++) {
        lq_table_free(packed[i].table);
        lq_texture_free(&packed[i].texture);
        lq_factored_textures_free(&packed[i].factors);
        lq_factored_free(packed[i].factored);
    }
    free(packed);
    lq_recipe_free(&recipe);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "DIR gets the texture of each table, or those of its factors, in every format asked for, decode\n"
        "source in GLSL, HLSL and C, and " LQ_MANIFEST ": how each file was made and the error it was\n"
        "measured to have, with half storage and 8-bit filter weights. DIR is complete or untouched.\n"
        "Exit 2: a budget was missed. What a recipe may hold: docs/packs.md; those shipped: recipes/.\n\n");
}

const cli_verb cli_verb_pack = {
    .name = "pack",
    .summary = "from a recipe to a folder of textures an engine loads",
    .usage = "RECIPE.json [options] -o DIR",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer pack recipes/realtime.json -o realtime\n"
                "lacquer pack recipes/dfg.json -o textures --cache ~/tables",
    .run = run,
};

/* pack.c - `lacquer pack`: from a recipe to a folder of textures, decode source and a manifest. */
#include "program/pack/pack.h"

#include "pack/cache.h"
#include "pack/folder.h"
#include "pack/page.h"
#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"
#include "system/status.h"

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
    if (!pack_find_recipe(r)) return false;
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
    for (size_t i = 0; i < lq_packed_images(p) && status == LQ_OK && !recipe->atlas; i++) {
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

static lq_status write_sources(const lq_packing *packing, const char *folder, lq_error *error) {
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (int l = 0; l < lq_packing_languages(packing->recipe) && status == LQ_OK; l++) {
        snprintf(path, sizeof path, "%s/%s", folder, lq_language_file((lq_language)l));
        status = lq_packing_source(packing, (lq_language)l, path, error);
    }
    return status;
}

static lq_status write_files(const lq_packing *packing, const char *folder, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        status = write_one(recipe, &packing->tables[i], folder, error);
        if (status == LQ_OK && cli_interrupted()) status = LQ_CANCELLED;
    }
    if (status == LQ_OK && recipe->atlas)
        status = write_image(recipe, &packing->atlas.image, "atlas", "lacquer_atlas_texels", folder, error);
    if (status == LQ_OK) status = write_sources(packing, folder, error);
    if (status == LQ_OK && recipe->material_count > 0) {
        char path[PATH_MAX + 64];
        snprintf(path, sizeof path, "%s/" LQ_PACK_PAGE, folder);
        status = lq_pack_page_write(packing, path, error);
    }
    return status == LQ_OK ? lq_manifest_write(packing, folder, error) : status;
}

static lq_status write_all(const lq_packing *packing, const char *target, lq_error *error) {
    lq_folder folder;
    lq_status status = lq_folder_open(&folder, target, error);
    if (status != LQ_OK) return status;
    status = write_files(packing, folder.staging, error);
    if (status == LQ_OK && cli_interrupted()) status = LQ_CANCELLED;
    if (status == LQ_OK) status = lq_folder_commit(&folder, error);
    if (status != LQ_OK) lq_folder_abandon(&folder);
    return status;
}

/* A signal does not end the program while there is a folder to clear. */
static lq_status write_held(const lq_packing *packing, const char *target, lq_error *error) {
    cli_signals_hold();
    const lq_status status = write_all(packing, target, error);
    cli_signals_release();
    return status;
}

/* ------------------------------------------------------------------------------------------- verb */

/* The budgets that were missed: the first one in words, the others by name. */
typedef struct misses {
    size_t count;
    char first[LQ_MESSAGE_SIZE], others[LQ_MESSAGE_SIZE];
} misses;

/* One table or material of the report. */
typedef struct reported {
    int line;
    const char *name;
    size_t bytes;
    double rms, p99, max, budget_p99, budget_max;
    const char *axis; /* that bends most where the error is largest; NULL: not known */
} reported;

static void report_one(const pack_request *r, const reported *one, misses *missed) {
    char asked[64] = "";
    printf("%-22s %9zu %9.2e %9.2e %9.2e\n", one->name, one->bytes, one->rms, one->p99, one->max);
    if (one->p99 <= one->budget_p99 && one->max <= one->budget_max) return;
    if (missed->count++ > 0) {
        lq_list_add(missed->others, sizeof missed->others, one->name);
        return;
    }
    if (isfinite(one->budget_p99)) snprintf(asked, sizeof asked, " p99 %.3g", one->budget_p99);
    if (isfinite(one->budget_max))
        snprintf(asked + strlen(asked), 32, "%s max %.3g", *asked ? "," : "", one->budget_max);
    snprintf(missed->first, sizeof missed->first,
             "%.200s:%d: %s misses its budget: best reached p99 %.3g, max %.3g; asked%s%s%s", r->recipe_path,
             one->line, one->name, one->p99, one->max, asked, one->axis ? "; refine " : "",
             one->axis ? one->axis : "");
}

static void report_all(const pack_request *r, const lq_packing *packing, misses *missed) {
    const lq_recipe *recipe = packing->recipe;
    printf("%-22s %9s %9s %9s %9s\n", "table", "bytes", "rms", "p99", "max");
    for (size_t i = 0; i < recipe->count; i++) {
        const lq_packed *p = &packing->tables[i];
        const lq_measure *m = &p->measure;
        const reported one = {
            p->from->line, p->from->name, lq_packed_bytes(p),
            m->rms,        m->p99,        m->max,
            p->from->p99,  p->from->max,  p->factored ? NULL : lq_texture_bends(&p->texture, m->worst)};
        report_one(r, &one, missed);
    }
    for (size_t i = 0; i < recipe->material_count; i++) {
        const lq_packed_material *p = &packing->materials[i];
        const lq_lobes_measure *m = &p->measure;
        const reported one = {p->from->line, p->from->name, lq_image_bytes(&p->lobes.image),
                              m->rms,        m->p99,        m->max,
                              recipe->p99,   recipe->max,   NULL};
        report_one(r, &one, missed);
    }
    printf("%-22s %9zu\n", recipe->atlas ? "the atlas" : "all textures", lq_packing_bytes(packing));
}

/* One line a table and a material; exit code 2 and its reason where a budget is missed. */
static int judge(const pack_request *r, const lq_packing *packing) {
    const lq_recipe *recipe = packing->recipe;
    const size_t bytes = lq_packing_bytes(packing);
    misses missed = {0};
    report_all(r, packing, &missed);
    if (missed.count > 0) {
        cli_message("%s%s%s", missed.first, missed.count > 1 ? "; so do " : "", missed.others);
        return CLI_EXCEEDED;
    }
    if (recipe->max_bytes == 0 || bytes <= recipe->max_bytes) return CLI_DONE;
    cli_message("%s: the textures take %zu bytes; asked are at most %zu", r->recipe_path, bytes,
                recipe->max_bytes);
    return CLI_EXCEEDED;
}

/* Every table and material, and all images in one where that is asked for. */
static lq_status make_all(pack_request *r, lq_packing *packing, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    lq_status status = LQ_OK;
    packing->tables = calloc(recipe->count + 1, sizeof *packing->tables);
    packing->materials = calloc(recipe->material_count + 1, sizeof *packing->materials);
    if (!packing->tables || !packing->materials)
        return snprintf(error->text, sizeof error->text, "out of memory"), LQ_NO_MEMORY;
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        packing->tables[i].from = &recipe->tables[i];
        status = pack_make(r, &packing->tables[i], error);
    }
    if (status == LQ_OK && recipe->material_count > 0) status = pack_bake(r, packing, error);
    return status == LQ_OK && recipe->atlas ? lq_packing_place(packing, error) : status;
}

static int pack(pack_request *r, lq_packing *packing) {
    lq_error error = {""};
    cli_signals_hold();
    lq_status status = lq_folder_check(r->output, &error); /* before the work */
    cli_signals_release();
    if (status == LQ_OK) status = lq_cache_check(r->cache, &error);
    if (status == LQ_OK) lq_cache_clear(r->cache);
    if (status == LQ_OK) status = make_all(r, packing, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    const int code = judge(r, packing);
    if (code != CLI_DONE) return code; /* the target stays as it was */
    status = write_held(packing, r->output, &error);
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
    lq_packing packing = {.recipe = &recipe};
    const int code = pack(&request, &packing);
    lq_packing_free(&packing);
    lq_recipe_free(&recipe);
    return code;
}

static void print_notes(FILE *out) {
    fprintf(
        out,
        "A NAME is that of a shipped recipe or scene: realtime, dfg, scene.\n"
        "DIR gets the texture of each table, or those of its factors, or all of them in one atlas, in every\n"
        "format asked for, decode source in GLSL, HLSL and C (with an atlas also Vulkan, WGSL and Metal),\n"
        "of a scene a page, " LQ_PACK_PAGE ", and " LQ_MANIFEST
        ": how each file was made and the error it was\n"
        "measured to have, with half storage and 8-bit filter weights. DIR is complete or untouched.\n"
        "Exit 2: a budget was missed. What a recipe may hold: docs/packs.md; those shipped: recipes/.\n\n");
}

const cli_verb cli_verb_pack = {
    .name = "pack",
    .summary = "from a recipe to a folder of textures an engine loads",
    .usage = "RECIPE.json|NAME [options] -o DIR",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .notes = print_notes,
    .examples = "lacquer pack scene -o scene-pack\n"
                "lacquer pack recipes/realtime.json -o realtime\n"
                "lacquer pack recipes/dfg.json -o textures --cache ~/tables",
    .run = run,
};

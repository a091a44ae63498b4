/* verb_pack.c - `lacquer pack`: from a recipe to a folder of textures, decode source and a manifest. */
#include "cli/message.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/verb.h"
#include "pack/cache.h"
#include "pack/folder.h"
#include "pack/manifest.h"
#include "pack/source.h"

#include <limits.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { OPTION_OUTPUT = 'o', OPTION_CACHE = 256, OPTION_THREADS };

typedef struct pack_request {
    const char *recipe_path, *output, *cache_given;
    size_t threads;
    char cache[PATH_MAX];
    char build[64];
} pack_request;

static bool take(pack_request *r, int id, const char *value) {
    if (id == OPTION_OUTPUT) r->output = value;
    if (id == OPTION_CACHE) r->cache_given = value;
    if (id == OPTION_THREADS) return cli_parse_count("--threads", value, 1, 4096, &r->threads);
    if (id == CLI_WORD && r->recipe_path) return cli_fail("two recipes; accepted is one"), false;
    if (id == CLI_WORD) r->recipe_path = value;
    return true;
}

static bool read_arguments(pack_request *r, int argc, char **argv) {
    cli_args args = cli_args_begin(&cli_verb_pack, argc, argv);
    for (int id; (id = cli_args_next(&args)) != CLI_END;)
        if (id == CLI_BAD || !take(r, id, args.value)) return false;
    if (!r->recipe_path) return cli_fail("no recipe; usage: lacquer pack RECIPE.json -o DIR"), false;
    if (!r->output) return cli_fail("no output folder; add -o DIR"), false;
    if (r->cache_given) snprintf(r->cache, sizeof r->cache, "%s", r->cache_given);
    else if (!lq_cache_default(r->cache, sizeof r->cache))
        return cli_fail("no cache folder: neither XDG_CACHE_HOME nor HOME is set; add --cache DIR"), false;
    lq_cache_build(r->build, sizeof r->build);
    return true;
}

/* ------------------------------------------------------------------------- tables and their checks */

/* All that determines a table: the program, the kind, the settings and every node. NULL: out of memory. */
static char *write_key(const pack_request *r, const lq_recipe_table *t, const char *what) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fprintf(out, "%s %s %s ndf=%s tolerance=%.17g scattering=%d masking=%d", r->build, what, t->kind->id,
            t->settings.ndf, t->settings.tolerance, (int)t->settings.scattering, (int)t->settings.masking);
    for (int a = 0; a < t->kind->axis_count; a++) {
        fprintf(out, " %s=", t->axes[a].name);
        for (size_t i = 0; i < t->axes[a].size; i++) fprintf(out, "%.17g,", t->axes[a].nodes[i]);
    }
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}

static lq_status compute(const lq_recipe_table *t, size_t points, const lq_settings *settings,
                         lq_table **table, lq_error *error) {
    cli_progress bar;
    char label[64];
    snprintf(label, sizeof label, points ? "%s, check" : "%s", t->name);
    cli_progress_begin(&bar, label);
    lq_status status = points
                           ? lq_measure_exact(t->kind, settings, t->axes, points, &bar.progress, table, error)
                           : lq_precompute(t->kind, settings, t->axes, &bar.progress, table, error);
    cli_progress_end(&bar);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* the measured error says what it comes to */
}

/* From the cache, or computed and put there. `points` 0: the table; otherwise exact values at so many. */
static lq_status obtain(const pack_request *r, const lq_recipe_table *t, size_t points, lq_table **table,
                        lq_error *error) {
    char what[48];
    snprintf(what, sizeof what, points ? "points-%zu" : "table", points);
    char *key = write_key(r, t, what);
    if (!key) return snprintf(error->text, sizeof error->text, "out of memory"), LQ_NO_MEMORY;
    lq_settings settings = t->settings;
    settings.threads = (int)r->threads;
    lq_status status = LQ_OK;
    *table = lq_cache_find(r->cache, key);
    if (!*table) {
        status = compute(t, points, &settings, table, error);
        if (status == LQ_OK) status = lq_cache_store(r->cache, key, *table, error);
    }
    free(key);
    return status;
}

static lq_status make_one(const pack_request *r, const lq_recipe *recipe, lq_packed *packed,
                          lq_error *error) {
    const lq_recipe_table *t = packed->from;
    lq_table *exact = NULL;
    lq_status status = obtain(r, t, 0, &packed->table, error);
    if (status == LQ_OK) status = lq_texture_make(&packed->texture, packed->table, t->name, error);
    if (status == LQ_OK) status = obtain(r, t, recipe->points, &exact, error);
    if (status == LQ_OK)
        status = lq_measure_texture(&packed->texture, t->axes, t->kind->axis_count, exact, &packed->measure,
                                    error);
    lq_table_free(exact);
    return status;
}

/* ------------------------------------------------------------------------------------------ files */

static lq_status write_one(const lq_recipe *recipe, const lq_packed *p, const char *folder, lq_error *error) {
    char name[64], path[PATH_MAX + 64], array[64];
    lq_status status = LQ_OK;
    snprintf(array, sizeof array, "lacquer_%s_texels", p->texture.name);
    for (int c = 0; c < LQ_CONTAINERS && status == LQ_OK; c++) {
        if (!recipe->containers[c]) continue;
        lq_packed_file(p, lq_container_ending((lq_container)c), name, sizeof name);
        snprintf(path, sizeof path, "%s/%s", folder, name);
        status = lq_image_write(&p->texture.image, (lq_container)c, array, path, error);
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
    lq_texture textures[LQ_RECIPE_TABLES];
    const lq_kind *kinds[LQ_RECIPE_TABLES];
    char path[PATH_MAX + 64];
    lq_status status = LQ_OK;
    for (size_t i = 0; i < recipe->count; i++) {
        textures[i] = packed[i].texture;
        kinds[i] = packed[i].from->kind;
    }
    for (int l = 0; l < LQ_LANGUAGES && status == LQ_OK; l++) {
        snprintf(path, sizeof path, "%s/%s", folder, lq_source_file((lq_language)l));
        status = lq_source_write((lq_language)l, textures, kinds, recipe->count, path, error);
    }
    return status;
}

static lq_status write_all(const lq_recipe *recipe, const lq_packed *packed, const char *target,
                           lq_error *error) {
    lq_folder folder;
    char path[PATH_MAX + 64];
    lq_status status = lq_folder_open(&folder, target, error);
    if (status != LQ_OK) return status;
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++)
        status = write_one(recipe, &packed[i], folder.staging, error);
    if (status == LQ_OK) status = write_sources(recipe, packed, folder.staging, error);
    snprintf(path, sizeof path, "%s/%s", folder.staging, LQ_MANIFEST);
    if (status == LQ_OK) status = lq_manifest_write(recipe, packed, path, error);
    if (status == LQ_OK && cli_interrupted()) status = LQ_CANCELLED;
    if (status == LQ_OK) status = lq_folder_commit(&folder, error);
    if (status != LQ_OK) lq_folder_abandon(&folder);
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
        bytes += lq_image_bytes(&packed[i].texture.image);
        printf("%-22s %9zu %9.2e %9.2e %9.2e\n", t->name, lq_image_bytes(&packed[i].texture.image), m->rms,
               m->p99, m->max);
        if (code != CLI_DONE || (m->p99 <= t->p99 && m->max <= t->max)) continue;
        cli_message("%s:%d: %s misses its budget: best reached p99 %.3g, max %.3g; asked p99 %.3g, max %.3g",
                    r->recipe_path, t->line, t->name, m->p99, m->max, t->p99, t->max);
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

static int pack(const pack_request *r, const lq_recipe *recipe, lq_packed *packed) {
    lq_error error = {""};
    lq_folder probe;
    /* Can the target be written? Asked before the work. */
    lq_status status = lq_folder_open(&probe, r->output, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    lq_folder_abandon(&probe);
    for (size_t i = 0; i < recipe->count; i++) {
        packed[i].from = &recipe->tables[i];
        status = make_one(r, recipe, &packed[i], &error);
        if (status != LQ_OK) return cli_fail_status(status, &error);
    }
    const int code = judge(r, recipe, packed);
    if (code != CLI_DONE) return code; /* the target stays as it was */
    status = write_all(recipe, packed, r->output, &error);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
}

static int run(int argc, char **argv) {
    pack_request request = {0};
    lq_recipe recipe;
    lq_error error = {""};
    if (!read_arguments(&request, argc, argv)) return CLI_FAILED;
    if (request.threads) omp_set_num_threads((int)request.threads);
    lq_status status = lq_recipe_read(&recipe, request.recipe_path, &error);
    if (status != LQ_OK) return cli_fail_status(status, &error);
    lq_packed *packed = calloc(recipe.count, sizeof *packed);
    const int code = packed ? pack(&request, &recipe, packed) : cli_fail("out of memory");
    for (size_t i = 0; packed && i < recipe.count; i++) {
        lq_table_free(packed[i].table);
        lq_texture_free(&packed[i].texture);
    }
    free(packed);
    lq_recipe_free(&recipe);
    return code;
}

static const cli_option options[] = {
    {OPTION_OUTPUT, "output", "DIR", "the folder to make, or the pack to replace (required)"},
    {OPTION_CACHE, "cache", "DIR", "tables computed before (default: lacquer in XDG_CACHE_HOME or ~/.cache)"},
    {OPTION_THREADS, "threads", "N", "threads; the files do not depend on it (default: one per core)"},
    {0},
};

static void print_notes(FILE *out) {
    fprintf(out,
            "DIR gets one texture per table in every format asked for, decode source in GLSL, HLSL and C,\n"
            "and " LQ_MANIFEST ": how each file was made and the error it was measured to have, with half\n"
            "storage and 8-bit filter weights. DIR is complete or untouched. Exit 2: a budget was missed.\n"
            "What a recipe may hold: docs/packs.md; those shipped: recipes/.\n\n");
}

const cli_verb cli_verb_pack = {
    .name = "pack",
    .summary = "from a recipe to a folder of textures an engine loads",
    .usage = "RECIPE.json [options] -o DIR",
    .options = options,
    .notes = print_notes,
    .examples = "lacquer pack recipes/dfg.json -o dfg\n"
                "lacquer pack recipes/dfg.json -o textures --cache /tmp/lacquer",
    .run = run,
};

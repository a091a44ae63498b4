/* pack.c - `lacquer pack`: from a recipe to a folder of textures, decode source and a manifest. */
#include "program/pack/pack.h"

#include "pack/contents.h"
#include "program/message.h"
#include "program/options.h"
#include "program/progress.h"
#include "program/settings.h"
#include "program/verb.h"

#include <stdio.h>

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
    return true;
}

static void report(const lq_pack_report *r) {
    bool atlas;
    const size_t bytes = lq_pack_report_bytes(r, &atlas);
    printf("%-22s %9s %9s %9s %9s\n", "table", "bytes", "rms", "p99", "max");
    for (size_t i = 0; i < lq_pack_report_count(r); i++) {
        const lq_pack_entry *e = lq_pack_report_entry(r, i);
        printf("%-22s %9zu %9.2e %9.2e %9.2e\n", e->name, e->bytes, e->rms, e->p99, e->max);
    }
    printf("%-22s %9zu\n", atlas ? "the atlas" : "all textures", bytes);
}

static int run(int argc, char **argv) {
    pack_request r = {0};
    lq_pack_report *made;
    lq_error error = {""};
    cli_watch bar;
    if (!read_arguments(&r, argc, argv)) return CLI_FAILED;
    lq_pack_options asked = lq_pack_options_default();
    asked.cache = r.cache;
    asked.trust = r.trust;
    asked.threads = (int)r.threads;
    asked.watch = cli_watch_start(&bar);
    const lq_status status = lq_pack_make(r.recipe_path, r.output, &asked, &made, &error);
    if (made) report(made);
    lq_pack_report_free(made);
    return status == LQ_OK ? CLI_DONE : cli_fail_status(status, &error);
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

/* names.c - collects every file name and identifier that a recipe will make, and finds what occurs twice. */
#include "pack/names.h"

#include "pack/contents.h"
#include "pack/source.h"
#include "system/status.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* An entry: a table, or after them a material. OURS: that of what every pack has. */
enum { NAME = 96, OURS = LQ_RECIPE_TABLES + LQ_RECIPE_MATERIALS };

typedef struct used {
    char text[2 * NAME];
    size_t table;
} used;

typedef struct names {
    const lq_recipe *recipe;
    used *list;
    size_t count, room;
    bool failed;
} names;

void lq_make_identifier(char *identifier, const char *name) {
    snprintf(identifier, LQ_NAME_SIZE, "%s", name);
    for (; *identifier; identifier++)
        if (!isalnum((unsigned char)*identifier)) *identifier = '_';
}

static size_t entries_of(const lq_recipe *recipe) {
    return recipe->count + recipe->material_count;
}

static const char *name_of(const lq_recipe *recipe, size_t entry) {
    return entry < recipe->count ? recipe->tables[entry].name : recipe->materials[entry - recipe->count].name;
}

static bool grow(names *n) {
    const size_t room = 2 * n->room + 64;
    used *list = realloc(n->list, room * sizeof *list);
    if (!list) return false;
    n->list = list;
    n->room = room;
    return true;
}

static void add(names *n, size_t table, const char *stem, const char *ending) {
    if (n->count == n->room && !grow(n)) n->failed = true;
    if (n->failed) return;
    used *entry = &n->list[n->count++];
    snprintf(entry->text, sizeof entry->text, "%s%s", stem, ending);
    entry->table = table;
}

/* How many pieces and factors a table comes to is known after its factorisation: every suffix is kept free.
 */
static void add_all(names *n, size_t table, const char *stem, const char *joint, const char *ending) {
    char text[NAME];
    if (!n->recipe->tables[table].factored) add(n, table, stem, ending);
    for (int s = 0; n->recipe->tables[table].factored && s < LQ_MAX_PIECES * LQ_MAX_FACTORS; s++) {
        snprintf(text, sizeof text, "%s%s%d_%d", stem, joint, s / LQ_MAX_FACTORS, s % LQ_MAX_FACTORS);
        add(n, table, text, ending);
    }
}

static void add_files(names *n, size_t table) {
    if (table >= n->recipe->count) return;
    const lq_recipe_table *t = &n->recipe->tables[table];
    char ending[NAME];
    for (int c = 0; c < LQ_CONTAINERS; c++)
        if (n->recipe->containers[c] && !n->recipe->atlas)
            add_all(n, table, t->name, ".", lq_container_ending((lq_container)c));
    for (int l = 0; l < LQ_LAYOUTS; l++) {
        if (!t->layouts[l]) continue;
        snprintf(ending, sizeof ending, ".%s.bin", lq_layout_name((lq_layout)l));
        add(n, table, t->name, ending);
    }
}

/* As the sources name them behind "lacquer_". */
static void add_identifiers(names *n, size_t table) {
    char identifier[LQ_NAME_SIZE];
    lq_make_identifier(identifier, name_of(n->recipe, table));
    add(n, table, identifier, "");
    if (n->recipe->atlas) add(n, table, identifier, "_rgb"); /* of three colours */
    if (table < n->recipe->count) add_all(n, table, identifier, "_", "_texels");
}

static int by_text(const void *a, const void *b) {
    const used *one = a, *two = b;
    /* Some file systems do not tell upper case from lower. */
    const int order = strcasecmp(one->text, two->text);
    return order != 0 ? order : (one->table < two->table) - (one->table > two->table);
}

static lq_status find_twice(names *n, const char *what, size_t *culprit, lq_error *error) {
    if (n->failed) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    qsort(n->list, n->count, sizeof *n->list, by_text);
    for (size_t i = 1; i < n->count; i++) {
        const used *one = &n->list[i - 1], *two = &n->list[i];
        if (strcasecmp(one->text, two->text) != 0) continue;
        const size_t first = one->table < two->table ? one->table : two->table;
        const size_t later = one->table < two->table ? two->table : one->table;
        *culprit = later == OURS ? first : later;
        const char *other = later == OURS ? "every pack" : name_of(n->recipe, first);
        return lq_fail(error, LQ_BAD_INPUT,
                       "the name '%s' makes %s '%s', which %s has too; accepted: another \"name\"",
                       name_of(n->recipe, *culprit), what, two->text, other);
    }
    return LQ_OK;
}

/* Identifiers with two underscores in a row are kept by GLSL for itself; files that begin with a dot are
 * hidden, and with a dash taken for options. */
static lq_status check_plain(const lq_recipe *recipe, size_t *culprit, lq_error *error) {
    for (size_t i = 0; i < entries_of(recipe); i++) {
        char identifier[LQ_NAME_SIZE];
        lq_make_identifier(identifier, name_of(recipe, i));
        *culprit = i;
        if (identifier[0] == '_' || strstr(identifier, "__") || identifier[strlen(identifier) - 1] == '_')
            return lq_fail(
                error, LQ_BAD_INPUT,
                "the name '%s' makes no identifier; accepted: letters and digits, with single '_', '-' or "
                "'.' between them",
                name_of(recipe, i));
    }
    return LQ_OK;
}

static lq_status check(names *n, void (*collect)(names *, size_t), const char *const *ours, const char *what,
                       size_t *culprit, lq_error *error) {
    n->count = 0;
    for (size_t i = 0; ours[i]; i++) add(n, OURS, ours[i], "");
    for (size_t i = 0; i < entries_of(n->recipe); i++) collect(n, i);
    return find_twice(n, what, culprit, error);
}

lq_status lq_names_check(const lq_recipe *recipe, size_t *culprit, lq_error *error) {
    const char *files[LQ_LANGUAGES + 2 + LQ_CONTAINERS] = {LQ_MANIFEST};
    names n = {.recipe = recipe};
    for (int l = 0; l < LQ_LANGUAGES; l++) files[l + 1] = lq_language_file((lq_language)l);
    lq_status status = check_plain(recipe, culprit, error);
    if (status == LQ_OK) status = check(&n, add_files, files, "the file", culprit, error);
    if (status == LQ_OK) status = check(&n, add_identifiers, lq_source_helpers(), "lacquer_", culprit, error);
    free(n.list);
    return status;
}

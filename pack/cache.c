/* cache.c - a folder of EXR archives named by the hash of their key. */
#define _GNU_SOURCE /* O_NOFOLLOW */
#include "pack/cache.h"

#include "pca/factors.h"
#include "pca/factors_json.h"
#include "system/leftover.h"
#include "system/status.h"

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char key_fact[] = "cache-key", sum_fact[] = "cache-sum";

/* FNV-1a, 64 bits. Collisions are harmless: the key itself is compared. */
static uint64_t hash(uint64_t seed, const void *bytes, size_t size) {
    for (const unsigned char *b = bytes; size-- > 0; b++) seed = (seed ^ *b) * UINT64_C(0x100000001b3);
    return seed;
}

static const uint64_t basis = UINT64_C(0xcbf29ce484222325);

static void name_file(char *path, size_t size, const char *folder, const char *key) {
    snprintf(path, size, "%s/%016" PRIx64 ".exr", folder, hash(basis, key, strlen(key)));
}

bool lq_cache_default(char *folder, size_t size) {
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (base && base[0] == '/') return snprintf(folder, size, "%s/lacquer", base) < (int)size;
    return home && home[0] == '/' && snprintf(folder, size, "%s/.cache/lacquer", home) < (int)size;
}

/* -------------------------------------------------------------------------------------- the folder */

/* Like mkdir -p. */
static bool make_folders(const char *folder) {
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path) return false;
    for (char *c = path + 1; *c; c++) {
        if (*c != '/') continue;
        *c = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST) return false;
        *c = '/';
    }
    return mkdir(path, 0700) == 0 || errno == EEXIST;
}

lq_status lq_cache_check(const char *folder, lq_error *error) {
    struct stat there;
    if (stat(folder, &there) != 0) return LQ_OK;
    if (!S_ISDIR(there.st_mode)) return lq_fail(error, LQ_IO, "the cache %s is no folder", folder);
    if (there.st_uid == geteuid() || (there.st_mode & S_ISVTX)) return LQ_OK;
    return lq_fail(
        error, LQ_IO,
        "the cache %s belongs to another user, who could change its entries; accepted: a folder of your "
        "own",
        folder);
}

/* An entry of the user's own, opened without following a link or waiting for a pipe, under a name that stays
 * this file's. */
static int open_entry(char *name, size_t size, const char *folder, const char *key) {
    char path[PATH_MAX];
    struct stat info;
    name_file(path, sizeof path, folder, key);
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return -1;
    snprintf(name, size, "/proc/self/fd/%d", file);
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid()) return file;
    close(file);
    return -1;
}

/* ------------------------------------------------------------------------------------- checksums */

static uint64_t add_text(uint64_t sum, const char *text) {
    return hash(sum, text, strlen(text) + 1);
}

static uint64_t add_facts(uint64_t sum, const lq_fact *facts, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (strncmp(facts[i].key, "cache-", 6) != 0)
            sum = add_text(add_text(sum, facts[i].key), facts[i].value);
    return sum;
}

static uint64_t table_sum(const lq_table *table, const char *key) {
    uint64_t sum = add_facts(add_text(basis, key), table->facts, table->fact_count);
    for (int a = 0; a < table->axis_count; a++) {
        sum = add_text(sum, table->axes[a].name);
        sum = hash(sum, table->axes[a].nodes, table->axes[a].size * sizeof *table->axes[a].nodes);
    }
    for (int c = 0; c < table->channel_count; c++) {
        sum = add_text(sum, table->channel_names[c]);
        sum = hash(sum, table->channels[c], lq_table_entries(table) * sizeof *table->channels[c]);
    }
    return sum;
}

/* 0: out of memory. */
static uint64_t factored_sum(const lq_factored *factored, const char *key) {
    uint64_t sum = add_facts(add_text(basis, key), factored->facts, factored->fact_count);
    char *structure = lq_factored_to_json(factored);
    if (!structure) return 0;
    sum = add_text(sum, structure);
    free(structure);
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &factored->pieces[p].factors[f];
            sum =
                hash(sum, factor->data, factor->base_count * lq_factor_texels(factor) * sizeof *factor->data);
        }
    return sum;
}

static void print_sum(char *text, size_t size, uint64_t sum) {
    snprintf(text, size, "%016" PRIx64, sum);
}

static bool is_entry(const char *of, const char *key, const char *stated, uint64_t sum) {
    char text[32];
    print_sum(text, sizeof text, sum);
    return of && stated && strcmp(of, key) == 0 && strcmp(stated, text) == 0;
}

/* --------------------------------------------------------------------------------------- entries */

static bool has_axes(const lq_table *table, const lq_axis *axes, int axis_count) {
    if (table->axis_count != axis_count) return false;
    for (int a = 0; a < axis_count; a++)
        if (strcmp(table->axes[a].name, axes[a].name) != 0 || table->axes[a].size != axes[a].size ||
            memcmp(table->axes[a].nodes, axes[a].nodes, axes[a].size * sizeof *axes[a].nodes) != 0)
            return false;
    return true;
}

lq_table *lq_cache_find(const char *folder, const char *key, const lq_axis *axes, int axis_count) {
    char name[64];
    lq_table *table = NULL;
    const int file = open_entry(name, sizeof name, folder, key);
    if (file < 0) return NULL;
    const lq_status status = lq_table_read_exr(&table, name, NULL);
    close(file);
    if (status != LQ_OK) return NULL;
    if (is_entry(lq_table_fact(table, key_fact), key, lq_table_fact(table, sum_fact),
                 table_sum(table, key)) &&
        has_axes(table, axes, axis_count))
        return table;
    lq_table_free(table);
    return NULL;
}

static bool spans(const lq_factored *factored, const lq_axis *axes, int axis_count) {
    if (factored->axis_count != axis_count) return false;
    for (int a = 0; a < axis_count; a++)
        if (strcmp(factored->axes[a].name, axes[a].name) != 0 || factored->axes[a].min != axes[a].min ||
            factored->axes[a].max != axes[a].max)
            return false;
    return true;
}

lq_factored *lq_cache_find_factored(const char *folder, const char *key, const lq_axis *axes,
                                    int axis_count) {
    char name[64];
    lq_factored *factored = NULL;
    const int file = open_entry(name, sizeof name, folder, key);
    if (file < 0) return NULL;
    const lq_status status = lq_factored_read(&factored, name, NULL);
    close(file);
    if (status != LQ_OK) return NULL;
    const char *of = lq_factored_fact(factored, key_fact), *stated = lq_factored_fact(factored, sum_fact);
    if (is_entry(of, key, stated, factored_sum(factored, key)) && spans(factored, axes, axis_count))
        return factored;
    lq_factored_free(factored);
    return NULL;
}

/* -------------------------------------------------------------------------------------- a place to write */

/* A folder of the user's own inside the cache, whose file is then renamed to its place: that replaces a link
 * where writing would follow it. The lock dies with its maker, and tells a folder that was left over from one
 * at work. */
typedef struct place {
    char path[PATH_MAX], file[PATH_MAX + 8];
    int lock;
} place;

static const char PLACE_NAME[] = "new-XXXXXX", FILE_NAME[] = "exr";

static bool is_own_folder(int folder) {
    struct stat info;
    return fstat(folder, &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid();
}

/* What system/output.c leaves beside the file it makes, too. */
static void clear_files(int folder) {
    DIR *list = fdopendir(dup(folder));
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (strcmp(entry->d_name, FILE_NAME) == 0 ||
            strncmp(entry->d_name, LQ_TEMPORARY, sizeof LQ_TEMPORARY - 1) == 0)
            unlinkat(folder, entry->d_name, 0);
    if (list) closedir(list);
}

static void clear_leftover(const char *cache, const char *name) {
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/%s", cache, name) >= (int)sizeof path) return;
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    if (is_own_folder(folder) && flock(folder, LOCK_EX | LOCK_NB) == 0) {
        clear_files(folder);
        rmdir(path); /* stays where it holds anything else */
    }
    close(folder);
}

void lq_cache_clear(const char *cache) {
    DIR *list = opendir(cache);
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (strlen(entry->d_name) == sizeof PLACE_NAME - 1 && strncmp(entry->d_name, PLACE_NAME, 4) == 0)
            clear_leftover(cache, entry->d_name);
    if (list) closedir(list);
}

/* Another run may take it for a leftover until it is locked. */
static bool make_place(place *p, const char *cache) {
    struct stat info;
    for (int attempt = 0; attempt < 10; attempt++) {
        if (snprintf(p->path, sizeof p->path, "%s/%s", cache, PLACE_NAME) >= (int)sizeof p->path)
            return false;
        if (!mkdtemp(p->path)) return false;
        p->lock = open(p->path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
        if (p->lock >= 0 && flock(p->lock, LOCK_EX) == 0 && stat(p->path, &info) == 0) return true;
        if (p->lock >= 0) close(p->lock);
        rmdir(p->path);
    }
    return false;
}

static lq_status open_place(place *p, const char *cache, lq_error *error) {
    lq_status status = make_folders(cache) ? lq_cache_check(cache, error)
                                           : lq_fail(error, LQ_IO, "the cache %s cannot be made: %m", cache);
    if (status != LQ_OK) return status;
    if (!make_place(p, cache)) return lq_fail(error, LQ_IO, "the cache %s cannot be written: %m", cache);
    snprintf(p->file, sizeof p->file, "%s/%s", p->path, FILE_NAME);
    return LQ_OK;
}

static lq_status close_place(const place *p, lq_status status, const char *cache, const char *key,
                             lq_error *error) {
    char path[PATH_MAX];
    name_file(path, sizeof path, cache, key);
    if (status == LQ_OK && rename(p->file, path) != 0)
        status = lq_fail(error, LQ_IO, "the cache %s cannot be written: %m", cache);
    unlink(p->file);
    rmdir(p->path);
    close(p->lock);
    return status;
}

/* --------------------------------------------------------------------------------------- storing */

lq_status lq_cache_store(const char *folder, const char *key, lq_table *table, lq_error *error) {
    place inner;
    char sum[32];
    lq_status status = open_place(&inner, folder, error);
    if (status != LQ_OK) return status;
    print_sum(sum, sizeof sum, table_sum(table, key));
    status = lq_table_set_fact(table, key_fact, key, error);
    if (status == LQ_OK) status = lq_table_set_fact(table, sum_fact, sum, error);
    if (status == LQ_OK) status = lq_table_write_exr(table, inner.file, error);
    return close_place(&inner, status, folder, key, error);
}

lq_status lq_cache_store_factored(const char *folder, const char *key, lq_factored *factored,
                                  lq_error *error) {
    place inner;
    char sum[32];
    lq_status status = open_place(&inner, folder, error);
    if (status != LQ_OK) return status;
    print_sum(sum, sizeof sum, factored_sum(factored, key));
    status = lq_factored_set_fact(factored, key_fact, key, error);
    if (status == LQ_OK) status = lq_factored_set_fact(factored, sum_fact, sum, error);
    if (status == LQ_OK) status = lq_factored_write(factored, inner.file, error);
    return close_place(&inner, status, folder, key, error);
}

const char *lq_cache_build(char *text, size_t size) {
    Dl_info here = {0};
    uint64_t sum = basis;
    unsigned char block[1 << 14];
    /* The file this code was loaded from: the library, or the program it was linked into. */
    FILE *in = dladdr((const void *)key_fact, &here) && here.dli_fname ? fopen("/proc/self/exe", "rb") : NULL;
    FILE *library = here.dli_fname ? fopen(here.dli_fname, "rb") : NULL;
    FILE *const files[2] = {in, library};
    for (int i = 0; i < 2; i++) {
        if (!files[i]) continue;
        for (size_t n; (n = fread(block, 1, sizeof block, files[i])) > 0;) sum = hash(sum, block, n);
        fclose(files[i]);
    }
    snprintf(text, size, LQ_VERSION "-%016" PRIx64, sum);
    return text;
}

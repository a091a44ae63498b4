/* cache.c - a folder of EXR archives named by the hash of their key. */
#include "pack/cache.h"

#include "pca/factors.h"
#include "system/status.h"

#include <dlfcn.h>
#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char key_fact[] = "cache-key";

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

lq_table *lq_cache_find(const char *folder, const char *key) {
    char path[PATH_MAX];
    lq_table *table = NULL;
    name_file(path, sizeof path, folder, key);
    if (lq_table_read_exr(&table, path, NULL) != LQ_OK) return NULL;
    const char *of = lq_table_fact(table, key_fact);
    if (of && strcmp(of, key) == 0) return table;
    lq_table_free(table);
    return NULL;
}

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
    return mkdir(path, 0777) == 0 || errno == EEXIST;
}

lq_factored *lq_cache_find_factored(const char *folder, const char *key) {
    char path[PATH_MAX];
    lq_factored *factored = NULL;
    name_file(path, sizeof path, folder, key);
    if (lq_factored_read(&factored, path, NULL) != LQ_OK) return NULL;
    const char *of = lq_factored_fact(factored, key_fact);
    if (of && strcmp(of, key) == 0) return factored;
    lq_factored_free(factored);
    return NULL;
}

/* Where the entry for `key` goes; its folder is there then. */
static lq_status place(char *path, size_t size, const char *folder, const char *key, lq_error *error) {
    name_file(path, size, folder, key);
    if (make_folders(folder)) return LQ_OK;
    return lq_fail(error, LQ_IO, "cache %s: %s; name another with --cache", folder, strerror(errno));
}

lq_status lq_cache_store(const char *folder, const char *key, lq_table *table, lq_error *error) {
    char path[PATH_MAX];
    lq_status status = place(path, sizeof path, folder, key, error);
    if (status == LQ_OK) status = lq_table_set_fact(table, key_fact, key, error);
    return status == LQ_OK ? lq_table_write_exr(table, path, error) : status;
}

lq_status lq_cache_store_factored(const char *folder, const char *key, lq_factored *factored,
                                  lq_error *error) {
    char path[PATH_MAX];
    lq_status status = place(path, sizeof path, folder, key, error);
    if (status == LQ_OK) status = lq_factored_set_fact(factored, key_fact, key, error);
    return status == LQ_OK ? lq_factored_write(factored, path, error) : status;
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

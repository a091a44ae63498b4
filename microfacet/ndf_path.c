/* Which file an NDF came from: its path, and a hash of what it held. */
#include "microfacet/ndf_file.h"
#include "system/input.h"
#include "system/status.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HASH_DIGITS = 16 };

/* FNV-1a, 64 bits: tells a changed file from the same, not a forged one. */
static uint64_t hash_bytes(const char *bytes, size_t size) {
    uint64_t hash = 0xCBF29CE484222325u;
    for (size_t i = 0; i < size; i++) hash = (hash ^ (unsigned char)bytes[i]) * 0x100000001B3u;
    return hash;
}

/* The end of PATH in PATH#HASH; the whole length where there is no such hash. */
static size_t path_length(const char *text) {
    const char *mark = strrchr(text, '#');
    if (mark && strlen(mark + 1) == HASH_DIGITS && strspn(mark + 1, "0123456789abcdef") == HASH_DIGITS)
        return (size_t)(mark - text);
    return strlen(text);
}

lq_status lq_ndf_path_make(lq_ndf_path *path, const char *family, const char *text, lq_error *error) {
    *path = (lq_ndf_path){.path = NULL};
    const size_t length = text ? path_length(text) : 0;
    if (length == 0)
        return lq_fail(error, LQ_BAD_INPUT, "NDF '%s' needs a path; write %s:PATH", family, family);
    const size_t room = strlen(family) + length + HASH_DIGITS + 3;
    path->path = strndup(text, length);
    path->id = malloc(room);
    if (!path->path || !path->id) return lq_fail(error, LQ_NO_MEMORY, "no memory for a path");
    const lq_status status =
        lq_input_read_within(path->path, LQ_NDF_FILE_LARGEST, &path->bytes, &path->size, error);
    if (status != LQ_OK) return status;
    snprintf(path->id, room, "%s:%s#%016" PRIx64, family, path->path, hash_bytes(path->bytes, path->size));
    const char *wanted = text + length, *found = path->id + strlen(path->id) - HASH_DIGITS;
    if (*wanted && strcmp(wanted + 1, found) != 0)
        return lq_fail(error, LQ_BAD_INPUT, "%s has changed: its hash is %s, not %s", path->path, found,
                       wanted + 1);
    return LQ_OK;
}

void lq_ndf_path_free(lq_ndf_path *path) {
    free(path->path);
    free(path->id);
    free(path->bytes);
    *path = (lq_ndf_path){.path = NULL};
}

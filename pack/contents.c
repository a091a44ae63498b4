/* contents.c - the files of a pack: listed in the manifest, checked and removed by that list alone. */
#include "pack/contents.h"

#include "system/input.h"
#include "system/status.h"

#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

bool lq_contents_checksum(const char *folder, const char *name, char *text) {
    char path[PATH_MAX + LQ_PACK_FILE_NAME + 2], *bytes;
    size_t size;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (lq_input_read(path, &bytes, &size, NULL) != LQ_OK) return false;
    snprintf(text, 9, "%08lx", crc32_z(0, (const unsigned char *)bytes, size) & 0xffffffffUL);
    free(bytes);
    return true;
}

static int is_file(const struct dirent *entry) {
    return entry->d_name[0] != '.' && strcmp(entry->d_name, LQ_MANIFEST) != 0;
}

static int by_bytes(const struct dirent **a, const struct dirent **b) {
    return strcmp((*a)->d_name, (*b)->d_name);
}

json_t *lq_contents_list(const char *folder) {
    struct dirent **entries = NULL;
    json_t *files = json_object();
    const int count = scandir(folder, &entries, is_file, by_bytes);
    bool fine = files && count >= 0;
    for (int i = 0; i < count; i++) {
        char text[9];
        fine = fine && lq_contents_checksum(folder, entries[i]->d_name, text);
        if (fine) lq_json_set(&files, entries[i]->d_name, json_string(text));
        free(entries[i]);
    }
    free(entries);
    if (fine) return files;
    json_decref(files);
    return NULL;
}

/* ----------------------------------------------------------------------------------- reading */

static bool is_name(const char *text) {
    return *text && *text != '.' && !strchr(text, '/') && strlen(text) < LQ_PACK_FILE_NAME;
}

static lq_status take_files(lq_contents *contents, json_t *files, const char *folder, lq_error *error) {
    const char *name;
    json_t *sum;
    contents->files = calloc(json_object_size(files) + 1, sizeof *contents->files);
    if (!contents->files) return lq_fail(error, LQ_NO_MEMORY, "%s: out of memory", folder);
    json_object_foreach(files, name, sum) {
        lq_pack_file *file = &contents->files[contents->count];
        if (!is_name(name) || !json_is_string(sum) || json_string_length(sum) != 8)
            return lq_fail(error, LQ_FORMAT, LQ_MANIFEST ": its list of files is damaged");
        snprintf(file->name, sizeof file->name, "%s", name);
        snprintf(file->crc32, sizeof file->crc32, "%s", json_string_value(sum));
        contents->count++;
    }
    return LQ_OK;
}

lq_status lq_contents_read(lq_contents *contents, const char *folder, lq_error *error) {
    char path[PATH_MAX + 16], *bytes;
    size_t size;
    *contents = (lq_contents){0};
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    lq_status status = lq_input_read(path, &bytes, &size, error);
    if (status != LQ_OK) return status;
    json_t *root;
    status = lq_json_parse(&root, LQ_MANIFEST, bytes, size, error);
    free(bytes);
    if (status == LQ_NO_MEMORY) return status;
    status = LQ_OK; /* what is no JSON is no pack's */
    const char *format = json_string_value(json_object_get(root, "format"));
    json_t *version = json_object_get(root, "version"), *files = json_object_get(root, "files");
    if (!format || strcmp(format, LQ_PACK_FORMAT) != 0 || !json_is_integer(version) || !json_is_object(files))
        status = lq_fail(error, LQ_FORMAT, LQ_MANIFEST " is not of a pack that this program made");
    else if (json_integer_value(version) > LQ_PACK_VERSION)
        status = lq_fail(error, LQ_FORMAT, LQ_MANIFEST " is of version %lld; known are versions up to %d",
                         (long long)json_integer_value(version), LQ_PACK_VERSION);
    if (status == LQ_OK) status = take_files(contents, files, folder, error);
    json_decref(root);
    if (status != LQ_OK) lq_contents_free(contents);
    return status;
}

/* ---------------------------------------------------------------------------------- checking */

static const lq_pack_file *find(const lq_contents *contents, const char *name) {
    for (size_t i = 0; i < contents->count; i++)
        if (strcmp(contents->files[i].name, name) == 0) return &contents->files[i];
    return NULL;
}

/* NULL: the entry is as it was made. */
static const char *complaint(const lq_contents *contents, const char *folder, const char *name) {
    char sum[9];
    if (strcmp(name, ".") == 0 || strcmp(name, "..") == 0 || strcmp(name, LQ_MANIFEST) == 0) return NULL;
    const lq_pack_file *file = find(contents, name);
    if (!file) return "is not part of the pack in it";
    return lq_contents_checksum(folder, name, sum) && strcmp(sum, file->crc32) == 0 ? NULL
                                                                                    : "was changed since";
}

lq_status lq_contents_check(const lq_contents *contents, const char *folder, const char *shown,
                            lq_error *error) {
    lq_status status = LQ_OK;
    DIR *list = opendir(folder);
    if (!list) return lq_fail(error, LQ_IO, "cannot read the folder %s: %m", shown);
    for (struct dirent *entry; status == LQ_OK && (entry = readdir(list));) {
        const char *what = complaint(contents, folder, entry->d_name);
        if (what)
            status = lq_fail(
                error, LQ_IO,
                "cannot replace %s: its '%s' %s; accepted: a new or empty folder, or a pack as it was "
                "made",
                shown, entry->d_name, what);
    }
    closedir(list);
    return status;
}

bool lq_contents_remove(const lq_contents *contents, const char *folder) {
    char path[PATH_MAX + LQ_PACK_FILE_NAME + 2];
    for (size_t i = 0; i < contents->count; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, contents->files[i].name);
        unlink(path);
    }
    snprintf(path, sizeof path, "%s/" LQ_MANIFEST, folder);
    unlink(path);
    return rmdir(folder) == 0;
}

void lq_contents_free(lq_contents *contents) {
    free(contents->files);
    *contents = (lq_contents){0};
}

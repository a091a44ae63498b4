/* fuzz.c - the list of readers, and the files they get their bytes in. */
#define _GNU_SOURCE /* mkdtemp, nftw */
#include "fuzz.h"

#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const fuzz_reader readers[] = {
    {"table", fuzz_table},
    {"factors", fuzz_factors},
    {"structure", fuzz_structure},
    {"foreign-exr", fuzz_foreign_exr},
    {"bin", fuzz_bin},
    {"dat", fuzz_dat},
    {"npy", fuzz_npy},
    {"c-array", fuzz_c_array},
    {"axes", fuzz_axes},
    {"ktx2", fuzz_ktx2},
    {"dds", fuzz_dds},
    {"manifest", fuzz_manifest},
    {"recipe", fuzz_recipe},
    {"scene", fuzz_recipe},
    {"stack", fuzz_stack},
    {"budget", fuzz_budget},
    {"ndf", fuzz_ndf},
    {"points", fuzz_points},
    {"text", fuzz_text_arguments},
    {"options", fuzz_options},
};

const fuzz_reader *fuzz_reader_at(size_t i) {
    return i < sizeof readers / sizeof *readers ? &readers[i] : NULL;
}

const fuzz_reader *fuzz_reader_find(const char *name) {
    for (size_t i = 0; fuzz_reader_at(i); i++)
        if (name && strcmp(readers[i].name, name) == 0) return &readers[i];
    return NULL;
}

static char folder[64];

static int remove_one(const char *path, const struct stat *info, int type, struct FTW *where) {
    (void)info, (void)type, (void)where;
    return remove(path);
}

static void remove_folder(void) {
    nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

static void need(int fine, const char *what) {
    if (fine) return;
    perror(what);
    abort();
}

const char *fuzz_folder(void) {
    if (*folder) return folder;
    snprintf(folder, sizeof folder, "%s/lacquer-fuzz-XXXXXX",
             access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
    need(mkdtemp(folder) != NULL, folder);
    atexit(remove_folder);
    return folder;
}

const char *fuzz_file(const char *name, const uint8_t *bytes, size_t size) {
    static char paths[8][128];
    static unsigned next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof *paths, "%s/%s", fuzz_folder(), name);
    const int file = open(path, O_CREAT | O_TRUNC | O_WRONLY, 0600);
    need(file >= 0 && write(file, bytes, size) == (ssize_t)size && close(file) == 0, path);
    return path;
}

char *fuzz_text(const uint8_t *bytes, size_t size) {
    char *text = malloc(size + 1);
    need(text != NULL, "fuzz_text");
    memcpy(text, bytes, size);
    text[size] = '\0';
    return text;
}

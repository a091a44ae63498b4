/* The temporary folder of a test program: made before its first test, and empty again after the last. */
#ifndef LACQUER_TESTS_SCRATCH_H
#define LACQUER_TESTS_SCRATCH_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char folder[] = "/tmp/lacquer-test-XXXXXX";

/* The path of `name` in it; a few may be in use at once. */
static inline const char *at(const char *name) {
    static char paths[4][512];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* How many files are in it; -1: it cannot be read. */
static inline int files_in_folder(void) {
    int count = 0;
    DIR *list = opendir(folder);
    if (!list) return -1;
    while (readdir(list)) count++;
    closedir(list);
    return count - 2; /* itself and its parent */
}

static inline int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

/* Fails where anything was left. */
static inline int remove_folder(void **state) {
    (void)state;
    return rmdir(folder);
}

#endif

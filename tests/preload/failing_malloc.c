/* failing_malloc.c - for LD_PRELOAD: the allocation numbered LACQUER_FAIL_AT, counted from main, fails; at
 * the end the number of allocations goes to the file LACQUER_ALLOCATIONS. For a program of one thread. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static volatile bool counting;
static volatile long count, fail_at;

static bool fails_now(void) {
    if (!counting || ++count != fail_at) return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size) {
    return fails_now() ? NULL : __libc_malloc(size);
}

void *calloc(size_t number, size_t size) {
    return fails_now() ? NULL : __libc_calloc(number, size);
}

void *realloc(void *block, size_t size) {
    return fails_now() ? NULL : __libc_realloc(block, size);
}

void *memalign(size_t alignment, size_t size) {
    return fails_now() ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    return memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
    void *got = memalign(alignment, size);
    if (got) *block = got;
    return got ? 0 : ENOMEM;
}

static void report(void) {
    counting = false;
    const char *path = getenv("LACQUER_ALLOCATIONS");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file) return;
    fprintf(file, "%ld\n", count);
    fclose(file);
}

static int (*true_main)(int, char **, char **);

static int counted_main(int argc, char **argv, char **environment) {
    const char *at = getenv("LACQUER_FAIL_AT");
    fail_at = at ? atol(at) : 0;
    atexit(report);
    counting = true;
    return true_main(argc, argv, environment);
}

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*start)(void),
                      void (*end)(void), void (*loader_end)(void), void *stack) {
    int (*next)(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void), void (*)(void),
                void *);
    *(void **)&next = dlsym(RTLD_NEXT, "__libc_start_main");
    true_main = main;
    return next(counted_main, argc, argv, start, end, loader_end, stack);
}

/* failing_malloc.h - the allocator of a test program, which fails when it is told to. Defines malloc and its
 * kin: for one file of a program. */
#define _GNU_SOURCE
#ifndef LACQUER_TESTS_FAILING_MALLOC_H
#define LACQUER_TESTS_FAILING_MALLOC_H

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CAN_FAIL 1 /* elsewhere the allocator cannot be replaced this way */
#else
#define CAN_FAIL 0
#endif

/* Allocations left before one fails; negative: none will. What is tested uses one thread. */
static volatile long countdown = -1; /* volatile: the compiler believes that malloc does not read it */

/* The largest that was asked for since somebody set it to 0. */
static volatile size_t largest_asked __attribute__((unused));

#if CAN_FAIL
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static bool fails_now(size_t size) {
    if (size > largest_asked) largest_asked = size;
    return countdown >= 0 && countdown-- == 0;
}

void *malloc(size_t size) {
    return fails_now(size) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    return fails_now(count * size) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size) {
    return fails_now(size) ? NULL : __libc_realloc(block, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
    void *got = fails_now(size) ? NULL : __libc_memalign(alignment, size);
    if (!got) return ENOMEM;
    *block = got;
    return 0;
}
#endif

/* Valgrind, which comes in by LD_PRELOAD, puts its own allocator before ours in part of the libraries. */
static inline bool can_fail(void) {
    const char *preload = getenv("LD_PRELOAD");
    return CAN_FAIL && !(preload && strstr(preload, "vgpreload"));
}

#endif

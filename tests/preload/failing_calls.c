/* failing_calls.c - for LD_PRELOAD: of the calls that change files, the one numbered LACQUER_DENY_AT finds
 * the disk full, the process is killed before the one numbered LACQUER_KILL_AT; at the end their number goes
 * to the file LACQUER_CALLS. Calls that only take away are never denied. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static long count;

static long setting(const char *name) {
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

/* True: the call is to fail. */
static bool next_call(bool deniable) {
    const long now = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
    if (now == setting("LACQUER_KILL_AT")) raise(SIGKILL);
    if (!deniable || now != setting("LACQUER_DENY_AT")) return false;
    errno = ENOSPC;
    return true;
}

__attribute__((destructor)) static void report(void) {
    const char *path = getenv("LACQUER_CALLS");
    const long calls = count;
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file) return;
    fprintf(file, "%ld\n", calls);
    fclose(file);
}

#define TRUE_CALL(TYPE, NAME, ...)                                                                           \
    TYPE (*call)(__VA_ARGS__);                                                                               \
    *(void **)&call = dlsym(RTLD_NEXT, NAME)

ssize_t write(int file, const void *bytes, size_t size) {
    TRUE_CALL(ssize_t, "write", int, const void *, size_t);
    return file > STDERR_FILENO && next_call(true) ? -1 : call(file, bytes, size);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t offset) {
    TRUE_CALL(ssize_t, "pwrite", int, const void *, size_t, off_t);
    return next_call(true) ? -1 : call(file, bytes, size, offset);
}

int open(const char *path, int flags, ...) {
    TRUE_CALL(int, "open", const char *, int, ...);
    va_list rest;
    va_start(rest, flags);
    const bool makes = (flags & O_CREAT) || (flags & O_TMPFILE) == O_TMPFILE;
    const mode_t mode = makes ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return makes && next_call(true) ? -1 : call(path, flags, mode);
}

int linkat(int from, const char *old, int to, const char *new, int flags) {
    TRUE_CALL(int, "linkat", int, const char *, int, const char *, int);
    return next_call(true) ? -1 : call(from, old, to, new, flags);
}

int rename(const char *old, const char *new) {
    TRUE_CALL(int, "rename", const char *, const char *);
    return next_call(true) ? -1 : call(old, new);
}

int renameat2(int from, const char *old, int to, const char *new, unsigned flags) {
    TRUE_CALL(int, "renameat2", int, const char *, int, const char *, unsigned);
    return next_call(true) ? -1 : call(from, old, to, new, flags);
}

char *mkdtemp(char *pattern) {
    TRUE_CALL(char *, "mkdtemp", char *);
    return next_call(true) ? NULL : call(pattern);
}

int mkdir(const char *path, mode_t mode) {
    TRUE_CALL(int, "mkdir", const char *, mode_t);
    return next_call(true) ? -1 : call(path, mode);
}

int unlink(const char *path) {
    TRUE_CALL(int, "unlink", const char *);
    next_call(false);
    return call(path);
}

int rmdir(const char *path) {
    TRUE_CALL(int, "rmdir", const char *);
    next_call(false);
    return call(path);
}

int unlinkat(int folder, const char *path, int flags) {
    TRUE_CALL(int, "unlinkat", int, const char *, int);
    next_call(false);
    return call(folder, path, flags);
}

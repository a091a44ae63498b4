/* input.c - whole files into memory. */
#include "system/input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/status.h"

static lq_status check(int file, const char *path, size_t largest, lq_error *error) {
    struct stat there;
    if (fstat(file, &there) != 0 || !S_ISREG(there.st_mode))
        return lq_fail(error, LQ_IO, "cannot read %s: not a regular file", path);
    if ((size_t)there.st_size > largest)
        return lq_fail(error, LQ_IO, "cannot read %s: it has %zu bytes; accepted are at most %zu", path,
                       (size_t)there.st_size, largest);
    return LQ_OK;
}

/* O_NONBLOCK: a pipe without a writer would wait for one before it could be refused. */
lq_status lq_input_open(FILE **in, const char *path, size_t largest, lq_error *error) {
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    *in = NULL;
    if (file < 0) return lq_fail(error, LQ_IO, "cannot read %s: %s", path, strerror(errno));
    lq_status status = check(file, path, largest, error);
    if (status == LQ_OK && !(*in = fdopen(file, "rb")))
        status = lq_fail(error, LQ_NO_MEMORY, "no memory to read %s", path);
    if (status != LQ_OK) close(file);
    return status;
}

lq_status lq_input_read(const char *path, char **bytes, size_t *size, lq_error *error) {
    return lq_input_read_within(path, SIZE_MAX / 2, bytes, size, error);
}

lq_status lq_input_read_within(const char *path, size_t largest, char **bytes, size_t *size,
                               lq_error *error) {
    struct stat there;
    FILE *in;
    *bytes = NULL;
    lq_status status = lq_input_open(&in, path, largest, error);
    if (status != LQ_OK) return status;
    if (fstat(fileno(in), &there) != 0) status = lq_fail(error, LQ_IO, "cannot read %s: %m", path);
    if (status == LQ_OK) {
        *size = (size_t)there.st_size;
        *bytes = malloc(*size + 1);
        if (!*bytes) status = lq_fail(error, LQ_NO_MEMORY, "no memory for %zu bytes", *size);
    }
    if (status == LQ_OK && fread(*bytes, 1, *size, in) != *size)
        status = lq_fail(error, LQ_IO, "cannot read %s: it ends early", path);
    fclose(in);
    if (status == LQ_OK) {
        (*bytes)[*size] = '\0';
        return LQ_OK;
    }
    free(*bytes);
    *bytes = NULL;
    return status;
}

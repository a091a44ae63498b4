/* input.c - whole files into memory. */
#include "system/input.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "system/status.h"

lq_status lq_input_read(const char *path, char **bytes, size_t *size, lq_error *error) {
    struct stat there;
    FILE *in = fopen(path, "rb");
    *bytes = NULL;
    if (!in) return lq_fail(error, LQ_IO, "cannot read %s: %m", path);
    lq_status status = LQ_OK;
    if (fstat(fileno(in), &there) != 0 || !S_ISREG(there.st_mode))
        status = lq_fail(error, LQ_IO, "cannot read %s: not a regular file", path);
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

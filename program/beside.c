/* beside.c - the folder of the running program. */
#include "program/beside.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

bool cli_beside(const char *const *places, size_t count, int mode, char *path, size_t size) {
    char self[PATH_MAX];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length > 0) self[length] = '\0';
    char *slash = length > 0 ? strrchr(self, '/') : NULL;
    if (slash) *slash = '\0';
    for (size_t i = 0; slash && i < count; i++)
        if ((size_t)snprintf(path, size, "%s%s", self, places[i]) < size && access(path, mode) == 0)
            return true;
    return false;
}

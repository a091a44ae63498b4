/* claims.c - a file that can be made only once is a claim, on network file systems too. */
#include "system/claims.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define TAKEN   "taken-"
#define STOPPED "taken-stop"

void lq_claims_clear(const char *folder) {
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (strncmp(entry->d_name, TAKEN, sizeof TAKEN - 1) == 0) unlinkat(dirfd(list), entry->d_name, 0);
    if (list) closedir(list);
}

/* False: it was there. */
static bool make(const char *path) {
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    /* What cannot be claimed for another reason than that it is claimed is done here, if more than once. */
    if (file < 0) return errno != EEXIST;
    close(file);
    return true;
}

bool lq_claim(const char *folder, const lq_crew *crew, size_t index) {
    char path[PATH_MAX];
    if (!crew) return true;
    if (snprintf(path, sizeof path, "%s/" STOPPED, folder) < (int)sizeof path && access(path, F_OK) == 0)
        return false;
    return snprintf(path, sizeof path, "%s/" TAKEN "%07zu", folder, index) >= (int)sizeof path || make(path);
}

void lq_claims_stop(const char *folder, const lq_crew *crew) {
    char path[PATH_MAX];
    if (crew && snprintf(path, sizeof path, "%s/" STOPPED, folder) < (int)sizeof path) make(path);
}

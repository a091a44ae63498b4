/* folder.c - staging beside the target, then one rename. */
#include "pack/folder.h"

#include "system/status.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The files of a pack lie flat. */
static void remove_files(const char *folder) {
    char path[2 * PATH_MAX];
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) unlink(path);
    }
    if (list) closedir(list);
    rmdir(folder);
}

static bool is_empty(const char *folder) {
    DIR *list = opendir(folder);
    int count = 0;
    while (list && readdir(list)) count++;
    if (list) closedir(list);
    return count == 2; /* itself and its parent */
}

static lq_status check_target(const char *target, lq_error *error) {
    char manifest[PATH_MAX];
    struct stat there;
    if (stat(target, &there) != 0) return LQ_OK;
    if (!S_ISDIR(there.st_mode)) return lq_fail(error, LQ_IO, "cannot write %s: it is a file", target);
    snprintf(manifest, sizeof manifest, "%s/%s", target, LQ_MANIFEST);
    if (access(manifest, F_OK) == 0 || is_empty(target)) return LQ_OK;
    return lq_fail(error, LQ_IO,
                   "cannot replace %s: it holds files and no %s; accepted: a new or empty folder, or a pack",
                   target, LQ_MANIFEST);
}

lq_status lq_folder_open(lq_folder *folder, const char *target, lq_error *error) {
    const mode_t mask = umask(0);
    umask(mask);
    *folder = (lq_folder){0};
    size_t length = strlen(target);
    while (length > 1 && target[length - 1] == '/') length--;
    if (length == 0 || length >= sizeof folder->target)
        return lq_fail(error, LQ_BAD_INPUT, "the output folder's name is empty or too long");
    memcpy(folder->target, target, length);
    lq_status status = check_target(folder->target, error);
    if (status != LQ_OK) return status;
    snprintf(folder->staging, sizeof folder->staging, "%s.new-XXXXXX", folder->target);
    if (mkdtemp(folder->staging) && chmod(folder->staging, 0777 & ~mask) == 0) return LQ_OK;
    folder->staging[0] = '\0';
    return lq_fail(error, LQ_IO, "cannot write %s: %s", folder->target, strerror(errno));
}

lq_status lq_folder_commit(lq_folder *folder, lq_error *error) {
    /* Exchange: at no time is there no target. What was there is then in the staging folder. */
    int done = renameat2(AT_FDCWD, folder->staging, AT_FDCWD, folder->target, RENAME_EXCHANGE);
    if (done != 0 && errno == ENOENT) {
        done = rename(folder->staging, folder->target);
        if (done == 0) folder->staging[0] = '\0';
    }
    if (done != 0) return lq_fail(error, LQ_IO, "cannot replace %s: %s", folder->target, strerror(errno));
    lq_folder_abandon(folder);
    return LQ_OK;
}

void lq_folder_abandon(lq_folder *folder) {
    if (folder->staging[0]) remove_files(folder->staging);
    folder->staging[0] = '\0';
}

/* folder.c - staging beside the target, then one exchange. */
#define _GNU_SOURCE /* renameat2 */
#include "pack/folder.h"

#include "system/output.h"
#include "system/status.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* A staging folder is TARGET.new-XXXXXX with this file in it: a folder of that name without it is somebody
 * else's, unless it is empty or a pack as it was made. The mark goes last before the exchange, when the
 * folder is such a pack. */
static const char MARK[] = ".lacquer-staging";
static const char STAGING_SUFFIX[] = ".new-XXXXXX";

/* ---------------------------------------------------------------------------------- the target */

static bool is_empty(const char *folder) {
    DIR *list = opendir(folder);
    int count = 0;
    while (list && readdir(list)) count++;
    if (list) closedir(list);
    return count == 2; /* itself and its parent */
}

/* The name without slashes at its end; the target, where it is there, without links. */
static lq_status resolve(lq_folder *folder, const char *target, lq_error *error) {
    char found[PATH_MAX];
    size_t length = strlen(target);
    while (length > 1 && target[length - 1] == '/') length--;
    const bool fits = length > 0 && length < sizeof folder->name;
    if (fits) snprintf(folder->name, sizeof folder->name, "%.*s", (int)length, target);
    const char *real = realpath(target, found) ? found : folder->name;
    if (!fits || strlen(real) >= sizeof folder->target)
        return lq_fail(error, LQ_BAD_INPUT, "the output folder's name is empty or too long");
    memcpy(folder->target, real, strlen(real) + 1);
    return LQ_OK;
}

/* What cannot be exchanged by renaming: the root, a mount point, and the current folder, which would be gone.
 */
static lq_status check_place(const lq_folder *folder, const struct stat *there, lq_error *error) {
    char parent[PATH_MAX];
    const char *name = folder->name;
    struct stat here, above;
    snprintf(parent, sizeof parent, "%s/..", folder->target);
    if (stat(".", &here) == 0 && here.st_dev == there->st_dev && here.st_ino == there->st_ino)
        return lq_fail(error, LQ_IO, "cannot replace %s: it is the current folder; accepted: another one",
                       name);
    if (stat(parent, &above) != 0 || above.st_dev != there->st_dev || above.st_ino == there->st_ino)
        return lq_fail(error, LQ_IO,
                       "cannot replace %s: it is the root of a file system; accepted: a folder in it", name);
    if (lq_output_is_protected(folder->target))
        return lq_fail(error, LQ_IO, "cannot replace %s: it is another user's, in a sticky folder", name);
    return LQ_OK;
}

/* `old` gets the list of the pack that is there; none where the target is new or empty. */
static lq_status check_target(const lq_folder *folder, lq_contents *old, lq_error *error) {
    const char *target = folder->target, *name = folder->name;
    struct stat there;
    lq_error why = {""};
    *old = (lq_contents){0};
    if (lstat(target, &there) != 0) return LQ_OK;
    if (S_ISLNK(there.st_mode))
        return lq_fail(error, LQ_IO, "cannot write %s: it is a link to nothing", name);
    if (!S_ISDIR(there.st_mode)) return lq_fail(error, LQ_IO, "cannot write %s: it is a file", name);
    lq_status status = check_place(folder, &there, error);
    if (status != LQ_OK || is_empty(target)) return status;
    if (lq_contents_read(old, target, &why) != LQ_OK)
        return lq_fail(
            error, LQ_IO,
            "cannot replace %s: it holds files and no pack of this program (%s); accepted: a new or empty "
            "folder, or a pack",
            name, why.text);
    status = lq_contents_check(old, target, name, error);
    if (status != LQ_OK) lq_contents_free(old);
    return status;
}

/* ---------------------------------------------------------------------------------- the staging */

/* All files of a staging folder are this program's. */
static void remove_staging(const char *folder) {
    char path[2 * PATH_MAX];
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) unlink(path);
    }
    if (list) closedir(list);
    rmdir(folder);
}

static bool has_mark(const char *staging) {
    char mark[2 * PATH_MAX + sizeof MARK];
    struct stat info;
    snprintf(mark, sizeof mark, "%s/%s", staging, MARK);
    return lstat(mark, &info) == 0 && S_ISREG(info.st_mode);
}

/* A kill between mark and exchange leaves a pack, or what is left of one that was being removed. */
static void clear_pack(const char *staging) {
    lq_contents contents;
    if (lq_contents_read(&contents, staging, NULL) != LQ_OK) return;
    if (lq_contents_check(&contents, staging, staging, NULL) == LQ_OK) lq_contents_remove(&contents, staging);
    lq_contents_free(&contents);
}

/* The lock of its maker, which dies with the maker, tells a folder that is left over from one at work. */
static void clear_leftover(const char *staging) {
    const int folder = open(staging, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return;
    if (flock(folder, LOCK_EX | LOCK_NB) == 0) {
        if (has_mark(staging)) remove_staging(staging);
        else if (rmdir(staging) != 0) clear_pack(staging);
    }
    close(folder);
}

/* What runs that were killed left beside the target. */
static void clear_leftovers(const char *target) {
    char parent[PATH_MAX], staging[2 * PATH_MAX];
    snprintf(parent, sizeof parent, "%s", target);
    char *slash = strrchr(parent, '/');
    const char *name = slash ? target + (slash - parent) + 1 : target;
    const size_t length = strlen(name), suffix = sizeof STAGING_SUFFIX - 1;
    if (slash) *(slash == parent ? slash + 1 : slash) = '\0';
    DIR *list = opendir(slash ? parent : ".");
    for (struct dirent *entry; list && (entry = readdir(list));) {
        const char *end = entry->d_name + length;
        if (strlen(entry->d_name) != length + suffix || strncmp(entry->d_name, name, length) != 0 ||
            strncmp(end, STAGING_SUFFIX, suffix - 6) != 0)
            continue;
        snprintf(staging, sizeof staging, "%s/%s", slash ? parent : ".", entry->d_name);
        clear_leftover(staging);
    }
    if (list) closedir(list);
}

static bool place_mark(const char *staging) {
    char mark[2 * PATH_MAX + sizeof MARK];
    snprintf(mark, sizeof mark, "%s/%s", staging, MARK);
    const int file = open(mark, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    return file >= 0 && close(file) == 0;
}

static void remove_mark(const char *staging) {
    char mark[2 * PATH_MAX + sizeof MARK];
    snprintf(mark, sizeof mark, "%s/%s", staging, MARK);
    unlink(mark);
}

static lq_status make_staging(lq_folder *folder, lq_error *error) {
    const mode_t mask = umask(0);
    umask(mask);
    snprintf(folder->staging, sizeof folder->staging, "%s%s", folder->target, STAGING_SUFFIX);
    if (!mkdtemp(folder->staging)) {
        folder->staging[0] = '\0';
        return lq_fail(error, LQ_IO, "cannot write %s: %s", folder->name, strerror(errno));
    }
    folder->lock = open(folder->staging, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder->lock >= 0 && flock(folder->lock, LOCK_EX | LOCK_NB) == 0 && place_mark(folder->staging) &&
        chmod(folder->staging, 0777 & ~mask) == 0)
        return LQ_OK;
    lq_fail(error, LQ_IO, "cannot write %s: %s", folder->name, strerror(errno));
    lq_folder_abandon(folder);
    return LQ_IO;
}

/* ---------------------------------------------------------------------------------- the folder */

lq_status lq_folder_check(const char *target, lq_error *error) {
    lq_folder probe;
    const lq_status status = lq_folder_open(&probe, target, error);
    if (status == LQ_OK) lq_folder_abandon(&probe);
    return status;
}

lq_status lq_folder_open(lq_folder *folder, const char *target, lq_error *error) {
    lq_contents old;
    *folder = (lq_folder){.lock = -1};
    lq_status status = resolve(folder, target, error);
    if (status == LQ_OK) status = check_target(folder, &old, error);
    if (status != LQ_OK) return status;
    lq_contents_free(&old);
    clear_leftovers(folder->target);
    return make_staging(folder, error);
}

/* After the exchange the old pack is what the staging name stands for. Only what its list names is removed.
 */
static lq_status remove_old(const lq_folder *folder, const lq_contents *old, lq_error *error) {
    if (lq_contents_remove(old, folder->staging)) return LQ_OK;
    return lq_fail(error, LQ_IO, "%s is made; what was put into the older one meanwhile is kept in %s",
                   folder->name, folder->staging);
}

lq_status lq_folder_commit(lq_folder *folder, lq_error *error) {
    lq_contents old;
    lq_status status = check_target(folder, &old, error);
    if (status != LQ_OK) return status;
    remove_mark(folder->staging);
    /* Exchange: at no time is there no target. */
    int done = renameat2(AT_FDCWD, folder->staging, AT_FDCWD, folder->target, RENAME_EXCHANGE);
    if (done == 0) status = remove_old(folder, &old, error);
    else if (errno == ENOENT) done = rename(folder->staging, folder->target);
    lq_contents_free(&old);
    if (done != 0) return lq_fail(error, LQ_IO, "cannot replace %s: %s", folder->name, strerror(errno));
    folder->staging[0] = '\0';
    lq_folder_abandon(folder);
    return status;
}

void lq_folder_abandon(lq_folder *folder) {
    if (folder->staging[0]) remove_staging(folder->staging);
    if (folder->lock >= 0) close(folder->lock);
    folder->staging[0] = '\0';
    folder->lock = -1;
}

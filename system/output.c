/* output.c - atomic output: write to an unnamed file, then link and rename it into place. */
#define _GNU_SOURCE /* O_TMPFILE, eaccess, vasprintf */
#include "system/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "system/leftover.h"
#include "system/number.h"
#include "system/status.h"

/* Lines of text are some 50 bytes: one system call for a thousand of them. */
enum { BUFFER_SIZE = 1 << 16 };

/* Names tried for the temporary file before giving up; each taken one is another writer at work. */
enum { MAX_ATTEMPTS = 1000 };

struct lq_output {
    char *path;        /* as the caller wrote it: messages */
    char *target;      /* `path` with links followed: what is replaced */
    char *temporary;   /* room for a name beside `target`; empty while there is no such file */
    int file, lock;    /* of the temporary, as long as it has a name; -1: none */
    bool direct;       /* a device or pipe: no temporary, no rename */
    uint64_t appended; /* bytes a pipe has taken through lq_output_write_at */
    size_t used;
    char buffer[BUFFER_SIZE];
};

/* ------------------------------------------------------------------ names */

/* Length of the folder part of `path` with its slash; 0 for the current folder. */
static size_t folder_length(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

static void name_temporary(lq_output *output, int attempt) {
    size_t length = folder_length(output->target);
    memcpy(output->temporary, output->target, length);
    sprintf(output->temporary + length, LQ_TEMPORARY "%ld-%d", (long)getpid(), attempt);
}

static lq_status refuse_open(const char *path, int cause, lq_error *error) {
    size_t length = folder_length(path);
    int shown = length > 1 ? (int)length - 1 : (int)length;
    const char *folder = length ? path : ".";
    if (!length) shown = 1;
    if (cause == ENOENT)
        return lq_fail(error, LQ_IO,
                       "%s: the folder '%.*s' does not exist; accepted is a file in one that does", path,
                       shown, folder);
    if (cause == ENOTDIR)
        return lq_fail(error, LQ_IO, "%s: '%.*s' is not a folder; accepted is a file in a folder", path,
                       shown, folder);
    return lq_fail(error, LQ_IO, "%s: cannot create a file in '%.*s': %s; accepted is a writable folder",
                   path, shown, folder, strerror(cause));
}

bool lq_output_is_protected(const char *path) {
    struct stat info, parent;
    char folder[PATH_MAX];
    const size_t length = folder_length(path);
    if (length >= sizeof folder || lstat(path, &info) != 0) return false;
    memcpy(folder, path, length);
    memcpy(folder + length, ".", 2);
    const uid_t user = geteuid();
    return stat(folder, &parent) == 0 && (parent.st_mode & S_ISVTX) && user != 0 && user != parent.st_uid &&
           user != info.st_uid;
}

/* ------------------------------------------------------------------ opening */

/* A program whose standard streams were closed must not find a table where it prints. */
static int above_streams(int file) {
    if (file < 0 || file > STDERR_FILENO) return file;
    const int higher = fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    close(file);
    return higher;
}

/* A file without a name in the folder of `target`. */
static int open_nameless(const char *target, int access) {
    char folder[PATH_MAX];
    size_t length = folder_length(target);
    if (length >= sizeof folder) return -1;
    memcpy(folder, target, length);
    memcpy(folder + length, length ? "" : ".", length ? 1 : 2);
    return open(folder, O_TMPFILE | access | O_CLOEXEC, 0666);
}

/* The unnamed file, if it can be named later on: that takes /proc. */
static int open_unnamed(const char *target) {
    char link[64];
    int file = open_nameless(target, O_WRONLY);
    if (file < 0) return -1;
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    if (access(link, F_OK) == 0) return file;
    close(file);
    return -1;
}

/* Another run may take the file for a leftover until it is locked. */
static int open_locked(lq_output *output) {
    struct stat info;
    const int file = open(output->temporary, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file < 0) return -1;
    output->lock = lq_leftover_lock(file);
    if (fstat(file, &info) != 0 || info.st_nlink > 0) return file;
    close(file);
    if (output->lock >= 0) close(output->lock);
    output->lock = -1;
    errno = EEXIST;
    return -1;
}

static int open_named(lq_output *output) {
    int file = -1;
    for (int i = 0; i < MAX_ATTEMPTS && file < 0; i++) {
        name_temporary(output, i);
        file = open_locked(output);
        if (file < 0 && errno != EEXIST) break;
    }
    if (file < 0) *output->temporary = '\0';
    return file;
}

/* What stands at `path` now decides: a folder is refused, a device opened as it is, a link followed. */
static lq_status inspect(lq_output *output, lq_error *error) {
    struct stat info;
    size_t length = strlen(output->path);
    if (length == 0) return lq_fail(error, LQ_IO, "an empty file name; accepted is the name of a file");
    bool exists = stat(output->path, &info) == 0;
    if (!exists && errno != ENOENT) return refuse_open(output->path, errno, error);
    if (exists ? S_ISDIR(info.st_mode) : output->path[length - 1] == '/')
        return lq_fail(error, LQ_IO, "%s: is a folder; accepted is the name of a file", output->path);
    output->direct = exists && !S_ISREG(info.st_mode);
    if (exists && eaccess(output->path, W_OK) != 0)
        return lq_fail(error, LQ_IO, "%s: %s; accepted is a file that may be replaced", output->path,
                       strerror(errno));
    if (exists && !output->direct && lq_output_is_protected(output->path))
        return lq_fail(error, LQ_IO, "%s: another user's, in a sticky folder; accepted is a file of your own",
                       output->path);
    output->target = exists && !output->direct ? realpath(output->path, NULL) : strdup(output->path);
    output->temporary = output->target ? calloc(1, strlen(output->target) + 64) : NULL;
    if (output->temporary) return LQ_OK;
    return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to write it", output->path);
}

static lq_status open_file(lq_output *output, lq_error *error) {
    if (output->direct) {
        output->file = above_streams(open(output->path, O_WRONLY | O_CLOEXEC));
        if (output->file >= 0) return LQ_OK;
        return lq_fail(error, LQ_IO, "%s: cannot open it: %s; accepted is a file that can be written",
                       output->path, strerror(errno));
    }
    lq_leftovers_clear(output->target, folder_length(output->target));
    output->file = above_streams(open_unnamed(output->target));
    if (output->file < 0) output->file = above_streams(open_named(output));
    return output->file >= 0 ? LQ_OK : refuse_open(output->path, errno, error);
}

lq_status lq_output_open(lq_output **output, const char *path, lq_error *error) {
    *output = NULL;
    lq_output *made = calloc(1, sizeof *made);
    if (made) made->path = strdup(path);
    if (!made || !made->path) {
        free(made);
        return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to write it", path);
    }
    made->file = made->lock = -1;
    lq_status status = inspect(made, error);
    if (status == LQ_OK) status = open_file(made, error);
    if (status) lq_output_abandon(made);
    else *output = made;
    return status;
}

/* ------------------------------------------------------------------ writing */

static lq_status refuse_write(const lq_output *output, int cause, lq_error *error) {
    const char *advice = "";
    if (cause == ENOSPC || cause == EDQUOT || cause == EFBIG)
        advice = "; accepted is a place with room for the whole file";
    if (cause == ESPIPE) advice = "; accepted is a regular file, as this format is not written in order";
    return lq_fail(error, LQ_IO, "%s: cannot write: %s%s", output->path, strerror(cause), advice);
}

/* A write that takes no byte and gives no reason is a full disk on the systems where it happens. */
static lq_status advance(const lq_output *output, ssize_t wrote, lq_error *error) {
    if (wrote > 0 || (wrote < 0 && errno == EINTR)) return LQ_OK;
    return refuse_write(output, wrote < 0 ? errno : ENOSPC, error);
}

static lq_status put(lq_output *output, const char *bytes, size_t size, lq_error *error) {
    while (size > 0) {
        ssize_t wrote = write(output->file, bytes, size);
        lq_status status = advance(output, wrote, error);
        if (status) return status;
        if (wrote < 0) continue;
        bytes += wrote;
        size -= (size_t)wrote;
    }
    return LQ_OK;
}

static lq_status flush(lq_output *output, lq_error *error) {
    size_t used = output->used;
    output->used = 0;
    return put(output, output->buffer, used, error);
}

lq_status lq_output_write(lq_output *output, const void *bytes, size_t size, lq_error *error) {
    if (size > sizeof output->buffer - output->used) {
        lq_status status = flush(output, error);
        if (status) return status;
    }
    if (size > sizeof output->buffer) return put(output, bytes, size, error);
    memcpy(output->buffer + output->used, bytes, size);
    output->used += size;
    return LQ_OK;
}

lq_status lq_output_print(lq_output *output, lq_error *error, const char *format, ...) {
    char *text;
    va_list arguments;
    va_start(arguments, format);
    const locale_t before = lq_locale_c();
    int length = vasprintf(&text, format, arguments);
    lq_locale_back(before);
    va_end(arguments);
    if (length < 0) return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to write it", output->path);
    lq_status status = lq_output_write(output, text, (size_t)length, error);
    free(text);
    return status;
}

lq_status lq_output_write_at(lq_output *output, const void *bytes, size_t size, uint64_t offset,
                             lq_error *error) {
    const char *next = bytes;
    while (size > 0) {
        ssize_t wrote = pwrite(output->file, next, size, (off_t)offset);
        if (wrote < 0 && errno == ESPIPE && offset == output->appended) {
            wrote = write(output->file, next, size);
            if (wrote > 0) output->appended += (uint64_t)wrote;
        }
        lq_status status = advance(output, wrote, error);
        if (status) return status;
        if (wrote < 0) continue;
        next += wrote;
        size -= (size_t)wrote;
        offset += (uint64_t)wrote;
    }
    return LQ_OK;
}

/* ------------------------------------------------------------------ publishing */

/* Give the unnamed file a name beside the target. */
static int link_unnamed(lq_output *output) {
    char link[64];
    snprintf(link, sizeof link, "/proc/self/fd/%d", output->file);
    output->lock = lq_leftover_lock(output->file);
    for (int i = 0; i < MAX_ATTEMPTS; i++) {
        name_temporary(output, i);
        if (linkat(AT_FDCWD, link, AT_FDCWD, output->temporary, AT_SYMLINK_FOLLOW) == 0) return 0;
        if (errno != EEXIST) break;
    }
    int cause = errno;
    *output->temporary = '\0';
    errno = cause;
    return -1;
}

/* A file that only its owner could read stays so when it is replaced. */
static void keep_permissions(const lq_output *output) {
    struct stat older;
    if (!output->direct && stat(output->target, &older) == 0) fchmod(output->file, older.st_mode & 07777);
}

static lq_status publish(lq_output *output, lq_error *error) {
    keep_permissions(output);
    bool named = output->direct || *output->temporary || link_unnamed(output) == 0;
    if (!named) return refuse_open(output->path, errno, error);
    int failed = close(output->file);
    output->file = -1;
    if (failed) return refuse_write(output, errno, error); /* network file systems report here */
    if (output->direct) return LQ_OK;
    if (rename(output->temporary, output->target) != 0)
        return lq_fail(error, LQ_IO, "%s: cannot replace it: %s; accepted is a file that may be replaced",
                       output->path, strerror(errno));
    *output->temporary = '\0';
    return LQ_OK;
}

lq_status lq_output_commit(lq_output *output, lq_error *error) {
    lq_status status = flush(output, error);
    if (status == LQ_OK) status = publish(output, error);
    lq_output_abandon(output);
    return status;
}

void lq_output_abandon(lq_output *output) {
    if (!output) return;
    if (output->file >= 0) close(output->file);
    if (output->temporary && *output->temporary) unlink(output->temporary);
    if (output->lock >= 0) close(output->lock);
    free(output->temporary);
    free(output->target);
    free(output->path);
    free(output);
}

lq_status lq_output_settle(const char *path, lq_error *error) {
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    const bool settled = file >= 0 && (fsync(file) == 0 || errno == EINVAL || errno == ENOSYS);
    const int cause = errno;
    if (file >= 0) close(file);
    return settled ? LQ_OK
                   : lq_fail(error, LQ_IO, "%s: cannot be brought to the disk: %s", path, strerror(cause));
}

lq_status lq_output_scratch(int *file, const char *beside, lq_error *error) {
    lq_output *output;
    *file = above_streams(open_nameless(beside, O_RDWR));
    if (*file >= 0) return LQ_OK;
    lq_status status = lq_output_open(&output, beside, error); /* where no file is without a name */
    if (status != LQ_OK) return status;
    *file = *output->temporary ? above_streams(open(output->temporary, O_RDWR | O_CLOEXEC)) : -1;
    if (*file < 0) status = refuse_open(beside, errno, error);
    lq_output_abandon(output);
    return status;
}

lq_status lq_output_folder(const char *path, lq_error *error) {
    struct stat there;
    if (mkdir(path, 0777) == 0) return LQ_OK;
    if (errno == EEXIST && stat(path, &there) == 0 && !S_ISDIR(there.st_mode)) errno = ENOTDIR;
    if (errno == EEXIST) return LQ_OK;
    return lq_fail(error, LQ_IO, "cannot make the folder '%.300s': %s", path, strerror(errno));
}

lq_status lq_output_save(const char *path, const void *bytes, size_t size, lq_error *error) {
    lq_output *file;
    lq_status status = lq_output_open(&file, path, error);
    if (status != LQ_OK) return status;
    status = lq_output_write(file, bytes, size, error);
    if (status == LQ_OK) return lq_output_commit(file, error);
    lq_output_abandon(file);
    return status;
}

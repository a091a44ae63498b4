/* part_folder.c - a folder that holds
 *
 *     lock      locked by the run at work; a lock dies with its process
 *     key       what decides the bytes of the parts; written before any of them
 *     0000012   a part: head, then bytes
 *     taken-0000012, stop   who makes what, between processes of one run; rank 0 removes those of a run
 * before
 */
#define _GNU_SOURCE /* O_NOFOLLOW */
#include "system/part_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "system/claims.h"
#include "system/input.h"
#include "system/output.h"
#include "system/status.h"

enum { KEY_MAX = 1 << 24, NAME = 32, BLOCK = 1 << 16 };

/* In the order of the machine's bytes: another machine's magic does not fit. */
typedef struct part_head {
    uint64_t magic, index, size;
    uint32_t key, sum; /* CRC-32 of the key and of the bytes */
} part_head;

static const uint64_t magic = UINT64_C(0x317472617071636c); /* "lcqpart1" */

struct lq_part_folder {
    char *path;
    uint32_t key;
    const lq_crew *crew;
    int lock; /* -1: it is another process of the crew that has it */
};

static uint32_t sum_of(uint32_t sum, const void *bytes, size_t size) {
    return (uint32_t)crc32_z(sum, bytes, size);
}

static void name_in(const lq_part_folder *f, const char *name, char path[PATH_MAX]) {
    snprintf(path, PATH_MAX, "%s/%s", f->path, name);
}

static void name_part(const lq_part_folder *f, const char *prefix, size_t index, char path[PATH_MAX]) {
    char name[NAME];
    snprintf(name, sizeof name, "%s%07zu", prefix, index);
    name_in(f, name, path);
}

/* ======================================================================================
 *                                       The folder
 * ====================================================================================== */

static bool is_part(const char *name) {
    return strlen(name) >= 7 && strspn(name, "0123456789") == strlen(name);
}

static void clear_parts(const lq_part_folder *f) {
    DIR *list = opendir(f->path);
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (is_part(entry->d_name)) unlinkat(dirfd(list), entry->d_name, 0);
    if (list) closedir(list);
}

/* Whether there is anything but the lock and what a run that was killed left of a file in the making. */
static bool is_used(const lq_part_folder *f) {
    bool used = false;
    DIR *list = opendir(f->path);
    for (struct dirent *entry; list && (entry = readdir(list));)
        used |= entry->d_name[0] != '.' && strcmp(entry->d_name, "lock") != 0;
    if (list) closedir(list);
    return used;
}

static lq_status lock(lq_part_folder *f, lq_error *error) {
    char path[PATH_MAX];
    struct stat there;
    if (lstat(f->path, &there) == 0 && (!S_ISDIR(there.st_mode) || there.st_uid != geteuid()))
        return lq_fail(error, LQ_BAD_INPUT, "%s: not a folder of your own; accepted is one, or none",
                       f->path);
    lq_status status = lq_output_folder(f->path, error);
    if (status != LQ_OK) return status;
    name_in(f, "lock", path);
    f->lock = open(path, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (f->lock < 0) return lq_fail(error, LQ_IO, "%s: cannot be used: %s", f->path, strerror(errno));
    if (flock(f->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return lq_fail(error, LQ_BAD_INPUT, "%s: another run is at work there; accepted is one at a time",
                       f->path);
    return LQ_OK;
}

/* ======================================================================================
 *                                         Key
 * ====================================================================================== */

/* How much of a line a message has room for. */
static int shown(const char *line) {
    const size_t length = strcspn(line, "\n");
    return length < 60 ? (int)length : 60;
}

/* The first lines that differ. */
static lq_status refuse_key(const lq_part_folder *f, const char *here, const char *there, lq_error *error) {
    while (*here && *there) {
        const size_t mine = strcspn(here, "\n"), other = strcspn(there, "\n");
        if (mine != other || memcmp(here, there, mine) != 0) break;
        here += mine + (here[mine] != '\0');
        there += other + (there[other] != '\0');
    }
    return lq_fail(error, LQ_BAD_INPUT,
                   "%s: has finished parts of other work ('%.*s', not '%.*s'); accepted: the same options as "
                   "then, another output file, or that folder removed",
                   f->path, shown(there), there, shown(here), here);
}

static lq_status check_key(const lq_part_folder *f, const char *key, lq_error *error) {
    char path[PATH_MAX], *there = NULL;
    size_t size = 0;
    name_in(f, "key", path);
    if (access(path, F_OK) != 0) {
        if (!is_used(f)) return lq_output_save(path, key, strlen(key), error);
        return lq_fail(error, LQ_BAD_INPUT,
                       "%s: not a folder of finished parts; accepted: an empty one, or none", f->path);
    }
    lq_status status = lq_input_read_within(path, KEY_MAX, &there, &size, error);
    if (status == LQ_OK && strcmp(there, key) != 0) status = refuse_key(f, key, there, error);
    free(there);
    return status;
}

/* All processes of a crew must do the same work, on machines that give the same bits. */
static lq_status compare_keys(const lq_part_folder *f, lq_error *error) {
    uint32_t first = f->key;
    f->crew->share(f->crew->user, &first, sizeof first);
    return first == f->key ? LQ_OK
                           : lq_fail(error, LQ_BAD_INPUT,
                                     "process %d of %d has other options, another program or another "
                                     "processor than the first; accepted: the same for all",
                                     f->crew->rank, f->crew->size);
}

static lq_status start(lq_part_folder *f, const char *key, lq_error *error) {
    const bool first = !f->crew || f->crew->rank == 0;
    lq_status status = first ? lock(f, error) : LQ_OK;
    if (status == LQ_OK && first) status = check_key(f, key, error);
    if (status == LQ_OK && first) lq_claims_clear(f->path);
    if (!f->crew) return status;
    status = f->crew->meet(f->crew->user, status, error);
    if (status == LQ_OK) status = f->crew->meet(f->crew->user, compare_keys(f, error), error);
    return status;
}

lq_status lq_part_folder_open(lq_part_folder **folder, const char *path, const char *key, const lq_crew *crew,
                              lq_error *error) {
    *folder = NULL;
    lq_part_folder *f = calloc(1, sizeof *f);
    if (f) f->path = strdup(path);
    if (!f || !f->path) {
        free(f);
        return lq_fail(error, LQ_NO_MEMORY, "%s: no memory for finished parts", path);
    }
    f->lock = -1;
    f->crew = crew;
    f->key = sum_of(0, key, strlen(key));
    lq_status status = LQ_OK;
    if (strlen(path) + NAME >= PATH_MAX) status = lq_fail(error, LQ_BAD_INPUT, "%.60s...: too long", path);
    if (status == LQ_OK) status = start(f, key, error);
    if (status != LQ_OK) lq_part_folder_close(f, false);
    else *folder = f;
    return status;
}

void lq_part_folder_close(lq_part_folder *f, bool whole) {
    if (!f) return;
    if (whole && f->lock >= 0) {
        char path[PATH_MAX];
        lq_claims_clear(f->path);
        clear_parts(f);
        name_in(f, "key", path); /* after the parts: they would be nobody's without it */
        unlink(path);
        name_in(f, "lock", path);
        unlink(path);
        rmdir(f->path);
    }
    if (f->lock >= 0) close(f->lock);
    free(f->path);
    free(f);
}

bool lq_part_folder_claim(const lq_part_folder *f, size_t index) {
    return lq_claim(f->path, f->crew, index);
}

void lq_part_folder_stop(const lq_part_folder *f) {
    lq_claims_stop(f->path, f->crew);
}

/* ======================================================================================
 *                                         Parts
 * ====================================================================================== */

int lq_part_folder_file(const lq_part_folder *f, size_t index, uint64_t *start, uint64_t *size) {
    char path[PATH_MAX];
    part_head head;
    struct stat info;
    name_part(f, "", index, path);
    const int file = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return -1;
    *start = sizeof head;
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) &&
        pread(file, &head, sizeof head, 0) == (ssize_t)sizeof head && head.magic == magic &&
        head.index == index && head.key == f->key && (uint64_t)info.st_size - sizeof head == head.size) {
        *size = head.size;
        return file;
    }
    close(file);
    return -1;
}

static bool is_sound(int file, uint64_t at, uint64_t size) {
    unsigned char block[BLOCK];
    part_head head;
    uint32_t sum = 0;
    if (pread(file, &head, sizeof head, 0) != (ssize_t)sizeof head) return false;
    while (size > 0) {
        const ssize_t got = pread(file, block, size < BLOCK ? (size_t)size : BLOCK, (off_t)at);
        if (got <= 0) return false;
        sum = sum_of(sum, block, (size_t)got);
        at += (uint64_t)got;
        size -= (uint64_t)got;
    }
    return sum == head.sum;
}

bool lq_part_folder_has(const lq_part_folder *f, size_t index) {
    uint64_t at, size;
    char path[PATH_MAX];
    const int file = lq_part_folder_file(f, index, &at, &size);
    const bool sound = file >= 0 && is_sound(file, at, size);
    if (file >= 0) close(file);
    name_part(f, "", index, path);
    if (!sound) unlink(path);
    return sound;
}

lq_status lq_part_folder_write(const lq_part_folder *f, size_t index, const void *bytes, size_t size,
                               lq_error *error) {
    const part_head head = {magic, index, size, f->key, sum_of(0, bytes, size)};
    char path[PATH_MAX];
    lq_output *output;
    name_part(f, "", index, path);
    lq_status status = lq_output_open(&output, path, error);
    if (status != LQ_OK) return status;
    status = lq_output_write(output, &head, sizeof head, error);
    if (status == LQ_OK) status = lq_output_write(output, bytes, size, error);
    if (status == LQ_OK) return lq_output_commit(output, error);
    lq_output_abandon(output);
    return status;
}

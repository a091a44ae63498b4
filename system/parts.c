/* parts.c - parts in memory, in a file without a name, or in a folder. */
#define _GNU_SOURCE /* O_TMPFILE */
#include "system/parts.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "system/output.h"
#include "system/parallel.h"
#include "system/part_folder.h"
#include "system/status.h"

/* Files that are kept open, of the thousand a process may have. */
enum { FILES_OPEN = 256 };

typedef struct part {
    void *bytes;   /* NULL: it is in a file */
    uint64_t size; /* 0: not known here */
    int file;      /* -1: not open; that without a name is nobody's */
    uint64_t start;
} part;

struct lq_parts {
    size_t most, in_memory; /* bytes */
    char *beside;
    int unnamed;  /* -1: not there yet */
    uint64_t end; /* of it */
    lq_part_folder *folder;
    const lq_crew *crew;
    part *part;
    size_t count, found, open;
};

lq_status lq_parts_open(lq_parts **parts, const lq_parts_place *place, lq_error *error) {
    *parts = NULL;
    lq_parts *p = calloc(1, sizeof *p);
    if (!p) return lq_fail(error, LQ_NO_MEMORY, "no memory for parts");
    p->unnamed = -1;
    p->most = place->beside ? place->most : SIZE_MAX;
    p->crew = place->folder ? place->crew : NULL;
    lq_status status = LQ_OK;
    if (place->beside && !(p->beside = strdup(place->beside)))
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for parts");
    if (status == LQ_OK && place->folder)
        status = lq_part_folder_open(&p->folder, place->folder, place->key, p->crew, error);
    if (status != LQ_OK) lq_parts_close(p, false);
    else *parts = p;
    return status;
}

void lq_parts_close(lq_parts *p, bool whole) {
    if (!p) return;
    for (size_t i = 0; i < p->count; i++) {
        free(p->part[i].bytes);
        if (p->part[i].file >= 0) close(p->part[i].file);
    }
    if (p->unnamed >= 0) close(p->unnamed);
    lq_part_folder_close(p->folder, whole);
    free(p->part);
    free(p->beside);
    free(p);
}

size_t lq_parts_found(const lq_parts *p) {
    return p->found;
}

/* ======================================================================================
 *                                        Keeping
 * ====================================================================================== */

/* A place of its own in the file without a name; -1: there is no such file. */
static lq_status take_room(lq_parts *p, part *made, lq_error *error) {
    lq_status status = LQ_OK;
#pragma omp critical(lq_parts_room)
    {
        if (p->unnamed < 0) status = lq_output_scratch(&p->unnamed, p->beside, error);
        made->start = p->end;
        if (status == LQ_OK) p->end += made->size;
    }
    return status;
}

static lq_status write_unnamed(lq_parts *p, part *made, const char *bytes, lq_error *error) {
    lq_status status = take_room(p, made, error);
    for (uint64_t done = 0; status == LQ_OK && done < made->size;) {
        const ssize_t wrote =
            pwrite(p->unnamed, bytes + done, made->size - done, (off_t)(made->start + done));
        if (wrote < 0 && errno == EINTR) continue;
        if (wrote <= 0)
            status = lq_fail(error, LQ_IO,
                             "%s: cannot keep what is finished beside it: %s; accepted is a place with room",
                             p->beside, strerror(wrote < 0 ? errno : ENOSPC));
        else done += (uint64_t)wrote;
    }
    return status;
}

/* Whether so many bytes more may be in memory. */
static bool fits(lq_parts *p, size_t size) {
    bool fit;
#pragma omp critical(lq_parts_room)
    {
        fit = size <= p->most - p->in_memory;
        if (fit) p->in_memory += size;
    }
    return fit;
}

/* Takes `bytes` over. */
static lq_status keep(lq_parts *p, size_t index, void *bytes, size_t size, lq_error *error) {
    lq_status status = LQ_OK;
    part *made = &p->part[index];
    if (!p->folder) made->size = size;
    if (!p->folder && fits(p, size)) {
        made->bytes = bytes;
        return LQ_OK;
    }
    status = p->folder ? lq_part_folder_write(p->folder, index, bytes, size, error)
                       : write_unnamed(p, made, bytes, error);
    free(bytes);
    return status;
}

/* ======================================================================================
 *                                        Making
 * ====================================================================================== */

typedef struct making {
    lq_parts *parts;
    const size_t *index;
    lq_part_make *make;
    void *user;
} making;

static lq_status make_turn(void *user, size_t turn, int thread, lq_error *error) {
    const making *m = user;
    const size_t index = m->index[turn];
    void *bytes = NULL;
    size_t size = 0;
    if (m->parts->folder && !lq_part_folder_claim(m->parts->folder, index)) return LQ_OK;
    if (m->parts->folder && lq_part_folder_has(m->parts->folder, index)) {
#pragma omp atomic
        m->parts->found++;
        return LQ_OK;
    }
    const lq_status status = m->make(m->user, index, thread, &bytes, &size, error);
    if (status == LQ_OK) return keep(m->parts, index, bytes, size, error);
    free(bytes);
    return status;
}

static bool grow(lq_parts *p, const size_t *index, size_t count) {
    size_t needed = p->count;
    for (size_t i = 0; i < count; i++) needed = index[i] < needed ? needed : index[i] + 1;
    part *longer = realloc(p->part, (needed + 1) * sizeof *longer);
    if (!longer) return false;
    p->part = longer;
    for (; p->count < needed; p->count++) longer[p->count] = (part){.file = -1};
    return true;
}

lq_status lq_parts_make(lq_parts *p, const size_t *index, size_t count, int threads, lq_part_make *make,
                        void *user, const lq_progress *progress, lq_error *error) {
    making m = {p, index, make, user};
    lq_status status = grow(p, index, count) ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for parts");
    if (status == LQ_OK) status = lq_parallel(count, threads, make_turn, &m, progress, error);
    if (!p->crew) return status;
    if (status != LQ_OK) lq_part_folder_stop(p->folder);
    return p->crew->meet(p->crew->user, status, error);
}

/* ======================================================================================
 *                                        Reading
 * ====================================================================================== */

typedef struct opened {
    int file;
    uint64_t start, size; /* of the part's bytes in it */
    bool own;             /* to be closed by who asked for it */
} opened;

static opened open_part(lq_parts *p, size_t index) {
    part *at = &p->part[index];
    opened it = {p->unnamed, at->start, at->size, false};
    if (!p->folder) return it;
#pragma omp critical(lq_parts_file)
    {
        it = (opened){at->file, at->start, at->size, false};
        if (it.file < 0) it.file = lq_part_folder_file(p->folder, index, &it.start, &it.size);
        it.own = it.file >= 0 && at->file < 0 && p->open >= FILES_OPEN;
        if (it.file >= 0 && at->file < 0 && !it.own) {
            *at = (part){.file = it.file, .start = it.start, .size = it.size};
            p->open++;
        }
    }
    return it;
}

static void leave(const opened *it) {
    if (it->own) close(it->file);
}

static lq_status read_file(int file, uint64_t at, size_t size, char *bytes, lq_error *error) {
    while (size > 0) {
        const ssize_t got = file < 0 ? -1 : pread(file, bytes, size, (off_t)at);
        if (got < 0 && file >= 0 && errno == EINTR) continue;
        if (got <= 0) return lq_fail(error, LQ_IO, "a finished part cannot be read again");
        bytes += got;
        at += (uint64_t)got;
        size -= (size_t)got;
    }
    return LQ_OK;
}

lq_status lq_parts_read(lq_parts *p, size_t index, size_t offset, size_t size, void *bytes, lq_error *error) {
    if (p->part[index].bytes) {
        memcpy(bytes, (const char *)p->part[index].bytes + offset, size);
        return LQ_OK;
    }
    const opened it = open_part(p, index);
    const lq_status status = read_file(it.file, it.start + offset, size, bytes, error);
    leave(&it);
    return status;
}

size_t lq_parts_size(lq_parts *p, size_t index) {
    if (p->part[index].bytes) return (size_t)p->part[index].size;
    const opened it = open_part(p, index);
    leave(&it);
    return it.file < 0 ? 0 : (size_t)it.size;
}

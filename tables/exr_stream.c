/* exr_stream.c - bytes of an open file at an offset. */
#include "tables/exr_stream.h"

#include <errno.h>
#include <unistd.h>

int64_t lq_exr_stream_read(exr_const_context_t context, void *user, void *bytes, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    const lq_exr_stream *stream = user;
    uint64_t done = 0;
    if (offset > stream->size) return -1; /* beyond off_t, too */
    while (done < size) {
        const ssize_t got = pread(stream->file, (char *)bytes + done, size - done, (off_t)(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return -1;
        if (got == 0) break;
        done += (uint64_t)got;
    }
    return (int64_t)done;
}

int64_t lq_exr_stream_size(exr_const_context_t context, void *user) {
    (void)context;
    return (int64_t)((const lq_exr_stream *)user)->size;
}

/* stream.c - a stream whose writes go through system/output.h. (One of open_memstream loses text without a
 * word where memory runs out.) */
#include "system/stream.h"

#include "system/number.h"
#include "system/status.h"

static ssize_t take(void *user, const char *bytes, size_t size) {
    lq_stream *stream = user;
    if (stream->status == LQ_OK) stream->status = lq_output_write(stream->output, bytes, size, stream->error);
    return stream->status == LQ_OK ? (ssize_t)size : 0;
}

lq_status lq_stream_open(lq_stream *stream, const char *path, lq_error *error) {
    *stream = (lq_stream){.status = LQ_OK, .error = error};
    const lq_status status = lq_output_open(&stream->output, path, error);
    if (status != LQ_OK) return status;
    stream->out = fopencookie(stream, "w", (cookie_io_functions_t){.write = take});
    if (stream->out) {
        stream->before = lq_locale_c();
        return LQ_OK;
    }
    lq_output_abandon(stream->output);
    return lq_fail(error, LQ_NO_MEMORY, "%s: no memory to write it", path);
}

lq_status lq_stream_close(lq_stream *stream, lq_status so_far, lq_error *error) {
    const int failed = ferror(stream->out), unflushed = fclose(stream->out);
    lq_locale_back(stream->before);
    lq_status status = so_far != LQ_OK ? so_far : stream->status;
    if (status == LQ_OK && (failed || unflushed))
        status = lq_fail(error, LQ_IO, "the text could not be written");
    if (status == LQ_OK) return lq_output_commit(stream->output, error);
    lq_output_abandon(stream->output);
    return status;
}

/* exr_stream.h - an EXR file that was opened once, as OpenEXR reads it: what is checked is what is decoded.
 */
#ifndef LACQUER_TABLES_EXR_STREAM_H
#define LACQUER_TABLES_EXR_STREAM_H

#include <openexr.h>
#include <stdint.h>

/* The first member of what OpenEXR gets as user data. */
typedef struct lq_exr_stream {
    int file;
    uint64_t size;
} lq_exr_stream;

/* For exr_context_initializer_t; any thread may call them. */
int64_t lq_exr_stream_read(exr_const_context_t context, void *user, void *bytes, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t report);
int64_t lq_exr_stream_size(exr_const_context_t context, void *user);

#endif

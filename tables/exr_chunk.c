/* exr_chunk.c - sizes of EXR chunks: packed, unpacked, and those of the file. */
#include "tables/exr_chunk.h"

enum {
    OVERHEAD = 16,        /* bytes every chunk takes in a file beside its data: offset, row, size */
    DEFLATE_LIMIT = 1032, /* the most that one byte of deflate can become */
    RLE_LIMIT = 64,       /* 128 equal bytes are two */
    OTHER_LIMIT = 16384   /* of wavelets and blocks: no bound is documented, this one is generous */
};

static double limit_of(exr_compression_t compression) {
    if (compression == EXR_COMPRESSION_NONE) return 1.0;
    if (compression == EXR_COMPRESSION_RLE) return RLE_LIMIT;
    const bool deflate = compression == EXR_COMPRESSION_ZIPS || compression == EXR_COMPRESSION_ZIP;
    return deflate ? DEFLATE_LIMIT : OTHER_LIMIT;
}

bool lq_exr_may_hold(uint64_t size, exr_compression_t compression, double rows, double row_bytes,
                     int rows_per_chunk) {
    const double full_chunks = (double)(uint64_t)(rows / rows_per_chunk);
    return (double)size >= full_chunks * OVERHEAD + rows * row_bytes / limit_of(compression);
}

exr_result_t lq_exr_check_chunk(const exr_chunk_info_t *chunk, uint64_t size, uint64_t row_bytes) {
    const bool inside = chunk->data_offset <= size && chunk->packed_size <= size - chunk->data_offset;
    const bool fits = chunk->height > 0 && chunk->unpacked_size == (uint64_t)chunk->height * row_bytes &&
                      chunk->packed_size <= chunk->unpacked_size;
    const bool exact =
        chunk->compression != EXR_COMPRESSION_NONE || chunk->packed_size == chunk->unpacked_size;
    return inside && fits && exact ? EXR_ERR_SUCCESS : EXR_ERR_BAD_CHUNK_LEADER;
}

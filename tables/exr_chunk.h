/* exr_chunk.h - what an EXR file claims to hold, against what its bytes can, before memory is asked for. */
#ifndef LACQUER_TABLES_EXR_CHUNK_H
#define LACQUER_TABLES_EXR_CHUNK_H

#include <openexr.h>
#include <stdbool.h>
#include <stdint.h>

/* Could a file of `size` bytes hold `rows` rows of `row_bytes` bytes, so many rows a chunk? */
bool lq_exr_may_hold(uint64_t size, exr_compression_t compression, double rows, double row_bytes,
                     int rows_per_chunk);

/* A chunk as its leader describes it: within the file, no larger packed than not, of the exact size where it
 * is not compressed (OpenEXRCore 3.1.5 hands out what it did not read otherwise). EXR_ERR_BAD_CHUNK_LEADER.
 */
exr_result_t lq_exr_check_chunk(const exr_chunk_info_t *chunk, uint64_t size, uint64_t row_bytes);

#endif

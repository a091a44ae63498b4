/* raw.h - the bare numbers of foreign files: .npy, EXR, C arrays. */
#ifndef LACQUER_TABLES_RAW_H
#define LACQUER_TABLES_RAW_H

#include "lacquer.h"

typedef struct lq_raw {
    float *values;
    size_t count;
} lq_raw;

/* By the ending of the name: .npy, .exr, anything else a C array. `channels` of an EXR are interleaved in
 * this order (NULL: it has one); for the others components lie as they are. Values that are no numbers in
 * float32 are kept as they come out (infinite, NaN). */
lq_status lq_raw_read(lq_raw *raw, const char *path, const char *const *channels, int channel_count,
                      lq_error *error);
void lq_raw_free(lq_raw *raw);

lq_status lq_raw_read_exr(lq_raw *raw, const char *path, const char *const *channels, int channel_count,
                          lq_error *error);

#endif

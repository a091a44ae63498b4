/* The random numbers of one walk: a counter-based stream, so that a sample never depends on another one.
 *
 * Philox 4x64-10 (Salmon et al. 2011) under the key (seed, purpose) maps the counter (sample, block) to
 * four 64-bit words. No state is carried between samples: any thread may compute any of them.
 */
#ifndef LACQUER_VALIDATE_STREAM_H
#define LACQUER_VALIDATE_STREAM_H

#include <Random123/philox.h>
#include <stdint.h>

typedef struct lq_stream {
    philox4x64_key_t key;
    philox4x64_ctr_t counter;
    philox4x64_ctr_t words;
    unsigned used;
} lq_stream;

static inline lq_stream lq_stream_open(uint64_t seed, uint64_t purpose, uint64_t sample) {
    lq_stream stream = {.key = {{seed, purpose}}, .counter = {{sample, 0, 0, 0}}, .used = 4};
    return stream;
}

static inline uint64_t lq_stream_word(lq_stream *stream) {
    if (stream->used == 4) {
        stream->words = philox4x64(stream->counter, stream->key);
        stream->counter.v[1]++;
        stream->used = 0;
    }
    return stream->words.v[stream->used++];
}

/* Uniform on the middles of 2^52 cells of (0,1): neither end can come up, so its logarithm is finite. */
static inline double lq_stream_uniform(lq_stream *stream) {
    return ((double)(lq_stream_word(stream) >> 12) + 0.5) * 0x1p-52;
}

#endif

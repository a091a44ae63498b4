/* engine_replay.c - without libFuzzer: every file of the corpora as it is, then COUNT changes of each
 * reader's.
 *
 *     lacquer-fuzz CORPUS COUNT [READER]
 *
 * The same inputs in every run. A sanitizer's report is followed by the reader and the input's number. */
#define _GNU_SOURCE /* scandir */
#include "fuzz.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/input.h"

enum { LONGEST = 1 << 14 };

static const char *current;
static size_t number;

/* A size that is believed shows as an allocation that no input of this length justifies. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) {
    return "max_allocation_size_mb=80:allocator_may_return_null=0";
}

void __sanitizer_set_death_callback(void (*call)(void)) __attribute__((weak));

static void say_where(void) {
    fprintf(stderr, "reader %s, input %zu\n", current, number);
}

/* Steele, Lea and Flood 2014, SplitMix64. */
static uint64_t draw(uint64_t *state) {
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

static size_t below(uint64_t *state, size_t limit) {
    return limit > 0 ? (size_t)(draw(state) % limit) : 0;
}

typedef struct corpus {
    size_t count;
    char *bytes[64];
    size_t size[64];
} corpus;

static size_t change(uint8_t *bytes, size_t size, const corpus *from, uint64_t *state) {
    static const uint32_t odd[] = {0,      1,          0x7f,       0xff,       0x7fff,
                                   0xffff, 0x7fffffff, 0x80000000, 0xffffffff, 0x7f800000};
    const size_t at = below(state, size), other = below(state, from->count);
    size_t length = below(state, 32);
    switch (below(state, 6)) {
    case 0: /* one bit */
        if (size > 0) bytes[at] ^= (uint8_t)(1u << below(state, 8));
        return size;
    case 1: /* a number that is often wrong */
        if (size >= 4 && at + 4 <= size) memcpy(bytes + at, &odd[below(state, sizeof odd / sizeof *odd)], 4);
        return size;
    case 2: /* cut short, or a piece taken out */
        if (below(state, 2) == 0 || at + length > size) return at;
        memmove(bytes + at, bytes + at + length, size - at - length);
        return size - length;
    case 3: /* a piece twice */
        if (at + length > size || size + length > LONGEST) return size;
        memmove(bytes + at + length, bytes + at, size - at);
        return size + length;
    case 4: /* the end of another one */
        length = from->size[other] > at ? from->size[other] - at : 0;
        if (length == 0 || at + length > LONGEST) return size;
        memcpy(bytes + at, from->bytes[other] + at, length);
        return at + length;
    default: /* a byte, printable or any */
        if (size > 0) bytes[at] = (uint8_t)(below(state, 2) ? ' ' + below(state, 95) : below(state, 256));
        return size;
    }
}

static int is_file(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static void load(corpus *to, const char *folder, const char *name) {
    char path[4096];
    struct dirent **list = NULL;
    *to = (corpus){.count = 0};
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const int count = scandir(path, &list, is_file, alphasort);
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, "%s/%s/%s", folder, name, list[i]->d_name);
        if (to->count < 64 && lq_input_read(path, &to->bytes[to->count], &to->size[to->count], NULL) == LQ_OK)
            to->count++;
        free(list[i]);
    }
    free(list);
}

/* Bytes of exactly that size, so that one beyond them is seen. */
static void give(const fuzz_reader *reader, const uint8_t *bytes, size_t size) {
    uint8_t *exact = malloc(size > 0 ? size : 1);
    if (!exact) abort();
    memcpy(exact, bytes, size);
    reader->read(exact, size);
    free(exact);
    number++;
}

static size_t run(const fuzz_reader *reader, const char *folder, size_t count) {
    static uint8_t bytes[LONGEST];
    corpus from;
    uint64_t state = 1;
    current = reader->name;
    number = 0;
    load(&from, folder, reader->name);
    for (size_t i = 0; i < from.count; i++) give(reader, (uint8_t *)from.bytes[i], from.size[i]);
    for (size_t i = 0; i < count && from.count > 0; i++) {
        const size_t one = below(&state, from.count);
        size_t size = from.size[one] < LONGEST ? from.size[one] : LONGEST;
        memcpy(bytes, from.bytes[one], size);
        for (size_t changes = 1 + below(&state, 4); changes > 0; changes--)
            size = change(bytes, size, &from, &state);
        give(reader, bytes, size);
    }
    for (size_t i = 0; i < from.count; i++) free(from.bytes[i]);
    return from.count;
}

int main(int argc, char **argv) {
    if (argc < 3) return fprintf(stderr, "usage: lacquer-fuzz CORPUS COUNT [READER]\n"), 1;
    setenv("OMP_NUM_THREADS", "1", 1);
    if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(say_where);
    int code = 0;
    for (size_t i = 0; fuzz_reader_at(i); i++) {
        const fuzz_reader *reader = fuzz_reader_at(i);
        if (argc > 3 && strcmp(argv[3], reader->name) != 0) continue;
        if (run(reader, argv[1], strtoul(argv[2], NULL, 10)) > 0) continue;
        fprintf(stderr, "no corpus of %s in %s\n", reader->name, argv[1]);
        code = 1;
    }
    return code;
}

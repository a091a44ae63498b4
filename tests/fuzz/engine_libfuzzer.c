/* engine_libfuzzer.c - libFuzzer on the reader that LACQUER_FUZZ names. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>

static const fuzz_reader *reader;

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc, (void)argv;
    setenv("OMP_NUM_THREADS", "1", 1);
    reader = fuzz_reader_find(getenv("LACQUER_FUZZ"));
    if (reader) return 0;
    fprintf(stderr, "LACQUER_FUZZ is one of:");
    for (size_t i = 0; fuzz_reader_at(i); i++) fprintf(stderr, " %s", fuzz_reader_at(i)->name);
    fprintf(stderr, "\n");
    exit(1);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    reader->read(bytes, size);
    return 0;
}

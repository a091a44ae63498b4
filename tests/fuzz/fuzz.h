/* fuzz.h - one entry a reader of the project: bytes of a stranger's in, nothing out. docs/reliability.md */
#ifndef LACQUER_TESTS_FUZZ_H
#define LACQUER_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

typedef struct fuzz_reader {
    const char *name; /* of its folder in corpus/ and its file in dict/ */
    void (*read)(const uint8_t *bytes, size_t size);
} fuzz_reader;

/* The reader called so; NULL beyond the last, or where there is none. */
const fuzz_reader *fuzz_reader_at(size_t i);
const fuzz_reader *fuzz_reader_find(const char *name);

/* A folder of this process's own, in memory where there is such a file system; it goes at exit. */
const char *fuzz_folder(void);
/* The path of a file in it, with these bytes. Valid until the next call but seven. */
const char *fuzz_file(const char *name, const uint8_t *bytes, size_t size);

/* The bytes as text, up to the first zero byte; free() it. */
char *fuzz_text(const uint8_t *bytes, size_t size);

void fuzz_table(const uint8_t *bytes, size_t size);
void fuzz_factors(const uint8_t *bytes, size_t size);
void fuzz_structure(const uint8_t *bytes, size_t size);
void fuzz_foreign_exr(const uint8_t *bytes, size_t size);
void fuzz_bin(const uint8_t *bytes, size_t size);
void fuzz_dat(const uint8_t *bytes, size_t size);
void fuzz_npy(const uint8_t *bytes, size_t size);
void fuzz_c_array(const uint8_t *bytes, size_t size);
void fuzz_axes(const uint8_t *bytes, size_t size);
void fuzz_ktx2(const uint8_t *bytes, size_t size);
void fuzz_dds(const uint8_t *bytes, size_t size);
void fuzz_manifest(const uint8_t *bytes, size_t size);
void fuzz_recipe(const uint8_t *bytes, size_t size);
void fuzz_stack(const uint8_t *bytes, size_t size);
void fuzz_budget(const uint8_t *bytes, size_t size);
void fuzz_ndf(const uint8_t *bytes, size_t size);
void fuzz_points(const uint8_t *bytes, size_t size);
void fuzz_text_arguments(const uint8_t *bytes, size_t size);
void fuzz_options(const uint8_t *bytes, size_t size);

#endif

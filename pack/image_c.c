/* image_c.c - an image as a C header. */
#include "pack/bytes.h"
#include "pack/language.h"

#include <stdio.h>

void lq_c_encode(lq_bytes *bytes, const lq_image *image, const char *name) {
    enum { PER_LINE = 8 };
    const size_t count = lq_image_texels(image) * (size_t)image->channels;
    char text[256];
    int used = snprintf(
        text, sizeof text,
        "/* %s: %zu x %zu x %zu texels, %zu layers, %d channels; channels fastest, then x, y, z. */\n"
        "static const float %s[%zu] = {\n",
        name, image->width, image->height, image->depth, image->layers, image->channels, name, count);
    lq_bytes_add(bytes, text, (size_t)used);
    for (size_t i = 0; i < count; i++) {
        const bool ends = i % PER_LINE == PER_LINE - 1 || i == count - 1;
        char number[LQ_LITERAL_SIZE];
        used = snprintf(text, sizeof text, "%s%s,%s", i % PER_LINE == 0 ? "    " : " ",
                        lq_literal((double)image->data[i], LQ_C, number), ends ? "\n" : "");
        lq_bytes_add(bytes, text, (size_t)used);
    }
    lq_bytes_add(bytes, "};\n", 3);
}

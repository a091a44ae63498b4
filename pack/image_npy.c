/* image_npy.c - an image as a NumPy array. */
#include "pack/bytes.h"

#include <stdio.h>
#include <string.h>

void lq_npy_encode(lq_bytes *bytes, const lq_image *image) {
    enum { PREAMBLE = 10, HEADER = 128 };
    const size_t sizes[5] = {image->layers, image->depth, image->height, image->width,
                             (size_t)image->channels};
    char header[HEADER - PREAMBLE + 1];
    int used = snprintf(header, sizeof header, "{'descr': '<f%d', 'fortran_order': False, 'shape': (",
                        image->single ? 4 : 2);
    for (int i = 0; i < 5; i++)
        if (sizes[i] > 1 || i == 3)
            used += snprintf(header + used, sizeof header - (size_t)used, "%zu, ", sizes[i]);
    used += snprintf(header + used, sizeof header - (size_t)used, "), }");
    memset(header + used, ' ', sizeof header - 2 - (size_t)used);
    header[HEADER - PREAMBLE - 1] = '\n';
    lq_bytes_add(bytes, "\x93NUMPY\x01\x00", 8);
    lq_bytes_u16(bytes, HEADER - PREAMBLE);
    lq_bytes_add(bytes, header, HEADER - PREAMBLE);
    lq_bytes_texels(bytes, image);
}

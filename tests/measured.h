/* A measured NDF for tests. */
#ifndef LACQUER_TESTS_MEASURED_H
#define LACQUER_TESTS_MEASURED_H

#include "tests/expect.h"

#include <stdio.h>

/* Beckmann's shape at one roughness, as somebody would measure it, into a file that is closed then. */
static inline void write_measured(FILE *out) {
    assert_non_null(out);
    fputs("theta_deg,alpha=0.3\n", out);
    for (int i = 0; i < 180; i++) {
        const double theta = 0.5 * i * 3.14159265358979323846 / 180.0, t = tan(theta), c = cos(theta);
        fprintf(out, "%.17g,%.17g\n", 0.5 * i, exp(-t * t / 0.09) / (c * c * c * c));
    }
    assert_int_equal(fclose(out), 0);
}

#endif

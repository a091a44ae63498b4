/* cmocka with its prerequisites, and comparisons of doubles that print the figures. (cmocka's own
 * assert_float_equal rounds to float first.) */
#ifndef LACQUER_TESTS_EXPECT_H
#define LACQUER_TESTS_EXPECT_H

/* cmocka.h wants these before it */
/* clang-format off */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
/* clang-format on */

/* |got - want| <= tolerance; a NaN fails. */
#define assert_near(got, want, tolerance) assert_near_at(got, want, tolerance, __FILE__, __LINE__)

static inline void assert_near_at(double got, double want, double tolerance, const char *file, int line) {
    if (fabs(got - want) <= tolerance) return;
    print_error("got %.17g, want %.17g: off by %.3g, allowed %.3g\n", got, want, fabs(got - want), tolerance);
    _fail(file, line);
}

#endif

/* number.c - the C locale, for one thread at a time: setlocale is the host program's. */
#define _GNU_SOURCE /* newlocale, uselocale */
#include "system/number.h"

#include <stdio.h>
#include <stdlib.h>

/* The C locale takes no memory and needs not be freed. */
locale_t lq_locale_c(void) {
    return uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0));
}

void lq_locale_back(locale_t before) {
    uselocale(before);
}

double lq_strtod(const char *text, char **end) {
    const locale_t before = lq_locale_c();
    const double value = strtod(text, end);
    lq_locale_back(before);
    return value;
}

float lq_strtof(const char *text, char **end) {
    const locale_t before = lq_locale_c();
    const float value = strtof(text, end);
    lq_locale_back(before);
    return value;
}

int lq_vprint(char *text, size_t size, const char *format, va_list arguments) {
    const locale_t before = lq_locale_c();
    const int length = vsnprintf(text, size, format, arguments);
    lq_locale_back(before);
    return length;
}

int lq_print(char *text, size_t size, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = lq_vprint(text, size, format, arguments);
    va_end(arguments);
    return length;
}

/* number.h - numbers as text with a point, whatever locale a host program has set. */
#ifndef LACQUER_SYSTEM_NUMBER_H
#define LACQUER_SYSTEM_NUMBER_H

#include <locale.h>
#include <stdarg.h>
#include <stddef.h>

/* strtod, strtof, snprintf and vsnprintf of the C locale. */
double lq_strtod(const char *text, char **end);
float lq_strtof(const char *text, char **end);
int lq_print(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
int lq_vprint(char *text, size_t size, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

/* What this thread prints and reads from here on is of the C locale; give the result to lq_locale_back in the
 * same function. */
locale_t lq_locale_c(void);
void lq_locale_back(locale_t before);

#endif

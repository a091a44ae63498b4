/* date.c - the day that a page tells. */
#include "program/date.h"

#include <errno.h>
#include <stdlib.h>
#include <time.h>

void cli_date(char text[CLI_DATE_SIZE]) {
    const char *given = getenv("SOURCE_DATE_EPOCH");
    char *end = NULL;
    struct tm day;
    errno = 0;
    time_t when = given && *given ? (time_t)strtoll(given, &end, 10) : time(NULL);
    if (given && *given && (*end || errno != 0 || when < 0)) when = time(NULL);
    if (!gmtime_r(&when, &day) || strftime(text, CLI_DATE_SIZE, "%Y-%m-%d", &day) == 0) text[0] = '\0';
}

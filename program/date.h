/* date.h - the day that a page tells. */
#ifndef LACQUER_PROGRAM_DATE_H
#define LACQUER_PROGRAM_DATE_H

enum { CLI_DATE_SIZE = 16 };

/* "2026-11-26", in UTC: of SOURCE_DATE_EPOCH where that is set (reproducible-builds.org), so that a page can
 * be made again with the same bytes, otherwise today. */
void cli_date(char text[CLI_DATE_SIZE]);

#endif

/* part_folder.h - parts as files of a folder, with what decides their bytes. */
#ifndef LACQUER_SYSTEM_PART_FOLDER_H
#define LACQUER_SYSTEM_PART_FOLDER_H

#include <stdint.h>

#include "system/parts.h"

typedef struct lq_part_folder lq_part_folder;

/* See lq_parts_open. It is locked by the crew's first process until it is closed. */
lq_status lq_part_folder_open(lq_part_folder **folder, const char *path, const char *key, const lq_crew *crew,
                              lq_error *error);

/* With a crew: may this process make the part? Each number is given away once, and none after
 * lq_part_folder_stop. */
bool lq_part_folder_claim(const lq_part_folder *folder, size_t index);
void lq_part_folder_stop(const lq_part_folder *folder);

/* Whether the part is there and whole; one that is damaged is removed. */
bool lq_part_folder_has(const lq_part_folder *folder, size_t index);

/* Open a part for reading: its bytes start at *start of the file. -1: it is not there. */
int lq_part_folder_file(const lq_part_folder *folder, size_t index, uint64_t *start, uint64_t *size);

lq_status lq_part_folder_write(const lq_part_folder *folder, size_t index, const void *bytes, size_t size,
                               lq_error *error);

/* `whole`: all of it is removed, by the crew's first process. NULL is fine. */
void lq_part_folder_close(lq_part_folder *folder, bool whole);

#endif

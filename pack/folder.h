/* folder.h - a folder that appears whole or not at all. */
#ifndef LACQUER_PACK_FOLDER_H
#define LACQUER_PACK_FOLDER_H

#include "lacquer.h"

#include <limits.h>

/* Files go to `staging`, beside the target, until lq_folder_commit. */
typedef struct lq_folder {
    char target[PATH_MAX - 64], staging[PATH_MAX];
} lq_folder;

/* The name of every pack's manifest; a folder with one may be replaced, other folders must be empty or
 * absent. */
#define LQ_MANIFEST "manifest.json"

lq_status lq_folder_open(lq_folder *folder, const char *target, lq_error *error);
/* The target is the new folder, and the older one is gone. */
lq_status lq_folder_commit(lq_folder *folder, lq_error *error);
/* As if it had never been opened; after a commit: nothing. */
void lq_folder_abandon(lq_folder *folder);

#endif

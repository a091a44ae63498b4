/* folder.h - a folder that appears whole or not at all, and replaces nothing but a pack. */
#ifndef LACQUER_PACK_FOLDER_H
#define LACQUER_PACK_FOLDER_H

#include "lacquer.h"
#include "pack/contents.h"

#include <limits.h>

/* Files go to `staging`, beside the target, until lq_folder_commit. */
typedef struct lq_folder {
    char name[PATH_MAX - 64];   /* as it was asked for: messages */
    char target[PATH_MAX - 64]; /* the real folder: links are followed once, when it is opened */
    char staging[PATH_MAX];
    int lock; /* held on the staging folder: who can take it knows that its maker is dead */
} lq_folder;

/* Whether `target` may become a pack: it is new, empty, or a pack of this program with nothing added and
 * nothing changed, and not the current folder. Leaves nothing behind; for before the work. */
lq_status lq_folder_check(const char *target, lq_error *error);

lq_status lq_folder_open(lq_folder *folder, const char *target, lq_error *error);
/* The target is the new folder, and the older pack is gone. The target is checked once more. */
lq_status lq_folder_commit(lq_folder *folder, lq_error *error);
/* As if it had never been opened; after a commit: nothing. */
void lq_folder_abandon(lq_folder *folder);

#endif

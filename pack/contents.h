/* contents.h - the files that make up a pack, as its manifest lists them: what may be replaced, and removed.
 */
#ifndef LACQUER_PACK_CONTENTS_H
#define LACQUER_PACK_CONTENTS_H

#include "lacquer.h"
#include "system/json.h"

/* The name of every pack's manifest, and what says that it is one: "format", and "version" as far as this
 * program knows. */
#define LQ_MANIFEST    "manifest.json"
#define LQ_PACK_FORMAT "lacquer-pack"
/* And of the page that packs with materials have. */
#define LQ_PACK_PAGE "index.html"
enum { LQ_PACK_VERSION = 1, LQ_PACK_FILE_NAME = 256 };

typedef struct lq_pack_file {
    char name[LQ_PACK_FILE_NAME];
    char crc32[9]; /* hexadecimal */
} lq_pack_file;

typedef struct lq_contents {
    size_t count;
    lq_pack_file *files; /* without the manifest */
} lq_contents;

/* The CRC-32 of a file of `folder` as a manifest has it, 8 hexadecimal digits and a zero; false: it cannot be
 * read. */
bool lq_contents_checksum(const char *folder, const char *name, char *text);

/* "files" of a manifest: every regular file of `folder`, by name, with its checksum; NULL: out of memory, or
 * a file cannot be read. */
json_t *lq_contents_list(const char *folder);

/* The list of the pack in `folder`. LQ_FORMAT where there is no manifest of this program. */
lq_status lq_contents_read(lq_contents *contents, const char *folder, lq_error *error);

/* Whether `folder`, `shown` in messages, holds these files as they were made and nothing else; LQ_IO names
 * the first that is not. */
lq_status lq_contents_check(const lq_contents *contents, const char *folder, const char *shown,
                            lq_error *error);

/* Remove the files listed, then the manifest and, where nothing else is in it, the folder: then true. */
bool lq_contents_remove(const lq_contents *contents, const char *folder);

void lq_contents_free(lq_contents *contents);

#endif

/* NDFs that come from outside: sampled in a file, or compiled into a plugin. */
#ifndef LACQUER_MICROFACET_NDF_FILE_H
#define LACQUER_MICROFACET_NDF_FILE_H

#include "microfacet/ndf.h"

/* `text` is PATH or PATH#HASH, 16 hexadecimal digits: then a file of another content is refused. */
lq_status lq_ndf_file_open(const lq_ndf **ndf, const char *text, lq_error *error);
lq_status lq_ndf_plugin_open(const lq_ndf **ndf, const char *text, lq_error *error);

/* More is no table of samples and no plugin: it is refused before it is read. */
enum { LQ_NDF_FILE_LARGEST = 1 << 28 };

/* PATH and HASH apart, the content checked against it; `id` becomes "family:PATH#HASH". The content is read
 * once: what was hashed is what is used, whatever happens to the file meanwhile. Free it. */
typedef struct lq_ndf_path {
    char *path, *id;
    char *bytes; /* a zero byte behind them */
    size_t size;
} lq_ndf_path;

lq_status lq_ndf_path_make(lq_ndf_path *path, const char *family, const char *text, lq_error *error);
void lq_ndf_path_free(lq_ndf_path *path);

#endif

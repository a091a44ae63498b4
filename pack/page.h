/* page.h - index.html of a pack with materials: what it is, how good, and spheres to look at. */
#ifndef LACQUER_PACK_PAGE_H
#define LACQUER_PACK_PAGE_H

#include "pack/manifest.h"

/* One file that needs no network: it holds the decode source and the atlas, and a finer reference of float
 * texels (lq_packed_material.reference). */
lq_status lq_pack_page_write(const lq_packing *packing, const char *path, lq_error *error);

#endif

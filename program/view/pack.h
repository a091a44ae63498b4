/* pack.h - what the files that show packs share. */
#ifndef LACQUER_PROGRAM_VIEW_PACK_H
#define LACQUER_PROGRAM_VIEW_PACK_H

#include "pack/measure.h"
#include "pack/read.h"
#include "program/view/view.h"

/* Its lobes over the cosine, on top of each other; ranges at their middle. `note` ends the caption. */
lq_status view_add_material(lq_figure *figure, const lq_shipped_material *shipped, const char *note,
                            lq_error *error);

#endif

/* model_source.h - the tables of a pack as a model of layered materials looks them up, by the same texels and
 * filters as a shader. */
#ifndef LACQUER_PACK_MODEL_SOURCE_H
#define LACQUER_PACK_MODEL_SOURCE_H

#include "pack/read.h"
#include "stack/model_tables.h"

/* The pack must outlive it. A kind that no table of the pack has, or none at that point, is LQ_BAD_INPUT by
 * name; only light nearer to the horizon than a table goes is that of its first texel. */
lq_model_source lq_pack_source(const lq_pack *pack);

#endif

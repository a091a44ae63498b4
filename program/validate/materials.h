/* materials.h - the materials of a scene's pack against the exact stack. */
#ifndef LACQUER_PROGRAM_VALIDATE_MATERIALS_H
#define LACQUER_PROGRAM_VALIDATE_MATERIALS_H

#include "pack/read.h"
#include "program/validate/certify.h"

/* A line each, unless the request is for JSON; `exceeded` where one misses the budget of the pack, or of the
 * request. */
lq_status validate_materials(const certify_request *request, const lq_pack *pack, bool *exceeded,
                             lq_error *error);

#endif

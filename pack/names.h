/* names.h - the names that the tables of a recipe give to files and functions. */
#ifndef LACQUER_PACK_NAMES_H
#define LACQUER_PACK_NAMES_H

#include "pack/recipe.h"

/* `name` as part of an identifier (LQ_NAME_SIZE bytes): what is neither letter nor digit becomes '_'. */
void lq_make_identifier(char *identifier, const char *name);

/* Whether every name makes files and identifiers of its own in every language: none is that of a helper
 * function, of the decode source or the manifest, or of another table, and none is reserved by GLSL. On
 * LQ_BAD_INPUT `culprit` is the index of the table to be named otherwise. */
lq_status lq_names_check(const lq_recipe *recipe, size_t *culprit, lq_error *error);

#endif

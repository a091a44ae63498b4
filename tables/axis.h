/* axis.h - what the rooms share about axes beyond lacquer.h. */
#ifndef LACQUER_TABLES_AXIS_H
#define LACQUER_TABLES_AXIS_H

#include "lacquer.h"

/* The largest number of nodes on one axis. */
enum { LQ_MAX_AXIS_SIZE = 1 << 20 };

/* Names of axes, channels and facts: 1 to LQ_NAME_SIZE-1 letters, digits, '_', '-' and '.', so that they
 * survive command lines, CSV headers, JSON and EXR attributes unquoted. `what` says which in the message. */
lq_status lq_name_check(const char *what, const char *name, lq_error *error);

/* lq_axis_parse of at most `most` nodes; more are refused before there is memory for them. */
lq_status lq_axis_parse_within(lq_axis *axis, const char *name, const char *text, size_t most,
                               lq_error *error);

/* The map called `name` in a file ("linear", "sqrt", "power", "custom"); false where there is none. */
bool lq_map_find(const char *name, lq_map *map);

#endif

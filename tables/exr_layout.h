/* exr_layout.h - what the writer and the reader of EXR tables agree on: attributes, JSON, checksum. */
#ifndef LACQUER_TABLES_EXR_LAYOUT_H
#define LACQUER_TABLES_EXR_LAYOUT_H

#include "system/json.h"
#include <stdint.h>

#include "lacquer.h"

/* All are string attributes. A fact K is the attribute LQ_EXR_FACT K. */
#define LQ_EXR_FORMAT   "lacquer:format"   /* version of this layout */
#define LQ_EXR_AXES     "lacquer:axes"     /* JSON: [{name, size, min, max, map, exponent, nodes}, ...] */
#define LQ_EXR_CHANNELS "lacquer:channels" /* JSON: channel names in table order (EXR sorts them) */
#define LQ_EXR_FACTS    "lacquer:facts"    /* JSON: fact keys in the order they were set */
#define LQ_EXR_CHECKSUM "lacquer:crc32"    /* of everything above and the data, 8 hexadecimal digits */
#define LQ_EXR_FACT     "lacquer:fact-"

#define LQ_EXR_FORMAT_VERSION "1"

/* Room for LQ_EXR_FACT, a key, and the end of the string. */
enum { LQ_EXR_FACT_SIZE = sizeof LQ_EXR_FACT + LQ_NAME_SIZE };

/* Tables of fewer entries take less time on one core than it takes to wake the others where they are busy. */
enum { LQ_EXR_PARALLEL = 1 << 16 };

/* The JSON texts, allocated; NULL where memory ran out. Doubles keep every bit. */
char *lq_exr_axes_text(const lq_table *table);
char *lq_exr_channels_text(const lq_table *table);
char *lq_exr_facts_text(const lq_table *table);

/* One axis, and back; the message names no file. `most`: of the nodes that what it belongs to can hold; more
 * are refused before there is memory for them. */
json_t *lq_axis_to_json(const lq_axis *axis);
lq_status lq_axis_from_json(json_t *json, size_t most, lq_axis *axis, lq_error *error);

/* The axes a JSON text describes, of a table of at most `most` entries; frees what it made when it fails. The
 * message names no file. */
lq_status lq_exr_parse_axes(const char *text, size_t most, lq_axis *axes, int *count, lq_error *error);

/* An array of strings, up to `limit` of them. Free with lq_exr_free_names. */
lq_status lq_exr_parse_names(const char *text, size_t limit, char ***names, size_t *count, lq_error *error);
void lq_exr_free_names(char **names, size_t count);

/* The checksum of a table from the CRC-32 of the data of each channel, and of one that is held; the same for
 * any number of threads. */
lq_status lq_exr_checksum_join(const lq_table *shape, const uint32_t *of_channels, uint32_t *sum,
                               lq_error *error);
lq_status lq_exr_checksum(const lq_table *table, uint32_t *sum, lq_error *error);

#endif

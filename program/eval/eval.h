/* eval.h - the parts of `lacquer eval`: where values come from, one point, a stream of points. */
#ifndef LACQUER_PROGRAM_EVAL_EVAL_H
#define LACQUER_PROGRAM_EVAL_EVAL_H

#include "lacquer.h"

#include <stdio.h>

/* ======================================================================================
 *                                Where values come from
 * ====================================================================================== */

typedef struct eval_axis {
    const char *name;
    double lowest, highest; /* accepted, inclusive */
} eval_axis;

enum { EVAL_CHANNELS = LQ_PACK_VALUES };

/* A table kind, computed exactly; or a stored table, interpolated; or factors, or a function of a pack, as a
 * GPU filters them. */
typedef struct eval_source {
    const lq_kind *kind; /* NULL for a file */
    lq_settings settings;
    lq_table *table; /* owned; one of these four */
    lq_factored *factored;
    lq_pack *pack;
    size_t function; /* of the pack */
    const char *path;
    int axis_count;
    eval_axis axes[LQ_MAX_AXES];
    int channel_count;
    const char *channels[EVAL_CHANNELS];
} eval_source;

typedef struct eval_point {
    double at[LQ_MAX_AXES];
    bool given[LQ_MAX_AXES];
} eval_point;

typedef struct eval_result {
    lq_status status;
    double values[EVAL_CHANNELS];
    double estimate; /* of the error; a stored table has none */
    lq_error error;
} eval_result;

/* `settings` with their NDF opened, where it is not the default. */
void eval_source_kind(eval_source *source, const lq_kind *kind, const lq_settings *settings);
lq_status eval_source_file(eval_source *source, const char *path, lq_error *error);
/* The function `name` of the pack in a folder: a table's, or a material's. */
lq_status eval_source_pack(eval_source *source, const char *folder, const char *name, lq_error *error);
void eval_source_free(eval_source *source);

/* The axis called `name`, or -1 and a message that lists those there are. */
int eval_find_axis(const eval_source *source, const char *name, lq_error *error);
/* Read one coordinate. Errors: not a number, out of the accepted range, given before. */
bool eval_coordinate(const eval_source *source, eval_point *point, int axis, const char *text,
                     lq_error *error);
/* A point with nothing given; an axis of one value need not be. */
eval_point eval_start(const eval_source *source);
/* Whether every axis was given; if not, the message names the missing ones. */
bool eval_complete(const eval_source *source, const eval_point *point, lq_error *error);

void eval_compute(const eval_source *source, const lq_settings *settings, const eval_point *point,
                  eval_result *result);

/* ======================================================================================
 *                                       Printing
 * ====================================================================================== */

enum { EVAL_NUMBER_SIZE = 40 };

/* As many digits as the error estimate supports, at least 9; the estimate itself is rounded up. */
void eval_format_value(char *text, double value, double estimate);
void eval_format_estimate(char *text, double estimate);

void eval_print_text(const eval_source *source, const eval_result *result);
void eval_print_csv_header(const eval_source *source);
/* The columns after the coordinates: values and error. */
void eval_print_csv_result(const eval_source *source, const eval_result *result);
int eval_print_json(const eval_source *source, const eval_point *point, const eval_result *result);

/* ======================================================================================
 *                                      CSV on stdin
 * ====================================================================================== */

/* Read points, write points with their values; the exit code of the verb. */
int eval_csv(const eval_source *source, FILE *in);

#endif

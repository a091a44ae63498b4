/* view.h - what the files of `lacquer view` share. */
#ifndef LACQUER_PROGRAM_VIEW_VIEW_H
#define LACQUER_PROGRAM_VIEW_VIEW_H

#include "picture/page.h"
#include "program/verb.h"

typedef struct view_range {
    bool given;
    double ends[2];
} view_range;

typedef struct view_request {
    const char *input, *output;
    const char *x, *y, *channel; /* NULL: not given */
    cli_texts at;
    view_range range;
    const char *axes, *kind;
    int layout; /* -1: none */
    bool trusted;
    double tolerance;
    size_t threads;
} view_request;

/* A slice of a table as the request asks for it; it points into `at`. False: a line was printed. */
bool view_slice(const view_request *request, const lq_table *table, lq_slice *slice, double *at);

/* What is shown of each kind of thing. The figure is freed by the caller, whatever comes back. */
lq_status view_table(const lq_table *table, const lq_slice *slice, const char *name, lq_figure **figure,
                     lq_error *error);
lq_status view_factors(const lq_factored *factored, const char *name, lq_figure **figure, lq_error *error);
/* `factors`: the planes and lines of its functions too. */
lq_status view_pack(const char *folder, bool factors, lq_figure **figure, lq_error *error);
lq_status view_stack(const view_request *request, const lq_stack *stack, lq_figure **figure, lq_error *error);

/* An empty figure that tells these facts; its title is the kind they name, or else `name`. */
lq_status view_begin(const lq_fact *facts, size_t count, const char *name, const char *subtitle,
                     lq_figure **figure, lq_error *error);

/* The planes and lines of a factored table as further panels, their titles after `name`. */
lq_status view_add_factors(lq_figure *figure, const lq_factored *factored, const char *name, lq_error *error);

#endif

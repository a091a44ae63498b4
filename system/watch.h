/* watch.h - telling whoever watches a call of several steps. */
#ifndef LACQUER_SYSTEM_WATCH_H
#define LACQUER_SYSTEM_WATCH_H

#include "lacquer.h"

/* A step at work: what to hand to a call that reports progress. */
typedef struct lq_step {
    const lq_watch *watch;
    lq_progress progress;
} lq_step;

/* The members of `given` that its header knew, the others NULL; `given` NULL: nobody watches. */
lq_status lq_watch_read(lq_watch *watch, const lq_watch *given, lq_error *error);

/* `step` stays in place from begin to end. */
void lq_step_begin(lq_step *step, const lq_watch *watch, const char *name);
void lq_step_end(const lq_step *step);

/* LQ_CANCELLED where the watcher wants no more. */
lq_status lq_watch_go_on(const lq_watch *watch);
void lq_watch_note(const lq_watch *watch, const char *line);
void lq_watch_hold(const lq_watch *watch, bool held);

#endif

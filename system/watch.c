/* watch.c - calls that a watcher may have left out. */
#include "system/watch.h"

#include "system/extend.h"

#include <stddef.h>

lq_status lq_watch_read(lq_watch *watch, const lq_watch *given, lq_error *error) {
    const size_t first = offsetof(lq_watch, user) + sizeof given->user;
    *watch = (lq_watch){.struct_size = sizeof *watch};
    return given ? lq_extend(watch, sizeof *watch, given, first, "a watch", error) : LQ_OK;
}

static bool report(void *user, double fraction) {
    const lq_step *step = user;
    return !step->watch->report || step->watch->report(step->watch->user, fraction);
}

void lq_step_begin(lq_step *step, const lq_watch *watch, const char *name) {
    *step = (lq_step){watch, {report, step}};
    if (watch->begin) watch->begin(watch->user, name);
}

void lq_step_end(const lq_step *step) {
    if (step->watch->end) step->watch->end(step->watch->user);
}

lq_status lq_watch_go_on(const lq_watch *watch) {
    return !watch->go_on || watch->go_on(watch->user) ? LQ_OK : LQ_CANCELLED;
}

void lq_watch_note(const lq_watch *watch, const char *line) {
    if (watch->note) watch->note(watch->user, line);
}

void lq_watch_hold(const lq_watch *watch, bool held) {
    if (watch->hold) watch->hold(watch->user, held);
}

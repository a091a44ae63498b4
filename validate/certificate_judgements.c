/* The list of judgements of a certificate, which every check adds to. */
#include "validate/certificate_checks.h"

#include "system/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static bool make_room(lq_certified *certified) {
    const int room = certified->check_room > 0 ? 2 * certified->check_room : 32;
    lq_check *checks = realloc(certified->checks, (size_t)room * sizeof *checks);
    if (!checks) return false;
    certified->checks = checks;
    certified->check_room = room;
    return true;
}

void lq_check_add(lq_certified *certified, const char *name, double value, double limit, const char *format,
                  ...) {
    if (certified->check_count == certified->check_room && !make_room(certified)) {
        certified->check_lost = true;
        return;
    }
    lq_check *check = &certified->checks[certified->check_count++];
    *check = (lq_check){.value = value, .limit = limit};
    check->outcome = isnan(limit) ? LQ_NOTED : value <= limit ? LQ_PASSED : LQ_FAILED;
    snprintf(check->name, sizeof check->name, "%s", name);
    if (!format) return;
    va_list list;
    va_start(list, format);
    lq_vprint(check->detail, sizeof check->detail, format, list);
    va_end(list);
}

void lq_point_text(const lq_kind *kind, const double *point, char *text, size_t size) {
    size_t used = 0;
    if (size > 0) text[0] = '\0';
    for (int a = 0; a < kind->axis_count && used < size; a++)
        used += (size_t)lq_print(text + used, size - used, "%s%s=%.5g", a ? " " : "", kind->axes[a].name,
                                 point[a]);
}

const lq_check lq_check_lost = {
    .name = "judgements lost", .outcome = LQ_FAILED, .detail = "there was no memory to keep one"};

const lq_check *lq_certified_failure(const lq_certified *certified) {
    for (int i = 0; i < certified->check_count; i++)
        if (certified->checks[i].outcome == LQ_FAILED) return &certified->checks[i];
    return certified->check_lost ? &lq_check_lost : NULL;
}

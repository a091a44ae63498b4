/* Break points kept sorted in place: there are few, and they are inserted once a direction. */
#include "microfacet/panels.h"

#include <math.h>
#include <string.h>

/* Closer than this, two break points are one: the panel between them would hold nothing. */
static const double closest = 1e-13;

void lq_panels_start(lq_panels *panels, double from, double to) {
    panels->count = 2;
    panels->at[0] = from;
    panels->at[1] = to;
    panels->singular[0] = panels->singular[1] = false;
}

void lq_panels_add(lq_panels *panels, double at, bool singular) {
    const int last = panels->count - 1;
    if (!(at >= panels->at[0] - closest && at <= panels->at[last] + closest)) return;
    int i = 0;
    while (i < last && at > panels->at[i] + closest) i++;
    if (fabs(at - panels->at[i]) <= closest) {
        panels->singular[i] |= singular;
        return;
    }
    if (panels->count == LQ_PANELS_MAX) return;
    const size_t tail = (size_t)(panels->count - i);
    memmove(panels->at + i + 1, panels->at + i, tail * sizeof panels->at[0]);
    memmove(panels->singular + i + 1, panels->singular + i, tail * sizeof panels->singular[0]);
    panels->at[i] = at;
    panels->singular[i] = singular;
    panels->count++;
}

void lq_panels_grade(lq_panels *panels, double centre, double width, double ratio, bool singular) {
    const double from = panels->at[0], to = panels->at[panels->count - 1];
    if (singular) lq_panels_add(panels, centre, true);
    for (double w = width; centre - w > from || centre + w < to; w *= ratio) {
        lq_panels_add(panels, centre - w, false);
        lq_panels_add(panels, centre + w, false);
    }
}

double lq_map_ends(double from, double to, bool singular_from, bool singular_to, double u, double *slope) {
    const double width = to - from;
    if (singular_from && singular_to) {
        *slope = 6.0 * width * u * (1.0 - u);
        return from + width * u * u * (3.0 - 2.0 * u);
    }
    if (singular_from) {
        *slope = 2.0 * width * u;
        return from + width * u * u;
    }
    if (singular_to) {
        *slope = 2.0 * width * (1.0 - u);
        return to - width * (1.0 - u) * (1.0 - u);
    }
    *slope = width;
    return from + width * u;
}

double lq_panels_map(const lq_panels *panels, int p, double u, double *slope) {
    return lq_map_ends(panels->at[p], panels->at[p + 1], panels->singular[p], panels->singular[p + 1], u,
                       slope);
}

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

static bool crowded(const lq_panels *panels, double at, double room) {
    for (int i = 0; i < panels->count; i++)
        if (panels->singular[i] && fabs(panels->at[i] - at) < room) return true;
    return false;
}

void lq_panels_grade(lq_panels *panels, double centre, double width, double ratio) {
    const double from = panels->at[0], to = panels->at[panels->count - 1];
    for (double w = width; centre - w > from || centre + w < to; w *= ratio) {
        if (!crowded(panels, centre - w, 0.03 * w)) lq_panels_add(panels, centre - w, false);
        if (!crowded(panels, centre + w, 0.03 * w)) lq_panels_add(panels, centre + w, false);
    }
}

/* Distance of panel p to the nearest singular break point that is not one of its ends. */
static double nearest_foreign(const lq_panels *panels, int p) {
    double nearest = INFINITY;
    for (int i = 0; i < panels->count; i++) {
        if (!panels->singular[i] || i == p || i == p + 1) continue;
        nearest = fmin(nearest, i < p ? panels->at[p] - panels->at[i] : panels->at[i] - panels->at[p + 1]);
    }
    return nearest;
}

void lq_panels_separate(lq_panels *panels) {
    for (int p = 0; p + 1 < panels->count;) {
        const double width = panels->at[p + 1] - panels->at[p];
        const int before = panels->count;
        if (width > 1e-9 && nearest_foreign(panels, p) < 0.2 * width)
            lq_panels_add(panels, panels->at[p] + 0.5 * width, false);
        if (panels->count == before) p++;
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

/* plot_labels.c - texts beside points, each where it meets nothing that is there already. */
#include "picture/plot_parts.h"

#include <math.h>

#include "picture/draw.h"

enum { TAKEN = 2048, LINE = 14 };

/* What is on the chart: first what a text may not touch, then curves, which it should not. */
typedef struct crowd {
    size_t solid, count;
    lq_box boxes[TAKEN];
} crowd;

static void take(crowd *c, lq_box box) {
    if (c->count < TAKEN) c->boxes[c->count++] = box;
}

static bool meets(const lq_box *a, const lq_box *b) {
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

/* 2: free; 1: over a curve; 0: taken, or outside the chart. */
static int room_for(const crowd *c, const lq_box *box) {
    int room = 2;
    if (box->x < LQ_PLOT_LEFT + 2 || box->x + box->width > LQ_PLOT_WIDTH - 2 || box->y < LQ_PLOT_TOP - 4 ||
        box->y + box->height > LQ_PLOT_HEIGHT - LQ_PLOT_BOTTOM)
        return 0;
    for (size_t i = 0; i < c->count && room > 0; i++)
        if (meets(&c->boxes[i], box)) room = i < c->solid ? 0 : 1;
    return room;
}

static void take_marks(crowd *c, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y) {
    for (size_t k = 0; k < plot->series_count; k++)
        for (size_t i = 0; i < plot->series[k].count; i++) {
            const lq_plot_line *s = &plot->series[k];
            if (!lq_plot_has(plot, s, i) || !lq_plot_marked(s, i) || s->scatter) continue;
            take(c, (lq_box){lq_plot_at(x, s->x[i]) - 5, lq_plot_at(y, s->y[i]) - 5, 10, 10});
        }
}

/* The span's text and the rule's, which come first. */
static void take_notes(crowd *c, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y) {
    if (plot->span) {
        const double middle = 0.5 * (lq_plot_at(x, plot->span->x_from) + lq_plot_at(x, plot->span->x_to));
        const double width = 1.1 * lq_plot_text_width(plot->span->label);
        take(c, (lq_box){middle - 0.5 * width, lq_plot_at(y, plot->span->y) - 22, width, 28});
    }
    if (plot->rule) {
        const double width = lq_plot_text_width(plot->rule->label) + 8;
        take(c,
             (lq_box){LQ_PLOT_WIDTH - LQ_PLOT_RIGHT - width, lq_plot_at(y, plot->rule->y) - 18, width, 20});
    }
}

static void take_segment(crowd *c, double x0, double y0, double x1, double y1) {
    const int steps = (int)fmin(ceil(hypot(x1 - x0, y1 - y0) / 6.0), 200.0);
    for (int i = 0; i < steps; i++) {
        const double t = (i + 0.5) / steps;
        take(c, (lq_box){x0 + t * (x1 - x0) - 2, y0 + t * (y1 - y0) - 2, 4, 4});
    }
}

static void take_curves(crowd *c, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y) {
    for (size_t k = 0; k < plot->series_count; k++) {
        const lq_plot_line *s = &plot->series[k];
        double px = NAN, py = NAN;
        for (size_t i = 0; !s->scatter && i < s->count; i++) {
            if (!lq_plot_has(plot, s, i)) continue;
            const double ax = lq_plot_at(x, s->x[i]), ay = lq_plot_at(y, s->y[i]);
            if (isfinite(px)) take_segment(c, px, py, ax, ay);
            px = ax;
            py = ay;
        }
    }
}

/* Left below first, where falling curves leave room; then around the point, then farther away. */
static const struct {
    double x, y, align;
} places[] = {{-8, 15, 1}, {9, -8, 0},  {9, 15, 0},  {-8, -8, 1}, {0, -11, 0.5}, {0, 22, 0.5},
              {12, 4, 0},  {-12, 4, 1}, {-8, 29, 1}, {9, -22, 0}, {9, 29, 0},    {-8, -22, 1}};

static void place(FILE *out, crowd *c, double x, double y, const char *text) {
    static const char *const anchors[] = {"class=\"soft halo\"", "class=\"soft halo\" text-anchor=\"middle\"",
                                          "class=\"soft halo\" text-anchor=\"end\""};
    const double width = lq_plot_text_width(text);
    int best = -1, most = 0;
    for (int k = 0; k < (int)(sizeof places / sizeof *places) && most < 2; k++) {
        const lq_box box = {x + places[k].x - places[k].align * width, y + places[k].y - LINE + 3, width,
                            LINE};
        const int room = room_for(c, &box);
        if (room > most) most = room, best = k;
    }
    if (best < 0) return;
    const lq_box box = {x + places[best].x - places[best].align * width, y + places[best].y - LINE + 3, width,
                        LINE};
    lq_plot_text(out, x + places[best].x, y + places[best].y, anchors[(int)(2.0 * places[best].align)], text);
    if (c->count < TAKEN) { /* it is as solid as a marker */
        c->boxes[c->count++] = c->boxes[c->solid];
        c->boxes[c->solid++] = box;
    }
}

void lq_plot_labels(FILE *out, const lq_plot *plot, const lq_plot_scale *x, const lq_plot_scale *y) {
    crowd c;
    c.count = 0;
    take_notes(&c, plot, x, y);
    take_marks(&c, plot, x, y);
    c.solid = c.count;
    take_curves(&c, plot, x, y);
    for (size_t k = 0; k < plot->series_count; k++) {
        const lq_plot_line *s = &plot->series[k];
        for (size_t i = 0; s->labels && i < s->count; i++)
            if (s->labels[i] && lq_plot_has(plot, s, i))
                place(out, &c, lq_plot_at(x, s->x[i]), lq_plot_at(y, s->y[i]), s->labels[i]);
    }
}

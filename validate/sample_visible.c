/* Visible normals: GGX in closed form, every other NDF by rejection from its inverse of integral m_z D. */
#include "validate/sample_visible.h"

#include "microfacet/ggx.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* GGX by spherical caps (Dupuy & Benyoub 2023). Stretched by 1/alpha the visible normals are those of a
 * mirror sphere, which reflects a parallel beam uniformly: the reflected direction c is uniform, and m_z > 0
 * cuts it to the cap c_z > -v_z. That holds for v below the horizon too. The sums 1 + v_z and 1 - c_z are
 * the variables, because each of them goes to 0 somewhere.
 */
static void sample_ggx(double alpha, double v_z, double v_s, lq_stream *stream, lq_facet *facet) {
    const double norm = sqrt(v_z * v_z + alpha * alpha * v_s * v_s);
    const double z = v_z / norm;
    const double x = alpha * v_s / norm;
    const double cap = z >= 0.0 ? 1.0 + z : x * x / (1.0 - z); /* 1 + z */
    const double u = lq_stream_uniform(stream);
    const double fall = u * cap; /* 1 - c_z */
    const double radius = sqrt(fall * (2.0 - fall));
    const double cosine = cos(pi * lq_stream_uniform(stream)); /* y shows up squared: half a turn is enough */
    const double h_x = x + radius * cosine;
    const double h_y2 = radius * radius * (1.0 - cosine) * (1.0 + cosine);
    const double h_z = (1.0 - u) * cap;
    const double flat2 = h_x * h_x + h_y2;
    const double length = sqrt(alpha * alpha * flat2 + h_z * h_z);
    facet->x = alpha * h_x / length;
    facet->y = alpha * sqrt(h_y2) / length;
    facet->z = h_z / length;
    /* v.h = |h|^2 / 2 between the stretched unit vectors: positive without a cancellation. */
    facet->cosine = 0.5 * norm * (flat2 + h_z * h_z) / length;
}

/* The cells of 1 - xi are 4 to the octave; the slope falls with 1 - xi, so its largest value in a cell is
 * at the small end. What lies beyond 2^-52 is one cell whose slope is taken at 2^-53, the last xi < 1. */
static void make_cells(lq_visible *visible) {
    const lq_ndf *ndf = visible->ndf;
    for (int i = 0; i <= LQ_VISIBLE_CELLS; i++) visible->rest[i] = exp2(-0.25 * i);
    visible->rest[LQ_VISIBLE_CELLS] = 0.0;
    for (int i = 0; i < LQ_VISIBLE_CELLS; i++) {
        const double end = fmax(visible->rest[i + 1], 0x1p-53);
        visible->slope[i] = ndf->slope_quantile(ndf, visible->alpha, 1.0 - end);
    }
    visible->tail[LQ_VISIBLE_CELLS] = 0.0;
    for (int i = LQ_VISIBLE_CELLS - 1; i >= 0; i--)
        visible->tail[i] =
            visible->tail[i + 1] + (visible->rest[i] - visible->rest[i + 1]) * visible->slope[i];
}

/* The first cell in which anything falls to `target` or below; `values` fall from `first` on. */
static int find_cell(const double *values, int first, double target) {
    int low = first, high = LQ_VISIBLE_CELLS;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (values[middle] >= target) low = middle;
        else high = middle;
    }
    return low;
}

/* The first cell with a slope that v, below the horizon, can see: tan theta_m > -v_z / v_s. */
static int first_cell_in_sight(const lq_visible *visible, double v_z, double v_s) {
    if (v_z >= 0.0) return 0;
    int low = -1, high = LQ_VISIBLE_CELLS - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (visible->slope[middle] * v_s > -v_z) high = middle;
        else low = middle;
    }
    return high;
}

/* One candidate from the envelope (v_z)+ + v_s slope(cell) over xi and the azimuth. True: accepted. The
 * density wanted is (v_z + v_s tan theta_m cos phi)+: v.m over m_z, because xi carries m_z D already. */
static bool propose(const lq_visible *visible, double v_z, double v_s, int first, lq_stream *stream,
                    double *slope, double *cosine) {
    const lq_ndf *ndf = visible->ndf;
    const double flat = fmax(v_z, 0.0);
    const double steep = v_s * visible->tail[first];
    const double pick = lq_stream_uniform(stream) * (flat + steep);
    const double u = lq_stream_uniform(stream);
    int cell;
    double rest;
    if (pick < flat) {
        rest = u;
        cell = find_cell(visible->rest, 0, rest);
    } else {
        cell = find_cell(visible->tail, first, (pick - flat) / v_s);
        rest = visible->rest[cell + 1] + u * (visible->rest[cell] - visible->rest[cell + 1]);
    }
    *slope = ndf->slope_quantile(ndf, visible->alpha, 1.0 - fmax(rest, 0x1p-53));
    *cosine = cos(pi * lq_stream_uniform(stream));
    const double wanted = v_z + v_s * *slope * *cosine;
    return lq_stream_uniform(stream) * (flat + v_s * visible->slope[cell]) < wanted;
}

static void sample_by_rejection(const lq_visible *visible, double v_z, double v_s, lq_stream *stream,
                                lq_facet *facet) {
    const int first = first_cell_in_sight(visible, v_z, v_s);
    double slope = 0.0, cosine = 1.0;
    /* The bound is never reached where anything is in sight; beyond the steepest facet nothing is. */
    for (int tries = 0; tries < 1000000; tries++)
        if (propose(visible, v_z, v_s, first, stream, &slope, &cosine)) break;
    const double z = 1.0 / sqrt(1.0 + slope * slope);
    facet->x = slope * z * cosine;
    facet->y = slope * z * sqrt((1.0 - cosine) * (1.0 + cosine));
    facet->z = z;
    facet->cosine = fmax(v_z * z + v_s * facet->x, 0.0);
}

void lq_visible_make(lq_visible *visible, const lq_ndf *ndf, double alpha, bool closed_form) {
    visible->ndf = ndf;
    visible->alpha = alpha;
    visible->closed_form = closed_form && ndf == &lq_ggx;
    if (!visible->closed_form) make_cells(visible);
}

void lq_visible_sample(const lq_visible *visible, double v_z, double v_s, lq_stream *stream,
                       lq_facet *facet) {
    if (visible->closed_form) sample_ggx(visible->alpha, v_z, v_s, stream, facet);
    else sample_by_rejection(visible, v_z, v_s, stream, facet);
}

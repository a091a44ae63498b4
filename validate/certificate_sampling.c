/* Were the texels meant for other places? What is decoded there is compared with the same exact values. */
#include "pca/factors.h"
#include "validate/certificate_checks.h"
#include "validate/pattern.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Another sampling must explain this much of the rms. */
static const double explains = 0.5;

/* Points that are looked at again. */
enum { AGAIN = 20000 };

/* The nodes or texel centres along a table axis at point x, or NULL where none are placed on it directly. */
static const lq_axis *texels_at(const lq_subject *s, int axis, const double *x) {
    if (!s->factored) return &s->table->axes[axis];
    const lq_piece *piece = lq_factored_piece(s->factored, x);
    const lq_axis *finest = NULL;
    for (int f = 0; f < piece->factor_count; f++)
        for (int k = 0; k < piece->factors[f].axis_count; k++) {
            const lq_texture_axis *t = &piece->factors[f].axes[k];
            if (t->axis == axis && t->coordinate == LQ_COORDINATE_AXIS &&
                (!finest || t->texels.size > finest->size))
                finest = &t->texels;
        }
    return finest;
}

/* Where to read for x if node i of N was sampled at that place. */
static double read_at(const lq_axis *axis, lq_sampling sampling, double x) {
    const double last = (double)(axis->size - 1), n = (double)axis->size;
    const double index = lq_axis_locate(axis, x), u = index / last;
    const double at[LQ_SAMPLINGS] = {[LQ_SAMPLED_CENTRES] = u * n - 0.5,
                                     [LQ_SAMPLED_STARTS] = u * n,
                                     [LQ_SAMPLED_ENDS] = u * n - 1.0,
                                     [LQ_SAMPLED_UP] = index - 0.5,
                                     [LQ_SAMPLED_DOWN] = index + 0.5};
    const double to = fmin(fmax(at[sampling], 0.0), last);
    const size_t below = to < last ? (size_t)to : axis->size - 2;
    return axis->nodes[below] + (to - (double)below) * (axis->nodes[below + 1] - axis->nodes[below]);
}

/* rms over some of the points with one axis read otherwise; axis -1: as it is. */
static double rms_if(const lq_certified *certified, int axis, lq_sampling sampling) {
    const lq_sampled *c = &certified->certificate;
    const lq_stage *last = &c->request.stages[c->request.stage_count - 1];
    const size_t axes = (size_t)c->request.kind->axis_count, step = 1 + c->points / AGAIN;
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < c->points; i += step) {
        double x[LQ_MAX_AXES] = {0.0};
        memcpy(x, c->at + i * axes, axes * sizeof *x);
        const lq_axis *texels = axis >= 0 ? texels_at(&certified->subject, axis, x) : NULL;
        if (texels && texels->size > 1) x[axis] = read_at(texels, sampling, x[axis]);
        for (int k = 0; k < c->request.kind->channel_count; k++) {
            const double d = last->decode(last->subject, k, x) - c->exact[(size_t)k * c->points + i];
            sum += d * d;
            count++;
        }
    }
    return sqrt(sum / count);
}

/* Only where something failed: a good table has no reason to be looked at so. */
void lq_check_sampling(lq_certified *certified) {
    if (!lq_certified_failure(certified)) return;
    const lq_kind *kind = certified->subject.origin.kind;
    const double as_it_is = rms_if(certified, -1, LQ_SAMPLED_CENTRES);
    double best = INFINITY;
    int axis = 0;
    lq_sampling sampling = LQ_SAMPLED_CENTRES;
    for (int a = 0; a < kind->axis_count; a++)
        for (lq_sampling s = 0; s < LQ_SAMPLINGS; s++) {
            const double rms = rms_if(certified, a, s);
            if (!(rms < best)) continue;
            best = rms;
            axis = a;
            sampling = s;
        }
    if (best < explains * as_it_is)
        lq_check_add(certified, "looks misplaced", best, NAN,
                     "rms would be %.2e, not %.2e, with the nodes of %s sampled at %s", best, as_it_is,
                     kind->axes[axis].name, lq_sampling_name(sampling));
}

/* walk_pile.c - a stack made ready for rays, and one ray through all of it. */
#include <math.h>
#include <stdlib.h>

#include "microfacet/ggx.h"
#include "stack/description.h"
#include "system/status.h"
#include "validate/walk_stack.h"

/* No light needs so many; only a lossless trap does, such as a mirror below total reflection. */
static const long MOST_HITS = 1000000;

/* ======================================================================================
 *                                     Made ready
 * ====================================================================================== */

static bool same(const lq_quantity *q) {
    return q->value[1] == q->value[0] && q->value[2] == q->value[0];
}

bool lq_walk_pile_shared(const lq_stack *stack) {
    for (size_t i = 0; i < stack->layer_count; i++) {
        const lq_layer *layer = &stack->layers[i];
        if (!same(&layer->alpha_x) || (layer->type == LQ_LAYER_DIELECTRIC && !same(&layer->n))) return false;
    }
    return true;
}

static lq_status make_rough(lq_walk_interface *f, const lq_layer *layer, double alpha, lq_error *error) {
    lq_status status = lq_ndf_open(&f->ndf, layer->ndf, error);
    f->alpha = alpha;
    f->ggx = f->ndf == &lq_ggx;
    if (status == LQ_OK && alpha > 0.0) status = lq_ndf_prepare(f->ndf, alpha, error);
    if (status == LQ_OK && f->rough) lq_visible_make(&f->visible, f->ndf, alpha, true);
    return status;
}

static lq_status make_interface(const lq_walk_pile *p, lq_walk_interface *f, const lq_layer *layer,
                                int channel, const double *n_above, lq_error *error) {
    const double n = layer->n.value[channel], alpha = layer->alpha_x.value[channel];
    f->opaque = layer->type != LQ_LAYER_DIELECTRIC;
    f->diffuse = layer->type == LQ_LAYER_LAMBERTIAN;
    for (int c = 0; c < p->colours; c++) {
        f->rho[c] = layer->rho.value[channel + c];
        f->n[c] = layer->n.value[channel + c] / n_above[channel + c];
        f->kappa[c] = layer->kappa.value[channel + c] / n_above[channel + c];
    }
    if (f->diffuse) return LQ_OK;
    f->eta[0] = n / n_above[channel];
    f->eta[1] = n_above[channel] / n;
    /* An interface between equal media is none, however often a grazing ray would have to cross it. */
    f->rough = alpha > 0.0 && (f->opaque || n != n_above[channel]);
    return make_rough(f, layer, alpha, error);
}

static lq_status make_layers(lq_walk_pile *p, const lq_stack *stack, bool single, int channel,
                             lq_error *error) {
    static const double outside[LQ_STACK_CHANNELS] = {1.0, 1.0, 1.0};
    const double *n_above = outside;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < p->count && status == LQ_OK; i++) {
        const lq_layer *layer = &stack->layers[i];
        p->interface[i].once = single;
        status = make_interface(p, &p->interface[i], layer, channel, n_above, error);
        n_above = layer->n.value;
        for (int c = 0; c < p->colours && layer->type == LQ_LAYER_DIELECTRIC; c++)
            p->log_tau[i + 1][c] = log(lq_medium_transmittance(&layer->medium, channel + c));
    }
    return status;
}

lq_status lq_walk_pile_make(lq_walk_pile *p, const lq_stack *stack, const lq_stack_query *query, int channel,
                            int colours, lq_error *error) {
    const size_t count = stack->layer_count;
    *p = (lq_walk_pile){.count = count, .colours = colours, .from_below = query->from_below};
    p->interface = calloc(count, sizeof *p->interface);
    p->log_tau = calloc(count + 1, sizeof *p->log_tau);
    if (!p->interface || !p->log_tau)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for a stack of %zu layers", count);
    return make_layers(p, stack, query->single, channel, error);
}

void lq_walk_pile_free(lq_walk_pile *p) {
    for (size_t i = 0; p->interface && i < p->count; i++) lq_ndf_close(p->interface[i].ndf);
    free(p->interface);
    free(p->log_tau);
}

/* ======================================================================================
 *                                       One ray
 * ====================================================================================== */

static void cross(const lq_walk_pile *p, size_t medium, lq_traveller *t) {
    const double *log_tau = p->log_tau[medium];
    if (p->colours == 1) {
        t->ray.weight *= lq_ray_crossing(log_tau[0], t->ray.z);
        return;
    }
    if (log_tau[0] == 0.0 && log_tau[1] == 0.0 && log_tau[2] == 0.0) return;
    double factor[LQ_STACK_CHANNELS];
    for (int c = 0; c < LQ_STACK_CHANNELS; c++) factor[c] = lq_ray_crossing(log_tau[c], t->ray.z);
    lq_walk_tint(t, factor);
}

static lq_traveller arrive(const lq_walk_pile *p, double mu) {
    lq_traveller t = {.ray = {.z = mu, .weight = 1.0},
                      .x = lq_sine(mu),
                      .tint = {1.0, 1.0, 1.0},
                      .colours = p->colours,
                      .side = p->from_below ? 1 : 0,
                      .hits_left = MOST_HITS};
    if (p->from_below) cross(p, p->count, &t);
    t.ray.z = -mu;
    return t;
}

lq_fate lq_walk_through(const lq_walk_pile *p, double mu, lq_stream *stream, lq_traveller *t,
                        size_t *meetings) {
    const size_t first = p->from_below ? p->count - 1 : 0;
    *t = arrive(p, mu);
    *meetings = 0;
    for (size_t at = first;;) {
        *meetings += at == first;
        lq_walk_meet(&p->interface[at], t, stream);
        if (t->hits_left <= 0) return LQ_GIVEN_UP;
        const size_t medium = at + (size_t)t->side;
        cross(p, medium, t);
        if (medium == 0 || medium == p->count)
            return !(t->ray.weight > 0.0)          ? LQ_ABSORBED
                   : (medium > 0) == p->from_below ? LQ_RETURNED
                                                   : LQ_THROUGH;
        lq_ray_roulette(&t->ray, stream);
        if (!(t->ray.weight > 0.0)) return LQ_ABSORBED;
        at = t->side ? at + 1 : at - 1;
        t->side = 1 - t->side;
        t->ray.z = -t->ray.z;
    }
}

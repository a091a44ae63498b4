/* model_y19.c - B18's adding on the three entries of a covariance. */
#include "stack/model_y19.h"

#include <math.h>
#include <string.h>

#include "stack/description.h"
#include "system/status.h"

static const double DEGREE = 3.14159265358979323846 / 180.0;
static const double LEAST_MU = 1e-6;

/* Entries of a covariance, in the frame of the first layer. */
enum { XX, XY, YY, ENTRIES };

typedef struct passage {
    const lq_stack *stack;
    const lq_model_tables *tables;
    int channel;
    double mu, plane; /* the plane of incidence, from the x axis of the first layer */
    lq_model_ray ray;
    lq_model_sum sum[ENTRIES];
    double above;
} passage;

/* An interface's axes in that frame: cosine and sine of its x axis. */
typedef struct axes {
    double x, y; /* alpha */
    double cosine, sine;
} axes;

/* Right angles are exact, so that layers with the same axes have no covariance between them. */
static axes axes_of(const passage *p, const lq_layer *layer) {
    const lq_layer *first = &p->stack->layers[0];
    const int c = p->channel;
    const double turn = fmod(layer->rotate.value[c] - first->rotate.value[c], 180.0);
    axes a = {layer->alpha_x.value[c], layer->alpha_y.value[c], cos(turn * DEGREE), sin(turn * DEGREE)};
    if (turn == 0.0) a.sine = 0.0;
    if (fabs(turn) == 90.0) a.cosine = 0.0;
    return a;
}

/* An entry of R diag(a, b) R^T, the same for all R where a = b. */
static double entry(const axes *x, int which, double a, double b) {
    if (which == XX) return b + (a - b) * x->cosine * x->cosine;
    if (which == YY) return a + (b - a) * x->cosine * x->cosine;
    return (a - b) * x->cosine * x->sine;
}

/* Roughness of the facets along the plane of incidence. */
static double projected(const passage *p, const axes *x) {
    const double along = cos(p->plane) * x->cosine + sin(p->plane) * x->sine;
    return sqrt(fmax(x->y * x->y + (x->x * x->x - x->y * x->y) * along * along, 0.0));
}

/* Variance on the way down along that plane. */
static double arriving(const passage *p) {
    const double c = cos(p->plane), s = sin(p->plane);
    return c * c * p->sum[XX].t0i.variance + 2.0 * c * s * p->sum[XY].t0i.variance +
           s * s * p->sum[YY].t0i.variance;
}

/* ======================================================================================
 *                                      A covariance
 * ====================================================================================== */

/* The pole of f is a large number: turned, it leaves no digits of the other axis. */
static const double TURNABLE = 1e10;

static lq_status lobe_of(const passage *p, const lq_flow *flow, double sine, lq_turned_lobe *lobe,
                         lq_error *error) {
    const double xx = flow[XX].variance, xy = flow[XY].variance, yy = flow[YY].variance;
    const double half = 0.5 * (xx - yy), radius = hypot(half, xy), largest = 0.5 * (xx + yy) + radius;
    const lq_model_mapping *mapping = p->tables->mapping;
    *lobe = (lq_turned_lobe){.energy = flow[XX].energy, .mean = sine, .angle = -p->plane};
    if (!(lobe->energy > 0.0)) return LQ_OK;
    if (xy == 0.0) {
        lobe->alpha_x = lq_model_roughness(mapping, fmax(xx, 0.0));
        lobe->alpha_y = lq_model_roughness(mapping, fmax(yy, 0.0));
        return LQ_OK;
    }
    if (!(largest < TURNABLE))
        return lq_fail(error, LQ_BAD_INPUT,
                       "alpha next to 1 on one axis, turned against that of another layer; accepted there: "
                       "f(alpha) below %g",
                       TURNABLE);
    lobe->alpha_x = lq_model_roughness(mapping, largest);
    lobe->alpha_y = lq_model_roughness(mapping, fmax((xx * yy - xy * xy) / largest, 0.0));
    lobe->angle += 0.5 * atan2(xy, half);
    return LQ_OK;
}

/* ======================================================================================
 *                                        The layers
 * ====================================================================================== */

static void cross(passage *p, const lq_medium *medium) {
    const lq_flow crossing = lq_model_medium(p->tables, medium, p->channel, p->ray.cosine);
    for (int e = 0; e < ENTRIES; e++)
        lq_model_cross(&p->sum[e], (lq_flow){crossing.energy, e == XY ? 0.0 : crossing.variance});
}

static lq_status go_down(passage *p, size_t at, double looked_up, lq_error *error) {
    double pass;
    const lq_status status = lq_model_pass(p->tables, p->ray, p->above, looked_up, &pass, error);
    if (status != LQ_OK) return status;
    for (int e = 0; e < ENTRIES; e++) lq_model_reflect_back(&p->sum[e], pass);
    cross(p, &p->stack->layers[at].medium);
    return LQ_OK;
}

static lq_status interface_of(passage *p, const lq_layer *layer, double alpha, double looked_up,
                              lq_model_interface *i, lq_error *error) {
    const double n = layer->n.value[p->channel];
    return layer->type == LQ_LAYER_DIELECTRIC
               ? lq_model_dielectric(p->tables, &p->ray, n, alpha, looked_up, i, error)
               : lq_model_conductor(p->tables, p->ray, n, layer->kappa.value[p->channel], alpha, looked_up, i,
                                    error);
}

/* The interface as one entry of covariances sees it, from what it is to each axis alone. */
static lq_model_interface entry_of(const lq_model_interface *i, const axes *x, int which,
                                   const lq_model_spread *on_x, const lq_model_spread *on_y) {
    lq_model_interface one = *i;
    one.r12.variance = one.r21.variance = entry(x, which, on_x->reflected, on_y->reflected);
    one.t12.variance = entry(x, which, on_x->down, on_y->down);
    one.t21.variance = entry(x, which, on_x->up, on_y->up);
    return one;
}

static lq_status add_layer(passage *p, size_t at, lq_turned_lobe *lobe, lq_error *error) {
    const lq_layer *layer = &p->stack->layers[at];
    const axes x = axes_of(p, layer);
    const double alpha = projected(p, &x), looked_up = lq_model_lookup_alpha(p->tables, arriving(p), alpha);
    lq_status status = at > 0 ? go_down(p, at - 1, looked_up, error) : LQ_OK;
    const lq_model_ray here = p->ray;
    lq_model_interface i;
    lq_flow flow[ENTRIES];
    if (status == LQ_OK) status = interface_of(p, layer, alpha, looked_up, &i, error);
    if (status != LQ_OK) return status;
    const lq_model_spread on_x = lq_model_spread_of(p->tables, x.x, here, p->ray),
                          on_y = lq_model_spread_of(p->tables, x.y, here, p->ray);
    for (int e = 0; e < ENTRIES; e++) {
        const lq_model_interface one = entry_of(&i, &x, e, &on_x, &on_y);
        flow[e] = lq_model_add(&p->sum[e], &one);
    }
    p->above = here.index;
    return lobe_of(p, flow, sqrt((1.0 - p->mu) * (1.0 + p->mu)), lobe, error);
}

static lq_status pass_down(passage *p, lq_turned_lobe *lobes, lq_error *error) {
    const size_t count = p->stack->layer_count;
    const lq_layer *last = &p->stack->layers[count - 1];
    memset(lobes, 0, (count + 1) * sizeof *lobes);
    for (size_t i = 0; i < count && p->ray.cosine > 0.0; i++) {
        const lq_status status = add_layer(p, i, &lobes[i], error);
        if (status != LQ_OK) return status;
    }
    if (last->type != LQ_LAYER_DIELECTRIC || !(p->ray.cosine > 0.0)) return LQ_OK;
    cross(p, &last->medium);
    const lq_flow through[ENTRIES] = {p->sum[XX].t0i, p->sum[XY].t0i, p->sum[YY].t0i};
    return lobe_of(p, through, sqrt((1.0 - p->ray.cosine) * (1.0 + p->ray.cosine)), &lobes[count], error);
}

static lq_status check_base(const lq_stack *stack, lq_error *error) {
    if (stack->layers[stack->layer_count - 1].type != LQ_LAYER_LAMBERTIAN) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "a lambertian base; accepted by y19: a conductor, or none");
}

lq_status lq_model_y19(const lq_stack *stack, const lq_model_query *query, double azimuth,
                       lq_turned_lobe *lobes, lq_error *error) {
    lq_model_memo memo = {0};
    lq_model_mapping own;
    const lq_model_tables tables = {query->variant, query->mapping ? query->mapping : &own, query->tolerance,
                                    &memo, query->source};
    lq_status status = lq_model_check(stack, query, error);
    if (status == LQ_OK) status = check_base(stack, error);
    if (status == LQ_OK && !query->mapping) status = lq_model_mapping_make(&own, query->f, error);
    for (int c = 0; c < lq_stack_channels(stack) && status == LQ_OK; c++) {
        const double mu = fmax(query->mu[0], LEAST_MU);
        passage p = {.stack = stack,
                     .tables = &tables,
                     .channel = c,
                     .mu = mu,
                     .plane = (azimuth - stack->layers[0].rotate.value[c]) * DEGREE,
                     .ray = {mu, 1.0},
                     .above = 1.0};
        for (int e = 0; e < ENTRIES; e++) p.sum[e] = lq_model_nothing();
        status = pass_down(&p, lobes + (size_t)c * lq_model_lobe_count(stack), error);
    }
    return status;
}

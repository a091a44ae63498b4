/* model_window.c - sums over half vectors inside, that crowd as GGX has them. */
#include "stack/model_window.h"

#include <math.h>
#include <stdlib.h>

#include "microfacet/fresnel.h"
#include "stack/description.h"
#include "stack/model.h"
#include "stack/spread.h"
#include "system/status.h"

/* Paths: the top alone, once inside, more often inside. */
enum { PATHS = 1 + LQ_WINDOW_PARTS, RINGS = 512, SECTORS = 32, HALVINGS = 40 };
static const double PI = 3.14159265358979323846;

/* ======================================================================================
 *                                        One lobe
 * ====================================================================================== */

static lq_incidence inside(lq_incidence from, double n) {
    const double sine = from.sine / n;
    return (lq_incidence){sqrt((1.0 - sine) * (1.0 + sine)), sine};
}

static double transmittance(double cosine, double n) {
    double refracted;
    return n > 1.0 ? 1.0 - lq_fresnel_dielectric(fmin(cosine, 1.0), n, &refracted) : 1.0;
}

static double density(lq_incidence from, double n, double alpha, double x, double y, double z) {
    const double xi = x / n, yi = y / n, zi = sqrt(fmax(1.0 - xi * xi - yi * yi, z * z / (n * n)));
    return transmittance(z, n) * lq_lobe_density(inside(from, n), alpha, xi, yi, zi) * z / (n * n * zi);
}

/* What half vectors of a ring and a sector send out; sectors of half the circle stand for both halves. */
static void add_facet(lq_stack_lobe *sum, lq_incidence in, double n, double alpha, int ring, int sector) {
    const double left = (ring + 0.5) / RINGS, u = 1.0 - left * left, phi = PI * (sector + 0.5) / SECTORS;
    const double slope = sqrt(u / (1.0 - u)) * alpha, hz = 1.0 / sqrt(1.0 + slope * slope);
    const double hx = hz * slope * cos(phi), hy = hz * slope * sin(phi);
    const double facets = (1.0 - u) * (1.0 - u) / (PI * alpha * alpha * hz * hz * hz);
    const double dot = in.cosine * hz - in.sine * hx;
    const double x = 2.0 * dot * hx + in.sine, y = 2.0 * dot * hy, z = 2.0 * dot * hz - in.cosine;
    const double out2 = 1.0 - n * n * (x * x + y * y); /* below 0: reflected inside */
    if (!(dot > 0.0) || !(z > 0.0) || !(out2 > 0.0)) return;
    const double flux = 2.0 * left / (RINGS * SECTORS) * lq_lobe_density(in, alpha, x, y, z) * 4.0 * dot /
                        facets * transmittance(sqrt(out2), n);
    sum->energy += flux;
    sum->sin2 += flux * n * n * (x * x + y * y);
    sum->mean += flux * n * x;
    sum->across += flux * n * n * y * y;
}

static lq_stack_lobe divided(lq_stack_lobe sum) {
    if (!(sum.energy > 0.0)) return (lq_stack_lobe){0};
    return (lq_stack_lobe){sum.energy, sum.sin2 / sum.energy, sum.mean / sum.energy, sum.across / sum.energy};
}

static lq_stack_lobe moments(double mu, double n, double alpha) {
    const lq_incidence in = inside(lq_incidence_of(mu), n);
    lq_stack_lobe sum = {0};
    for (int r = 0; r < RINGS; r++)
        for (int s = 0; s < SECTORS; s++) add_facet(&sum, in, n, alpha, r, s);
    return divided(sum);
}

/* The least roughness whose lobe spreads so far; 1 where none does. */
static double alpha_of(double mu, double n, double across, double least) {
    double low = least, high = 1.0;
    if (moments(mu, n, low).across >= across) return low;
    if (moments(mu, n, high).across <= across) return high;
    for (int i = 0; i < HALVINGS && high / low > 1.0 + 1e-5; i++) {
        const double middle = sqrt(low * high);
        *(moments(mu, n, middle).across < across ? &low : &high) = middle;
    }
    return high;
}

/* ======================================================================================
 *                                       All parts
 * ====================================================================================== */

double lq_window_value(const lq_window *w, lq_incidence from, double x, double y, double z) {
    double sum = 0.0;
    for (int p = 0; p < LQ_WINDOW_PARTS; p++)
        if (w->part[p].scale > 0.0) sum += w->part[p].scale * density(from, w->n, w->part[p].alpha, x, y, z);
    return sum;
}

lq_stack_lobe lq_window_light(const lq_window *w, double mu) {
    lq_stack_lobe sum = {0};
    for (int p = 0; p < LQ_WINDOW_PARTS; p++) {
        const double energy = w->part[p].energy;
        if (!(energy > 0.0)) continue;
        const lq_stack_lobe one = moments(mu, w->n, w->part[p].alpha);
        sum.energy += energy;
        sum.sin2 += energy * one.sin2;
        sum.mean += energy * one.mean;
        sum.across += energy * one.across;
    }
    return divided(sum);
}

/* ======================================================================================
 *                                    From the exact stack
 * ====================================================================================== */

static void set_inner(lq_window *w, double n, double mu, double least_alpha, const lq_stack_light *paths) {
    *w = (lq_window){.n = fmax(n, 1.0)};
    for (int p = 0; p < LQ_WINDOW_PARTS; p++) {
        const lq_stack_lobe *exact = &paths[1 + p].reflected;
        if (!(exact->energy > 0.0)) continue;
        const double alpha = alpha_of(mu, w->n, exact->across, least_alpha);
        const double whole = moments(mu, w->n, alpha).energy;
        w->energy += exact->energy;
        w->part[p].energy = exact->energy;
        w->part[p].alpha = alpha;
        w->part[p].scale = whole > 0.0 ? exact->energy / whole : 0.0;
    }
}

static lq_status set_through(lq_windowed *made, double n, double mu, const lq_stack_light *paths,
                             lq_error *error) {
    const double cosine = lq_sine(fmin(lq_sine(mu) / n, 1.0));
    double across = 0.0;
    for (int p = 0; p < PATHS; p++) {
        made->through += paths[p].transmitted.energy;
        across += paths[p].transmitted.energy * paths[p].transmitted.across;
    }
    return made->through > 0.0
               ? lq_spread_alpha_at(cosine, across / made->through, &made->through_alpha, error)
               : LQ_OK;
}

lq_status lq_model_windowed(const lq_stack *stack, double mu, double least_alpha, int threads,
                            lq_windowed *made, lq_error *error) {
    const lq_model_query asked = {.mu = &mu, .mu_count = 1, .model = LQ_MODEL_BAKED_WINDOW};
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .paths = PATHS, .threads = threads};
    const size_t last = stack->layer_count - 1;
    lq_stack_light light[LQ_STACK_CHANNELS * PATHS];
    lq_status status = lq_model_check(stack, &asked, error);
    if (status == LQ_OK) status = lq_stack_solve(stack, &query, light, NULL, error);
    if (status == LQ_NOT_CONVERGED) status = LQ_OK; /* what is left is far below what a lobe misses */
    for (int c = 0; c < lq_stack_channels(stack) && status == LQ_OK; c++) {
        const lq_stack_light *paths = light + c * PATHS;
        made[c] = (lq_windowed){.top = paths[0].reflected.energy};
        if (last > 0) set_inner(&made[c].inner, stack->layers[last - 1].n.value[c], mu, least_alpha, paths);
        if (stack->layers[last].type == LQ_LAYER_DIELECTRIC)
            status = set_through(&made[c], stack->layers[last].n.value[c], mu, paths, error);
    }
    return status;
}

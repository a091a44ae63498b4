/* The lobe of a rough mirror: visible normals, reflected once and weighted by masking; a ratio of two means.
 */
#include "validate/walk_lobe.h"

#include "microfacet/fresnel.h"
#include "validate/sample_visible.h"
#include "validate/walk_ray.h"
#include "validate/walk_reduce.h"

#include <math.h>

typedef struct context {
    const lq_walk *walk;
    lq_walk_lobe_mean which;
    lq_visible visible;
} context;

static double counted(const context *c, double mu, double sine) {
    const double eta = c->walk->n;
    if (c->which == LQ_WALK_LOST) return sine > eta ? 1.0 : 0.0;
    return eta > 0.0 ? 1.0 - lq_fresnel_dielectric(mu, eta, NULL) : 0.0;
}

/* The weight y and x = y times what is counted, and the products that give the spread of x - (X/Y) y. */
enum { X, Y, XX, XY, YY, SUMS };

static void sample_lobe(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    const lq_walk *walk = c->walk;
    lq_ray ray = {.z = -walk->mu, .s = lq_sine(walk->mu), .weight = 1.0};
    lq_facet facet;
    lq_visible_sample(&c->visible, walk->mu, ray.s, stream, &facet);
    lq_ray_reflect(&ray, &facet);
    if (ray.z <= 0.0) return;
    const double y = ray.z / (ray.z + walk->ndf->area_below(walk->ndf, walk->alpha, ray.z, ray.s));
    const double x = y * counted(c, fmin(ray.z, 1.0), ray.s);
    values[X] = x;
    values[Y] = y;
    values[XX] = x * x;
    values[XY] = x * y;
    values[YY] = y * y;
}

lq_status lq_walk_lobe(const lq_walk *walk, lq_walk_lobe_mean which, lq_walk_mean *mean, lq_error *error) {
    lq_status status = lq_walk_check(walk, error);
    if (status != LQ_OK) return status;
    context c = {.walk = walk, .which = which};
    if (walk->alpha == 0.0) {
        *mean = (lq_walk_mean){counted(&c, walk->mu, lq_sine(walk->mu)), 0.0};
        return LQ_OK;
    }
    lq_walk_mean sums[SUMS];
    lq_visible_make(&c.visible, walk->ndf, walk->alpha, true);
    status = lq_walk_reduce(walk, sample_lobe, &c, SUMS, sums, error);
    if (status != LQ_OK) return status;
    const double ratio = sums[Y].mean > 0.0 ? sums[X].mean / sums[Y].mean : 0.0;
    const double spread = sums[XX].mean - 2.0 * ratio * sums[XY].mean + ratio * ratio * sums[YY].mean;
    mean->mean = ratio;
    mean->error =
        sums[Y].mean > 0.0 ? sqrt(fmax(spread, 0.0) / (double)walk->samples) / sums[Y].mean : INFINITY;
    return LQ_OK;
}

/* The two-sided random walk of a rough dielectric (H16 section 4): reflects or refracts at each hit.
 *
 * A ray below the surface walks in the flipped frame (z -> -z, u -> 1 - u, m -> -m, eta -> 1/eta), so both
 * sides run the same code. The depth there is t' = -ln(1 - e^-t), and t <-> t' loses nothing at either end.
 */
#include "microfacet/fresnel.h"
#include "system/status.h"
#include "validate/walk.h"
#include "validate/walk_ray.h"
#include "validate/walk_reduce.h"

/* Both outcomes of a hit are followed while each weighs at least this much; below it one is drawn. */
static const double split = 0.005;

/* No path has more branches in waiting: all weights sum to 1 and each is at least `split`. */
enum { MAX_BRANCHES = 512 };

typedef struct branch {
    lq_ray ray;
    int side; /* 0 near, 1 far */
    int hits;
} branch;

typedef struct context {
    const lq_walk *walk;
    lq_visible visible;
    double eta[2]; /* index of the other side over that of this one */
    double log_tau[2];
} context;

/* What a sample writes. The sums with sin^2 added give the covariance that the error of a ratio needs. */
enum { ENERGY, SIN2 = 2, SUM = 4, VALUES = 6 };

/* Refraction through the facet, then into the frame of the other side. */
static void refract(branch *b, const lq_facet *facet, double eta, double cos_t) {
    const double normal = facet->cosine / eta - cos_t;
    const double x = normal * facet->x - b->ray.s / eta;
    const double y = normal * facet->y;
    b->ray.z = -(b->ray.z / eta + normal * facet->z);
    b->ray.s = sqrt(x * x + y * y);
    b->ray.t = lq_ray_flip_depth(b->ray.t);
    b->side = 1 - b->side;
}

/* One hit. Returns true when a second branch, `other`, came of it. */
static bool hit(const context *c, branch *b, branch *other, lq_stream *stream) {
    lq_facet facet;
    lq_visible_sample(&c->visible, -b->ray.z, b->ray.s, stream, &facet);
    double cos_t;
    const double eta = c->eta[b->side];
    b->hits++;
    const double f = lq_fresnel_dielectric(fmin(facet.cosine, 1.0), eta, &cos_t);
    const double reflected = b->ray.weight * f;
    const double refracted = b->ray.weight - reflected;
    if (fmin(reflected, refracted) >= split) {
        *other = *b;
        other->ray.weight = refracted;
        refract(other, &facet, eta, cos_t);
        b->ray.weight = reflected;
        lq_ray_reflect(&b->ray, &facet);
        return true;
    }
    if (lq_stream_uniform(stream) < f) lq_ray_reflect(&b->ray, &facet);
    else refract(b, &facet, eta, cos_t);
    return false;
}

static void leave(const context *c, const branch *b, double *values) {
    const double energy = b->ray.weight * lq_ray_crossing(c->log_tau[b->side], b->ray.z);
    const double sin2 = b->ray.s * b->ray.s;
    values[ENERGY + b->side] += energy;
    values[SIN2 + b->side] += energy * sin2;
}

/* To the next hit; false where there is none to count: the ray has left, or its one hit is behind it. */
static bool travel(const context *c, branch *b, lq_stream *stream, double *values) {
    const lq_walk *walk = c->walk;
    const bool over = walk->once && b->hits > 0;
    if (b->ray.z >= 0.0) {
        const bool leaves = lq_ray_rise(&b->ray, walk->ndf, walk->alpha, stream);
        if (leaves) leave(c, b, values);
        return !leaves && !over;
    }
    if (!over) lq_ray_descend(&b->ray, walk->ndf, walk->alpha, stream);
    return !over;
}

static void follow(const context *c, branch *stack, lq_stream *stream, double *values) {
    for (int waiting = 1; waiting > 0;) {
        branch *b = &stack[waiting - 1];
        if (!travel(c, b, stream, values)) waiting--;
        else if (hit(c, b, &stack[waiting], stream)) waiting++;
    }
}

static void finish(const context *c, double mu, double *values) {
    const double in = lq_ray_crossing(c->log_tau[0], mu);
    for (int i = 0; i < SUM; i++) values[i] *= in;
    for (int side = 0; side < 2; side++) values[SUM + side] = values[ENERGY + side] + values[SIN2 + side];
}

static void sample_rough(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    const double mu = lq_ray_incidence(c->walk, stream);
    /* Grazing light only touches the tips of the surface; a cosine of 0 stands for the limit. */
    const double down = fmax(mu, 1e-300);
    branch stack[MAX_BRANCHES];
    stack[0] = (branch){.ray = {.z = -down, .s = lq_sine(mu), .weight = 1.0}};
    follow(c, stack, stream, values);
    finish(c, mu, values);
}

static void sample_smooth(const void *data, lq_stream *stream, double *values) {
    const context *c = data;
    const double mu = lq_ray_incidence(c->walk, stream);
    const double sine = lq_sine(mu);
    double cos_t;
    const double f = lq_fresnel_dielectric(mu, c->eta[0], &cos_t);
    const branch near = {.ray = {.z = mu, .s = sine, .weight = f}};
    const branch far = {.ray = {.z = cos_t, .s = fmin(sine / c->eta[0], 1.0), .weight = 1.0 - f}, .side = 1};
    leave(c, &near, values);
    leave(c, &far, values);
    finish(c, mu, values);
}

/* An interface between equal media is none, however often a grazing ray would have to cross it. */
static bool is_rough(const lq_walk *walk) {
    return walk->alpha > 0.0 && walk->n != 1.0;
}

static void prepare(context *c, const lq_walk *walk) {
    *c = (context){
        .walk = walk, .eta = {walk->n, 1.0 / walk->n}, .log_tau = {log(walk->tau_near), log(walk->tau_far)}};
    if (is_rough(walk)) lq_visible_make(&c->visible, walk->ndf, walk->alpha, true);
}

static lq_status check(const lq_walk *walk, lq_error *error) {
    const lq_status status = lq_walk_check(walk, error);
    if (status == LQ_OK && (walk->fresnel != LQ_WALK_DIELECTRIC || !(walk->n > 0.0)))
        return lq_fail(error, LQ_BAD_INPUT, "two-sided random walk: needs a dielectric of index > 0");
    return status;
}

lq_status lq_walk_two_sided(const lq_walk *walk, lq_walk_sides *sides, lq_error *error) {
    lq_status status = check(walk, error);
    if (status != LQ_OK) return status;
    context c;
    lq_walk_mean m[VALUES];
    prepare(&c, walk);
    status = lq_walk_reduce(walk, is_rough(walk) ? sample_rough : sample_smooth, &c, VALUES, m, error);
    if (status != LQ_OK) return status;
    sides->reflected = m[ENERGY];
    sides->transmitted = m[ENERGY + 1];
    sides->reflected_sin2 = lq_walk_ratio(m[SIN2], m[ENERGY], m[SUM]);
    sides->transmitted_sin2 = lq_walk_ratio(m[SIN2 + 1], m[ENERGY + 1], m[SUM + 1]);
    return LQ_OK;
}

/* ------------------------------------------------------------------------------- coated base */

typedef struct coated {
    context outside, inside; /* the interface as light from above and from the base meets it */
    lq_walk_sample *meet;
    double rho;
} coated;

/* What a path still carries below this plays Russian roulette. */
static const double faint = 0.05;

static void sample_coated(const void *data, lq_stream *stream, double *values) {
    const coated *c = data;
    double meeting[VALUES] = {0.0};
    c->meet(&c->outside, stream, meeting);
    values[0] = meeting[ENERGY];
    double carried = c->rho * meeting[ENERGY + 1];
    while (carried > 0.0) {
        if (carried < faint) carried = lq_stream_uniform(stream) * faint < carried ? faint : 0.0;
        for (int i = 0; i < VALUES; i++) meeting[i] = 0.0;
        c->meet(&c->inside, stream, meeting);
        values[0] += carried * meeting[ENERGY + 1];
        carried *= c->rho * meeting[ENERGY];
    }
}

lq_status lq_walk_coated(const lq_walk *walk, lq_walk_mean *albedo, lq_error *error) {
    const lq_status status = check(walk, error);
    if (status != LQ_OK) return status;
    lq_walk back = *walk;
    back.cosine = true;
    back.n = 1.0 / walk->n;
    back.tau_near = walk->tau_far;
    back.tau_far = walk->tau_near;
    coated c = {.meet = is_rough(walk) ? sample_rough : sample_smooth, .rho = walk->rho};
    prepare(&c.outside, walk);
    prepare(&c.inside, &back);
    return lq_walk_reduce(walk, sample_coated, &c, 1, albedo, error);
}

/* walk_stack_meet.c - what one interface of a stack does to one ray. */
#include "microfacet/fresnel.h"
#include "validate/walk_stack.h"

#include <math.h>

static const double two_pi = 6.28318530717958647692;

/* Grazing light only touches the tips of the surface. Of a conductor a cosine of 0 has a limit, for which the
 * least number stands. What is refracted at a tip leaves again with a chance that goes like mu^Lambda: no
 * number is small enough for that limit, and cosines below 1e-6 are taken for it, as in the tables of
 * two-sided scattering. */
static const double NO_COSINE = 1e-300, GRAZING = 1e-6;

/* Sets the direction of travel, of length 1 but for rounding; now and then that is mended: a path of a
 * million hits must not drift. */
static void head(lq_traveller *t, double x, double y, double z) {
    enum { MENDED = 64 };
    t->x = x;
    t->y = y;
    t->ray.z = z;
    if (t->hits_left % MENDED != 0) return;
    const double scale = 1.0 / sqrt(x * x + y * y + z * z);
    t->x *= scale;
    t->y *= scale;
    t->ray.z *= scale;
}

static double sine2(const lq_traveller *t) {
    return t->x * t->x + t->y * t->y;
}

static void reflect(lq_traveller *t, const lq_facet *m) {
    const double twice = 2.0 * m->cosine;
    head(t, t->x + twice * m->x, t->y + twice * m->y, t->ray.z + twice * m->z);
}

/* Refraction through the facet, then into the frame of the other side. */
static void refract(lq_traveller *t, const lq_facet *m, double eta, double cos_t) {
    const double along = m->cosine / eta - cos_t;
    head(t, t->x / eta + along * m->x, t->y / eta + along * m->y, -(t->ray.z / eta + along * m->z));
    t->ray.t = lq_ray_flip_depth(t->ray.t);
    t->side = 1 - t->side;
}

void lq_walk_tint(lq_traveller *t, const double *factor) {
    if (t->colours == 1) {
        t->ray.weight *= factor[0];
        return;
    }
    double most = 0.0;
    for (int c = 0; c < LQ_STACK_CHANNELS; c++) {
        t->tint[c] *= factor[c];
        if (t->tint[c] > most) most = t->tint[c];
    }
    t->ray.weight *= most;
    for (int c = 0; most > 0.0 && c < LQ_STACK_CHANNELS; c++) t->tint[c] /= most;
}

/* A point of the unit circle, from points of the disc: twice their angle. */
static void draw_azimuth(lq_stream *stream, double *cosine, double *sine) {
    double a, b, square;
    do {
        const uint64_t word = lq_stream_word(stream);
        a = ((double)(uint32_t)word + 0.5) * 0x1p-31 - 1.0;
        b = ((double)(uint32_t)(word >> 32) + 0.5) * 0x1p-31 - 1.0;
        square = a * a + b * b;
    } while (square > 1.0);
    *cosine = (a * a - b * b) / square;
    *sine = 2.0 * a * b / square;
}

/* GGX by spherical caps (Dupuy & Benyoub 2023), as sample_visible.c has it, in three dimensions: stretched by
 * 1/alpha the facets are those of a sphere, and the direction c that it mirrors the ray to is uniform over
 * the cap c_z > -v_z. */
static lq_facet draw_ggx(double alpha, const lq_traveller *t, lq_stream *stream) {
    /* v stretched, and all lengths below in units of its own, `norm`. */
    const double x = -alpha * t->x, y = -alpha * t->y, z = -t->ray.z;
    const double flat = x * x + y * y, norm = sqrt(flat + z * z);
    const double cap = z >= 0.0 ? norm + z : flat / (norm - z);
    const double u = lq_stream_uniform(stream), fall = u * cap; /* 1 - c_z */
    const double radius = sqrt(fall * (2.0 * norm - fall));
    double cosine, sine;
    draw_azimuth(stream, &cosine, &sine);
    const double h_x = x + radius * cosine, h_y = y + radius * sine, h_z = (1.0 - u) * cap;
    const double flat2 = h_x * h_x + h_y * h_y;
    const double shrink = 1.0 / sqrt(alpha * alpha * flat2 + h_z * h_z);
    /* v.h = |h|^2 / 2 between the stretched unit vectors: positive without a cancellation. */
    const double along = 0.5 * (flat2 + h_z * h_z) * shrink;
    return (lq_facet){alpha * h_x * shrink, alpha * h_y * shrink, h_z * shrink, along < 1.0 ? along : 1.0};
}

/* A facet that the ray sees, turned from the ray's plane of incidence to x and y. The sampler leaves out
 * which side of that plane it leans to: a coin says. */
static lq_facet draw_facet(const lq_walk_interface *f, const lq_traveller *t, lq_stream *stream) {
    if (f->ggx) return draw_ggx(f->alpha, t, stream);
    lq_facet m;
    const double sine = sqrt(sine2(t));
    lq_visible_sample(&f->visible, -t->ray.z, sine, stream, &m);
    m.cosine = fmin(m.cosine, 1.0);
    const double c = sine > 0.0 ? -t->x / sine : 1.0, s = sine > 0.0 ? -t->y / sine : 0.0;
    const double x = m.x, y = lq_stream_uniform(stream) < 0.5 ? m.y : -m.y;
    m.x = c * x - s * y;
    m.y = s * x + c * y;
    return m;
}

static void hit(const lq_walk_interface *f, lq_traveller *t, const lq_facet *m, lq_stream *stream) {
    t->hits_left--;
    if (f->opaque) {
        double factor[LQ_STACK_CHANNELS];
        for (int c = 0; c < t->colours; c++)
            factor[c] = lq_fresnel_conductor(m->cosine, f->n[c], f->kappa[c]);
        lq_walk_tint(t, factor);
        reflect(t, m);
        return;
    }
    double cos_t;
    const double eta = f->eta[t->side];
    const double reflected = lq_fresnel_dielectric(m->cosine, eta, &cos_t);
    if (lq_stream_uniform(stream) < reflected) reflect(t, m);
    else refract(t, m, eta, cos_t);
}

/* sigma(-omega) of the direction of travel or, where it goes down, of its reverse, as the NDF has it; of GGX
 * without the call. */
static double area_below(const lq_walk_interface *f, const lq_traveller *t) {
    const double mu = fabs(t->ray.z), stretch2 = f->alpha * f->alpha * sine2(t);
    if (!f->ggx || stretch2 < 1e-280) return f->ndf->area_below(f->ndf, f->alpha, mu, sqrt(sine2(t)));
    return 0.5 * stretch2 / (sqrt(mu * mu + stretch2) + mu);
}

/* After its only hit the ray must rise from where it is unblocked: exp(-t Lambda). Over all depths of a first
 * hit that is G = (1+L_i)/(1+L_i+L_o) for reflected, (1+L_i) B(1+L_i, 1+L_o) for refracted light. */
static void leave_at_once(const lq_walk_interface *f, lq_traveller *t) {
    lq_ray *ray = &t->ray;
    if (ray->z <= 0.0) ray->weight = 0.0;
    else if (ray->t > 0.0) ray->weight *= exp(-ray->t * area_below(f, t) / ray->z);
}

static void descend(const lq_walk_interface *f, lq_traveller *t, lq_stream *stream) {
    lq_ray_descend_in(&t->ray, -t->ray.z + area_below(f, t), stream);
}

static void meet_rough(const lq_walk_interface *f, lq_traveller *t, lq_stream *stream) {
    lq_ray *ray = &t->ray;
    ray->t = 0.0;
    ray->z = fmin(ray->z, f->opaque ? -NO_COSINE : -GRAZING);
    descend(f, t, stream);
    while (ray->weight > 0.0 && t->hits_left > 0) {
        const lq_facet m = draw_facet(f, t, stream);
        hit(f, t, &m, stream);
        if (f->once) {
            leave_at_once(f, t);
            return;
        }
        if (ray->z < 0.0) descend(f, t, stream);
        else if (lq_ray_rise_in(ray, area_below(f, t), stream)) return;
        lq_ray_roulette(ray, stream);
    }
}

/* One facet, level. */
static void meet_smooth(const lq_walk_interface *f, lq_traveller *t, lq_stream *stream) {
    const lq_facet m = {.z = 1.0, .cosine = fmin(-t->ray.z, 1.0)};
    hit(f, t, &m, stream);
}

static void meet_diffuse(const lq_walk_interface *f, lq_traveller *t, lq_stream *stream) {
    t->hits_left--;
    lq_walk_tint(t, f->rho);
    const double u = lq_stream_uniform(stream), phi = two_pi * lq_stream_uniform(stream);
    const double s = sqrt(u);
    head(t, s * cos(phi), s * sin(phi), sqrt(1.0 - u));
}

void lq_walk_meet(const lq_walk_interface *interface, lq_traveller *traveller, lq_stream *stream) {
    if (interface->diffuse) meet_diffuse(interface, traveller, stream);
    else if (interface->rough) meet_rough(interface, traveller, stream);
    else meet_smooth(interface, traveller, stream);
}

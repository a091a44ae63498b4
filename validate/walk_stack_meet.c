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

/* Sets the direction of travel. Its length is mended at every hit: a path of a million must not drift. */
static void head(lq_traveller *t, double x, double y, double z) {
    const double scale = 1.0 / sqrt(x * x + y * y + z * z);
    t->x = x * scale;
    t->y = y * scale;
    t->ray.z = z * scale;
    t->ray.s = sqrt(t->x * t->x + t->y * t->y);
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

/* A facet that the ray sees, turned from the ray's plane of incidence to x and y. The sampler leaves out
 * which side of that plane it leans to: a coin says. */
static lq_facet draw_facet(const lq_walk_interface *f, const lq_traveller *t, lq_stream *stream) {
    lq_facet m;
    lq_visible_sample(&f->visible, -t->ray.z, t->ray.s, stream, &m);
    m.cosine = fmin(m.cosine, 1.0);
    const double c = t->ray.s > 0.0 ? -t->x / t->ray.s : 1.0, s = t->ray.s > 0.0 ? -t->y / t->ray.s : 0.0;
    const double x = m.x, y = lq_stream_uniform(stream) < 0.5 ? m.y : -m.y;
    m.x = c * x - s * y;
    m.y = s * x + c * y;
    return m;
}

static void hit(const lq_walk_interface *f, lq_traveller *t, const lq_facet *m, lq_stream *stream) {
    t->hits_left--;
    if (f->opaque) {
        t->ray.weight *= lq_fresnel_conductor(m->cosine, f->n, f->kappa);
        reflect(t, m);
        return;
    }
    double cos_t;
    const double eta = f->eta[t->side];
    const double reflected = lq_fresnel_dielectric(m->cosine, eta, &cos_t);
    if (lq_stream_uniform(stream) < reflected) reflect(t, m);
    else refract(t, m, eta, cos_t);
}

/* After its only hit the ray must rise from where it is unblocked: exp(-t Lambda). Over all depths of a first
 * hit that is G = (1+L_i)/(1+L_i+L_o) for reflected, (1+L_i) B(1+L_i, 1+L_o) for refracted light. */
static void leave_at_once(const lq_walk_interface *f, lq_traveller *t) {
    lq_ray *ray = &t->ray;
    if (ray->z <= 0.0) ray->weight = 0.0;
    else if (ray->t > 0.0)
        ray->weight *= exp(-ray->t * f->ndf->area_below(f->ndf, f->alpha, ray->z, ray->s) / ray->z);
}

static void meet_rough(const lq_walk_interface *f, lq_traveller *t, lq_stream *stream) {
    lq_ray *ray = &t->ray;
    ray->t = 0.0;
    ray->z = fmin(ray->z, f->opaque ? -NO_COSINE : -GRAZING);
    lq_ray_descend(ray, f->ndf, f->alpha, stream);
    while (ray->weight > 0.0 && t->hits_left > 0) {
        const lq_facet m = draw_facet(f, t, stream);
        hit(f, t, &m, stream);
        if (f->once) {
            leave_at_once(f, t);
            return;
        }
        if (ray->z < 0.0) lq_ray_descend(ray, f->ndf, f->alpha, stream);
        else if (lq_ray_rise(ray, f->ndf, f->alpha, stream)) return;
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
    t->ray.weight *= f->rho;
    const double u = lq_stream_uniform(stream), phi = two_pi * lq_stream_uniform(stream);
    const double s = sqrt(u);
    head(t, s * cos(phi), s * sin(phi), sqrt(1.0 - u));
}

void lq_walk_meet(const lq_walk_interface *interface, lq_traveller *traveller, lq_stream *stream) {
    if (interface->diffuse) meet_diffuse(interface, traveller, stream);
    else if (interface->rough) meet_rough(interface, traveller, stream);
    else meet_smooth(interface, traveller, stream);
}

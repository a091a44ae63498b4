/* The hot loops of the solvers, built once per instruction set (see microfacet/kernels.h for how). */
#ifndef LACQUER_PRECOMPUTE_KERNELS_H
#define LACQUER_PRECOMPUTE_KERNELS_H

#include <stddef.h>

enum {
    LQ_LANES = 8,        /* materials that are solved together */
    LQ_NODES_MAX = 384,  /* cosines of the finest level */
    LQ_FACETS_MAX = 256, /* facets handed over at once */
    LQ_DEPTHS_LIMIT = 80 /* collocation depths of the finest level */
};

/* Eight doubles in GCC's vector extension: one zmm register, two ymm or four xmm. Always passed by pointer:
 * by value the calling convention would depend on the instruction set. */
typedef double lq_v8 __attribute__((vector_size(64)));

/* Where a cosine lies on the axis of the interpolation nodes:
 *     x = scale asinh(t / alpha) + shift,
 * t the cosine itself, or 2 tan(elevation/2) where `half_angle` is set; where `rooted` is set, the root of
 * asinh(t / alpha) takes its place. Where `root` is set, it is
 *     x = scale sqrt(root (cosine - from)) + shift,
 * root being 1 or -1. */
typedef struct lq_cosine_map {
    double inverse_alpha, scale, shift;
    int half_angle, rooted;
    int root;
    double from;
} lq_cosine_map;

/* The equation of one batch, A_d R + R A_u = S (conductor.c). Arrays of vectors hold one material a lane. */
typedef struct lq_sylvester {
    int nodes, curves;
    size_t stride; /* of one curve in the operators: nodes^2 rounded up to a multiple of 8 */
    /* Scatter operators of every curve: dd, du as [curve * stride + i * nodes + j], uu transposed,
     * [curve * stride + j * nodes + i], i the node scattered from and j the one scattered to. */
    const double *dd, *du, *uu;
    const double *a_down, *a_up;
    double negligible;         /* energy below which what remains after a bounce does not count */
    int loses;                 /* `ratio` is what is lost of the flux, not what leaves of what remains */
    const lq_v8 *coefficients; /* [curve] */
    lq_v8 *down, *source, *up; /* work, stride each */
    lq_v8 *r;                  /* nodes^2: start and solution */
} lq_sylvester;

/* Cosines at which a solution is read. */
typedef struct lq_readout {
    size_t count;
    const double *escaping;  /* [mu * curves + k]: first bounce, leaves at once */
    const double *remaining; /* likewise: first bounce, hits again */
    const double *weights;   /* [mu * nodes + i]: interpolation from the nodes */
} lq_readout;

/* One side of a dielectric (dielectric.c). E and C at depth k: [k * 2 nodes + q], q rising, then falling. */
typedef struct lq_two_sided {
    int nodes, depths;
    const double *fall, *rise; /* rows of 4 nodes: own rising, own falling, other rising, falling */
    const double *travel_down, *travel_up; /* [(node * depths + from) * depths + at] */
    lq_v8 *own;                            /* E of this side */
    const lq_v8 *other;                    /* E of the other side, whose depths count backwards */
    lq_v8 *before;                         /* C of this side */
    const lq_v8 *reward;                   /* [rising node] */
    lq_v8 *mirrored;                       /* of packed depths: see travel_packed */
} lq_two_sided;

typedef struct lq_solver_kernels {
    /* Chebyshev moments: moments[m] += sum_i weight[i] T_m(x(cosine[i])), m < count_moments. */
    void (*moments)(const lq_cosine_map *map, size_t count, const double *cosine, const double *weight,
                    int count_moments, double *moments);
    /* The same of three weights, weight[k][i], to moments[k]. */
    void (*moments3)(const lq_cosine_map *map, size_t count, const double *cosine,
                     const double *const *weight, int count_moments, double *const *moments);
    /* Of the facets of a fan that reflect upwards, the weight that leaves at once: sum w G with
     * G = area_in mu_o / (area_in mu_o + area mu_i), area[i] the facets that block direction i. */
    double (*escaping)(double area_in, double mu_i, size_t count, const double *mu_o, const double *area,
                       const double *weight);
    /* sums[k * moments + m] += curve[k] * moment[m] */
    void (*spread)(int curves, const double *curve, int moments, const double *moment, double *sums);
    /* Operators of a batch from those of the curves; one Gauss-Seidel sweep, returning the largest change
     * over all lanes; the fraction of the flux that hits twice or more that leaves (or where it `loses`,
     * the flux that hits twice or more and does not), at every node; the energy at the cosines of a
     * readout. */
    void (*assemble)(const lq_sylvester *s);
    double (*sweep)(const lq_sylvester *s);
    void (*survival)(const lq_sylvester *s, lq_v8 *ratio);
    /* E of one side from C, returning the largest change; survival[depth * nodes + j] = u^Lambda. C from E.
     */
    double (*travel)(const lq_two_sided *s, const double *survival);
    void (*meet)(const lq_two_sided *s);
    /* The same of one reward, reward[node][0], whose depths are packed into lanes: depth 8 b + l of E and C
     * is [b * 2 nodes + q][l], and no lane beyond the last depth is ever other than 0. `mirrored` gets E once
     * more, its depths backwards in blocks that count backwards: as `other`, `meet` of ceil(depths / 8)
     * depths takes it for what it is. Rows of weights are read to the end of a vector. */
    double (*travel_packed)(const lq_two_sided *s, const double *survival);
    /* out[q] = sum_k arrival[k] e[k * directions + q], or with the depths backwards. */
    void (*average)(int depths, int directions, const double *arrival, int backwards, const lq_v8 *e,
                    lq_v8 *out);
    /* out: the sum of weights[k * nodes + j] c[k * 2 nodes + j]. */
    void (*contract)(int depths, int nodes, const double *weights, const lq_v8 *c, lq_v8 *out);
    /* out += sum over k and j of arrival[k] weight[j] c[k * 2 nodes + j], the arrival read backwards or not.
     */
    void (*arrive)(int depths, int nodes, const double *arrival, int backwards, const double *weight,
                   const lq_v8 *c, lq_v8 *out);
    void (*read)(const lq_readout *readout, const lq_sylvester *s, const lq_v8 *ratio, lq_v8 *energy);
} lq_solver_kernels;

const lq_solver_kernels *lq_solver_kernels_get(void);
const lq_solver_kernels *lq_precompute_kernels_base(void);
const lq_solver_kernels *lq_precompute_kernels_avx2(void);
const lq_solver_kernels *lq_precompute_kernels_avx512(void);

#endif

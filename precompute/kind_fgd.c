/* `fgd`: directional albedo of a rough conductor, single scattering or all orders (B18 eq. 2 and sec. 4.1).
 */
#include "precompute/conductor.h"
#include "precompute/first_bounce.h"
#include "precompute/kinds.h"
#include "system/status.h"

#include "microfacet/fresnel.h"

#include <math.h>
#include <stdlib.h>

enum { MU, ALPHA, N, KAPPA };

/* Materials are taken in blocks that share a basis of Fresnel curves: enough to make the basis pay, few
 * enough to keep its work space (a few thousand doubles a material) small beside the table. */
enum { BLOCK = 4096 };

typedef struct state {
    size_t block_count;
    double *n, *kappa; /* of every material, n fastest */
    lq_conductors *blocks;
} state;

static void release(void *p) {
    state *s = p;
    if (!s) return;
    for (size_t b = 0; s->blocks && b < s->block_count; b++) lq_conductors_free(&s->blocks[b]);
    free(s->blocks);
    free(s->n);
    free(s->kappa);
    free(s);
}

static void list_materials(const lq_job *job, state *s) {
    for (size_t k = 0; k < job->size[KAPPA]; k++)
        for (size_t n = 0; n < job->size[N]; n++) {
            s->n[k * job->size[N] + n] = job->nodes[N][n];
            s->kappa[k * job->size[N] + n] = job->nodes[KAPPA][k];
        }
}

static lq_status prepare(const lq_job *job, void **out, lq_error *error) {
    const size_t count = job->size[N] * job->size[KAPPA];
    state *s = calloc(1, sizeof *s);
    *out = s;
    if (s) {
        s->block_count = (count + BLOCK - 1) / BLOCK;
        s->n = malloc(count * sizeof *s->n);
        s->kappa = malloc(count * sizeof *s->kappa);
        s->blocks = calloc(s->block_count, sizeof *s->blocks);
    }
    if (!s || !s->n || !s->kappa || !s->blocks)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", count);
    list_materials(job, s);
    for (size_t b = 0; b < s->block_count; b++) {
        const size_t first = b * BLOCK, left = count - first;
        const lq_status status =
            lq_conductors_make(&s->blocks[b], s->n + first, s->kappa + first, left < BLOCK ? left : BLOCK,
                               0.01 * job->tolerance, error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

/* How much an error common to all curves can grow when they are combined. */
static double amplification(const lq_conductors *materials) {
    const size_t curves = (size_t)materials->curves.count;
    double most = 0.0;
    for (size_t i = 0; i < materials->count; i++) {
        double sum = 1.0;
        for (size_t k = 1; k < curves; k++) sum += fabs(materials->coefficients[i * curves + k]);
        most = fmax(most, sum);
    }
    return most;
}

/* Single scattering of every material: the curves' integrals, combined. */
static lq_status single_energies(const lq_job *job, double alpha, const lq_conductors *materials,
                                 double *energy, double *estimate, lq_error *error) {
    const size_t curves = (size_t)materials->curves.count, mus = job->size[MU];
    double *first = malloc(mus * curves * sizeof *first);
    if (!first) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mus);
    *estimate = lq_smooth_masking_error(alpha, job->nodes[MU], mus) + 1e-15;
    if (alpha >= LQ_SMOOTH_ALPHA) {
        const double factor = amplification(materials);
        *estimate =
            factor * lq_first_bounce_converged(job->ndf, alpha, job->masking, job->nodes[MU], mus,
                                               &materials->curves, 0.9 * job->tolerance / factor, first) +
            materials->missed;
    }
    for (size_t i = 0; i < materials->count; i++) {
        const double *c = materials->coefficients + i * curves;
        for (size_t m = 0; m < mus; m++) {
            double value = alpha < LQ_SMOOTH_ALPHA
                               ? lq_fresnel_conductor(job->nodes[MU][m], materials->n[i], materials->kappa[i])
                               : first[m * curves];
            for (size_t k = 1; alpha >= LQ_SMOOTH_ALPHA && k < curves; k++)
                value -= c[k] * first[m * curves + k];
            energy[i * mus + m] = fmin(fmax(value, 0.0), 1.0);
        }
    }
    free(first);
    return LQ_OK;
}

static lq_status slice(const lq_job *job, const void *p, size_t index, double *const *values,
                       double *estimate, lq_error *error) {
    const state *s = p;
    const double alpha = job->nodes[ALPHA][index];
    *estimate = 0.0;
    for (size_t b = 0; b < s->block_count; b++) {
        double *energy = values[0] + b * BLOCK * job->size[MU], largest = 0.0;
        const lq_status status =
            job->scattering == LQ_MULTIPLE
                ? lq_conductor_energies(job->ndf, alpha, &s->blocks[b], job->nodes[MU], job->size[MU],
                                        job->tolerance, energy, &largest, error)
                : single_energies(job, alpha, &s->blocks[b], energy, &largest, error);
        if (status != LQ_OK) return status;
        *estimate = fmax(*estimate, largest);
    }
    return LQ_OK;
}

const lq_evaluator lq_evaluate_fgd = {"fgd", ALPHA, 1.0, prepare, slice, release};

lq_status lq_eval_orders(const lq_settings *settings, const double *point, size_t count, double *energies,
                         lq_error *error) {
    const lq_kind *kind = lq_kind_find("fgd", error);
    const size_t size[LQ_MAX_AXES] = {1, 1, 1, 1};
    const double *nodes[LQ_MAX_AXES] = {point, point + 1, point + 2, point + 3};
    lq_job job;
    lq_status status = lq_job_make(&job, kind, settings, size, nodes, error);
    if (status != LQ_OK) return status;
    lq_conductors material;
    status = lq_job_prepare(&job, &lq_evaluate_fgd, 0, error);
    if (status == LQ_OK) status = lq_conductors_make(&material, point + N, point + KAPPA, 1, 1e-14, error);
    if (status == LQ_OK) {
        status = lq_conductor_orders(job.ndf, point[ALPHA], &material, point[MU], count, energies, error);
        lq_conductors_free(&material);
    }
    lq_job_free(&job);
    return status;
}

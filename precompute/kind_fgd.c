/* `fgd`: directional albedo of a rough conductor, single scattering or all orders (B18 eq. 2 and sec. 4.1).
 */
#include "precompute/conductor.h"
#include "precompute/first_bounce.h"
#include "precompute/index_cells.h"
#include "precompute/kinds.h"
#include "system/status.h"

#include "microfacet/fresnel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MU, ALPHA, N, KAPPA };

/* Materials are taken in blocks that share a basis of Fresnel curves: enough to make the basis pay, few
 * enough to keep its work space (a few thousand doubles a material) small beside the table. */
enum { BLOCK = 4096 };

/* What interpolation between indices may leave out at least, and along each of them. */
static const double INTERPOLATION = 0.2, ALONG_ONE = 0.1;

typedef struct state {
    lq_index_cells cells;
    size_t block_count;
    lq_conductors *blocks; /* one after the other, the materials of the cells */
} state;

static void release(void *p) {
    state *s = p;
    if (!s) return;
    for (size_t b = 0; s->blocks && b < s->block_count; b++) lq_conductors_free(&s->blocks[b]);
    free(s->blocks);
    lq_index_cells_free(&s->cells);
    free(s);
}

/* Blocks of the materials up to `end`, which are solved to one tolerance. */
static lq_status make_blocks(const lq_job *job, state *s, size_t first, size_t end, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t count; status == LQ_OK && first < end; first += count) {
        count = end - first < BLOCK ? end - first : BLOCK;
        status = lq_conductors_make(&s->blocks[s->block_count++], s->cells.n + first, s->cells.kappa + first,
                                    count, 0.01 * job->tolerance, error);
    }
    return status;
}

static lq_status prepare(const lq_job *job, void **out, lq_error *error) {
    const size_t count = job->size[N] * job->size[KAPPA];
    state *s = calloc(1, sizeof *s);
    *out = s;
    if (!s) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", count);
    lq_status status = lq_index_cells_make(&s->cells, job->nodes[N], job->size[N], job->nodes[KAPPA],
                                           job->size[KAPPA], ALONG_ONE * job->tolerance, error);
    if (status != LQ_OK) return status;
    s->blocks = calloc(s->cells.count / BLOCK + 2, sizeof *s->blocks);
    if (!s->blocks) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", s->cells.count);
    status = make_blocks(job, s, 0, s->cells.nodes, error);
    return status == LQ_OK ? make_blocks(job, s, s->cells.nodes, s->cells.count, error) : status;
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
                                 double tolerance, double *energy, double *estimate, lq_error *error) {
    const size_t curves = (size_t)materials->curves.count, mus = job->size[MU];
    double *first = malloc(mus * curves * sizeof *first);
    if (!first) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mus);
    *estimate = lq_smooth_masking_error(alpha, job->nodes[MU], mus) + 1e-15;
    if (alpha >= LQ_SMOOTH_ALPHA) {
        const double factor = amplification(materials);
        *estimate = factor * lq_first_bounce_converged(job->ndf, alpha, job->masking, job->nodes[MU], mus,
                                                       &materials->curves, 0.9 * tolerance / factor, first) +
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

static lq_status solve(const lq_job *job, double alpha, const lq_conductors *materials, double tolerance,
                       double *energy, double *estimate, lq_error *error) {
    if (job->scattering == LQ_SINGLE)
        return single_energies(job, alpha, materials, tolerance, energy, estimate, error);
    return lq_conductor_energies(job->ndf, alpha, materials, job->nodes[MU], job->size[MU], tolerance, energy,
                                 estimate, error);
}

/* energy[material * mus + m] of what the cells ask for, and the largest estimate of those that are nodes of
 * the table, 0, and of those that are interpolated between, 1. */
static lq_status solve_blocks(const lq_job *job, const state *s, double alpha, double *energy,
                              double estimate[2], lq_error *error) {
    lq_status status = LQ_OK;
    size_t first = 0;
    estimate[0] = estimate[1] = 0.0;
    for (size_t b = 0; status == LQ_OK && b < s->block_count; b++) {
        const bool between = first >= s->cells.nodes;
        const double tolerance = (between ? 1.0 - INTERPOLATION : 1.0) * job->tolerance;
        double largest = 0.0;
        status = solve(job, alpha, &s->blocks[b], tolerance, energy + first * job->size[MU], &largest, error);
        estimate[between] = fmax(estimate[between], largest);
        first += s->blocks[b].count;
    }
    return status;
}

/* The nodes of a cell as they are, where its points do not suffice at this roughness. */
static lq_status solve_cell(const lq_job *job, double alpha, const lq_index_cell *cell, double *values,
                            double *estimate, lq_error *error) {
    const size_t mus = job->size[MU], along = cell->n.count, count = along * cell->kappa.count;
    double *n = malloc((2 + mus) * count * sizeof *n), *kappa = n + count, *energy = n + 2 * count;
    lq_conductors materials = {0};
    if (!n) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", count);
    for (size_t i = 0; i < count; i++) {
        n[i] = cell->n.nodes[i % along];
        kappa[i] = cell->kappa.nodes[i / along];
    }
    lq_status status = lq_conductors_make(&materials, n, kappa, count, 0.01 * job->tolerance, error);
    if (status == LQ_OK) status = solve(job, alpha, &materials, job->tolerance, energy, estimate, error);
    for (size_t i = 0; status == LQ_OK && i < count; i++) {
        const size_t at = (cell->kappa.begin + i / along) * job->size[N] + cell->n.begin + i % along;
        memcpy(values + at * mus, energy + i * mus, mus * sizeof *values);
    }
    lq_conductors_free(&materials);
    free(n);
    return status;
}

/* One cell of the table, and what it may be off by: `solves`, those of its points. */
static lq_status fill_cell(const lq_job *job, const state *s, double alpha, const lq_index_cell *cell,
                           const double *energy, double solves, double *values, double *estimate,
                           lq_error *error) {
    const double missing = lq_index_cell_missing(cell, energy, job->size[MU]);
    *estimate = solves + missing;
    if (missing <= fmax(INTERPOLATION * job->tolerance, job->tolerance - solves))
        return lq_index_cell_expand(&s->cells, cell, energy, job->size[MU], values, error);
    return solve_cell(job, alpha, cell, values, estimate, error);
}

static lq_status slice(const lq_job *job, const void *p, size_t index, double *const *values,
                       double *estimate, lq_error *error) {
    const state *s = p;
    const double alpha = job->nodes[ALPHA][index];
    double *energy = malloc(s->cells.count * job->size[MU] * sizeof *energy), solves[2];
    lq_status status = energy ? solve_blocks(job, s, alpha, energy, solves, error)
                              : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", s->cells.count);
    *estimate = 0.0;
    for (int c = 0; status == LQ_OK && c < s->cells.cells; c++) {
        const lq_index_cell *cell = &s->cells.cell[c];
        double largest = 0.0;
        status = fill_cell(job, s, alpha, cell, energy, solves[!lq_index_cell_is_direct(cell)], values[0],
                           &largest, error);
        *estimate = fmax(*estimate, largest);
    }
    free(energy);
    return status;
}

const lq_evaluator lq_evaluate_fgd = {"fgd", ALPHA, 10.0, prepare, slice, release};

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

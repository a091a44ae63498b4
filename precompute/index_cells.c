/* index_cells.c - which indices are solved, and those between. */
#include "precompute/index_cells.h"

#include "system/status.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Where cells end: a cell much longer than it is far from the branch points would take more points than two.
 */
static const double n_edges[] = {0.0, 1.2, 4.0, 13.0, 40.0, 100.0};
static const double kappa_edges[] = {0.0, 0.5, 4.0, 13.0, 40.0, 100.0};
enum { EDGES = sizeof n_edges / sizeof n_edges[0] };

/* ======================================================================================
 *                                        Points
 * ====================================================================================== */

/* The sum of half axes of the ellipse around [from, to] through a singularity (T13, ch. 8). */
static double ellipse_through(double from, double to, double real, double imaginary) {
    const double half = 0.5 * (to - from);
    const double complex z = (real - 0.5 * (from + to) + imaginary * I) / half, root = csqrt(z * z - 1.0);
    return fmax(cabs(z + root), cabs(z - root));
}

/* Along n at the smallest kappa of a cell branch points lie at s + i kappa, s in [-1, 1]. */
static double ellipse_of_n(const lq_cell_side *n, double kappa) {
    enum { SINES = 21 };
    double least = INFINITY;
    for (int i = 0; i < SINES; i++)
        least = fmin(
            least, ellipse_through(n->nodes[0], n->nodes[n->count - 1], -1.0 + 2.0 * i / (SINES - 1), kappa));
    return least;
}

/* Along kappa at the smallest n of a cell they lie at i (n - s). */
static double ellipse_of_kappa(const lq_cell_side *kappa, double n) {
    return ellipse_through(kappa->nodes[0], kappa->nodes[kappa->count - 1], 0.0, fmax(n - 1.0, 0.0));
}

/* Coefficient m of fgd is SCALE rho^-m and less. */
static void choose_series(lq_cell_side *side, double rho, double accuracy) {
    static const double SCALE = 0.1;
    const double points = rho > 1.05 ? ceil(1.0 + log(SCALE / accuracy) / log(rho)) : INFINITY;
    if (side->count <= LQ_SERIES_MIN || !(points < (double)side->count) || points > LQ_SERIES_MAX) return;
    side->series =
        (lq_series){(size_t)fmax(points, LQ_SERIES_MIN), side->nodes[0], side->nodes[side->count - 1]};
}

static size_t points_of(const lq_cell_side *side) {
    return side->series.nodes ? side->series.nodes : side->count;
}

static double point_at(const lq_cell_side *side, size_t i) {
    if (!side->series.nodes) return side->nodes[i];
    return fmin(fmax(lq_series_node(&side->series, i), side->series.from), side->series.to);
}

/* ======================================================================================
 *                                        Cells
 * ====================================================================================== */

/* The nodes of an axis in (edge i, edge i + 1], the first edge included. */
static lq_cell_side side_of(const double *nodes, size_t size, const double *edges, int i) {
    size_t begin = 0, end;
    while (i > 0 && begin < size && nodes[begin] <= edges[i]) begin++;
    for (end = begin; end < size && nodes[end] <= edges[i + 1];) end++;
    return (lq_cell_side){.nodes = nodes + begin, .count = end - begin, .begin = begin};
}

bool lq_index_cell_is_direct(const lq_index_cell *cell) {
    return !cell->n.series.nodes && !cell->kappa.series.nodes;
}

/* The cell between edges, if it is of the kind that is being added. */
static void add_cell(lq_index_cells *cells, const lq_cell_side *n, const lq_cell_side *kappa, bool near,
                     double accuracy, bool direct) {
    lq_index_cell cell = {*n, *kappa, cells->count};
    if (n->count == 0 || kappa->count == 0) return;
    if (!near && n->count > 1) choose_series(&cell.n, ellipse_of_n(n, kappa->nodes[0]), accuracy);
    if (!near && kappa->count > 1) choose_series(&cell.kappa, ellipse_of_kappa(kappa, n->nodes[0]), accuracy);
    if (lq_index_cell_is_direct(&cell) != direct) return;
    cells->count += points_of(&cell.n) * points_of(&cell.kappa);
    cells->cell[cells->cells++] = cell;
}

static void add_cells(lq_index_cells *cells, const double *n, const double *kappa, size_t kappa_size,
                      double accuracy, bool direct) {
    for (int k = 0; k + 1 < EDGES; k++)
        for (int i = 0; i + 1 < EDGES; i++) {
            const lq_cell_side along_n = side_of(n, cells->n_size, n_edges, i);
            const lq_cell_side along_kappa = side_of(kappa, kappa_size, kappa_edges, k);
            add_cell(cells, &along_n, &along_kappa, i == 0 && k == 0, accuracy, direct);
        }
}

static void list_materials(lq_index_cells *cells) {
    for (int c = 0; c < cells->cells; c++) {
        const lq_index_cell *cell = &cells->cell[c];
        const size_t along = points_of(&cell->n);
        for (size_t i = 0; i < along * points_of(&cell->kappa); i++) {
            cells->n[cell->first + i] = point_at(&cell->n, i % along);
            cells->kappa[cell->first + i] = point_at(&cell->kappa, i / along);
        }
    }
}

lq_status lq_index_cells_make(lq_index_cells *cells, const double *n, size_t n_size, const double *kappa,
                              size_t kappa_size, double accuracy, lq_error *error) {
    *cells = (lq_index_cells){.n_size = n_size};
    add_cells(cells, n, kappa, kappa_size, accuracy, true);
    cells->nodes = cells->count;
    add_cells(cells, n, kappa, kappa_size, accuracy, false);
    cells->n = malloc(cells->count * sizeof *cells->n);
    cells->kappa = malloc(cells->count * sizeof *cells->kappa);
    if (!cells->n || !cells->kappa)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu materials", cells->count);
    list_materials(cells);
    return LQ_OK;
}

void lq_index_cells_free(lq_index_cells *cells) {
    free(cells->n);
    free(cells->kappa);
}

/* ======================================================================================
 *                                    Interpolation
 * ====================================================================================== */

/* Of the lines of a cell along one side: `lines` of them, `apart` from each other, their points `step` apart,
 * counted in materials. */
static double missing_along(const lq_cell_side *side, const double *energy, size_t lines, size_t apart,
                            size_t step, size_t mu_count) {
    const double *at_node[LQ_SERIES_MAX];
    double most = 0.0;
    for (size_t line = 0; side->series.nodes && line < lines; line++) {
        for (size_t k = 0; k < side->series.nodes; k++)
            at_node[k] = energy + (line * apart + k * step) * mu_count;
        most = fmax(most, lq_series_missing(&side->series, at_node, mu_count));
    }
    return most;
}

double lq_index_cell_missing(const lq_index_cell *cell, const double *energy, size_t mu_count) {
    const double *own = energy + cell->first * mu_count;
    const size_t n = points_of(&cell->n), kappa = points_of(&cell->kappa);
    return missing_along(&cell->n, own, kappa, n, 1, mu_count) +
           missing_along(&cell->kappa, own, n, 1, n, mu_count);
}

/* to[i] = sum over points k of the side, weighing with those of one node, of from[k * step + i]. */
static void combine(const lq_cell_side *side, size_t node, const double *from, size_t step, double *to) {
    double weight[LQ_SERIES_MAX];
    if (!side->series.nodes) {
        memcpy(to, from + node * step, step * sizeof *to);
        return;
    }
    lq_series_weights(&side->series, side->nodes[node], weight);
    memset(to, 0, step * sizeof *to);
    for (size_t k = 0; k < side->series.nodes; k++)
        for (size_t i = 0; i < step; i++) to[i] += weight[k] * from[k * step + i];
}

lq_status lq_index_cell_expand(const lq_index_cells *cells, const lq_index_cell *cell, const double *energy,
                               size_t mu_count, double *values, lq_error *error) {
    const size_t row = points_of(&cell->n) * mu_count;
    double *of_kappa = malloc(row * sizeof *of_kappa);
    if (!of_kappa) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu cosines", mu_count);
    for (size_t k = 0; k < cell->kappa.count; k++) {
        double *to = values + ((cell->kappa.begin + k) * cells->n_size + cell->n.begin) * mu_count;
        combine(&cell->kappa, k, energy + cell->first * mu_count, row, of_kappa);
        for (size_t n = 0; n < cell->n.count; n++)
            combine(&cell->n, n, of_kappa, mu_count, to + n * mu_count);
        for (size_t i = 0; i < cell->n.count * mu_count; i++) to[i] = fmin(fmax(to[i], 0.0), 1.0);
    }
    free(of_kappa);
    return LQ_OK;
}

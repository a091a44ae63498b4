/* lobes_measure.c - exact materials at points off the grid, solved in one loop. */
#include "pack/lobes_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pack/measure.h"
#include "system/parallel.h"
#include "system/status.h"

typedef struct solving {
    lq_lobes_exact *exact;
    int level;
    double tolerance;
    const lq_spread *spread;
} solving;

/* Where the fractional parts of multiples of irrational numbers fall: evenly, and on no grid. */
static double fraction(size_t i, int r) {
    static const double steps[LQ_MATERIAL_RANGES] = {0.7548776662466927, 0.5698402909980532};
    const double x = 0.5 + (double)i * steps[r];
    return x - floor(x);
}

static void values_of(const lq_material *m, size_t set, double *values) {
    for (int r = 0; r < m->range_count; r++) {
        const double u = fraction(set, r); /* small roughnesses matter more than their share of the range */
        const double share = m->ranges[r].roughness ? u * u : u;
        values[r] = m->ranges[r].min + (m->ranges[r].max - m->ranges[r].min) * share;
    }
}

/* Nothing is open: one set says all. */
static size_t sets_of(const lq_lobes_exact *exact, size_t material) {
    return exact->materials[material]->range_count > 0 ? exact->sets : 1;
}

static double *numbers_of(const lq_lobes_exact *exact, size_t material, size_t set) {
    return exact->numbers + (material * exact->sets + set) * LQ_EXACT_COSINES * LQ_MATERIAL_NUMBERS;
}

static lq_status solve_set(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const solving *s = user;
    const lq_lobes_exact *exact = s->exact;
    const size_t material = turn / exact->sets, set = turn % exact->sets;
    double values[LQ_MATERIAL_RANGES] = {0.0};
    if (set >= sets_of(exact, material)) return LQ_OK;
    values_of(exact->materials[material], set, values);
    return lq_material_solve(exact->materials[material], values, s->spread, exact->mu, LQ_EXACT_COSINES,
                             s->level, s->tolerance, numbers_of(exact, material, set), error);
}

/* Cosines between those of any grid, denser towards grazing light; and 1, for the spread. */
static lq_status prepare(lq_lobes_exact *exact, lq_spread *spread, lq_error *error) {
    double mu[LQ_EXACT_COSINES + 1];
    for (int i = 0; i < LQ_EXACT_COSINES; i++) {
        const double u = (i + 0.5) / LQ_EXACT_COSINES;
        mu[i] = exact->mu[i] = LQ_MATERIAL_FROM + (1.0 - LQ_MATERIAL_FROM) * u * u;
    }
    mu[LQ_EXACT_COSINES] = 1.0;
    const size_t points = exact->count * exact->sets * LQ_EXACT_COSINES;
    exact->numbers = calloc(points * LQ_MATERIAL_NUMBERS + 1, sizeof *exact->numbers);
    if (!exact->numbers) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu points", points);
    return lq_spread_make(spread, mu, LQ_EXACT_COSINES + 1, error);
}

lq_status lq_lobes_exact_make(lq_lobes_exact *exact, const lq_material *const *materials, size_t count,
                              size_t sets, int level, double tolerance, int threads,
                              const lq_progress *progress, lq_error *error) {
    lq_spread spread = {0};
    *exact = (lq_lobes_exact){.materials = materials, .count = count, .sets = sets};
    solving s = {exact, level, tolerance, &spread};
    lq_status status = prepare(exact, &spread, error);
    if (status == LQ_OK) status = lq_parallel(count * sets, threads, solve_set, &s, progress, error);
    lq_spread_free(&spread);
    return status;
}

void lq_lobes_exact_free(lq_lobes_exact *exact) {
    free(exact->numbers);
    *exact = (lq_lobes_exact){0};
}

/* ======================================================================================
 *                                       Errors
 * ====================================================================================== */

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The errors of one set, after the `count` there are; where the largest of all is goes to `measure`. */
static size_t compare_set(const lq_lobes_exact *exact, size_t material, size_t set, const lq_lobes *lobes,
                          double *errors, size_t count, lq_lobes_measure *measure) {
    double values[LQ_MATERIAL_RANGES] = {0.0}, numbers[LQ_MATERIAL_NUMBERS];
    const double *truth = numbers_of(exact, material, set);
    values_of(lobes->material, set, values);
    for (size_t i = 0; i < LQ_EXACT_COSINES; i++) {
        lq_lobes_sample(lobes, exact->mu[i], values, LQ_FILTER_BITS, numbers);
        const size_t added =
            lq_lobes_compare(lobes->material, numbers, truth + i * LQ_MATERIAL_NUMBERS, errors + count);
        for (size_t e = count; e < count + added; e++) {
            if (errors[e] <= measure->max) continue;
            measure->max = errors[e];
            measure->worst[0] = exact->mu[i];
            memcpy(measure->worst + 1, values, sizeof values);
        }
        count += added;
    }
    return count;
}

lq_status lq_lobes_measure_one(const lq_lobes_exact *exact, size_t i, const lq_lobes *lobes,
                               lq_lobes_measure *measure, lq_error *error) {
    const size_t sets = sets_of(exact, i);
    double *errors = malloc((sets * LQ_EXACT_COSINES * LQ_LOBES_ERRORS + 1) * sizeof *errors), sum = 0.0;
    size_t count = 0;
    if (!errors) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu sets", sets);
    *measure = (lq_lobes_measure){.points = sets * LQ_EXACT_COSINES, .max = -1.0};
    for (size_t set = 0; set < sets; set++) count = compare_set(exact, i, set, lobes, errors, count, measure);
    for (size_t e = 0; e < count; e++) sum += errors[e] * errors[e];
    qsort(errors, count, sizeof *errors, ascending);
    measure->max = fmax(measure->max, 0.0);
    measure->rms = count > 0 ? sqrt(sum / (double)count) : 0.0;
    measure->p99 = count > 0 ? errors[(size_t)ceil(0.99 * (double)count) - 1] : 0.0;
    free(errors);
    return LQ_OK;
}

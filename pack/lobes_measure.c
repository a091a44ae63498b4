/* lobes_measure.c - exact materials at points off the grid, solved in one loop. */
#include "pack/lobes_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/parallel.h"
#include "system/status.h"

enum { COSINES = 48, FILTER_BITS = 8 };

typedef struct measuring {
    const lq_lobes *lobes;
    size_t count, sets;
    int level;
    double tolerance;
    const lq_spread *spread;
    double mu[COSINES];
    double *errors; /* [((material * sets + set) * COSINES + m) * LQ_LOBES_ERRORS + e] */
    size_t *counts; /* of each point */
    double *numbers;
} measuring;

/* Where the fractional parts of multiples of irrational numbers fall: evenly, and on no grid. */
static double fraction(size_t i, int r) {
    static const double steps[LQ_MATERIAL_RANGES] = {0.7548776662466927, 0.5698402909980532};
    const double x = 0.5 + (double)i * steps[r];
    return x - floor(x);
}

static void values_of(const lq_material *m, size_t set, double *values) {
    for (int r = 0; r < m->range_count; r++) {
        const double u = fraction(set, r); /* small roughnesses matter more than their share of the range */
        values[r] =
            m->ranges[r].min + (m->ranges[r].max - m->ranges[r].min) * (m->ranges[r].roughness ? u * u : u);
    }
}

static lq_status measure_set(void *user, size_t turn, int thread, lq_error *error) {
    (void)thread;
    const measuring *m = user;
    const lq_lobes *lobes = &m->lobes[turn / m->sets];
    double values[LQ_MATERIAL_RANGES] = {0.0}, numbers[LQ_MATERIAL_NUMBERS];
    double *exact = m->numbers + turn * COSINES * LQ_MATERIAL_NUMBERS;
    if (lobes->material->range_count == 0 && turn % m->sets > 0) return LQ_OK; /* nothing is open: one set */
    values_of(lobes->material, turn % m->sets, values);
    const lq_status status = lq_material_solve(lobes->material, values, m->spread, m->mu, COSINES, m->level,
                                               m->tolerance, exact, error);
    for (size_t i = 0; i < COSINES && (status == LQ_OK || status == LQ_NOT_CONVERGED); i++) {
        lq_lobes_sample(lobes, m->mu[i], values, FILTER_BITS, numbers);
        m->counts[turn * COSINES + i] =
            lq_lobes_compare(lobes->material, numbers, exact + i * LQ_MATERIAL_NUMBERS,
                             m->errors + (turn * COSINES + i) * LQ_LOBES_ERRORS);
    }
    return status;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void summarise(const measuring *m, size_t material, lq_lobes_measure *measure) {
    const lq_material *of = m->lobes[material].material;
    const size_t first = material * m->sets * COSINES;
    double *errors = m->errors + first * LQ_LOBES_ERRORS, sum = 0.0;
    size_t count = 0;
    *measure = (lq_lobes_measure){.points = (of->range_count ? m->sets : 1) * COSINES, .max = -1.0};
    for (size_t i = 0; i < measure->points; i++)
        for (size_t e = 0; e < m->counts[first + i]; e++) {
            const double error = errors[i * LQ_LOBES_ERRORS + e];
            sum += error * error;
            errors[count++] = error; /* moved together: count never passes what is read */
            if (error <= measure->max) continue;
            measure->max = error;
            measure->worst[0] = m->mu[i % COSINES];
            values_of(of, i / COSINES, measure->worst + 1);
        }
    qsort(errors, count, sizeof *errors, ascending);
    measure->max = fmax(measure->max, 0.0);
    measure->rms = count > 0 ? sqrt(sum / (double)count) : 0.0;
    measure->p99 = count > 0 ? errors[(size_t)ceil(0.99 * (double)count) - 1] : 0.0;
}

/* Cosines between those of any grid, denser towards grazing light. */
static lq_status prepare(measuring *m, lq_spread *spread, lq_error *error) {
    double mu[COSINES + 1];
    for (int i = 0; i < COSINES; i++) {
        const double u = (i + 0.5) / COSINES;
        mu[i] = m->mu[i] = LQ_MATERIAL_FROM + (1.0 - LQ_MATERIAL_FROM) * u * u;
    }
    mu[COSINES] = 1.0;
    const size_t turns = m->count * m->sets + 1;
    m->errors = calloc(turns * COSINES * LQ_LOBES_ERRORS, sizeof *m->errors);
    m->counts = calloc(turns * COSINES, sizeof *m->counts);
    m->numbers = malloc(turns * COSINES * LQ_MATERIAL_NUMBERS * sizeof *m->numbers);
    if (!m->errors || !m->counts || !m->numbers)
        return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu stacks", turns);
    return lq_spread_make(spread, mu, COSINES + 1, error);
}

lq_status lq_lobes_measure_all(const lq_lobes *lobes, size_t count, size_t sets, int level, double tolerance,
                               int threads, const lq_progress *progress, lq_lobes_measure *measures,
                               lq_error *error) {
    lq_spread spread = {0};
    measuring m = {.lobes = lobes,
                   .count = count,
                   .sets = sets,
                   .level = level,
                   .tolerance = tolerance,
                   .spread = &spread};
    lq_status status = prepare(&m, &spread, error);
    if (status == LQ_OK) status = lq_parallel(count * sets, threads, measure_set, &m, progress, error);
    for (size_t i = 0; i < count && (status == LQ_OK || status == LQ_NOT_CONVERGED); i++)
        summarise(&m, i, &measures[i]);
    lq_spread_free(&spread);
    free(m.errors);
    free(m.counts);
    free(m.numbers);
    return status;
}

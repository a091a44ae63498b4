/* pile.c - layers of a chain added; equal ones by doubling. */
#include "stack/pile.h"

#include <stdlib.h>
#include <string.h>

#include "system/status.h"

static lq_status no_memory(lq_error *error) {
    return lq_fail(error, LQ_NO_MEMORY, "no memory to put layers together");
}

lq_status lq_pile_make(lq_pile *pile, const lq_plan_chain *chain, lq_error *error) {
    *pile = (lq_pile){.chain = chain,
                      .block = calloc(chain->steps, sizeof *pile->block),
                      .crossing = calloc(chain->steps + 1, sizeof *pile->crossing)};
    return pile->block && pile->crossing ? LQ_OK : no_memory(error);
}

void lq_pile_free(lq_pile *pile) {
    for (size_t i = 0; pile->block && i < pile->chain->steps; i++) lq_block_free(&pile->block[i]);
    free(pile->block);
    free(pile->crossing);
}

/* ======================================================================================
 *                                       Periods
 * ====================================================================================== */

static bool same_step(const lq_plan_chain *c, size_t a, size_t b) {
    const lq_plan_step *x = &c->step[a], *y = &c->step[b];
    return x->surface == y->surface && x->flipped == y->flipped && x->material == y->material;
}

static bool same_medium(const lq_plan_chain *c, size_t a, size_t b) {
    return c->medium[a].axis == c->medium[b].axis && c->medium[a].tau == c->medium[b].tau;
}

/* Steps from `from` on that repeat with this period, all of them counted: the medium below the last is free.
 */
static size_t repeated(const lq_plan_chain *c, size_t from, size_t period) {
    size_t i = from + period;
    while (i < c->steps && same_step(c, i - period, i) && (i == from || same_medium(c, i - period, i))) i++;
    return (i - from) / period;
}

typedef struct run {
    size_t period, times;
} run;

enum { LONGEST_PERIOD = 16 };

/* The run from a step on that saves most additions. */
static run find_run(const lq_plan_chain *c, size_t from) {
    run best = {1, 1};
    for (size_t period = 1; period <= LONGEST_PERIOD && from + 2 * period <= c->steps; period++) {
        const size_t times = repeated(c, from, period);
        if (times > 1 && (times - 1) * period > (best.times - 1) * best.period) best = (run){period, times};
    }
    return best;
}

/* ======================================================================================
 *                                       Adding
 * ====================================================================================== */

/* A run of steps as one block; free it in either case. */
static lq_status add_run(const lq_pile *pile, size_t from, const run *r, lq_block *sum, lq_error *error) {
    lq_status status = lq_block_copy(&pile->block[from], sum, error);
    for (size_t i = from + 1; i < from + r->period && status == LQ_OK; i++)
        status = lq_block_append(sum, pile->crossing[i], &pile->block[i], error);
    if (status != LQ_OK || r->times == 1) return status;
    lq_block all = {0};
    status = lq_block_repeat(sum, pile->crossing[from + r->period], r->times, &all, error);
    if (status != LQ_OK) return status;
    lq_block_free(sum);
    *sum = all;
    return LQ_OK;
}

/* All steps below the first; free it in either case. */
static lq_status add_rest(const lq_pile *pile, lq_block *rest, lq_error *error) {
    lq_status status = LQ_OK;
    for (size_t i = 1; i < pile->chain->steps && status == LQ_OK;) {
        const run r = find_run(pile->chain, i);
        lq_block next = {0};
        status = add_run(pile, i, &r, i == 1 ? rest : &next, error);
        if (status == LQ_OK && i > 1) status = lq_block_append(rest, pile->crossing[i], &next, error);
        lq_block_free(&next);
        i += r.period * r.times;
    }
    return status;
}

/* ======================================================================================
 *                                        Paths
 * ====================================================================================== */

/* What is worked with while paths are told apart. Columns of a vector of values: side * 2 + reward. */
enum { COLUMNS = 4 };

typedef struct walk {
    const lq_pile *pile;
    size_t paths, nodes; /* nodes of the medium below the first step */
    double *below;       /* D r D of the rest: nodes x nodes */
    double *again;       /* the same after a reflection off the first step from below */
    double *value;       /* nodes x COLUMNS: light below the first step that sets out downwards */
    double *next;        /* likewise */
    double *values;      /* result */
} walk;

/* Value of light at every entry that the first step lets through, onto path p. */
static void enter(walk *w, size_t p, const double *value) {
    const lq_block *top = &w->pile->block[0];
    for (size_t i = 0; i < top->entries[0]; i++)
        for (size_t c = 0; c < COLUMNS; c++) {
            double sum = 0.0;
            for (size_t k = 0; k < w->nodes; k++) sum += top->t[0][i * w->nodes + k] * value[k * COLUMNS + c];
            w->values[(i * w->paths + p) * COLUMNS + c] += sum;
        }
}

/* `columns` rewards at the nodes of a matrix' columns: product[row * COLUMNS + first + c]. */
static void rewarded(const double *matrix, size_t rows, size_t nodes, const double *reward, size_t first,
                     size_t stride, double *product) {
    for (size_t i = 0; i < rows; i++)
        for (size_t c = 0; c < 2; c++) {
            double sum = 0.0;
            for (size_t j = 0; j < nodes; j++) sum += matrix[i * nodes + j] * reward[c * nodes + j];
            product[i * stride + first + c] = sum;
        }
}

/* value = M value, M = below r21: one more reflection off the first step from below. */
static void reflect(walk *w) {
    lq_matrix_product(w->again, w->value, w->nodes, w->nodes, COLUMNS, w->next);
    memcpy(w->value, w->next, w->nodes * COLUMNS * sizeof *w->value);
}

/* What light below the first step is worth that meets it no more (beyond), or once, to leave. */
static void start(walk *w, const lq_block *rest, const double *crossing, const double *reward,
                  const double *reward_beyond) {
    const lq_block *top = &w->pile->block[0];
    const size_t n = w->nodes;
    lq_block_there_and_back(rest->r[0], crossing, n, w->below);
    lq_matrix_product(w->below, top->r[1], n, n, n, w->again);
    rewarded(top->t[1], n, top->nodes[0], reward, 0, COLUMNS, w->next);
    lq_matrix_product(w->below, w->next, n, n, COLUMNS, w->value);
    rewarded(rest->t[0], n, rest->nodes[1], reward_beyond, 2, COLUMNS, w->value);
    for (size_t i = 0; i < n; i++)
        for (size_t c = 2; c < COLUMNS; c++) w->value[i * COLUMNS + c] *= crossing[i];
}

/* Light that leaves on its own side has met the first step once more than light that leaves beyond. */
static lq_status split(walk *w, lq_error *error) {
    const size_t n = w->nodes;
    double *masked = calloc(n * COLUMNS + 1, sizeof *masked);
    lq_status status = masked ? LQ_OK : no_memory(error);
    for (size_t p = 0; p < w->paths && status == LQ_OK; p++) {
        const bool last = p + 1 == w->paths;
        if (last) status = lq_block_trapped(w->again, n, w->value, COLUMNS, error); /* any number of them */
        for (size_t side = 0; side < 2 && status == LQ_OK; side++) {
            for (size_t i = 0; i < n * COLUMNS; i++) masked[i] = i % COLUMNS / 2 == side ? w->value[i] : 0.0;
            enter(w, side == 0 && !last ? p + 1 : p, masked);
        }
        if (!last) reflect(w);
    }
    free(masked);
    return status;
}

lq_status lq_pile_values(const lq_pile *pile, const double *reward, const double *reward_beyond, size_t paths,
                         double *values, lq_error *error) {
    const lq_block *top = &pile->block[0];
    const size_t n = top->nodes[1], rows = top->entries[0];
    memset(values, 0, rows * paths * COLUMNS * sizeof *values);
    rewarded(top->r[0], rows, top->nodes[0], reward, 0, paths * COLUMNS, values);
    if (pile->chain->steps == 1) {
        rewarded(top->t[0], rows, n, reward_beyond, 2, paths * COLUMNS, values);
        return LQ_OK;
    }
    lq_block rest = {0};
    lq_status status = add_rest(pile, &rest, error);
    double *memory = calloc(2 * n * (n + COLUMNS) + 1, sizeof *memory);
    if (status == LQ_OK && !memory) status = no_memory(error);
    if (status == LQ_OK) {
        double *const vectors = memory + 2 * n * n;
        walk w = {pile, paths, n, memory, memory + n * n, vectors, vectors + n * COLUMNS, values};
        start(&w, &rest, pile->crossing[1], reward, reward_beyond);
        status = split(&w, error);
    }
    free(memory);
    lq_block_free(&rest);
    return status;
}

/* make_materials.c - the materials of a scene: baked from the exact stack, made into texels, measured. */
#include "pack/make.h"
#include "pack/names.h"
#include "system/parallel.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Where a recipe asks for none. */
static const lq_lobes_budget DEFAULT = {2e-3, 1e-2};

/* What a bake may be off by at its coarser nodes, in budgets: twice as many, which it keeps, are some hundred
 * times as good. What they come to is measured. */
static const double BAKED = 2.0;

enum { POINTS_PER_SET = 500, FEWEST_SETS = 4, MOST_SETS = 64, CHECK_LEVEL = 1 };

static lq_lobes_budget budget_of(const lq_recipe *recipe) {
    if (!isfinite(recipe->p99) && !isfinite(recipe->max)) return DEFAULT;
    return (lq_lobes_budget){fmin(recipe->p99, recipe->max), recipe->max};
}

/* Materials on their way: baked once, fitted and checked until they keep their budget. */
typedef struct fitting {
    const lq_making *making;
    lq_packing *packing;
    lq_baked *baked;
    lq_lobes_budget budget;
    lq_lobes_exact exact;
    double *share; /* of the budget that the next fit of a material is to keep; 0: it is done */
} fitting;

enum { ATTEMPTS = 4 };
static const double TIGHTER = 0.6;

static lq_status fit(void *user, size_t i, int thread, lq_error *error) {
    (void)thread;
    const fitting *f = user;
    lq_lobes *lobes = &f->packing->materials[i].lobes;
    const lq_lobes_budget budget = {f->share[i] * f->budget.p99, f->share[i] * f->budget.max};
    if (f->share[i] == 0.0) return LQ_OK;
    lq_lobes_free(lobes);
    return lq_lobes_make(lobes, &f->baked[i], &budget, error);
}

/* What keeps its budget is done; what does not is fitted more finely. */
static lq_status check(void *user, size_t i, int thread, lq_error *error) {
    (void)thread;
    const fitting *f = user;
    lq_packed_material *m = &f->packing->materials[i];
    if (f->share[i] == 0.0) return LQ_OK;
    const lq_status status = lq_lobes_measure_one(&f->exact, i, &m->lobes, &m->measure, error);
    const bool kept = m->measure.p99 <= f->budget.p99 && m->measure.max <= f->budget.max;
    f->share[i] = kept ? 0.0 : TIGHTER * f->share[i];
    return status;
}

/* The exact values that fits are checked against. */
static lq_status solve_exact(fitting *f, const lq_material *const *materials, lq_error *error) {
    const lq_recipe *recipe = f->packing->recipe;
    const size_t asked = recipe->points / POINTS_PER_SET;
    const size_t sets = asked < FEWEST_SETS ? FEWEST_SETS : asked > MOST_SETS ? MOST_SETS : asked;
    lq_step step;
    lq_step_begin(&step, &f->making->watch, "materials, check");
    const lq_status status = lq_lobes_exact_make(&f->exact, materials, recipe->material_count, sets,
                                                 CHECK_LEVEL, 0.0, f->making->threads, &step.progress, error);
    lq_step_end(&step);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* some interface took no finer level */
}

static lq_status refer(void *user, size_t i, int thread, lq_error *error) {
    (void)thread;
    const fitting *f = user;
    return lq_lobes_make_fine(&f->packing->materials[i].reference, &f->baked[i], error);
}

static bool is_left(const fitting *f) {
    for (size_t i = 0; i < f->packing->recipe->material_count; i++)
        if (f->share[i] > 0.0) return true;
    return false;
}

static lq_status fit_all(fitting *f, lq_error *error) {
    const size_t count = f->packing->recipe->material_count;
    const int threads = f->making->threads;
    lq_status status = LQ_OK;
    for (size_t i = 0; i < count; i++) f->share[i] = 1.0;
    for (int attempt = 0; attempt < ATTEMPTS && is_left(f) && status == LQ_OK; attempt++) {
        status = lq_parallel(count, threads, fit, f, NULL, error);
        if (status == LQ_OK || status == LQ_NOT_CONVERGED)
            status = lq_parallel(count, threads, check, f, NULL, error);
    }
    return status; /* what is left misses its budget: the measured error says so */
}

static lq_status bake(const lq_making *r, const lq_recipe *recipe, const lq_lobes_budget *budget,
                      const lq_material *const *materials, lq_baked *baked, lq_error *error) {
    double mu[LQ_LOBES_COSINES];
    lq_step step;
    lq_lobes_cosines(mu);
    lq_step_begin(&step, &r->watch, "materials");
    const lq_status status =
        lq_bake(materials, recipe->material_count, mu, LQ_LOBES_COSINES,
                BAKED * fmin(budget->p99, budget->max), r->threads, &step.progress, baked, error);
    lq_step_end(&step);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status; /* the measured error says what it comes to */
}

lq_status lq_make_materials(const lq_making *r, lq_packing *packing, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    const size_t count = recipe->material_count;
    const lq_material **materials = calloc(count, sizeof *materials);
    lq_baked *baked = calloc(count, sizeof *baked);
    fitting f = {.making = r, .packing = packing, .baked = baked, .budget = budget_of(recipe)};
    f.share = calloc(count, sizeof *f.share);
    lq_status status = materials && baked && f.share ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "out of memory");
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        packing->materials[i].from = &recipe->materials[i];
        lq_make_identifier(packing->materials[i].name, recipe->materials[i].name);
        materials[i] = &recipe->materials[i].material;
    }
    if (status == LQ_OK) status = bake(r, recipe, &f.budget, materials, baked, error);
    if (status == LQ_OK) status = solve_exact(&f, materials, error);
    if (status == LQ_OK) status = fit_all(&f, error);
    if (status == LQ_OK) status = lq_parallel(count, r->threads, refer, &f, NULL, error);
    for (size_t i = 0; baked && i < count; i++) lq_baked_free(&baked[i]);
    free(materials);
    free(baked);
    lq_lobes_exact_free(&f.exact);
    free(f.share);
    return status;
}

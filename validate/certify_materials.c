/* certify_materials.c - the materials of a scene's pack, solved anew where a shader may ask. */
#include "system/status.h"
#include "validate/certify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A set of parameters has 48 cosines. Sets of few points would check little, many take minutes. */
enum { POINTS_PER_SET = 1000, FEWEST_SETS = 4, MOST_SETS = 64 };

static const double EXACT = 1e-4;

static lq_budget budget_for(const lq_certifying *asked, const lq_shipped_material *m) {
    lq_budget budget = {0};
    if (asked->has_budget) return lq_budgets_rule(&asked->budgets, m->name, "material")->budget;
    for (int n = 0; n < LQ_NORMS; n++) budget.bound[n] = INFINITY;
    budget.bound[LQ_NORM_P99] = m->lobes.p99;
    budget.bound[LQ_NORM_MAX] = m->lobes.max;
    return budget;
}

static lq_status solve(const lq_certifying *asked, const lq_pack *pack, const lq_material **materials,
                       lq_lobes_exact *exact, lq_error *error) {
    const size_t wanted = asked->points / POINTS_PER_SET;
    const size_t sets = wanted < FEWEST_SETS ? FEWEST_SETS : wanted > MOST_SETS ? MOST_SETS : wanted;
    lq_step step;
    for (size_t i = 0; i < pack->material_count; i++) materials[i] = &pack->materials[i].material;
    lq_step_begin(&step, &asked->watch, "materials");
    const lq_status status = lq_lobes_exact_make(exact, materials, pack->material_count, sets, -1, EXACT,
                                                 asked->threads, &step.progress, error);
    lq_step_end(&step);
    return status;
}

static lq_status judge(const lq_certifying *asked, const lq_lobes_exact *exact, size_t i,
                       const lq_shipped_material *shipped, lq_certified_material *made, lq_error *error) {
    made->budget = budget_for(asked, shipped);
    made->range_count = shipped->material.range_count;
    snprintf(made->name, sizeof made->name, "%s", shipped->name);
    for (int r = 0; r < made->range_count; r++)
        snprintf(made->ranges[r], sizeof made->ranges[r], "%s", shipped->material.ranges[r].name);
    return lq_lobes_measure_one(exact, i, &shipped->lobes, &made->measure, error);
}

lq_status lq_certify_materials(const lq_certifying *asked, const lq_pack *pack, lq_certificates *made,
                               lq_error *error) {
    const size_t count = pack->material_count;
    lq_lobes_exact exact = {0};
    if (count == 0) return LQ_OK;
    const lq_material **materials = malloc(count * sizeof *materials);
    made->materials = calloc(count, sizeof *made->materials);
    lq_status status = materials && made->materials ? solve(asked, pack, materials, &exact, error)
                                                    : lq_fail(error, LQ_NO_MEMORY, "out of memory");
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        status = judge(asked, &exact, i, &pack->materials[i], &made->materials[i], error);
    if (status == LQ_OK) made->material_count = count;
    lq_lobes_exact_free(&exact);
    free(materials);
    return status;
}

/* materials.c - the materials of a scene's pack, solved anew where a shader may ask. */
#include "program/validate/materials.h"

#include "pack/lobes_measure.h"
#include "program/message.h"
#include "program/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A set of parameters has 48 cosines. Sets of few points would check little, many take minutes. */
enum { POINTS_PER_SET = 1000, FEWEST_SETS = 4, MOST_SETS = 64 };

static const double EXACT = 1e-4;

static lq_budget budget_for(const certify_request *request, const lq_shipped_material *m) {
    lq_budget budget = {0};
    if (request->has_budget) return lq_budgets_rule(&request->budgets, m->name, "material")->budget;
    for (int n = 0; n < LQ_NORMS; n++) budget.bound[n] = INFINITY;
    budget.bound[LQ_NORM_P99] = m->lobes.p99;
    budget.bound[LQ_NORM_MAX] = m->lobes.max;
    return budget;
}

static bool keeps(const lq_budget *budget, const lq_lobes_measure *m) {
    const double p99 = budget->bound[LQ_NORM_P99], max = budget->bound[LQ_NORM_MAX];
    const double rms = budget->bound[LQ_NORM_RMS];
    return !(p99 > 0.0 && m->p99 > p99) && !(max > 0.0 && m->max > max) && !(rms > 0.0 && m->rms > rms);
}

static void print_line(const lq_shipped_material *material, const lq_lobes_measure *m, bool kept) {
    printf("  %-6s  %-20s %6zu %9.2e %9.2e %9.2e  at mu=%.3g", kept ? "passed" : "FAILED", material->name,
           m->points, m->rms, m->p99, m->max, m->worst[0]);
    for (int r = 0; r < material->material.range_count; r++)
        printf(" %s=%.3g", material->material.ranges[r].name, m->worst[1 + r]);
    putchar('\n');
}

static void judge(const certify_request *request, const lq_pack *pack, const lq_lobes_measure *measures,
                  bool *exceeded) {
    if (!request->json)
        printf("materials: energies and roughness against the exact stack, mu >= %g\n"
               "  %-6s  %-20s %6s %9s %9s %9s\n",
               LQ_MATERIAL_FROM, "", "material", "points", "rms", "p99", "max");
    for (size_t i = 0; i < pack->material_count; i++) {
        const lq_budget budget = budget_for(request, &pack->materials[i]);
        const bool kept = keeps(&budget, &measures[i]);
        if (!request->json) print_line(&pack->materials[i], &measures[i], kept);
        *exceeded = *exceeded || !kept;
    }
    if (!request->json) putchar('\n');
}

lq_status validate_materials(const certify_request *request, const lq_pack *pack, bool *exceeded,
                             lq_error *error) {
    const size_t count = pack->material_count, asked = request->points / POINTS_PER_SET;
    const size_t sets = asked < FEWEST_SETS ? FEWEST_SETS : asked > MOST_SETS ? MOST_SETS : asked;
    if (count == 0) return LQ_OK;
    const lq_material **materials = malloc(count * sizeof *materials);
    lq_lobes_measure *measures = malloc(count * sizeof *measures);
    lq_lobes_exact exact = {0};
    lq_status status = LQ_NO_MEMORY;
    cli_progress bar;
    cli_progress_begin(&bar, "materials");
    if (materials && measures) {
        for (size_t i = 0; i < count; i++) materials[i] = &pack->materials[i].material;
        status = lq_lobes_exact_make(&exact, materials, count, sets, -1, EXACT, request->threads,
                                     &bar.progress, error);
    } else snprintf(error->text, sizeof error->text, "out of memory");
    cli_progress_end(&bar);
    for (size_t i = 0; i < count && status == LQ_OK; i++)
        status = lq_lobes_measure_one(&exact, i, &pack->materials[i].lobes, &measures[i], error);
    if (status == LQ_OK) judge(request, pack, measures, exceeded);
    lq_lobes_exact_free(&exact);
    free(materials);
    free(measures);
    return status;
}

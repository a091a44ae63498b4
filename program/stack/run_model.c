/* run_model.c - lobes of a model and their light, of an incidence or of pairs of directions. */
#include "program/stack/stack.h"

#include <stdlib.h>

static lq_status run_lobes(model_result *r, const lq_progress *progress, lq_error *error) {
    const size_t lines = r->query->mu_count * (size_t)r->channels, lobes = lq_model_lobe_count(r->stack);
    const lq_status status = lq_model_solve(r->stack, r->query, r->lobes, progress, error);
    for (size_t i = 0; i < lines && status == LQ_OK; i++)
        r->light[i] = lq_model_light(r->stack, r->lobes + i * lobes);
    return status;
}

/* One cosine and channel of a shape. */
static void read_shape(const lq_model_shape *shape, int channel, const lq_model_mapping *mapping,
                       lq_model_lobe *lobes, lq_stack_light *light) {
    for (size_t k = 0; k < shape->count; k++) {
        const double alpha = shape->lobes[(size_t)channel * shape->count + k].alpha;
        const lq_stack_lobe sum = lq_model_shape_moments(shape, channel, k);
        lobes[k] = (lq_model_lobe){0};
        if (sum.energy > 0.0)
            lobes[k] = (lq_model_lobe){sum.energy, sum.mean, lq_model_variance(mapping, alpha), alpha};
    }
    *light = lq_model_shape_light(shape, channel);
}

static void read_turned(const lq_model_shape *shape, int channel, lq_turned_ggx *turned) {
    for (size_t k = 0; k < shape->count; k++) {
        const lq_shape_lobe *lobe = &shape->lobes[(size_t)channel * shape->count + k];
        turned[k] = lobe->turned ? lobe->ggx : (lq_turned_ggx){lobe->alpha, lobe->alpha, 1.0, 0.0};
    }
}

static lq_status run_shape(model_result *r, lq_error *error) {
    const lq_model_query *q = r->query;
    lq_model_mapping mapping;
    lq_model_shape shape = {0};
    lq_status status = lq_model_mapping_make(&mapping, q->f, error);
    const lq_shape_query query = {.model = q->model,
                                  .variant = q->variant,
                                  .f = q->f,
                                  .mapping = &mapping,
                                  .source = q->source,
                                  .first = r->first,
                                  .azimuth = r->azimuth,
                                  .threads = q->threads};
    if (status == LQ_OK) status = lq_model_shape_make(&shape, r->stack, &query, q->mu[0], error);
    for (size_t m = 0; m < q->mu_count && status == LQ_OK; m++) {
        status = lq_model_shape_aim(&shape, q->mu[m], error);
        for (int c = 0; c < r->channels && status == LQ_OK; c++) {
            const size_t line = m * (size_t)r->channels + (size_t)c;
            read_shape(&shape, c, &mapping, r->lobes + line * shape.count, r->light + line);
            if (r->turned) read_turned(&shape, c, r->turned + line * shape.count);
        }
    }
    lq_model_shape_free(&shape);
    return status;
}

lq_status model_run(model_result *r, const lq_progress *progress, lq_error *error) {
    const size_t lines = r->query->mu_count * (size_t)r->channels,
                 all = lines * lq_model_lobe_count(r->stack);
    const lq_model_kind *kind = &lq_model_kinds[r->query->model];
    r->lobes = calloc(all, sizeof *r->lobes);
    r->light = calloc(lines, sizeof *r->light);
    r->turned = kind->anisotropic ? calloc(all, sizeof *r->turned) : NULL;
    if (!r->lobes || !r->light || (kind->anisotropic && !r->turned)) {
        snprintf(error->text, sizeof error->text, "out of memory");
        return LQ_NO_MEMORY;
    }
    return kind->of_pairs || kind->windowed || kind->anisotropic || r->first != LQ_FIRST_OF_MODEL
               ? run_shape(r, error)
               : run_lobes(r, progress, error);
}

void model_free(model_result *r) {
    free(r->lobes);
    free(r->light);
    free(r->turned);
}

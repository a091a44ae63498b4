/* material.c - a material of a scene's pack as a shader has it: the energies of its lobes. */
#include "program/view/pack.h"

#include <stdio.h>

/* Top, inner and base, and the cosines they are drawn at. */
enum { LOBES = 3, COSINES = 49 };

/* Energies at one cosine, means of the colours; `rho` of a base whose albedo is open. */
static void sample(const lq_shipped_material *shipped, double mu, const double *values, double rho,
                   float energy[LOBES]) {
    const lq_material *material = &shipped->material;
    double numbers[LQ_MATERIAL_NUMBERS], sums[LOBES] = {0.0};
    lq_lobes_sample(&shipped->lobes, mu, values, LQ_FILTER_BITS, numbers);
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) {
        sums[0] += numbers[LQ_MATERIAL_TOP + c];
        sums[1] += numbers[LQ_MATERIAL_INNER + c];
        if (material->lambertian) sums[2] += lq_material_base(numbers, c, material, rho);
    }
    for (int i = 0; i < LOBES; i++) energy[i] = (float)(sums[i] / LQ_MATERIAL_COLOURS);
}

/* The middle of every range, and what the caption says of it. */
static double choose(const lq_material *material, const char *note, double *values, char *text, size_t size) {
    const double rho = 0.5 * (material->rho_min + material->rho_max);
    size_t used = 0;
    text[0] = '\0';
    for (int r = 0; r < material->range_count && used < size; r++) {
        values[r] = 0.5 * (material->ranges[r].min + material->ranges[r].max);
        used += (size_t)snprintf(text + used, size - used, "%s %.4g, ", material->ranges[r].name, values[r]);
    }
    if (material->open_rho && used < size)
        used += (size_t)snprintf(text + used, size - used, "rho %.4g, ", rho);
    if (used >= 2 && used < size) used -= 2;
    if (used < size) snprintf(text + used, size - used, "%s%s", used ? " · " : "", note);
    return rho;
}

lq_status view_add_material(lq_figure *figure, const lq_shipped_material *shipped, const char *note,
                            lq_error *error) {
    static const char *const lobes[LOBES] = {"top", "inner", "base"};
    static const double whole[2] = {0.0, 1.0};
    const lq_axis *range = &shipped->lobes.axes[0];
    float values[LOBES * COSINES];
    double at[LQ_MATERIAL_RANGES] = {0.0};
    char caption[LQ_MESSAGE_SIZE];
    lq_axis mu;
    lq_status status = lq_axis_make(&mu, "mu", range->min, range->max, COSINES, LQ_MAP_SQRT, 0.0, error);
    if (status != LQ_OK) return status;
    const double rho = choose(&shipped->material, note, at, caption, sizeof caption);
    for (size_t m = 0; m < COSINES; m++) {
        float energy[LOBES];
        sample(shipped, mu.nodes[m], at, rho, energy);
        for (int i = 0; i < LOBES; i++) values[(size_t)i * COSINES + m] = energy[i];
    }
    const lq_panel_parts parts = {.form = LQ_PANEL_AREAS,
                                  .title = shipped->name,
                                  .caption = caption,
                                  .quantity = "energy, mean of RGB",
                                  .x = &mu,
                                  .series_count = LOBES,
                                  .series = lobes,
                                  .values = values,
                                  .range = whole,
                                  .ordered = true};
    status = lq_figure_add(figure, &parts, error);
    lq_axis_free(&mu);
    return status;
}

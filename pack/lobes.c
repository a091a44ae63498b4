/* lobes.c - which numbers get channels, how many texels, and their values. */
#include "pack/lobes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pack/measure.h"
#include "system/status.h"

enum { RANGE_SAMPLES = 65, SIZES = 12, MAPS = 3 };

/* What a fit is measured against: samples between texels, and texels' weights at them. */
typedef struct samples {
    const lq_baked *baked;
    size_t count[LQ_LOBES_AXES];
    double *at[LQ_LOBES_AXES]; /* values of each axis */
    double *numbers;           /* [((s2 * count 1 + s1) * count 0 + s0) * LQ_MATERIAL_NUMBERS + k] */
} samples;

void lq_lobes_cosines(double mu[LQ_LOBES_COSINES]) {
    for (int i = 0; i < LQ_LOBES_COSINES; i++) {
        const double root = (double)i / (LQ_LOBES_COSINES - 1);
        mu[i] = root * root;
    }
}

/* ======================================================================================
 *                                       Samples
 * ====================================================================================== */

static size_t sample_count(const samples *s) {
    return s->count[0] * s->count[1] * s->count[2];
}

static void free_samples(samples *s) {
    for (int a = 0; a < LQ_LOBES_AXES; a++) free(s->at[a]);
    free(s->numbers);
}

/* Denser towards the lower end, as texels may be. */
static void place(samples *s, int axis, const lq_material_range *range) {
    for (size_t i = 0; i < s->count[axis]; i++) {
        const double u = s->count[axis] > 1 ? (double)i / (double)(s->count[axis] - 1) : 0.0;
        s->at[axis][i] = range ? range->min + (range->max - range->min) * u * u : 0.0;
    }
}

static lq_status take_samples(samples *s, const lq_baked *baked, lq_error *error) {
    const int ranges = baked->material->range_count;
    *s = (samples){.baked = baked, .count = {baked->mu_count, 1, 1}};
    for (int r = 0; r < ranges; r++) s->count[1 + r] = ranges > 1 ? RANGE_SAMPLES / 2 + 1 : RANGE_SAMPLES;
    bool there = (s->numbers = malloc(sample_count(s) * LQ_MATERIAL_NUMBERS * sizeof(double))) != NULL;
    for (int a = 0; a < LQ_LOBES_AXES; a++)
        there = (s->at[a] = malloc(s->count[a] * sizeof(double))) != NULL && there;
    if (!there) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples", sample_count(s));
    double mu[LQ_LOBES_COSINES];
    lq_lobes_cosines(mu);
    memcpy(s->at[0], mu, sizeof mu);
    for (int r = 0; r < LQ_MATERIAL_RANGES; r++)
        place(s, 1 + r, r < ranges ? &baked->material->ranges[r] : NULL);
    for (size_t i = 0; i < s->count[1] * s->count[2]; i++) {
        const double values[] = {s->at[1][i % s->count[1]], s->at[2][i / s->count[1]]};
        lq_baked_at(baked, values, s->numbers + i * s->count[0] * LQ_MATERIAL_NUMBERS);
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                       Channels
 * ====================================================================================== */

/* How much an error of a number is seen: an inner roughness where there is inner light, light that returns to
 * the base through what it changes, the base's lobe, which is nearly diffuse, hardly. */
static double weight_of(int number, const double *numbers) {
    double inner = 0.0;
    if (number == LQ_MATERIAL_BASE_ALPHA) return 0.1;
    if (number >= LQ_MATERIAL_BACK && number < LQ_MATERIAL_BACK + 3) return 0.5;
    if (number != LQ_MATERIAL_INNER_ALPHA) return 1.0;
    for (int c = 0; c < LQ_MATERIAL_COLOURS; c++) inner = fmax(inner, numbers[LQ_MATERIAL_INNER + c]);
    return inner;
}

/* The largest difference, as it is seen, of number `k` to number `other` of all samples, or to `value`. */
static double apart(const samples *s, int k, int other, double value) {
    double most = 0.0;
    for (size_t i = 0; i < sample_count(s); i++) {
        const double *n = s->numbers + i * LQ_MATERIAL_NUMBERS;
        most = fmax(most, weight_of(k, n) * fabs(n[k] - (other < 0 ? value : n[other])));
    }
    return most;
}

static double middle_of(const samples *s, int k) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < sample_count(s); i++) {
        const double *n = s->numbers + i * LQ_MATERIAL_NUMBERS;
        if (weight_of(k, n) < 1e-3) continue;
        low = fmin(low, n[k]);
        high = fmax(high, n[k]);
    }
    return low <= high ? 0.5 * (low + high) : 0.0;
}

/* A roughness has no other colours. */
static int first_colour(int k) {
    static const int of_colours[] = {LQ_MATERIAL_TOP, LQ_MATERIAL_INNER, LQ_MATERIAL_THROUGH,
                                     LQ_MATERIAL_BACK};
    for (int i = 0; i < 4; i++)
        if (k >= of_colours[i] && k < of_colours[i] + LQ_MATERIAL_COLOURS) return of_colours[i];
    return k;
}

static void choose_channels(lq_lobes *lobes, const samples *s, double tolerance) {
    for (int k = 0; k < LQ_MATERIAL_NUMBERS; k++) {
        const double middle = middle_of(s, k);
        lobes->channel[k] = -1;
        lobes->constant[k] = fabs(middle) < 1e-9 ? 0.0 : middle;
        if (apart(s, k, -1, middle) <= tolerance) continue;
        for (int other = first_colour(k); other < k && lobes->channel[k] < 0; other++)
            if (lobes->channel[other] >= 0 && apart(s, k, other, 0.0) <= tolerance)
                lobes->channel[k] = lobes->channel[other];
        if (lobes->channel[k] < 0) lobes->channel[k] = lobes->channel_count++;
    }
    lobes->texels = (size_t)(lobes->channel_count + LQ_LOBES_PER_TEXEL - 1) / LQ_LOBES_PER_TEXEL;
}

/* The first number of a channel. */
static int number_of(const lq_lobes *lobes, int channel) {
    int k = 0;
    while (lobes->channel[k] != channel) k++;
    return k;
}

/* ======================================================================================
 *                                         Fit
 * ====================================================================================== */

/* Linear interpolation along an axis: sample i is between texels below[i] and the next. */
typedef struct taps {
    size_t texels, samples;
    size_t *below;
    double *above; /* weight of the upper one */
} taps;

static bool make_taps(taps *t, const lq_axis *axis, const double *at, size_t count, int bits) {
    *t = (taps){axis ? axis->size : 1, count, malloc(count * sizeof(size_t)), calloc(count, sizeof(double))};
    if (!t->below || !t->above) return false;
    for (size_t i = 0; i < count; i++) {
        t->below[i] = 0;
        if (axis) t->below[i] = lq_texel_below(axis, at[i], bits, &t->above[i]);
    }
    return true;
}

static void free_taps(taps *t) {
    free(t->below);
    free(t->above);
}

/* Texels along one line of samples: normal equations, which are tridiagonal. `work` holds 4 rows of texels.
 */
static void fit_line(const taps *t, const double *line, size_t stride, double *texels, size_t texel_stride,
                     double *work) {
    const size_t n = t->texels;
    double *diagonal = work, *upper = work + n, *right = work + 2 * n;
    /* A texel that no sample sees keeps to its neighbours. */
    for (size_t i = 0; i < n; i++) {
        diagonal[i] = 1e-9;
        upper[i] = right[i] = 0.0;
    }
    for (size_t i = 0; i < t->samples; i++) {
        const size_t b = t->below[i];
        const double v = t->above[i], w = 1.0 - v, value = line[i * stride];
        diagonal[b] += w * w;
        right[b] += w * value;
        if (n == 1) continue;
        diagonal[b + 1] += v * v;
        upper[b] += w * v;
        right[b + 1] += v * value;
    }
    for (size_t i = 1; i < n; i++) {
        const double ratio = upper[i - 1] / diagonal[i - 1];
        diagonal[i] -= ratio * upper[i - 1];
        right[i] -= ratio * right[i - 1];
    }
    for (size_t i = n; i-- > 0;) {
        const double after = i + 1 < n ? upper[i] * texels[(i + 1) * texel_stride] : 0.0;
        texels[i * texel_stride] = (right[i] - after) / diagonal[i];
    }
}

/* What the texels of one channel say at the samples: along every axis in turn, or with `fit` the other way.
 */
static void along_axis(const taps *t, bool fit, const double *from, size_t inner, size_t outer, double *to,
                       double *work) {
    const size_t in = fit ? t->samples : t->texels, out = fit ? t->texels : t->samples;
    for (size_t o = 0; o < outer; o++)
        for (size_t i = 0; i < inner; i++) {
            const double *line = from + o * in * inner + i;
            double *result = to + o * out * inner + i;
            if (fit) {
                fit_line(t, line, inner, result, inner, work);
                continue;
            }
            for (size_t k = 0; k < out; k++) {
                const double *b = line + t->below[k] * inner;
                result[k * inner] = t->above[k] > 0.0 ? b[0] + t->above[k] * (b[inner] - b[0]) : b[0];
            }
        }
}

/* One try: axes, their taps, texels and what they say. */
typedef struct trial {
    const samples *samples;
    lq_lobes *lobes;
    taps fit[LQ_LOBES_AXES], filter[LQ_LOBES_AXES];
    double *decoded; /* of all channels: [channel * samples + i] */
    double *scratch[2], *work;
} trial;

static size_t texel_count(const lq_lobes *l) {
    size_t count = 1;
    for (int a = 0; a < l->axis_count; a++) count *= l->axes[a].size;
    return count;
}

/* Texel (x, y) of a slice, of a channel. */
static float *texel_at(const lq_lobes *l, const size_t at[LQ_LOBES_AXES], int channel) {
    const size_t row = at[2] * lq_lobes_pitch(l) + at[1];
    const size_t layer = (size_t)(channel / LQ_LOBES_PER_TEXEL);
    return &l->image.data[((layer * l->image.height + row) * l->image.width + at[0]) * LQ_LOBES_PER_TEXEL +
                          (size_t)(channel % LQ_LOBES_PER_TEXEL)];
}

static float *texel_of(const lq_lobes *l, size_t i, int channel) {
    const size_t width = l->axes[0].size, height = l->axis_count > 1 ? l->axes[1].size : 1;
    const size_t at[] = {i % width, i / width % height, i / width / height};
    return texel_at(l, at, channel);
}

/* The rows between slices repeat the nearest of them. */
static void fill_borders(lq_lobes *l) {
    const size_t pitch = lq_lobes_pitch(l), height = pitch - LQ_LOBES_BORDER;
    const size_t row = l->image.width * LQ_LOBES_PER_TEXEL;
    for (size_t y = 0; y < l->image.layers * l->image.height; y++) {
        const size_t in = y % l->image.height % pitch;
        if (in < height) continue;
        const size_t from = in == height ? y - 1 : y + 1;
        memcpy(&l->image.data[y * row], &l->image.data[from * row], row * sizeof(float));
    }
}

lq_status lq_lobes_allocate(lq_lobes *l, lq_error *error) {
    const size_t slices = l->axis_count > 2 ? l->axes[2].size : 1;
    return lq_image_create(&l->image, l->axes[0].size, slices * lq_lobes_pitch(l) - LQ_LOBES_BORDER, 1,
                           l->texels, LQ_LOBES_PER_TEXEL, error);
}

const char *lq_lobes_number_name(int k) {
    static const char *const names[LQ_MATERIAL_NUMBERS] = {
        "top.r",     "top.g",     "top.b",     "inner.r", "inner.g", "inner.b", "inner_alpha",
        "through.r", "through.g", "through.b", "back.r",  "back.g",  "back.b",  "base_alpha"};
    return names[k];
}

size_t lq_lobes_pitch(const lq_lobes *l) {
    return (l->axis_count > 1 ? l->axes[1].size : 1) + LQ_LOBES_BORDER;
}

static void fit_channel(trial *t, int channel) {
    const samples *s = t->samples;
    const int number = number_of(t->lobes, channel);
    double *from = t->scratch[0], *to = t->scratch[1], low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < sample_count(s); i++) { /* a fit may overshoot what is physical */
        low = fmin(low, s->numbers[i * LQ_MATERIAL_NUMBERS + (size_t)number]);
        high = fmax(high, s->numbers[i * LQ_MATERIAL_NUMBERS + (size_t)number]);
    }
    for (size_t i = 0; i < sample_count(s); i++)
        from[i] = s->numbers[i * LQ_MATERIAL_NUMBERS + (size_t)number];
    size_t inner = 1, outer = s->count[1] * s->count[2];
    for (int a = 0; a < LQ_LOBES_AXES; a++) {
        along_axis(&t->fit[a], true, from, inner, outer, to, t->work);
        inner *= t->fit[a].texels;
        if (a + 1 < LQ_LOBES_AXES) outer /= s->count[a + 1];
        double *swap = from;
        from = to;
        to = swap;
    }
    for (size_t i = 0; i < texel_count(t->lobes); i++)
        *texel_of(t->lobes, i, channel) = (float)fmin(fmax(from[i], low), high);
}

static void decode_channel(trial *t, int channel) {
    const samples *s = t->samples;
    double *from = t->scratch[0], *to = t->scratch[1];
    size_t inner = 1, outer = texel_count(t->lobes);
    for (size_t i = 0; i < outer; i++) from[i] = (double)*texel_of(t->lobes, i, channel);
    for (int a = 0; a < LQ_LOBES_AXES; a++) {
        outer /= t->filter[a].texels;
        if (a == LQ_LOBES_AXES - 1) to = t->decoded + (size_t)channel * sample_count(s);
        along_axis(&t->filter[a], false, from, inner, outer, to, t->work);
        inner *= t->filter[a].samples;
        double *swap = from;
        from = to;
        to = swap;
    }
}

/* ======================================================================================
 *                                       Judgement
 * ====================================================================================== */

size_t lq_lobes_compare(const lq_material *m, const double *numbers, const double *exact,
                        double errors[LQ_LOBES_ERRORS]) {
    const double rho[] = {m->rho_min, 0.5 * (m->rho_min + m->rho_max), m->rho_max};
    const size_t layers = m->stack->layer_count;
    size_t e = 0;
    for (int k = 0; k < LQ_MATERIAL_THROUGH; k++) {
        const bool there =
            k < LQ_MATERIAL_INNER ? layers > 1 || !m->lambertian : layers > (m->lambertian ? 2 : 1);
        if (there) errors[e++] = weight_of(k, exact) * fabs(numbers[k] - exact[k]);
    }
    for (int i = 0; i < (m->open_rho ? 3 : 1) && m->lambertian; i++)
        for (int c = 0; c < LQ_MATERIAL_COLOURS; c++)
            errors[e++] =
                fabs(lq_material_base(numbers, c, m, rho[i]) - lq_material_base(exact, c, m, rho[i]));
    if (m->lambertian)
        errors[e++] = weight_of(LQ_MATERIAL_BASE_ALPHA, exact) *
                      fabs(numbers[LQ_MATERIAL_BASE_ALPHA] - exact[LQ_MATERIAL_BASE_ALPHA]);
    return e;
}

/* The share of errors above `p99`, and the largest. Grazing light, where none is promised, does not count. */
static double judge(trial *t, double p99, double *max) {
    const samples *s = t->samples;
    const lq_lobes *l = t->lobes;
    size_t above = 0, counted = 0;
    *max = 0.0;
    for (size_t i = 0; i < sample_count(s); i++) {
        if (s->at[0][i % s->count[0]] < LQ_MATERIAL_FROM) continue;
        double numbers[LQ_MATERIAL_NUMBERS], errors[LQ_LOBES_ERRORS];
        for (int k = 0; k < LQ_MATERIAL_NUMBERS; k++)
            numbers[k] =
                l->channel[k] < 0 ? l->constant[k] : t->decoded[(size_t)l->channel[k] * sample_count(s) + i];
        const size_t count =
            lq_lobes_compare(l->material, numbers, s->numbers + i * LQ_MATERIAL_NUMBERS, errors);
        for (size_t e = 0; e < count; e++) {
            above += errors[e] > p99;
            *max = fmax(*max, errors[e]);
        }
        counted += count;
    }
    return counted > 0 ? (double)above / (double)counted : 0.0;
}

/* ======================================================================================
 *                                        Search
 * ====================================================================================== */

/* The maps of an axis that are tried. */
static lq_status set_axis(lq_axis *axis, const char *name, double min, double max, size_t size, int map,
                          lq_error *error) {
    static const lq_map maps[MAPS] = {LQ_MAP_LINEAR, LQ_MAP_SQRT, LQ_MAP_POWER};
    static const double exponents[MAPS] = {1.0, 2.0, 3.0};
    return lq_axis_make(axis, name, min, max, size, maps[map], exponents[map], error);
}

static void clear(lq_lobes *l) {
    for (int a = 0; a < LQ_LOBES_AXES; a++) lq_axis_free(&l->axes[a]);
    lq_image_free(&l->image);
}

/* Numbers on the way from samples to texels, some axes done. */
static size_t scratch_size(const trial *t) {
    size_t size = 1;
    for (int a = 0; a < LQ_LOBES_AXES; a++) {
        const size_t texels = a < t->lobes->axis_count ? t->lobes->axes[a].size : 1;
        size *= texels > t->samples->count[a] ? texels : t->samples->count[a];
    }
    return size;
}

static bool allocate(trial *t) {
    const samples *s = t->samples;
    bool there =
        (t->decoded = malloc(((size_t)t->lobes->channel_count * sample_count(s) + 1) * sizeof(double))) !=
        NULL;
    for (int i = 0; i < 2; i++)
        there = (t->scratch[i] = malloc((scratch_size(t) + 1) * sizeof(double))) != NULL && there;
    there = (t->work = malloc(4 * 128 * sizeof(double))) != NULL && there;
    for (int a = 0; a < LQ_LOBES_AXES; a++) {
        const lq_axis *axis = a < t->lobes->axis_count ? &t->lobes->axes[a] : NULL;
        there = make_taps(&t->fit[a], axis, s->at[a], s->count[a], 0) && there;
        there = make_taps(&t->filter[a], axis, s->at[a], s->count[a], LQ_FILTER_BITS) && there;
    }
    return there;
}

static void release(trial *t) {
    for (int a = 0; a < LQ_LOBES_AXES; a++) {
        free_taps(&t->fit[a]);
        free_taps(&t->filter[a]);
    }
    free(t->decoded);
    free(t->scratch[0]);
    free(t->scratch[1]);
    free(t->work);
}

typedef struct choice {
    size_t size[LQ_LOBES_AXES];
    int map[LQ_LOBES_AXES];
} choice;

/* The lobes with these texels; `budget` NULL: of float32, not judged. */
static lq_status try_choice(lq_lobes *l, const samples *s, const choice *c, const lq_lobes_budget *budget,
                            double *share, lq_error *error) {
    trial t = {.samples = s, .lobes = l};
    lq_status status = set_axis(&l->axes[0], "mu", 0.0, 1.0, c->size[0], c->map[0], error);
    for (int r = 0; r < l->material->range_count && status == LQ_OK; r++) {
        const lq_material_range *range = &l->material->ranges[r];
        status = set_axis(&l->axes[1 + r], range->name, range->min, range->max, c->size[1 + r], c->map[1 + r],
                          error);
    }
    if (status == LQ_OK) status = lq_lobes_allocate(l, error);
    if (status == LQ_OK && !allocate(&t)) status = lq_fail(error, LQ_NO_MEMORY, "no memory for texels");
    for (int ch = 0; ch < l->channel_count && status == LQ_OK; ch++) fit_channel(&t, ch);
    if (status == LQ_OK) fill_borders(l);
    l->image.single = budget == NULL;
    if (status == LQ_OK && budget) status = lq_image_to_half(&l->image, "a material", error);
    for (int ch = 0; ch < l->channel_count && status == LQ_OK && budget; ch++) decode_channel(&t, ch);
    if (status == LQ_OK && budget) *share = judge(&t, budget->p99, &l->max);
    release(&t);
    return status;
}

static const size_t sizes[SIZES] = {3, 4, 6, 8, 10, 12, 16, 20, 24, 32, 48, 64};

/* The search keeps this share of a budget, for what lies between its samples. */
static const double MARGIN = 0.8;

static size_t area_of(const choice *c) {
    return c->size[0] * c->size[1] * c->size[2];
}

static int by_area(const void *a, const void *b) {
    const choice *x = a, *y = b;
    if (area_of(x) != area_of(y)) return area_of(x) < area_of(y) ? -1 : 1;
    return memcmp(x->size, y->size, sizeof x->size); /* any order that is the same everywhere */
}

/* Every combination of sizes, without maps; the smallest first. */
static size_t list_choices(choice *list, int axes) {
    size_t count = 0;
    for (int i = 0; i < SIZES; i++)
        for (int j = 0; j < (axes > 1 ? SIZES : 1); j++)
            for (int k = 0; k < (axes > 2 ? SIZES : 1); k++)
                list[count++] = (choice){{sizes[i], axes > 1 ? sizes[j] : 1, axes > 2 ? sizes[k] : 1}, {0}};
    qsort(list, count, sizeof *list, by_area);
    return count;
}

/* Maps are chosen once, at a middling size: the best of each axis hardly depends on how many texels it has.
 */
static lq_status choose_maps(lq_lobes *l, const samples *s, int *map, lq_error *error) {
    const lq_lobes_budget any = {0.0, 1.0};
    double best = INFINITY, share;
    int found[LQ_LOBES_AXES] = {0};
    lq_status status = LQ_OK;
    for (int m = 0; m < MAPS * MAPS * MAPS && status == LQ_OK; m++) {
        const choice c = {{12, 12, 8}, {m % MAPS, m / MAPS % MAPS, m / MAPS / MAPS}};
        if ((l->axis_count < 2 && c.map[1] > 0) || (l->axis_count < 3 && c.map[2] > 0)) continue;
        clear(l);
        status = try_choice(l, s, &c, &any, &share, error);
        if (status != LQ_OK || l->max >= best) continue;
        best = l->max;
        memcpy(found, c.map, sizeof found);
    }
    memcpy(map, found, sizeof found);
    return status;
}

static lq_status search(lq_lobes *l, const samples *s, const lq_lobes_budget *asked, lq_error *error) {
    const lq_lobes_budget budget = {MARGIN * asked->p99, MARGIN * asked->max};
    choice *list = malloc(SIZES * SIZES * SIZES * sizeof *list);
    int map[LQ_LOBES_AXES];
    if (!list) return lq_fail(error, LQ_NO_MEMORY, "no memory for a search");
    const size_t count = list_choices(list, l->axis_count);
    lq_status status = choose_maps(l, s, map, error);
    double share = 1.0;
    bool kept = false;
    for (size_t i = 0; i < count && status == LQ_OK && !kept; i++) {
        memcpy(list[i].map, map, sizeof map);
        clear(l);
        status = try_choice(l, s, &list[i], &budget, &share, error);
        kept = share <= 0.01 && l->max <= budget.max;
    }
    free(list);
    if (status != LQ_OK || kept) return status;
    return lq_fail(error, LQ_NOT_CONVERGED, "%zu texels an axis leave an error of %.2g", sizes[SIZES - 1],
                   l->max);
}

lq_status lq_lobes_make(lq_lobes *lobes, const lq_baked *baked, const lq_lobes_budget *budget,
                        lq_error *error) {
    static const double CONSTANT = 0.1; /* the share of a budget that a constant may take */
    samples s;
    *lobes = (lq_lobes){.material = baked->material, .axis_count = 1 + baked->material->range_count};
    lq_status status = take_samples(&s, baked, error);
    if (status == LQ_OK) choose_channels(lobes, &s, CONSTANT * fmin(budget->p99, budget->max));
    if (status == LQ_OK && lobes->channel_count > 0) status = search(lobes, &s, budget, error);
    free_samples(&s);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) lq_lobes_free(lobes);
    return status;
}

lq_status lq_lobes_make_fine(lq_lobes *lobes, const lq_baked *baked, lq_error *error) {
    static const choice fine[] = {
        {{64, 1, 1}, {1, 1, 1}}, {{64, 32, 1}, {1, 1, 1}}, {{48, 12, 12}, {1, 1, 1}}};
    samples s;
    *lobes = (lq_lobes){.material = baked->material, .axis_count = 1 + baked->material->range_count};
    lq_status status = take_samples(&s, baked, error);
    if (status == LQ_OK) choose_channels(lobes, &s, 1e-6);
    if (status == LQ_OK && lobes->channel_count > 0)
        status = try_choice(lobes, &s, &fine[baked->material->range_count], NULL, NULL, error);
    free_samples(&s);
    if (status != LQ_OK) lq_lobes_free(lobes);
    return status;
}

void lq_lobes_free(lq_lobes *lobes) {
    clear(lobes);
    *lobes = (lq_lobes){0};
}

void lq_lobes_sample(const lq_lobes *l, double mu, const double *values, int bits,
                     double numbers[LQ_MATERIAL_NUMBERS]) {
    size_t below[LQ_LOBES_AXES] = {0};
    double above[LQ_LOBES_AXES] = {0.0}, sum[LQ_MATERIAL_NUMBERS] = {0.0};
    const int axes = l->channel_count > 0 ? l->axis_count : 0;
    for (int a = 0; a < axes; a++)
        below[a] = lq_texel_below(&l->axes[a], a == 0 ? mu : values[a - 1], bits, &above[a]);
    for (int corner = 0; corner < 1 << axes; corner++) {
        double w = 1.0;
        size_t at[LQ_LOBES_AXES] = {0};
        for (int a = 0; a < axes; a++) {
            const bool up = (corner >> a & 1) != 0;
            w *= up ? above[a] : 1.0 - above[a];
            at[a] = below[a] + (up ? 1 : 0);
        }
        for (int c = 0; c < l->channel_count; c++) sum[c] += w * (double)*texel_at(l, at, c);
    }
    for (int k = 0; k < LQ_MATERIAL_NUMBERS; k++)
        numbers[k] = l->channel[k] < 0 ? l->constant[k] : sum[l->channel[k]];
}

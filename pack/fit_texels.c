/* fit_texels.c - least squares by conjugate gradients. (Raising errors to higher powers was tried: the
 * largest hardly falls, for it lies between samples.) */
#include "pack/fit_texels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/status.h"

enum { PARTS = 3, STEPS = 60 };

/* The texels that a sample is interpolated from. */
typedef struct taps {
    int count;
    size_t texel[16];
    double share[16];
} taps;

typedef struct fit {
    size_t texels, samples;
    taps *taps;
    const float *wanted;
    double *weight; /* of each sample */
    double *x, *gradient, *direction, *product, *diagonal;
} fit;

lq_status lq_fit_axes(const lq_axis *axes, int axis_count, lq_axis *finer, lq_error *error) {
    for (int a = 0; a < axis_count; a++) {
        const lq_axis *axis = &axes[a];
        const size_t size = axis->size > 1 ? (axis->size - 1) * PARTS + 1 : 1;
        const lq_status status =
            lq_axis_make(&finer[a], axis->name, axis->min, axis->max, size, axis->map, axis->exponent, error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

/* ======================================================================================
 *                                   Least squares
 * ====================================================================================== */

static double interpolate(const taps *t, const double *x) {
    double sum = 0.0;
    for (int k = 0; k < t->count; k++) sum += t->share[k] * x[t->texel[k]];
    return sum;
}

/* to = A^T W A from */
static void apply(const fit *f, const double *from, double *to) {
    memset(to, 0, f->texels * sizeof *to);
    for (size_t s = 0; s < f->samples; s++) {
        const taps *t = &f->taps[s];
        const double w = f->weight[s] * interpolate(t, from);
        for (int k = 0; k < t->count; k++) to[t->texel[k]] += w * t->share[k];
    }
}

static double dot(const double *a, const double *b, size_t count) {
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

/* gradient = A^T W (wanted - A x), and the diagonal of A^T W A */
static void begin(const fit *f) {
    memset(f->gradient, 0, f->texels * sizeof *f->gradient);
    for (size_t i = 0; i < f->texels; i++) f->diagonal[i] = 1e-12;
    for (size_t s = 0; s < f->samples; s++) {
        const taps *t = &f->taps[s];
        const double w = f->weight[s] * ((double)f->wanted[s] - interpolate(t, f->x));
        for (int k = 0; k < t->count; k++) {
            f->gradient[t->texel[k]] += w * t->share[k];
            f->diagonal[t->texel[k]] += f->weight[s] * t->share[k] * t->share[k];
        }
    }
}

static double scaled_square(const fit *f) {
    double sum = 0.0;
    for (size_t i = 0; i < f->texels; i++) sum += f->gradient[i] * f->gradient[i] / f->diagonal[i];
    return sum;
}

static void solve(const fit *f) {
    begin(f);
    for (size_t i = 0; i < f->texels; i++) f->direction[i] = f->gradient[i] / f->diagonal[i];
    double square = scaled_square(f);
    const double enough = 1e-16 * square;
    for (int step = 0; step < STEPS && square > enough; step++) {
        apply(f, f->direction, f->product);
        const double along = square / dot(f->direction, f->product, f->texels);
        for (size_t i = 0; i < f->texels; i++) {
            f->x[i] += along * f->direction[i];
            f->gradient[i] -= along * f->product[i];
        }
        const double next = scaled_square(f);
        for (size_t i = 0; i < f->texels; i++)
            f->direction[i] = f->gradient[i] / f->diagonal[i] + next / square * f->direction[i];
        square = next;
    }
}

/* ======================================================================================
 *                                       A table
 * ====================================================================================== */

/* A sample's taps: on each axis between node i / PARTS and the next. */
static void place(taps *t, const lq_table *table, const lq_table *samples, size_t sample) {
    *t = (taps){1, {0}, {1.0}};
    size_t stride = 1;
    for (int a = 0; a < table->axis_count; a++) {
        const size_t at = sample % samples->axes[a].size, below = at / PARTS;
        const double above = (double)(at % PARTS) / PARTS;
        sample /= samples->axes[a].size;
        const int before = t->count;
        for (int k = 0; k < before; k++) t->texel[k] += below * stride;
        for (int k = 0; k < before && above > 0.0; k++) {
            t->texel[t->count] = t->texel[k] + stride;
            t->share[t->count++] = t->share[k] * above;
            t->share[k] *= 1.0 - above;
        }
        stride *= table->axes[a].size;
    }
}

static double weight_of(const lq_table *samples, size_t sample, double from) {
    bool promised = true;
    for (int a = 0; a < samples->axis_count; a++) {
        const lq_axis *axis = &samples->axes[a];
        const bool bounded = strcmp(axis->name, "mu") == 0 || strcmp(axis->name, "alpha") == 0;
        promised = promised && !(bounded && axis->nodes[sample % axis->size] < from);
        sample /= axis->size;
    }
    return promised ? 1.0 : 0.01;
}

/* The fit into the texels, between the smallest and the largest sample: it may overshoot what is physical.
 * The largest change. */
static double take(const fit *f, float *texels) {
    float low = INFINITY, high = -INFINITY;
    double moved = 0.0;
    for (size_t s = 0; s < f->samples; s++) {
        low = fminf(low, f->wanted[s]);
        high = fmaxf(high, f->wanted[s]);
    }
    for (size_t i = 0; i < f->texels; i++) {
        const float fitted = fminf(fmaxf((float)f->x[i], low), high);
        moved = fmax(moved, fabs((double)fitted - (double)texels[i]));
        texels[i] = fitted;
    }
    return moved;
}

static bool allocate(fit *f) {
    double **const columns[] = {&f->x, &f->gradient, &f->direction, &f->product, &f->diagonal};
    bool there = (f->taps = malloc(f->samples * sizeof *f->taps)) != NULL;
    there = (f->weight = malloc(f->samples * sizeof(double))) && there;
    for (int i = 0; i < 5; i++) there = (*columns[i] = malloc(f->texels * sizeof(double))) && there;
    return there;
}

static void release(fit *f) {
    double *const all[] = {f->weight, f->x, f->gradient, f->direction, f->product, f->diagonal};
    for (int i = 0; i < 6; i++) free(all[i]);
    free(f->taps);
}

lq_status lq_fit_texels(lq_table *table, const lq_table *samples, double from, double *moved,
                        lq_error *error) {
    *moved = 0.0;
    fit f = {.texels = lq_table_entries(table), .samples = lq_table_entries(samples)};
    lq_status status =
        allocate(&f) ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu samples", f.samples);
    for (size_t s = 0; s < f.samples && status == LQ_OK; s++) {
        place(&f.taps[s], table, samples, s);
        f.weight[s] = weight_of(samples, s, from);
    }
    for (int c = 0; c < table->channel_count && status == LQ_OK; c++) {
        f.wanted = samples->channels[c];
        for (size_t i = 0; i < f.texels; i++) f.x[i] = (double)table->channels[c][i];
        solve(&f);
        *moved = fmax(*moved, take(&f, table->channels[c]));
    }
    release(&f);
    return status;
}

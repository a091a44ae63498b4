/* Error metrics: maximum, rms, bias, percentile, and scores with a limit for many comparisons at once. */
#include "validate/compare.h"

#include "system/status.h"

#include <math.h>
#include <stdlib.h>

double lq_z_limit(size_t comparisons) {
    const double chance = LQ_FALSE_ALARM / (double)(comparisons > 0 ? comparisons : 1);
    double low = 0.0, high = 40.0;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (erfc(middle * 0.70710678118654752440) > chance) low = middle;
        else high = middle;
    }
    return high;
}

double lq_compared_score(const lq_compared *point) {
    const double d = point->value - point->reference;
    const double excess = fabs(d) - point->allowance;
    if (isnan(excess) || isnan(point->noise)) return INFINITY;
    return excess > 0.0 ? copysign(excess / point->noise, d) : 0.0;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The value that a hundredth of the points exceed; sorts `sizes`. */
static double percentile99(double *sizes, size_t count) {
    qsort(sizes, count, sizeof *sizes, ascending);
    const size_t above = count / 100;
    return sizes[count - 1 - above];
}

static void add(lq_comparison *r, const lq_compared *point, size_t i, double *size) {
    const double d = point->value - point->reference;
    const double z = lq_compared_score(point);
    *size = isnan(d) ? INFINITY : fabs(d);
    if (*size > r->max || i == 0) {
        r->max = *size;
        r->worst = i;
    }
    if (fabs(z) > r->z_max || i == 0) {
        r->z_max = fabs(z);
        r->z_worst = i;
    }
    r->rms += d * d;
    r->mean += d;
    r->z2 += z * z;
    r->z_bias += z;
    r->beyond4 += fabs(z) > 4.0;
}

lq_status lq_compare(const lq_compared *points, size_t count, size_t comparisons, lq_comparison *result,
                     lq_error *error) {
    *result = (lq_comparison){.count = count};
    if (count == 0) return lq_fail(error, LQ_BAD_INPUT, "nothing to compare");
    double *sizes = malloc(count * sizeof *sizes);
    if (!sizes) return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu errors", count);
    for (size_t i = 0; i < count; i++) add(result, &points[i], i, &sizes[i]);
    const double n = (double)count;
    result->p99 = percentile99(sizes, count);
    free(sizes);
    result->rms = sqrt(result->rms / n);
    result->mean /= n;
    result->z2 /= n;
    result->z_bias /= sqrt(n);
    result->beyond4_expected = n * erfc(4.0 * 0.70710678118654752440);
    result->z_limit = lq_z_limit(comparisons);
    result->explained = result->z_max <= result->z_limit && fabs(result->z_bias) <= result->z_limit;
    return LQ_OK;
}

static bool same_shape(const lq_table *a, const lq_table *b) {
    if (a->axis_count != b->axis_count) return false;
    for (int k = 0; k < a->axis_count; k++) {
        if (a->axes[k].size != b->axes[k].size) return false;
        for (size_t i = 0; i < a->axes[k].size; i++)
            if (a->axes[k].nodes[i] != b->axes[k].nodes[i]) return false;
    }
    return true;
}

lq_status lq_compare_tables(const lq_table *table, const lq_table *reference, int channel,
                            lq_comparison *result, lq_error *error) {
    if (!same_shape(table, reference))
        return lq_fail(error, LQ_BAD_INPUT, "tables over different axes cannot be compared entry by entry");
    if (channel < 0 || channel >= table->channel_count || channel >= reference->channel_count)
        return lq_fail(error, LQ_BAD_INPUT, "no channel %d in both tables", channel);
    const size_t count = lq_table_entries(table);
    lq_compared *points = calloc(count, sizeof *points);
    if (!points) return lq_fail(error, LQ_NO_MEMORY, "no memory to compare %zu entries", count);
    for (size_t i = 0; i < count; i++)
        points[i] = (lq_compared){.value = (double)table->channels[channel][i],
                                  .reference = (double)reference->channels[channel][i],
                                  .allowance = INFINITY};
    const lq_status status = lq_compare(points, count, count, result, error);
    free(points);
    return status;
}

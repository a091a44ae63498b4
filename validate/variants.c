/* Variants of a definition: each changes one thing of the stated one; all are computed over the same few
 * nodes. */
#include "validate/variants.h"

#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ======================================================================================
 *                                     What is tried
 * ====================================================================================== */

typedef enum axis_change { AS_IS, SQUARED, ROOTED, INVERTED, FLIPPED, ANGLE } axis_change;
typedef enum value_change { UNCHANGED, COMPLEMENT, TIMES_ETA2, OVER_ETA2, SWAPPED } value_change;

/* One change: of the axis called `axis`, of the values, or of the kind. */
typedef struct change {
    const char *what;
    const char *axis;
    axis_change how;
    value_change value;
    const char *kind, *instead; /* for this kind, compute that one */
} change;

static const change changes[] = {
    {.what = "as stated"},
    {"its alpha is r with alpha = r^2", "alpha", SQUARED, UNCHANGED, NULL, NULL},
    {"its alpha is alpha^2", "alpha", ROOTED, UNCHANGED, NULL, NULL},
    {"its alpha runs the other way", "alpha", FLIPPED, UNCHANGED, NULL, NULL},
    {"its mu runs the other way", "mu", FLIPPED, UNCHANGED, NULL, NULL},
    {"its mu is mu^2", "mu", ROOTED, UNCHANGED, NULL, NULL},
    {"its mu is 1 - 2 theta / pi, linear in angle", "mu", ANGLE, UNCHANGED, NULL, NULL},
    {"its eta is 1 / eta, seen from the other side", "eta", INVERTED, UNCHANGED, NULL, NULL},
    {"its eta runs the other way", "eta", FLIPPED, UNCHANGED, NULL, NULL},
    {"its tau runs the other way", "tau", FLIPPED, UNCHANGED, NULL, NULL},
    {"the complement, 1 - x", NULL, AS_IS, COMPLEMENT, NULL, NULL},
    {"radiance instead of flux: x eta^2", "eta", AS_IS, TIMES_ETA2, NULL, NULL},
    {"radiance instead of flux: x / eta^2", "eta", AS_IS, OVER_ETA2, NULL, NULL},
    {"its two channels are swapped", NULL, AS_IS, SWAPPED, NULL, NULL},
    {"the convention tir-loss", NULL, AS_IS, UNCHANGED, "tir-pass", "tir-loss"},
    {"1 - tir-loss", NULL, AS_IS, COMPLEMENT, "tir-pass", "tir-loss"},
    {"the convention tir-pass", NULL, AS_IS, UNCHANGED, "tir-loss", "tir-pass"},
    {"1 - tir-pass", NULL, AS_IS, COMPLEMENT, "tir-loss", "tir-pass"},
    {"diffuse-reflection", NULL, AS_IS, UNCHANGED, "diffuse-transmission", "diffuse-reflection"},
    {"diffuse-transmission", NULL, AS_IS, UNCHANGED, "diffuse-reflection", "diffuse-transmission"},
};
enum { CHANGES = sizeof changes / sizeof changes[0] };

static bool applies(const change *c, const lq_table *table, const lq_kind *kind) {
    if (c->kind && strcmp(c->kind, kind->id) != 0) return false;
    if (c->value == SWAPPED && kind->channel_count != 2) return false;
    return !c->axis || lq_table_axis(table, c->axis) >= 0;
}

/* ======================================================================================
 *                                     A few of its nodes
 * ====================================================================================== */

/* Nodes taken along each axis of a table of 1, 2, ... axes. */
static const size_t nodes_taken[LQ_MAX_AXES] = {48, 14, 9, 6, 4, 3};

typedef struct sample {
    const lq_table *table;
    size_t size[LQ_MAX_AXES];
    size_t *index[LQ_MAX_AXES]; /* of the nodes taken */
    size_t count;               /* entries of a channel */
    double *difference;         /* count x channels */
} sample;

static void free_sample(sample *s) {
    for (int a = 0; a < LQ_MAX_AXES; a++) free(s->index[a]);
    free(s->difference);
}

static lq_status take_sample(sample *s, const lq_table *table, lq_error *error) {
    *s = (sample){.table = table, .count = 1};
    bool made = true;
    for (int a = 0; a < table->axis_count; a++) {
        const size_t all = table->axes[a].size, most = nodes_taken[table->axis_count - 1];
        const size_t size = s->size[a] = all < most ? all : most;
        s->index[a] = malloc(size * sizeof *s->index[a]);
        made = made && s->index[a];
        for (size_t i = 0; made && i < size; i++) s->index[a][i] = size > 1 ? i * (all - 1) / (size - 1) : 0;
        s->count *= size;
    }
    s->difference = malloc(s->count * (size_t)table->channel_count * sizeof *s->difference);
    if (made && s->difference) return LQ_OK;
    free_sample(s);
    return lq_fail(error, LQ_NO_MEMORY, "no memory for %zu entries", s->count);
}

/* ======================================================================================
 *                                      One variant
 * ====================================================================================== */

static double moved(const lq_axis *axis, axis_change how, double x) {
    switch (how) {
    case SQUARED:
        return x * x;
    case ROOTED:
        return sqrt(fmax(x, 0.0));
    case INVERTED:
        return 1.0 / x;
    case FLIPPED:
        return axis->max - (x - axis->min);
    case ANGLE:
        return sin(1.57079632679489661923 * fmin(fmax(x, 0.0), 1.0));
    default:
        return x;
    }
}

static bool descends(axis_change how) {
    return how == INVERTED || how == FLIPPED;
}

/* The nodes taken along axis `a`, as the variant reads them, ascending. LQ_BAD_INPUT where it cannot. */
static lq_status variant_axis(const sample *s, const lq_kind *kind, int a, axis_change how, lq_axis *axis,
                              lq_error *error) {
    const lq_axis *from = &s->table->axes[a];
    const size_t size = s->size[a];
    double nodes[64];
    for (size_t i = 0; i < size; i++) {
        const size_t at = descends(how) ? size - 1 - i : i;
        nodes[i] = moved(from, how, from->nodes[s->index[a][at]]);
        /* published ranges are floats: an end may lie a rounding beyond */
        if (nodes[i] < kind->axes[a].lowest - 1e-6 || nodes[i] > kind->axes[a].highest + 1e-6)
            return lq_fail(error, LQ_BAD_INPUT, "%s = %g is out of range", from->name, nodes[i]);
        nodes[i] = fmin(fmax(nodes[i], kind->axes[a].lowest), kind->axes[a].highest);
    }
    return lq_axis_make_custom(axis, from->name, nodes, size, error);
}

static double variant_value(const change *c, const lq_table *exact, int channel, size_t entry, double eta) {
    const int from = c->value == SWAPPED ? 1 - channel : channel;
    const double x = (double)exact->channels[from][entry];
    switch (c->value) {
    case COMPLEMENT:
        return 1.0 - x;
    case TIMES_ETA2:
        return x * eta * eta;
    case OVER_ETA2:
        return x / (eta * eta);
    default:
        return x;
    }
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double trimmed_rms(double *sizes, size_t count) {
    const size_t kept = count - count / 20;
    double sum = 0.0;
    qsort(sizes, count, sizeof *sizes, ascending);
    for (size_t i = 0; i < kept; i++) sum += sizes[i] * sizes[i];
    return sqrt(sum / (double)kept);
}

static double compare(sample *s, const change *c, const lq_table *exact) {
    const lq_table *table = s->table;
    const int eta_axis = lq_table_axis(table, "eta");
    size_t used = 0;
    for (size_t i = 0; i < s->count; i++) {
        size_t rest = i, entry = 0, stride = 1, there = 0, stride_there = 1;
        double eta = 1.0;
        for (int a = 0; a < table->axis_count; a++) {
            const size_t k = rest % s->size[a];
            const bool turned = c->axis && descends(c->how) && strcmp(table->axes[a].name, c->axis) == 0;
            rest /= s->size[a];
            entry += stride * s->index[a][k];
            stride *= table->axes[a].size;
            there += stride_there * (turned ? s->size[a] - 1 - k : k);
            stride_there *= s->size[a];
            if (a == eta_axis) eta = table->axes[a].nodes[s->index[a][k]];
        }
        for (int channel = 0; channel < table->channel_count; channel++) {
            const double d =
                (double)table->channels[channel][entry] - variant_value(c, exact, channel, there, eta);
            s->difference[used++] = isfinite(d) ? fabs(d) : 1e30;
        }
    }
    return trimmed_rms(s->difference, used);
}

static lq_status try_one(sample *s, const lq_kind *kind, const lq_settings *settings, const change *c,
                         double *rms, lq_error *error) {
    const lq_kind *computed = c->instead ? lq_kind_find(c->instead, error) : kind;
    lq_axis axes[LQ_MAX_AXES] = {{.size = 0}};
    lq_table *exact = NULL;
    lq_status status = computed ? LQ_OK : LQ_BAD_INPUT;
    for (int a = 0; status == LQ_OK && a < kind->axis_count; a++) {
        const bool changed = c->axis && strcmp(kind->axes[a].name, c->axis) == 0;
        status = variant_axis(s, computed, a, changed ? c->how : AS_IS, &axes[a], error);
    }
    lq_settings loose = *settings;
    if (computed) loose.tolerance = fmin(10.0 * computed->tolerance, LQ_LOOSEST_TOLERANCE);
    if (status == LQ_OK) status = lq_precompute(computed, &loose, axes, NULL, &exact, error);
    if (status == LQ_NOT_CONVERGED) status = LQ_OK; /* it is close enough to tell definitions apart */
    if (status == LQ_OK) *rms = compare(s, c, exact);
    lq_table_free(exact);
    for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    return status;
}

/* ======================================================================================
 *                                        All of them
 * ====================================================================================== */

typedef struct attempt {
    sample sample;
    const lq_kind *kind;
    const lq_progress *progress;
    lq_variants *found;
    size_t done, all;
} attempt;

/* What cannot be computed (out of range, an NDF that needs parameters) is not a variant of this table. */
static lq_status attempt_one(attempt *t, const lq_settings *settings, const change *c, const char *what,
                             lq_error *error) {
    lq_variant *variant = &t->found->list[t->found->count];
    const lq_progress *progress = t->progress;
    t->done++;
    if (t->found->count == LQ_MAX_VARIANTS) return LQ_OK;
    lq_error cause = {""};
    const lq_status status = try_one(&t->sample, t->kind, settings, c, &variant->rms, &cause);
    if (status == LQ_OK) {
        snprintf(variant->what, sizeof variant->what, "%s", what);
        t->found->count++;
    } else if (status != LQ_BAD_INPUT) {
        return lq_fail(error, status, "%s", cause.text);
    }
    if (progress && progress->report &&
        !progress->report(progress->user, fmin((double)t->done / (double)t->all, 1.0)))
        return lq_fail(error, LQ_CANCELLED, "cancelled");
    return LQ_OK;
}

/* The same numbers? Of all orders of scattering, none has a masking of its own. */
static bool equivalent(unsigned takes, const lq_settings *a, const lq_settings *b) {
    if ((takes & LQ_TAKES_SCATTERING) && a->scattering != b->scattering) return false;
    const bool masked = !(takes & LQ_TAKES_SCATTERING) || a->scattering == LQ_SINGLE;
    return !(takes & LQ_TAKES_MASKING) || !masked || a->masking == b->masking;
}

static lq_status attempt_physics(attempt *t, const lq_settings *stated, lq_error *error) {
    static const struct {
        lq_scattering scattering;
        lq_masking masking;
        const char *both, *scattering_only, *masking_only;
    } physics[] = {
        {LQ_MULTIPLE, LQ_CORRELATED, "multiple scattering", "multiple scattering", NULL},
        {LQ_SINGLE, LQ_CORRELATED, "single scattering, correlated masking", "single scattering",
         "correlated masking"},
        {LQ_SINGLE, LQ_SEPARABLE, "single scattering, separable masking", NULL, "separable masking"}};
    const unsigned takes = t->kind->takes;
    lq_status status = LQ_OK;
    for (int p = 0; status == LQ_OK && p < 3; p++) {
        lq_settings settings = *stated;
        const char *what = takes == (LQ_TAKES_SCATTERING | LQ_TAKES_MASKING) ? physics[p].both
                           : takes & LQ_TAKES_SCATTERING                     ? physics[p].scattering_only
                           : takes & LQ_TAKES_MASKING                        ? physics[p].masking_only
                                                                             : NULL;
        if (takes & LQ_TAKES_SCATTERING) settings.scattering = physics[p].scattering;
        if (takes & LQ_TAKES_MASKING) settings.masking = physics[p].masking;
        if (what && !equivalent(takes, &settings, stated))
            status = attempt_one(t, &settings, &changes[0], what, error);
    }
    return status;
}

static const char *const other_ndfs[] = {"ggx", "beckmann", "gtr:gamma=1", "gtr:gamma=3"};
enum { NDFS = sizeof other_ndfs / sizeof other_ndfs[0] };

static lq_status attempt_ndfs(attempt *t, const lq_settings *stated, lq_error *error) {
    lq_status status = LQ_OK;
    for (int i = 0; status == LQ_OK && i < NDFS; i++) {
        lq_settings settings = *stated;
        char what[64];
        if (strcmp(stated->ndf, other_ndfs[i]) == 0) continue;
        settings.ndf = other_ndfs[i];
        settings.opened = NULL;
        snprintf(what, sizeof what, "the NDF %s", other_ndfs[i]);
        status = attempt_one(t, &settings, &changes[0], what, error);
    }
    return status;
}

static int closest_first(const void *a, const void *b) {
    const lq_variant *x = a, *y = b;
    return (x->rms > y->rms) - (x->rms < y->rms);
}

lq_status lq_variants_try(const lq_table *table, const lq_kind *kind, const lq_settings *settings,
                          const lq_progress *progress, lq_variants *variants, lq_error *error) {
    *variants = (lq_variants){.count = 0};
    attempt t = {.kind = kind, .progress = progress, .found = variants, .all = NDFS + 2};
    lq_status status = take_sample(&t.sample, table, error);
    if (status != LQ_OK) return status;
    for (int c = 0; c < CHANGES; c++) t.all += applies(&changes[c], table, kind);
    for (int c = 0; status == LQ_OK && c < CHANGES; c++)
        if (applies(&changes[c], table, kind))
            status = attempt_one(&t, settings, &changes[c], changes[c].what, error);
    variants->stated = variants->count > 0 ? variants->list[0].rms : NAN;
    variants->entries = t.sample.count * (size_t)table->channel_count;
    if (status == LQ_OK) status = attempt_physics(&t, settings, error);
    if (status == LQ_OK) status = attempt_ndfs(&t, settings, error);
    free_sample(&t.sample);
    qsort(variants->list, variants->count, sizeof variants->list[0], closest_first);
    variants->other = variants->count > 0 && variants->list[0].rms < 0.5 * variants->stated;
    return status;
}

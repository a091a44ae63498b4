/* pca.c - lq_pca: a table into factors, piece by piece. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/piece.h"
#include "pca/refine.h"
#include "system/extend.h"
#include "system/parallel.h"
#include "system/status.h"

lq_pca_options lq_pca_options_default(void) {
    return (lq_pca_options){.struct_size = sizeof(lq_pca_options),
                            .scheme = LQ_JOINT,
                            .value = LQ_VALUE_PLAIN,
                            .pairs = 2,
                            .power = 8.0,
                            .sweeps = 30};
}

/* ------------------------------------------------------------------ what can be asked */

static lq_status check_separations(const lq_table *table, const lq_pca_options *options, lq_error *error) {
    bool taken[LQ_MAX_AXES] = {false};
    int axes = 0, left = 0;
    if (options->separation_count < 0 || options->separation_count > LQ_MAX_AXES)
        return lq_fail(error, LQ_BAD_INPUT, "%d separations; accepted are 0 to %d", options->separation_count,
                       LQ_MAX_AXES);
    for (int i = 0; i < options->separation_count; i++) {
        const lq_separation *s = &options->separations[i];
        if (s->axis_count < 1 || s->axis_count > 2 || s->bases < 1 || s->bases > LQ_MAX_BASES)
            return lq_fail(error, LQ_BAD_INPUT,
                           "a separation of %d axes into %zu bases; accepted are 1 or 2 "
                           "axes and 1 to %d bases",
                           s->axis_count, s->bases, LQ_MAX_BASES);
        for (int j = 0; j < s->axis_count; j++, axes++) {
            const int a = s->axes[j];
            if (a < 0 || a >= table->axis_count || taken[a])
                return lq_fail(error, LQ_BAD_INPUT, "axis %d is separated twice or not there", a);
            taken[a] = true;
            if (table->axes[a].size < 2)
                return lq_fail(error, LQ_BAD_INPUT, "axis %s has one node; there is nothing to separate",
                               table->axes[a].name);
        }
    }
    for (int a = 0; a < table->axis_count; a++) left += !taken[a] && table->axes[a].size > 1;
    if (left < 1 || left > 2)
        return lq_fail(error, LQ_BAD_INPUT,
                       "%d axes of the table stay together; accepted are 1 or 2: separate %s", left,
                       left > 2 ? "more" : "fewer");
    if (options->scheme == LQ_JOINT && axes > 2)
        return lq_fail(error, LQ_BAD_INPUT, "%d axes to separate; accepted by the joint scheme are 0 to 2",
                       axes);
    return LQ_OK;
}

static lq_status check_value(const lq_table *table, const lq_pca_options *options, lq_error *error) {
    if (options->value != LQ_VALUE_BEER) return LQ_OK;
    for (int i = 0; i < options->separation_count; i++)
        for (int j = 0; j < options->separations[i].axis_count; j++)
            if (options->separations[i].axes[j] == options->value_axis) {
                const lq_axis *axis = &table->axes[options->value_axis];
                if (axis->min >= 0.0 && axis->max <= 1.0 && axis->size >= 3) return LQ_OK;
                return lq_fail(error, LQ_BAD_INPUT,
                               "value beer: axis %s is not a transmittance in [0,1] with 3 "
                               "nodes or more",
                               axis->name);
            }
    return lq_fail(error, LQ_BAD_INPUT, "value beer: the axis of transmittance, tau, must be separated");
}

static lq_status check_critical(const lq_table *table, const lq_pca_options *options, lq_error *error) {
    const int mu = lq_table_axis(table, "mu"), eta = lq_table_axis(table, "eta");
    if (!options->critical) return LQ_OK;
    bool good = mu >= 0 && eta >= 0 && table->axes[mu].size > 1 && table->axes[eta].size > 1;
    good = good && table->axes[eta].min < 1.0;
    for (int i = 0; i < options->separation_count; i++)
        for (int j = 0; j < options->separations[i].axis_count; j++)
            good = good && options->separations[i].axes[j] != mu && options->separations[i].axes[j] != eta;
    if (good) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "the critical cosine needs mu and eta below 1 in one plane: separate the others");
}

/* What options of an older header say; what that header did not have is as the defaults are. */
lq_status lq_pca_options_read(lq_pca_options *options, const lq_pca_options *given, lq_error *error) {
    const size_t first = offsetof(lq_pca_options, splits) + sizeof given->splits; /* version 0.1.0 */
    *options = lq_pca_options_default();
    return lq_extend(options, sizeof *options, given, first, "factor options", error);
}

lq_status lq_pca_check_splits(const lq_table *table, const lq_pca_options *options, lq_error *error) {
    if (options->split_count < 0 || options->split_count >= LQ_MAX_PIECES)
        return lq_fail(error, LQ_BAD_INPUT, "%d splits; accepted are 0 to %d", options->split_count,
                       LQ_MAX_PIECES - 1);
    if (options->split_count > 0 && (options->split_axis < 0 || options->split_axis >= table->axis_count))
        return lq_fail(error, LQ_BAD_INPUT, "axis %d to split; accepted are 0 to %d", options->split_axis,
                       table->axis_count - 1);
    for (int i = 0; i < options->split_count; i++) {
        const lq_axis *axis = &table->axes[options->split_axis];
        const double at = options->splits[i], before = i > 0 ? options->splits[i - 1] : axis->min;
        bool node = false;
        for (size_t n = 0; n < axis->size; n++) node = node || axis->nodes[n] == at;
        if (!node || !(at > before) || !(at < axis->max))
            return lq_fail(error, LQ_BAD_INPUT,
                           "split at %s = %g; accepted are nodes inside the table, ascending", axis->name,
                           at);
    }
    return LQ_OK;
}

lq_status lq_pca_check_table(const lq_table *table, int channel, lq_error *error) {
    if (channel < 0 || channel >= table->channel_count)
        return lq_fail(error, LQ_BAD_INPUT, "channel %d; the table has %d", channel, table->channel_count);
    lq_status status = LQ_OK;
    const size_t entries = lq_table_entries(table);
    for (size_t i = 0; i < entries && status == LQ_OK; i++)
        if (!isfinite(table->channels[channel][i]))
            status =
                lq_fail(error, LQ_BAD_INPUT, "the table holds %g at entry %zu; accepted are finite values",
                        (double)table->channels[channel][i], i);
    return status;
}

static lq_status check_numbers(const lq_pca_options *options, lq_error *error) {
    for (int k = 0; k < LQ_MAX_STREAMS; k++)
        if (options->bases[k] > LQ_MAX_BASES)
            return lq_fail(error, LQ_BAD_INPUT, "%zu bases; accepted are 1 to %d", options->bases[k],
                           LQ_MAX_BASES);
    if (lq_separated_bases(options) > LQ_MAX_BASES && options->scheme == LQ_JOINT && options->bases[0] == 0)
        return lq_fail(error, LQ_BAD_INPUT, "%zu bases; accepted are 1 to %d", lq_separated_bases(options),
                       LQ_MAX_BASES);
    if (options->threads < 0)
        return lq_fail(error, LQ_BAD_INPUT, "%d threads; accepted are 0, one per core, and more",
                       options->threads);
    if (options->pairs <= LQ_MAX_PAIRS && options->power >= 2.0 && options->power <= 64.0 &&
        options->sweeps >= 0)
        return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT,
                   "%zu pairs, power %g, %d sweeps; accepted are up to %d pairs and a power "
                   "of 2 to 64",
                   options->pairs, options->power, options->sweeps, LQ_MAX_PAIRS);
}

lq_status lq_pca_check_options(const lq_table *table, const lq_pca_options *options, lq_error *error) {
    lq_status status = lq_pca_check_splits(table, options, error);
    if (status == LQ_OK) status = check_separations(table, options, error);
    if (status == LQ_OK) status = check_numbers(options, error);
    if (status == LQ_OK) status = check_value(table, options, error);
    return status == LQ_OK ? check_critical(table, options, error) : status;
}

/* ------------------------------------------------------------------ the call */

/* The physical range: of the kind where the table says which it is, of its values otherwise. */
static void set_range(const lq_table *table, int channel, lq_factored *factored) {
    const char *id = lq_table_fact(table, "table");
    const lq_kind *kind = id ? lq_kind_find(id, NULL) : NULL;
    if (kind) {
        factored->value_min = kind->value_min;
        factored->value_max = kind->value_max;
        return;
    }
    const size_t entries = lq_table_entries(table);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < entries; i++) {
        low = fmin(low, (double)table->channels[channel][i]);
        high = fmax(high, (double)table->channels[channel][i]);
    }
    factored->value_min = low;
    factored->value_max = high > low ? high : low + 1.0;
}

lq_status lq_factored_start(const lq_table *table, int channel, lq_factored **factored, lq_error *error) {
    lq_factored *made = calloc(1, sizeof *made);
    *factored = NULL;
    if (!made) return lq_fail(error, LQ_NO_MEMORY, "no memory for factors");
    made->axis_count = table->axis_count;
    for (int a = 0; a < table->axis_count; a++) {
        memcpy(made->axes[a].name, table->axes[a].name, sizeof made->axes[a].name);
        made->axes[a].min = table->axes[a].min;
        made->axes[a].max = table->axes[a].max;
    }
    set_range(table, channel, made);
    lq_status status = lq_factored_set_fact(made, "channel", table->channel_names[channel], error);
    for (size_t i = 0; i < table->fact_count && status == LQ_OK; i++)
        status = lq_factored_set_fact(made, table->facts[i].key, table->facts[i].value, error);
    if (status != LQ_OK) lq_factored_free(made);
    else *factored = made;
    return status;
}

/* Progress of one piece among all. */
typedef struct share {
    const lq_progress *whole;
    int piece, pieces;
} share;

static bool report_share(void *user, double fraction) {
    const share *s = user;
    return s->whole->report(s->whole->user, (s->piece + fraction) / s->pieces);
}

static lq_status add_piece(const lq_table *table, int channel, const lq_pca_options *options,
                           const lq_progress *progress, lq_factored *factored, lq_error *error) {
    share part = {progress, factored->piece_count, options->split_count + 1};
    const lq_progress shared = {report_share, &part};
    lq_piece *piece = &factored->pieces[factored->piece_count];
    lq_piece_box(table, options, factored->piece_count++, piece);
    return lq_piece_make(table, channel, options, progress && progress->report ? &shared : NULL, piece,
                         error);
}

lq_status lq_pca(const lq_table *table, int channel, const lq_pca_options *options,
                 const lq_progress *progress, lq_factored **factored, lq_error *error) {
    lq_pca_options o;
    *factored = NULL;
    lq_status status = lq_pca_options_read(&o, options, error);
    if (status == LQ_OK) status = lq_pca_check_options(table, &o, error);
    if (status == LQ_OK) status = lq_pca_check_table(table, channel, error);
    if (status == LQ_OK) status = lq_factored_start(table, channel, factored, error);
    const int before = lq_threads_set(o.threads);
    for (int p = 0; status == LQ_OK && p <= o.split_count; p++)
        status = add_piece(table, channel, &o, progress, *factored, error);
    lq_threads_set(before);
    if (status == LQ_OK) status = lq_factored_check(*factored, error);
    if (status == LQ_OK) return LQ_OK;
    lq_factored_free(*factored);
    *factored = NULL;
    return status;
}

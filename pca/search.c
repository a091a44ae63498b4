/* search.c - the smallest factors within an error, or the best within a size.
 *
 * A family says which axes are separated and what is factored. Its ranks form a ladder from small to large.
 * With a budget each family is climbed until it is met, and left where it would cost more bytes than another
 * already does; then the plane's textures are made smaller for as long as the budget holds. With a size the
 * highest rung that fits is taken, for several sizes of the textures. Fits on the way take few sweeps; the
 * one chosen is fitted in full.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "pca/factors.h"
#include "pca/measure.h"
#include "pca/piece.h"
#include "pca/refine.h"
#include "system/extend.h"
#include "system/parallel.h"
#include "system/status.h"

enum {
    QUICK_SWEEPS = 8, /* from 8 to 30 the largest error falls by some 10 to 30 % */
    FAMILIES_MAX = 12,
    RUNGS_MAX = 10,
    QUICK_PAIRS = 3
};

typedef struct family {
    lq_pca_options options;
    int rungs;
    size_t bases[RUNGS_MAX][LQ_MAX_STREAMS];
} family;

typedef struct search {
    const lq_table *table;
    int channel, piece;
    const lq_pca_goal *goal;
    const lq_progress *progress;
    double done, share; /* of all the work: before this piece, of this piece */
    lq_piece box;
    lq_table *exact;
    int family_count;
    family families[FAMILIES_MAX];
    lq_pca_try *tries;
    size_t try_count, first; /* of this piece */
    lq_status status;
    lq_error *error;
} search;

/* ------------------------------------------------------------------ families */

static const size_t plain_ladder[][LQ_MAX_STREAMS] = {{1}, {2}, {3}, {4}, {6}, {8}, {12}, {16}, {24}};
static const size_t beer_ladder[][LQ_MAX_STREAMS] = {{1, 2}, {2, 2}, {2, 3}, {2, 4}, {3, 5},
                                                     {4, 6}, {4, 8}, {5, 7}, {6, 10}};
static const size_t path_ladder[][LQ_MAX_STREAMS] = {{1, 1}, {1, 2}, {1, 3}, {1, 4}, {1, 6}};

static void add_family(search *s, const lq_pca_options *start, int count, const int *axes, bool together,
                       lq_value value, bool critical) {
    family *f = &s->families[s->family_count++];
    const size_t(*ladder)[LQ_MAX_STREAMS] = value != LQ_VALUE_BEER ? plain_ladder
                                            : count > 1            ? beer_ladder
                                                                   : path_ladder;
    *f = (family){.options = *start};
    f->rungs = count == 0 ? 1 : value == LQ_VALUE_BEER && count == 1 ? 5 : 9;
    memcpy(f->bases, ladder, (size_t)f->rungs * sizeof *ladder);
    f->options.scheme = LQ_JOINT;
    f->options.separation_count = together ? 1 : count;
    for (int i = 0; i < f->options.separation_count; i++)
        f->options.separations[i] = (lq_separation){1, {axes[i], 0}, 1};
    if (together) f->options.separations[0] = (lq_separation){2, {axes[0], axes[1]}, 1};
    f->options.value = value;
    f->options.critical = critical;
    f->options.pairs = QUICK_PAIRS;
    f->options.power = s->goal->norm == LQ_PCA_RMS ? 2.0 : s->goal->norm == LQ_PCA_P99 ? 4.0 : 8.0;
}

/* Families of a table with `tau`: it is separated, with another axis where there are four. */
static void add_crossings(search *s, const lq_pca_options *start, const int *axes, int count, int tau) {
    const int mu = lq_table_axis(s->table, "mu"), eta = lq_table_axis(s->table, "eta");
    if (count == 3) {
        add_family(s, start, 1, &tau, false, LQ_VALUE_PLAIN, false);
        add_family(s, start, 1, &tau, false, LQ_VALUE_BEER, false);
        return;
    }
    for (int i = 0; i < count; i++) {
        const int pair[] = {tau, axes[i]};
        if (axes[i] == tau || axes[i] == mu) continue;
        const bool edge = mu >= 0 && eta >= 0 && axes[i] != eta && s->box.min[eta] < 1.0;
        add_family(s, start, 2, pair, false, LQ_VALUE_BEER, edge);
        add_family(s, start, 2, pair, false, LQ_VALUE_PLAIN, edge);
    }
}

static void add_families(search *s, const lq_pca_options *start) {
    int axes[LQ_MAX_AXES], count = 0;
    const int tau = lq_table_axis(s->table, "tau");
    for (int a = 0; a < s->table->axis_count; a++)
        if (s->table->axes[a].size > 1) axes[count++] = a;
    s->family_count = 0;
    const bool crossing = tau >= 0 && s->table->axes[tau].size >= 3 && s->table->axes[tau].max <= 1.0 &&
                          s->table->axes[tau].min >= 0.0;
    if (count <= 2) add_family(s, start, 0, NULL, false, LQ_VALUE_PLAIN, false);
    else if (crossing && count <= 4) add_crossings(s, start, axes, count, tau);
    else if (count == 3)
        for (int i = 0; i < 3; i++) add_family(s, start, 1, &axes[i], false, LQ_VALUE_PLAIN, false);
    else if (count == 4) {
        add_family(s, start, 2, &axes[2], true, LQ_VALUE_PLAIN, false);
        add_family(s, start, 2, &axes[2], false, LQ_VALUE_PLAIN, false);
    }
}

/* ------------------------------------------------------------------ one try */

static double error_of(const search *s, const lq_pca_errors *errors) {
    return s->goal->norm == LQ_PCA_MAX   ? errors->max
           : s->goal->norm == LQ_PCA_RMS ? errors->rms
                                         : errors->p99;
}

/* Bytes before the fit: texels of the plane and of the lines. */
static size_t predict(const search *s, const lq_pca_options *options) {
    lq_grid grid;
    if (lq_piece_grid(s->table, options, &s->box, &grid, NULL) != LQ_OK) return SIZE_MAX;
    const size_t a = grid.rest_count > 0 ? grid.rest[0].texels.size : 0;
    const size_t b = grid.rest_count > 1 ? grid.rest[1].texels.size : 0;
    const bool together = options->separation_count == 1 && grid.rest_count == 2, lines = b > 0 && !together;
    const bool beer = options->value == LQ_VALUE_BEER;
    const size_t last = options->bases[beer ? 1 : 0];
    size_t values = lq_grid_rows(&grid) * (options->bases[0] + (beer ? last : 0));
    values += last * (together ? a * b : lines ? options->pairs * (a + b) : a);
    if (beer && lines) values += options->bases[0] * (grid.rest[0].axis == options->value_axis ? b : a);
    lq_grid_free(&grid);
    return values * 2;
}

/* A factored table of this piece alone. */
static lq_status fit_piece(search *s, const lq_pca_options *options, lq_factored **factored,
                           lq_error *error) {
    lq_status status = lq_factored_start(s->table, s->channel, factored, error);
    if (status != LQ_OK) return status;
    lq_piece *piece = &(*factored)->pieces[0];
    memcpy(piece->min, s->box.min, sizeof piece->min);
    memcpy(piece->max, s->box.max, sizeof piece->max);
    (*factored)->piece_count = 1;
    status = lq_piece_make(s->table, s->channel, options, NULL, piece, error);
    if (status != LQ_OK) {
        lq_factored_free(*factored);
        *factored = NULL;
    }
    return status;
}

static bool report(search *s) {
    const double fraction = s->done + s->share * (1.0 - exp2(-(double)(s->try_count - s->first) / 6.0));
    if (!s->progress || !s->progress->report || s->progress->report(s->progress->user, fraction)) return true;
    s->status = lq_fail(s->error, LQ_CANCELLED, "cancelled");
    return false;
}

/* Fit and measure; the index of the try, or -1 after a failure. */
static int attempt(search *s, const lq_pca_options *options, int sweeps, lq_factored **keep) {
    lq_factored *factored;
    lq_pca_try try = {.piece = s->piece, .options = *options};
    try.options.sweeps = sweeps;
    s->status = fit_piece(s, &try.options, &factored, s->error);
    if (s->status != LQ_OK) return -1;
    try.bytes = lq_factored_bytes(factored);
    s->status = lq_factored_errors(factored, s->exact, s->channel, &try.errors, s->error);
    if (keep && s->status == LQ_OK) *keep = factored;
    else lq_factored_free(factored);
    lq_pca_try *longer = realloc(s->tries, (s->try_count + 1) * sizeof *longer);
    if (longer) s->tries = longer;
    else if (s->status == LQ_OK) s->status = lq_fail(s->error, LQ_NO_MEMORY, "no memory for a list");
    if (s->status != LQ_OK) return -1;
    s->tries[s->try_count++] = try;
    return report(s) ? (int)s->try_count - 1 : -1;
}

/* Make the plane's textures `fraction` of the table's nodes. */
static lq_pca_options smaller(const search *s, const lq_pca_options *options, double fraction) {
    lq_pca_options made = *options;
    for (int a = 0; a < s->table->axis_count; a++) {
        bool separated = false;
        for (int i = 0; i < options->separation_count; i++)
            for (int j = 0; j < options->separations[i].axis_count; j++)
                separated = separated || options->separations[i].axes[j] == a;
        const size_t size = options->texels[a] > 0 ? options->texels[a] : s->table->axes[a].size;
        if (!separated && size > 4) made.texels[a] = (size_t)fmax(4.0, round((double)size * fraction));
    }
    return made;
}

static lq_pca_options rung_options(const family *f, int rung) {
    lq_pca_options options = f->options;
    for (int k = 0; k < LQ_MAX_STREAMS; k++) options.bases[k] = f->bases[rung][k];
    return options;
}

/* ------------------------------------------------------------------ the two goals */

/* True where try `a` is to be preferred; -1 is none. */
static bool better(const search *s, int a, int b) {
    if (b < 0) return a >= 0;
    const double at = error_of(s, &s->tries[a].errors), bt = error_of(s, &s->tries[b].errors);
    if (s->goal->budget > 0.0 && at <= s->goal->budget)
        return bt > s->goal->budget || s->tries[a].bytes < s->tries[b].bytes;
    return at < bt;
}

static bool meets(const search *s, int t) {
    return t >= 0 && s->goal->budget > 0.0 && error_of(s, &s->tries[t].errors) <= s->goal->budget;
}

static int climb(search *s, const family *f, int best) {
    for (int rung = 0; rung < f->rungs && s->status == LQ_OK; rung++) {
        const lq_pca_options options = rung_options(f, rung);
        const size_t bytes = predict(s, &options);
        if (s->goal->bytes > 0 && bytes > s->goal->bytes) return best;
        if (meets(s, best) && bytes >= s->tries[best].bytes) return best;
        const int t = attempt(s, &options, QUICK_SWEEPS, NULL);
        if (t >= 0 && better(s, t, best)) best = t;
        if (meets(s, t)) return best;
    }
    return best;
}

static int shrink(search *s, int best) {
    static const double fractions[] = {0.75, 0.5, 0.375, 0.25};
    if (!meets(s, best)) return best;
    const lq_pca_options full = s->tries[best].options;
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions && s->status == LQ_OK; i++) {
        const lq_pca_options options = smaller(s, &full, fractions[i]);
        const int t = attempt(s, &options, QUICK_SWEEPS, NULL);
        if (!meets(s, t)) break;
        if (better(s, t, best)) best = t;
    }
    return best;
}

/* The highest rung of a family that fits, at several sizes of the plane. */
static int fill_bytes(search *s, const family *f, int best) {
    static const double fractions[] = {1.0, 0.75, 0.5, 0.25};
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions && s->status == LQ_OK; i++)
        for (int rung = f->rungs; rung-- > 0 && s->status == LQ_OK;) {
            const lq_pca_options whole = rung_options(f, rung);
            const lq_pca_options options = i == 0 ? whole : smaller(s, &whole, fractions[i]);
            if (predict(s, &options) > s->goal->bytes) continue;
            const int t = attempt(s, &options, QUICK_SWEEPS, NULL);
            if (t >= 0 && better(s, t, best)) best = t;
            break;
        }
    return best;
}

/* The chosen one in full, into `piece`. */
static void finish(search *s, int best, int sweeps, lq_piece *piece) {
    lq_factored *quick = NULL, *full = NULL;
    const lq_pca_options options = s->tries[best].options;
    int t = attempt(s, &options, sweeps, &full);
    if (t >= 0 && better(s, best, t)) { /* few sweeps were better: that happens with reweighting */
        t = attempt(s, &options, options.sweeps, &quick);
        if (t >= 0) {
            lq_factored_free(full);
            full = quick;
        }
    }
    if (t >= 0) {
        s->tries[t].chosen = true;
        *piece = full->pieces[0];
        full->piece_count = 0;
    }
    lq_factored_free(full);
}

/* ------------------------------------------------------------------ pieces */

static void search_piece(search *s, const lq_pca_options *start, lq_piece *piece, bool *met) {
    int best = -1;
    lq_pca_options unsplit = *start;
    unsplit.split_count = 0;
    s->first = s->try_count;
    lq_piece_box(s->table, start, s->piece, &s->box);
    add_families(s, &unsplit);
    s->status = s->goal->exact ? s->goal->exact(s->goal->user, s->box.min, s->box.max, &s->exact, s->error)
                               : lq_nodes_within(s->table, s->box.min, s->box.max, &s->exact, s->error);
    for (int f = 0; f < s->family_count && s->status == LQ_OK; f++)
        best = s->goal->budget > 0.0 ? climb(s, &s->families[f], best) : fill_bytes(s, &s->families[f], best);
    if (s->status == LQ_OK && best < 0)
        s->status = s->family_count == 0
                        ? lq_fail(s->error, LQ_BAD_INPUT,
                                  "no factorisation is known for a table of %d axes; "
                                  "accepted are up to 4 with more than one node",
                                  s->table->axis_count)
                        : lq_fail(s->error, LQ_BAD_INPUT, "%zu bytes hold no factorisation of this table",
                                  s->goal->bytes);
    if (s->status == LQ_OK) best = shrink(s, best);
    if (s->status == LQ_OK) finish(s, best, start->sweeps, piece);
    if (s->status == LQ_OK && s->goal->budget > 0.0) {
        for (size_t t = s->first; t < s->try_count; t++)
            if (s->tries[t].chosen) *met = *met && meets(s, (int)t);
    }
    lq_table_free(s->exact);
    s->exact = NULL;
}

lq_status lq_pca_search(const lq_table *table, int channel, const lq_pca_options *start,
                        const lq_pca_goal *goal, const lq_progress *progress, lq_factored **factored,
                        lq_pca_try **tries, size_t *try_count, lq_error *error) {
    lq_pca_options o;
    bool met = true;
    *factored = NULL;
    *tries = NULL;
    *try_count = 0;
    lq_pca_goal each = {.struct_size = sizeof each};
    search s = {.table = table, .channel = channel, .goal = &each, .progress = progress, .error = error};
    s.status = lq_extend(&each, sizeof each, goal, offsetof(lq_pca_goal, user) + sizeof goal->user,
                         "a search's goal", error);
    if (s.status == LQ_OK && !(each.budget > 0.0 || each.bytes > 0))
        s.status = lq_fail(error, LQ_BAD_INPUT, "a search needs a budget or a number of bytes");
    if (s.status == LQ_OK) s.status = lq_pca_options_read(&o, start, error);
    if (s.status == LQ_OK) s.status = lq_pca_check_splits(table, &o, error);
    if (s.status == LQ_OK) s.status = lq_pca_check_table(table, channel, error);
    const int pieces = s.status == LQ_OK ? o.split_count + 1 : 1;
    each.bytes /= (size_t)pieces;
    if (s.status == LQ_OK) s.status = lq_factored_start(table, channel, factored, error);
    const int before = lq_threads_set(o.threads);
    for (s.piece = 0; s.piece < pieces && s.status == LQ_OK; s.piece++) {
        s.share = 1.0 / pieces;
        s.done = (double)s.piece / pieces;
        search_piece(&s, &o, &(*factored)->pieces[s.piece], &met);
        if (s.status == LQ_OK) (*factored)->piece_count++;
    }
    lq_threads_set(before);
    *tries = s.tries;
    *try_count = s.try_count;
    if (s.status == LQ_OK && met) return LQ_OK;
    if (s.status == LQ_OK)
        return lq_fail(error, LQ_NOT_CONVERGED, "no factorisation tried meets %g", goal->budget);
    lq_factored_free(*factored);
    *factored = NULL;
    return s.status;
}

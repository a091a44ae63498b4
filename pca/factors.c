/* factors.c - factored tables in memory: their parts, look-up as a shader does it, and what must hold. */
#include "pca/factors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/status.h"
#include "tables/facts.h"
#include "tables/half.h"

enum { GPU_FRACTION_BITS = 8 };

/* ------------------------------------------------------------------ coordinates and filtering */

const char *lq_coordinate_name(lq_coordinate coordinate) {
    static const char *const names[LQ_COORDINATES] = {"axis", "critical", "cosine"};
    return coordinate < LQ_COORDINATES ? names[coordinate] : "unknown";
}

const char *lq_value_name(lq_value value) {
    static const char *const names[LQ_VALUES] = {"plain", "square", "beer"};
    return value < LQ_VALUES ? names[value] : "unknown";
}

double lq_coordinate_at(const lq_texture_axis *axis, const double *x) {
    const double at = x[axis->axis];
    if (axis->coordinate == LQ_COORDINATE_AXIS) return at;
    const double eta = axis->coordinate == LQ_COORDINATE_COSINE ? at : x[axis->other];
    const double critical = eta < 1.0 ? sqrt((1.0 - eta) * (1.0 + eta)) : 0.0;
    if (axis->coordinate == LQ_COORDINATE_COSINE) return critical;
    if (at < critical) return -sqrt(1.0 - at / critical);
    return critical < 1.0 ? sqrt((at - critical) / (1.0 - critical)) : 1.0;
}

size_t lq_factor_texels(const lq_factor *factor) {
    return factor->axes[0].texels.size * (factor->axis_count > 1 ? factor->axes[1].texels.size : 1);
}

/* The texel below a position and the weight of the one above. */
static size_t texel_below(const lq_texture_axis *axis, const double *x, int fraction_bits, double *weight) {
    double index = lq_axis_locate(&axis->texels, lq_coordinate_at(axis, x));
    if (fraction_bits > 0) index = ldexp(nearbyint(ldexp(index, fraction_bits)), -fraction_bits);
    const size_t last = axis->texels.size - 1;
    size_t below = (size_t)index;
    if (below >= last) below = last > 0 ? last - 1 : 0;
    *weight = index - (double)below;
    return below;
}

void lq_factor_tap(const lq_factor *factor, const double *x, int fraction_bits, lq_tap *tap) {
    const size_t width = factor->axes[0].texels.size;
    double along[2] = {0.0, 0.0};
    const size_t column = texel_below(&factor->axes[0], x, fraction_bits, &along[0]);
    const size_t row =
        factor->axis_count > 1 ? texel_below(&factor->axes[1], x, fraction_bits, &along[1]) : 0;
    tap->count = 0;
    for (size_t corner = 0; corner < 4; corner++) {
        const size_t right = corner & 1, up = corner >> 1;
        const double weight = (right ? along[0] : 1.0 - along[0]) * (up ? along[1] : 1.0 - along[1]);
        if (weight == 0.0) continue; /* also texels past the last */
        tap->texel[tap->count] = (row + up) * width + column + right;
        tap->weight[tap->count++] = weight;
    }
}

/* ------------------------------------------------------------------ look-up */

double lq_value_apply(const lq_piece *piece, const double *s, const double *x) {
    switch (piece->value) {
    case LQ_VALUE_SQUARE:
        return s[0] * s[0];
    case LQ_VALUE_BEER:
        return s[0] * pow(x[piece->value_axis], exp2(s[1]));
    default:
        return s[0];
    }
}

static bool holds(const lq_piece *piece, const double *x, int axis_count) {
    for (int a = 0; a < axis_count; a++)
        if (!(x[a] >= piece->min[a] && x[a] <= piece->max[a])) return false;
    return true;
}

const lq_piece *lq_factored_piece(const lq_factored *factored, const double *x) {
    for (int p = 0; p + 1 < factored->piece_count; p++)
        if (holds(&factored->pieces[p], x, factored->axis_count)) return &factored->pieces[p];
    return &factored->pieces[factored->piece_count - 1];
}

static double filtered(const lq_factor *factor, size_t base, const lq_tap *tap) {
    const float *data = factor->data + base * lq_factor_texels(factor);
    double sum = 0.0;
    for (int i = 0; i < tap->count; i++) sum += tap->weight[i] * (double)data[tap->texel[i]];
    return sum;
}

static double stream_at(const lq_piece *piece, const lq_term_sum *sum, const lq_tap *taps, bool single) {
    double total = 0.0;
    for (size_t t = 0; t < sum->term_count; t++) {
        double product = 1.0;
        for (int g = 0; g < sum->factor_count; g++) {
            const int f = sum->factors[g];
            const size_t base = sum->index[t * (size_t)sum->factor_count + (size_t)g];
            const double value = filtered(&piece->factors[f], base, &taps[f]);
            product = single ? (double)((float)product * (float)value) : product * value;
        }
        total = single ? (double)((float)total + (float)product) : total + product;
    }
    return total;
}

static double look_up(const lq_factored *factored, const double *point, int fraction_bits) {
    double x[LQ_MAX_AXES], s[LQ_MAX_STREAMS] = {0.0};
    lq_tap taps[LQ_MAX_FACTORS];
    for (int a = 0; a < factored->axis_count; a++)
        x[a] =
            point[a] > factored->axes[a].min ? fmin(point[a], factored->axes[a].max) : factored->axes[a].min;
    const lq_piece *piece = lq_factored_piece(factored, x);
    for (int f = 0; f < piece->factor_count; f++)
        lq_factor_tap(&piece->factors[f], x, fraction_bits, &taps[f]);
    for (int k = 0; k < piece->stream_count; k++)
        s[k] = stream_at(piece, &piece->streams[k], taps, fraction_bits > 0);
    const double value = lq_value_apply(piece, s, x);
    return fmin(fmax(value, factored->value_min), factored->value_max);
}

double lq_factored_lookup(const lq_factored *factored, const double *point) {
    return look_up(factored, point, 0);
}

double lq_factored_lookup_gpu(const lq_factored *factored, const double *point) {
    return (double)(float)look_up(factored, point, GPU_FRACTION_BITS);
}

size_t lq_factored_bytes(const lq_factored *factored) {
    size_t bytes = 0;
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++) {
            const lq_factor *factor = &factored->pieces[p].factors[f];
            bytes += lq_factor_texels(factor) * factor->base_count * sizeof(uint16_t);
        }
    return bytes;
}

/* ------------------------------------------------------------------ construction */

static void factor_free(lq_factor *factor) {
    for (int a = 0; a < factor->axis_count; a++) lq_axis_free(&factor->axes[a].texels);
    free(factor->data);
    memset(factor, 0, sizeof *factor);
}

lq_status lq_factor_create(lq_factor *factor, const lq_texture_axis *axes, int axis_count, size_t base_count,
                           lq_error *error) {
    memset(factor, 0, sizeof *factor);
    for (int a = 0; a < axis_count; a++) {
        factor->axes[a] = axes[a];
        const lq_status status = lq_axis_copy(&factor->axes[a].texels, &axes[a].texels, error);
        if (status != LQ_OK) {
            factor_free(factor);
            return status;
        }
        factor->axis_count++;
    }
    const size_t values = lq_factor_texels(factor) * base_count;
    factor->base_count = base_count;
    factor->data = calloc(values, sizeof *factor->data);
    if (factor->data) return LQ_OK;
    factor_free(factor);
    return lq_fail(error, LQ_NO_MEMORY, "no memory for a texture of %zu values", values);
}

lq_status lq_term_sum_create(lq_term_sum *sum, size_t term_count, const int *factors, int factor_count,
                             lq_error *error) {
    *sum = (lq_term_sum){.term_count = term_count, .factor_count = factor_count};
    for (int g = 0; g < factor_count; g++) sum->factors[g] = factors[g];
    sum->index = calloc(term_count * (size_t)factor_count, sizeof *sum->index);
    return sum->index ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu terms", term_count);
}

void lq_piece_free(lq_piece *piece) {
    for (int f = 0; f < piece->factor_count; f++) factor_free(&piece->factors[f]);
    for (int k = 0; k < piece->stream_count; k++) free(piece->streams[k].index);
    memset(piece, 0, sizeof *piece);
}

void lq_factored_free(lq_factored *factored) {
    if (!factored) return;
    for (int p = 0; p < factored->piece_count; p++) lq_piece_free(&factored->pieces[p]);
    lq_facts_free(factored->facts, factored->fact_count);
    free(factored);
}

const char *lq_factored_fact(const lq_factored *factored, const char *key) {
    return lq_facts_find(factored->facts, factored->fact_count, key);
}

lq_status lq_factored_set_fact(lq_factored *factored, const char *key, const char *value, lq_error *error) {
    return lq_facts_set(&factored->facts, &factored->fact_count, key, value, error);
}

/* ------------------------------------------------------------------ what must hold */

static lq_status check_axis(const lq_factored *factored, const lq_texture_axis *axis, lq_error *error) {
    const bool reads_other = axis->coordinate == LQ_COORDINATE_CRITICAL;
    if (axis->coordinate >= LQ_COORDINATES || axis->axis < 0 || axis->axis >= factored->axis_count ||
        (reads_other && (axis->other < 0 || axis->other >= factored->axis_count)))
        return lq_fail(error, LQ_FORMAT, "a texture axis does not measure an axis of the table");
    if (axis->texels.size < 1 || !axis->texels.nodes || axis->texels.map == LQ_MAP_CUSTOM)
        return lq_fail(error, LQ_FORMAT,
                       "a texture axis without regular texels; accepted are the maps "
                       "linear, sqrt and power");
    return LQ_OK;
}

static lq_status check_factor(const lq_factored *factored, const lq_factor *factor, lq_error *error) {
    if (factor->axis_count < 1 || factor->axis_count > 2 || factor->base_count < 1 || !factor->data)
        return lq_fail(error, LQ_FORMAT, "a texture of %d axes and %zu bases; accepted are 1 or 2 axes",
                       factor->axis_count, factor->base_count);
    for (int a = 0; a < factor->axis_count; a++) {
        const lq_status status = check_axis(factored, &factor->axes[a], error);
        if (status != LQ_OK) return status;
    }
    const size_t values = lq_factor_texels(factor) * factor->base_count;
    for (size_t i = 0; i < values; i++)
        if (!isfinite(factor->data[i]) || lq_half_round(factor->data[i]) != factor->data[i])
            return lq_fail(error, LQ_FORMAT, "texel value %g is not a finite half", (double)factor->data[i]);
    return LQ_OK;
}

static lq_status check_sum(const lq_piece *piece, const lq_term_sum *sum, lq_error *error) {
    bool good = sum->index && sum->factor_count >= 1 && sum->factor_count <= LQ_MAX_FACTORS;
    for (int g = 0; good && g < sum->factor_count; g++)
        good = sum->factors[g] >= 0 && sum->factors[g] < piece->factor_count;
    for (size_t t = 0; good && t < sum->term_count; t++)
        for (int g = 0; good && g < sum->factor_count; g++)
            good = sum->index[t * (size_t)sum->factor_count + (size_t)g] <
                   piece->factors[sum->factors[g]].base_count;
    return good ? LQ_OK : lq_fail(error, LQ_FORMAT, "a term names a factor or base that is not there");
}

static lq_status check_piece(const lq_factored *factored, const lq_piece *piece, lq_error *error) {
    const int streams = piece->value == LQ_VALUE_BEER ? 2 : 1;
    if (piece->value >= LQ_VALUES || piece->stream_count != streams)
        return lq_fail(error, LQ_FORMAT, "a value of kind %d from %d streams", (int)piece->value,
                       piece->stream_count);
    if (streams == 2 && (piece->value_axis < 0 || piece->value_axis >= factored->axis_count))
        return lq_fail(error, LQ_FORMAT, "a value that depends on axis %d", piece->value_axis);
    for (int a = 0; a < factored->axis_count; a++)
        if (!(piece->min[a] <= piece->max[a]))
            return lq_fail(error, LQ_FORMAT, "a piece without extent along %s", factored->axes[a].name);
    lq_status status = LQ_OK;
    for (int f = 0; status == LQ_OK && f < piece->factor_count; f++)
        status = check_factor(factored, &piece->factors[f], error);
    for (int k = 0; status == LQ_OK && k < piece->stream_count; k++)
        status = check_sum(piece, &piece->streams[k], error);
    return status;
}

lq_status lq_factored_check(const lq_factored *factored, lq_error *error) {
    if (factored->axis_count < 1 || factored->axis_count > LQ_MAX_AXES || factored->piece_count < 1 ||
        factored->piece_count > LQ_MAX_PIECES)
        return lq_fail(error, LQ_FORMAT,
                       "a factored table of %d axes and %d pieces; accepted are 1 to %d and "
                       "1 to %d",
                       factored->axis_count, factored->piece_count, LQ_MAX_AXES, LQ_MAX_PIECES);
    if (!(factored->value_min < factored->value_max))
        return lq_fail(error, LQ_FORMAT, "a physical range from %g to %g", factored->value_min,
                       factored->value_max);
    lq_status status = LQ_OK;
    for (int p = 0; status == LQ_OK && p < factored->piece_count; p++)
        status = check_piece(factored, &factored->pieces[p], error);
    return status;
}

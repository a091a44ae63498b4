/* Rank, bytes and error of a factored table cut short. */
#include "validate/report_ranks.h"

#include "pca/factors.h"
#include "picture/plot.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 5000 };

/* Bytes of the bases that the terms of a piece use. */
static size_t bytes_of(const lq_piece *piece) {
    size_t bytes = 0;
    for (int f = 0; f < piece->factor_count; f++)
        for (size_t b = 0; b < piece->factors[f].base_count; b++) {
            bool used = false;
            for (int k = 0; k < piece->stream_count; k++) {
                const lq_term_sum *sum = &piece->streams[k];
                for (size_t t = 0; t < sum->term_count; t++)
                    for (int g = 0; g < sum->factor_count; g++)
                        used |= sum->factors[g] == f &&
                                sum->index[t * (size_t)sum->factor_count + (size_t)g] == b;
            }
            bytes += used ? lq_factor_texels(&piece->factors[f]) * sizeof(uint16_t) : 0;
        }
    return bytes;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void measure(const lq_sampled *c, const lq_factored *cut, double *size, lq_rank *rank) {
    const size_t axes = (size_t)c->request.kind->axis_count, step = 1 + c->points / POINTS;
    size_t count = 0;
    double square = 0.0;
    for (size_t i = 0; i < c->points; i += step) {
        const double d = fabs(lq_factored_lookup_gpu(cut, c->at + i * axes) - c->exact[i]);
        size[count++] = d;
        square += d * d;
    }
    qsort(size, count, sizeof *size, ascending);
    rank->max = size[count - 1];
    rank->p99 = size[count - 1 - count / 100];
    rank->rms = sqrt(square / (double)count);
}

/* `part` of `steps` of the terms of every sum, one at least. The copy shares its arrays with the original. */
static void cut_terms(lq_factored *cut, const lq_factored *whole, size_t part, size_t steps, lq_rank *rank) {
    *cut = *whole;
    rank->terms = rank->bytes = 0;
    for (int p = 0; p < cut->piece_count; p++) {
        for (int k = 0; k < cut->pieces[p].stream_count; k++) {
            lq_term_sum *sum = &cut->pieces[p].streams[k];
            const size_t kept = (sum->term_count * part + steps - 1) / steps;
            sum->term_count = kept > 0 ? kept : sum->term_count;
            rank->terms += sum->term_count;
        }
        rank->bytes += bytes_of(&cut->pieces[p]);
    }
}

size_t lq_ranks(const lq_certified *certified, lq_rank *ranks) {
    const lq_factored *whole = certified->subject.factored;
    if (!whole) return 0;
    size_t most = 1;
    for (int p = 0; p < whole->piece_count; p++)
        for (int k = 0; k < whole->pieces[p].stream_count; k++)
            if (whole->pieces[p].streams[k].term_count > most) most = whole->pieces[p].streams[k].term_count;
    const size_t steps = most < LQ_RANKS_MAX ? most : LQ_RANKS_MAX;
    lq_factored *cut = malloc(sizeof *cut);
    double *size = malloc((2 + certified->certificate.points) * sizeof *size);
    for (size_t i = 0; cut && size && i < steps; i++) {
        cut_terms(cut, whole, i + 1, steps, &ranks[i]);
        measure(&certified->certificate, cut, size, &ranks[i]);
    }
    const size_t count = cut && size ? steps : 0;
    free(cut);
    free(size);
    return count;
}

lq_status lq_report_ranks(const lq_rank *ranks, size_t count, FILE *out, lq_error *error) {
    double bytes[LQ_RANKS_MAX], max[LQ_RANKS_MAX], p99[LQ_RANKS_MAX], rms[LQ_RANKS_MAX];
    for (size_t i = 0; i < count; i++) {
        bytes[i] = (double)ranks[i].bytes;
        max[i] = ranks[i].max;
        p99[i] = ranks[i].p99;
        rms[i] = ranks[i].rms;
    }
    const lq_plot_line series[] = {{.name = "max", .count = count, .x = bytes, .y = max, .hue = 1},
                                   {.name = "p99", .count = count, .x = bytes, .y = p99, .hue = 2},
                                   {.name = "rms", .count = count, .x = bytes, .y = rms}};
    const lq_plot plot = {.title = "Terms, bytes and error",
                          .subtitle = "the first terms of every sum; the last point is the file as it is",
                          .x = {"bytes in half precision", false},
                          .y = {"error against the solver", true},
                          .series = series,
                          .series_count = 3};
    return lq_plot_draw(&plot, out, error);
}

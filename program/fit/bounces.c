/* What a mapping is worth in use: the variance of stacked bounces against simulation, isotropic by every f,
 * and anisotropic by f per axis (Y19). */
#include "program/fit/bounces.h"

#include "microfacet/lobe.h"
#include "program/message.h"
#include "program/progress.h"
#include "system/json.h"
#include "system/output.h"
#include "validate/sample_visible.h"
#include "validate/stream.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
enum { BLOCK = 4096 };

/* ======================================================================================
 *                                  Isotropic: 2, 4, 8 bounces
 * ====================================================================================== */

static const double alphas[] = {0.03, 0.1, 0.2, 0.3, 0.5, 0.7};
static const int counts[] = {2, 4, 8};
enum { ALPHAS = sizeof alphas / sizeof alphas[0], COUNTS = 3, BOUNCES = 8 };

/* The density of omega_o is D(h) over the hemisphere: reflection at visible normals, what leaves below the
 * horizon drawn again. */
static double bounce(const lq_visible *visible, double mu, lq_stream *stream) {
    for (;;) {
        lq_facet m;
        lq_visible_sample(visible, mu, lq_sine(mu), stream, &m);
        const double out = 2.0 * m.cosine * m.z - mu;
        if (out > 0.0) return out < 1.0 ? out : 1.0;
    }
}

typedef struct tally {
    double sum[COUNTS], square[COUNTS];
} tally;

/* Sums over a block in its order, then over blocks in theirs: the same bits for any number of threads. */
static tally simulate(const lq_visible *visible, size_t row, size_t samples) {
    const size_t blocks = (samples + BLOCK - 1) / BLOCK;
    tally total = {{0}, {0}}, *each = calloc(blocks, sizeof *each);
    if (!each) return total;
#pragma omp parallel for schedule(dynamic)
    for (size_t b = 0; b < blocks; b++)
        for (size_t i = b * BLOCK; i < samples && i < (b + 1) * BLOCK; i++) {
            lq_stream stream = lq_stream_open(5, row, i);
            double mu = 1.0;
            for (int n = 1, k = 0; n <= BOUNCES; n++) {
                mu = bounce(visible, mu, &stream);
                if (n != counts[k]) continue;
                const double v = (1.0 - mu) * (1.0 + mu);
                each[b].sum[k] += v;
                each[b].square[k++] += v * v;
            }
        }
    for (size_t b = 0; b < blocks; b++)
        for (int k = 0; k < COUNTS; k++) {
            total.sum[k] += each[b].sum[k];
            total.square[k] += each[b].square[k];
        }
    free(each);
    return total;
}

/* v1 of the roughness that n bounces have by a family. */
static double by_family(const fit_job *job, int family, const double *p, double alpha, int n) {
    const double roughness = lq_family_inverse(family, p, n * lq_family_value(family, p, &alpha));
    return lq_lobe_variance(job->ndf, fmin(roughness, 1.0));
}

static json_t *row_of(const fit_job *job, double alpha, int n, double mean, double sigma) {
    const double exact =
        lq_lobe_variance(job->ndf, lq_curve_inverse(&job->curve, n * lq_curve_f(&job->curve, alpha)));
    const double fitted = by_family(job, job->request.family, job->answer.p, alpha, n);
    const double paper = by_family(job, job->published, job->published_p, alpha, n);
    printf("%6g %3d  %.5f +- %.5f   %.5f %+6.2f %%   %.5f %+6.2f %%   %.5f %+6.2f %%\n", alpha, n, mean,
           sigma, exact, 100.0 * (exact / mean - 1.0), fitted, 100.0 * (fitted / mean - 1.0), paper,
           100.0 * (paper / mean - 1.0));
    return json_pack("{s:f, s:i, s:o, s:o, s:o, s:o, s:o}", "alpha", alpha, "bounces", n, "simulated",
                     lq_json_number(mean), "standard-error", lq_json_number(sigma), "exact-f",
                     lq_json_number(exact), "fit", lq_json_number(fitted), "published",
                     lq_json_number(paper));
}

json_t *fit_bounces(const fit_job *job, size_t samples) {
    json_t *rows = json_array();
    cli_progress bar;
    cli_progress_begin(&bar, "bounces");
    lq_visible *visible = malloc(sizeof *visible);
    tally all[ALPHAS];
    bool going = visible != NULL;
    for (int a = 0; a < ALPHAS && going; a++) {
        lq_visible_make(visible, job->ndf, alphas[a], true);
        all[a] = simulate(visible, (size_t)a, samples);
        going = bar.progress.report(bar.progress.user, (a + 1.0) / ALPHAS);
    }
    cli_progress_end(&bar);
    free(visible);
    if (!going) return json_decref(rows), NULL;
    printf("Variance E[sin^2] after n bounces of %s: simulated, and v1(f^-1(n f(alpha)))\n"
           " alpha   n  simulated            exact f              fit                  B18\n",
           lq_ndf_text(job->ndf));
    for (int a = 0; a < ALPHAS; a++)
        for (int k = 0; k < COUNTS; k++) {
            const double count = (double)samples, mean = all[a].sum[k] / count;
            const double sigma = sqrt((all[a].square[k] / count - mean * mean) / count);
            lq_json_append(&rows, row_of(job, alphas[a], counts[k], mean, sigma));
        }
    if (!rows) cli_message("no memory for the rows");
    return rows;
}

/* ======================================================================================
 *                               Anisotropic GGX: two bounces
 * ====================================================================================== */

typedef struct vec {
    double x, y, z;
} vec;

typedef struct surface {
    double ax, ay, cos_turn, sin_turn; /* its x axis, turned against the world's */
} surface;

typedef struct disc {
    double xx, yy, xy;
} disc;

/* A visible normal (Heitz 2018) of anisotropic GGX, its frame that of v. */
static vec visible_normal(vec v, double ax, double ay, lq_stream *stream) {
    vec s = {ax * v.x, ay * v.y, v.z};
    const double length = sqrt(s.x * s.x + s.y * s.y + s.z * s.z);
    s = (vec){s.x / length, s.y / length, s.z / length};
    const double flat = sqrt(s.x * s.x + s.y * s.y);
    const vec t1 = flat > 0.0 ? (vec){-s.y / flat, s.x / flat, 0.0} : (vec){1.0, 0.0, 0.0};
    const vec t2 = {-s.z * t1.y, s.z * t1.x, s.x * t1.y - s.y * t1.x};
    const double r = sqrt(lq_stream_uniform(stream)), phi = 2.0 * pi * lq_stream_uniform(stream);
    const double a = r * cos(phi), lean = 0.5 * (1.0 + s.z);
    const double b = (1.0 - lean) * sqrt(1.0 - a * a) + lean * r * sin(phi);
    const double c = sqrt(fmax(0.0, 1.0 - a * a - b * b));
    const vec n = {ax * (a * t1.x + b * t2.x + c * s.x), ay * (a * t1.y + b * t2.y + c * s.y),
                   fmax(1e-300, b * t2.z + c * s.z)};
    const double norm = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    return (vec){n.x / norm, n.y / norm, n.z / norm};
}

static vec reflect(vec v, const surface *on, lq_stream *stream) {
    const vec in = {on->cos_turn * v.x + on->sin_turn * v.y, on->cos_turn * v.y - on->sin_turn * v.x, v.z};
    for (;;) {
        const vec m = visible_normal(in, on->ax, on->ay, stream);
        const double twice = 2.0 * (m.x * in.x + m.y * in.y + m.z * in.z);
        /* the mirrored ray arrives at the next surface from the same side: azimuth turned by 180 degrees */
        const vec out = {twice * m.x - in.x, twice * m.y - in.y, twice * m.z - in.z};
        if (out.z <= 0.0) continue;
        return (vec){-(on->cos_turn * out.x - on->sin_turn * out.y),
                     -(on->sin_turn * out.x + on->cos_turn * out.y), out.z};
    }
}

/* Covariance in the projected disc after the given surfaces, one after the other, from normal incidence. */
static disc scatter(const surface *surfaces, int count, size_t row, size_t samples) {
    const size_t blocks = (samples + BLOCK - 1) / BLOCK;
    disc total = {0}, *each = calloc(blocks, sizeof *each);
    if (!each) return total;
#pragma omp parallel for schedule(dynamic)
    for (size_t b = 0; b < blocks; b++)
        for (size_t i = b * BLOCK; i < samples && i < (b + 1) * BLOCK; i++) {
            lq_stream stream = lq_stream_open(6, row, i);
            vec v = {0.0, 0.0, 1.0};
            for (int n = 0; n < count; n++) v = reflect(v, &surfaces[n], &stream);
            each[b].xx += v.x * v.x;
            each[b].yy += v.y * v.y;
            each[b].xy += v.x * v.y;
        }
    for (size_t b = 0; b < blocks; b++) {
        total.xx += each[b].xx / (double)samples;
        total.yy += each[b].yy / (double)samples;
        total.xy += each[b].xy / (double)samples;
    }
    free(each);
    return total;
}

/* Eigenvalues, larger first, and the angle of the larger one's axis. */
static void axes_of(disc d, double *major, double *minor, double *turn) {
    const double mean = 0.5 * (d.xx + d.yy), half = 0.5 * (d.xx - d.yy), off = hypot(half, d.xy);
    *major = mean + off;
    *minor = mean - off;
    *turn = 0.5 * atan2(d.xy, half);
}

static surface surface_of(double ax, double ay, double turn) {
    return (surface){ax, ay, cos(turn), sin(turn)};
}

/* Y19: f of each axis, turned into one frame, added; the eigenvalues are f of the sum's axes. */
static surface predict(const lq_curve *curve, const surface pair[2]) {
    disc sum = {0};
    for (int k = 0; k < 2; k++) {
        const double fx = lq_curve_f(curve, pair[k].ax), fy = lq_curve_f(curve, pair[k].ay);
        const double c = pair[k].cos_turn, s = pair[k].sin_turn;
        sum.xx += fx * c * c + fy * s * s;
        sum.yy += fx * s * s + fy * c * c;
        sum.xy += (fx - fy) * c * s;
    }
    double major, minor, turn;
    axes_of(sum, &major, &minor, &turn);
    return surface_of(lq_curve_inverse(curve, major), lq_curve_inverse(curve, minor), turn);
}

json_t *fit_anisotropic(const fit_job *job, size_t samples) {
    static const double pairs[][2] = {{0.1, 0.1}, {0.3, 0.1}, {0.6, 0.1}, {0.3, 0.2}, {0.6, 0.3}};
    static const int turns[] = {0, 45, 90};
    enum { PAIRS = 5, TURNS = 3 };
    json_t *rows = json_array();
    cli_progress bar;
    cli_progress_begin(&bar, "anisotropic");
    bool going = true;
    disc found[PAIRS * TURNS], claimed[PAIRS * TURNS];
    surface equal[PAIRS * TURNS];
    for (int i = 0; i < PAIRS * TURNS && going; i++) {
        const double *alpha = pairs[i / TURNS];
        const surface pair[2] = {surface_of(alpha[0], alpha[1], 0.0),
                                 surface_of(alpha[0], alpha[1], turns[i % TURNS] * pi / 180.0)};
        equal[i] = predict(&job->curve, pair);
        found[i] = scatter(pair, 2, (size_t)(2 * i), samples);
        claimed[i] = scatter(&equal[i], 1, (size_t)(2 * i + 1), samples);
        going = bar.progress.report(bar.progress.user, (i + 1.0) / (PAIRS * TURNS));
    }
    cli_progress_end(&bar);
    if (!going) return json_decref(rows), NULL;
    printf("Two bounces of anisotropic GGX, the second turned: covariance in the projected disc, simulated,\n"
           "and that of one lobe with f added per axis (Y19)\n"
           " ax   ay  turn   simulated major, minor   one lobe: ax', ay'    major, minor       error\n");
    for (int i = 0; i < PAIRS * TURNS; i++) {
        const double *alpha = pairs[i / TURNS];
        double a[3], b[3];
        axes_of(found[i], &a[0], &a[1], &a[2]);
        axes_of(claimed[i], &b[0], &b[1], &b[2]);
        printf("%.1f  %.1f  %3d     %.5f  %.5f         %.4f  %.4f      %.5f  %.5f   %+6.1f %% %+6.1f %%\n",
               alpha[0], alpha[1], turns[i % TURNS], a[0], a[1], equal[i].ax, equal[i].ay, b[0], b[1],
               100.0 * (b[0] / a[0] - 1.0), 100.0 * (b[1] / a[1] - 1.0));
        lq_json_append(&rows, json_pack("{s:[f,f], s:i, s:[f,f,f], s:[f,f], s:[f,f,f]}", "alpha", alpha[0],
                                        alpha[1], "turn", turns[i % TURNS], "simulated", found[i].xx,
                                        found[i].yy, found[i].xy, "predicted-alpha", equal[i].ax, equal[i].ay,
                                        "predicted", claimed[i].xx, claimed[i].yy, claimed[i].xy));
    }
    if (!rows) cli_message("no memory for the rows");
    return rows;
}

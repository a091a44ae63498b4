/* Rough dielectrics: every published value and identity, the walk, every hard case. */
#include "tests/expect.h"

#include "lacquer.h"
#include "microfacet/fresnel.h"
#include "microfacet/gauss.h"
#include "precompute/dielectric.h"
#include "validate/walk.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* |R + T - 1| where both are solved apart, at one level of resolution, and at mu <= 1e-3. The passes end when
 * all later ones would add 1e-9. */
#define GAP         3e-8
#define GRAZING_GAP 2e-6

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const char *describe(const lq_kind *kind, const double *point) {
    static char text[160];
    int used = snprintf(text, sizeof text, "%s at", kind->id);
    for (int a = 0; a < kind->axis_count; a++)
        used += snprintf(text + used, sizeof text - (size_t)used, " %s %.6g", kind->axes[a].name, point[a]);
    return text;
}

/* The kind's default tolerance must be reached, with a factor for the interfaces that just miss it; a finer
 * one as far as it goes: the comparison with what is expected judges it. */
static double eval(const char *id, const lq_settings *settings, const double *point, double *second) {
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find(id, &error);
    double values[LQ_MAX_CHANNELS], estimate;
    const lq_status status = lq_eval(kind, settings, point, values, &estimate, &error);
    if ((status != LQ_OK && status != LQ_NOT_CONVERGED) || !(estimate <= 2.0 * kind->tolerance))
        fail_msg("%s: status %d, estimate %g, %s", describe(kind, point), status, estimate, error.text);
    if (!(values[0] >= 0.0 && values[0] <= 1.0)) fail_msg("%s is %g", describe(kind, point), values[0]);
    if (second) *second = values[1];
    return values[0];
}

static lq_settings settings_of(double tolerance, lq_scattering scattering) {
    lq_settings settings = lq_settings_default();
    settings.tolerance = tolerance;
    settings.scattering = scattering;
    settings.threads = 1;
    return settings;
}

static double r01(double mu, double alpha, double eta, double tolerance) {
    const lq_settings settings = settings_of(tolerance, LQ_MULTIPLE);
    return eval("fgd-dielectric", &settings, (const double[]){mu, alpha, eta}, NULL);
}

static double t01(double mu, double alpha, double eta, double tau, double tolerance) {
    const lq_settings settings = settings_of(tolerance, LQ_MULTIPLE);
    return eval("transmission", &settings, (const double[]){mu, alpha, eta, tau}, NULL);
}

static double diffuse(const char *id, double eta, double alpha, double tau, double tolerance) {
    const lq_settings settings = settings_of(tolerance, LQ_MULTIPLE);
    return eval(id, &settings, (const double[]){eta, alpha, tau}, NULL);
}

static double variance(double eta, double alpha, double *roughness) {
    const lq_settings settings = settings_of(1e-5, LQ_MULTIPLE);
    return eval("variance", &settings, (const double[]){eta, alpha}, roughness);
}

/* Means of 2 mu and of 2 mu (1 - mu^2) times a directional table at tau = 1. Energies turn over cosines of
 * alpha from grazing on; the rule is in cbrt(mu). */
static void means(const char *id, double alpha, double eta, double *mean, double *moment) {
    enum { NODES = 24 };
    lq_gauss rule;
    lq_axis axes[4];
    lq_error error = {""};
    lq_gauss_make(&rule, NODES);
    const lq_kind *kind = lq_kind_find(id, &error);
    double mu[NODES];
    for (int q = 0; q < NODES; q++) mu[q] = pow(rule.node[q], 3.0);
    assert_int_equal(lq_axis_make_custom(&axes[0], "mu", mu, NODES, &error), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[1], "alpha", alpha, alpha, 1, LQ_MAP_LINEAR, 1.0, &error), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[2], "eta", eta, eta, 1, LQ_MAP_LINEAR, 1.0, &error), LQ_OK);
    assert_int_equal(lq_axis_make(&axes[3], "tau", 1.0, 1.0, 1, LQ_MAP_LINEAR, 1.0, &error), LQ_OK);
    const lq_settings settings = settings_of(1e-5, LQ_MULTIPLE);
    lq_table *table = NULL;
    lq_precompute(kind, &settings, axes, NULL, &table, &error);
    if (!table) fail_msg("%s: %s", id, error.text);
    *mean = *moment = 0.0;
    for (int q = 0; q < NODES; q++) {
        const double u = rule.node[q];
        const double weight = rule.weight[q] * 6.0 * u * u * mu[q] * (double)table->channels[0][q];
        *mean += weight;
        *moment += weight * (1.0 - mu[q] * mu[q]);
    }
    lq_table_free(table);
    for (int a = 0; a < 4; a++) lq_axis_free(&axes[a]);
}

/* ------------------------------------------------------------------------------ published values */

/* Random walks, sigma about 1e-4, made once with an independent program. */
static void random_walks_of_glass(void **state) {
    (void)state;
    const double alphas[] = {.3, 1.0}, mus[] = {.05, .4, .95};
    const double above[2][3] = {{.1773, .0808, .0371}, {.0823, .0332, .0160}};
    const double below[2][3] = {{.9821, .8965, .1752}, {.9877, .7596, .4149}};
    for (int a = 0; a < 2; a++)
        for (int m = 0; m < 3; m++) {
            assert_near(r01(mus[m], alphas[a], 1.5, 1e-5), above[a][m], 3e-4);
            assert_near(r01(mus[m], alphas[a], 1.0 / 1.5, 1e-5), below[a][m], 3e-4);
        }
}

/* External reflectance of the smooth interface (Walsh): R01mean = 1 - eta^2 T10mean. */
static void smooth_interface_is_walsh(void **state) {
    (void)state;
    const double etas[] = {1.1, 4.0 / 3.0, 1.5, 2.0, 2.5, 4.0};
    const double want[] = {.0251573574, NAN, .0917779593, .1605966371, .2218665735, .3666380565};
    for (size_t i = 0; i < COUNT(etas); i++) {
        const double eta = i == 1 ? 1.33 : etas[i], walsh = i == 1 ? .0659308493 : want[i];
        const double through = diffuse("diffuse-transmission", eta, 0.0, 1.0, 1e-6);
        assert_near(1.0 - eta * eta * through, walsh, eta * eta * 1e-6);
        assert_near(diffuse("diffuse-reflection", eta, 0.0, 1.0, 1e-6), 1.0 - (1.0 - walsh) / (eta * eta),
                    1e-6);
    }
}

static void smooth_coating_absorbs(void **state) {
    (void)state;
    const double want[][3] = {
        {.9, .35806443, .37406352}, {.5, .18380126, .04744152}, {.1, .03004046, .00042305}};
    for (size_t i = 0; i < COUNT(want); i++) {
        assert_near(diffuse("diffuse-transmission", 1.5, 0.0, want[i][0], 1e-6), want[i][1], 1e-6);
        assert_near(diffuse("diffuse-reflection", 1.5, 0.0, want[i][0], 1e-6), want[i][2], 1e-6);
    }
}

/* E[sin^2] of the lobe at normal incidence, closed form for GGX. */
static double lobe_variance(double alpha) {
    const double a = alpha * alpha, d = a - 1.0, p = (a + 1.0) / (d * d * d), q = -1.0 / (d * d),
                 s = -a / (d * d);
    return (1.0 + a) * 4.0 * a *
           (p * log(2.0) + 0.5 * q - p * log((1.0 + a) / a) + s * (1.0 / a - 1.0 / (1.0 + a)));
}

static void variance_of_what_leaves(void **state) {
    (void)state;
    const double alphas[] = {0.0, .1, .5, 1.0}, want[] = {.478350, .48454, .49575, .49725};
    for (size_t i = 0; i < COUNT(alphas); i++) {
        double roughness;
        const double spread = variance(1.5, alphas[i], &roughness);
        assert_near(spread, want[i], i == 0 ? 2e-6 : 2e-5);
        assert_near(lobe_variance(roughness), spread, 1e-6);
    }
    assert_near(variance(1.0 / 1.5, 0.0, NULL), .212600, 2e-6);
    /* A matched interface lets the base's own light out. */
    assert_near(variance(1.0, 0.3, NULL), 0.5, 1e-6);
}

/* ------------------------------------------------------------------------------------ identities */

enum { GAP_MUS = 9, GRAZING_MUS = 3 };
static const double gap_mu[GAP_MUS] = {1e-9, 1e-6, 1e-3, 0.03, 0.2, 0.5, 0.745, 0.9, 1.0};

/* Largest |R + T - 1| over the first, grazing, and over the other cosines. */
static void unity_gap(lq_rough *rough, double eta, int level, int side, double *gap) {
    /* A coating so clear that it is rounding: with tau = 1 the solver takes one side for the rest of the
     * other. */
    const double one = 1.0, clear = 1.0 - 0x1p-53;
    double back[GAP_MUS], through[GAP_MUS], rest[GAP_MUS];
    const lq_question questions[] = {{side, side, LQ_MULTIPLE, gap_mu, GAP_MUS, &clear, 1, back},
                                     {side, 1 - side, LQ_MULTIPLE, gap_mu, GAP_MUS, &clear, 1, through},
                                     {side, 1 - side, LQ_MULTIPLE, gap_mu, GAP_MUS, &one, 1, rest}};
    /* Nearly matched media: a fine level may be void, and says so; a coarser one holds. */
    lq_status status = LQ_NOT_CONVERGED;
    for (; status == LQ_NOT_CONVERGED && level >= 0; level--)
        status = lq_dielectric_answer(rough, eta, level, questions, 3, NULL);
    assert_int_equal(status, LQ_OK);
    for (int m = 0; m < GAP_MUS; m++) {
        assert_true(back[m] >= -1e-12 && back[m] <= 1.0 + 1e-12);
        assert_true(through[m] >= -1e-12 && through[m] <= 1.0 + 1e-12);
        double *most = &gap[m >= GRAZING_MUS];
        *most = fmax(*most, fabs(back[m] + through[m] - 1.0));
        /* The two are read on other nodes; those of nearly matched media are of first order only. */
        if (fabs(eta - 1.0) > 1e-3) assert_near(rest[m], through[m], 2e-5);
    }
}

/* What leaves on one side and on the other, solved apart, is all there was. */
static void nothing_is_lost(void **state) {
    (void)state;
    const double alphas[] = {0.0, 1e-3, 0.03, 0.3, 1.0};
    const double etas[] = {0.25, 1.0 / 1.5, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.01, 1.5, 4.0};
    double worst[2] = {0.0, 0.0};
    for (size_t a = 0; a < COUNT(alphas); a++) {
        lq_rough rough = lq_rough_start(lq_ndf_find("ggx"), alphas[a]);
        for (size_t e = 0; e < COUNT(etas); e++)
            /* Matched media are not solved: one side is the rest of the other. */
            for (int side = 0; side < 2 && !lq_dielectric_is_matched(&rough, etas[e]); side++) {
                double gap[2] = {0.0, 0.0};
                unity_gap(&rough, etas[e], 2, side, gap);
                if (!(gap[0] <= GRAZING_GAP && gap[1] <= GAP))
                    fail_msg("alpha %g eta %.8g side %d: R + T = 1 within %.2g, grazing %.2g", alphas[a],
                             etas[e], side, gap[1], gap[0]);
                for (int k = 0; k < 2; k++) worst[k] = fmax(worst[k], gap[k]);
            }
        lq_rough_free(&rough);
    }
    print_message("R + T = 1 within %.2g, mu <= 1e-3 within %.2g\n", worst[1], worst[0]);
}

static void first_hits_are_some_of_all(void **state) {
    (void)state;
    const lq_settings first = settings_of(1e-4, LQ_SINGLE);
    const double alphas[] = {0.02, 0.3, 1.0}, etas[] = {1.0 / 1.5, 1.5, 2.5}, mus[] = {0.03, 0.3, 0.9};
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t e = 0; e < COUNT(etas); e++)
            for (size_t m = 0; m < COUNT(mus); m++) {
                const double point[] = {mus[m], alphas[a], etas[e], 1.0};
                const double reflected = eval("fgd-dielectric", &first, point, NULL);
                const double through = eval("transmission", &first, point, NULL);
                const double all = r01(mus[m], alphas[a], etas[e], 1e-4);
                assert_true(reflected + through <= 1.0 + 2e-4);
                assert_true(reflected <= all + 2e-4);
                assert_true(through <= t01(mus[m], alphas[a], etas[e], 1.0, 1e-4) + 2e-4);
            }
}

/* T10mean = T01mean / eta^2, against a quadrature of our own over the directional table. */
static void inside_follows_from_outside(void **state) {
    (void)state;
    const double alphas[] = {0.05, 0.3, 1.0}, etas[] = {1.33, 1.5, 2.0};
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(alphas); i++) {
        const double eta = etas[i], square = eta * eta;
        double outside, unused;
        means("fgd-dielectric", alphas[i], eta, &outside, &unused);
        const double back = diffuse("diffuse-reflection", eta, alphas[i], 1.0, 1e-5);
        const double through = diffuse("diffuse-transmission", eta, alphas[i], 1.0, 1e-5);
        worst = fmax(worst, fabs(back - (1.0 - (1.0 - outside) / square)));
        worst = fmax(worst, fabs(back + through - 1.0));
        assert_near(back, 1.0 - (1.0 - outside) / square, 3e-5);
        assert_near(back + through, 1.0, 3e-5);
    }
    print_message("R10mean = 1 - (1 - R01mean)/eta^2 and R10mean + T10mean = 1 within %.2g\n", worst);
}

/* sigma^2 is the mean of sin^2 over T01. */
static void variance_follows_from_transmission(void **state) {
    (void)state;
    double flux, moment;
    means("transmission", 0.4, 1.6, &flux, &moment);
    assert_near(moment / flux, variance(1.6, 0.4, NULL), 3e-5);
}

static double coated(double mu, double alpha, double eta, double tau, double rho) {
    const lq_settings settings = lq_settings_default();
    return eval("coated-lambertian", &settings, (const double[]){mu, alpha, eta, tau, rho}, NULL);
}

static void white_base_returns_everything(void **state) {
    (void)state;
    const double alphas[] = {0.0, 1e-3, 0.1, 0.5, 1.0}, etas[] = {1.0, 1.33, 1.5, 2.5};
    const double mus[] = {0.02, 0.3, 1.0};
    double worst = 0.0;
    for (size_t a = 0; a < COUNT(alphas); a++)
        for (size_t e = 0; e < COUNT(etas); e++)
            for (size_t m = 0; m < COUNT(mus); m++) {
                const double albedo = coated(mus[m], alphas[a], etas[e], 1.0, 1.0);
                worst = fmax(worst, fabs(albedo - 1.0));
                assert_near(albedo, 1.0, 1e-12);
            }
    print_message("white base under a lossless coating: 1 within %.2g\n", worst);
    /* A black base shows the interface alone; D22 eq. 3 from the four tables. */
    assert_near(coated(0.4, 0.3, 1.5, 0.5, 0.0), r01(0.4, 0.3, 1.5, 1e-5), 1e-3);
    const double rho = 0.6, gain = rho / (1.0 - rho * diffuse("diffuse-reflection", 1.5, 0.3, 0.5, 1e-5));
    const double want = r01(0.4, 0.3, 1.5, 1e-5) + t01(0.4, 0.3, 1.5, 0.5, 1e-5) * gain *
                                                       diffuse("diffuse-transmission", 1.5, 0.3, 0.5, 1e-5);
    assert_near(coated(0.4, 0.3, 1.5, 0.5, rho), want, 1e-3);
}

static void smooth_interface_is_fresnel(void **state) {
    (void)state;
    const double etas[] = {0.25, 1.0 / 1.5, 1.0, 1.5, 4.0}, mus[] = {1e-3, 0.1, 0.4, 0.75, 1.0};
    for (size_t e = 0; e < COUNT(etas); e++)
        for (size_t m = 0; m < COUNT(mus); m++) {
            double cos_t;
            const double f = lq_fresnel_dielectric(mus[m], etas[e], &cos_t);
            assert_near(r01(mus[m], 0.0, etas[e], 1e-4), f, 1e-12);
            assert_near(t01(mus[m], 0.0, etas[e], 1.0, 1e-4), 1.0 - f, 1e-12);
            const double loss = f < 1.0 ? pow(0.3, 1.0 / cos_t) : 0.0;
            assert_near(t01(mus[m], 0.0, etas[e], 0.3, 1e-4), (1.0 - f) * loss, 1e-12);
        }
    /* A little roughness away from the critical angle changes little. */
    for (size_t e = 1; e < COUNT(etas); e++)
        for (size_t m = 2; m < COUNT(mus); m++) {
            double cos_t;
            if (etas[e] < 1.0 && fabs(mus[m] * mus[m] + etas[e] * etas[e] - 1.0) < 0.02) continue;
            assert_near(r01(mus[m], 1e-4, etas[e], 1e-5), lq_fresnel_dielectric(mus[m], etas[e], &cos_t),
                        2e-5);
        }
}

static void more_absorption_leaves_less(void **state) {
    (void)state;
    const double taus[] = {0.0, 1e-6, 1e-3, 0.05, 0.3, 0.6, 0.9, 0.99, 1.0};
    double before[3] = {-1.0, -1.0, -1.0};
    for (size_t i = 0; i < COUNT(taus); i++) {
        const double now[3] = {t01(0.2, 0.4, 1.5, taus[i], 1e-5),
                               diffuse("diffuse-transmission", 1.5, 0.4, taus[i], 1e-5),
                               diffuse("diffuse-reflection", 1.5, 0.4, taus[i], 1e-5)};
        for (int k = 0; k < 3; k++) {
            /* tau^(1/mu) <= tau on every path; the table is good to its tolerance. */
            assert_true(now[k] <= taus[i] + 1e-12);
            assert_true(now[k] > before[k]);
            if (taus[i] == 0.0) assert_near(now[k], 0.0, 0.0);
            before[k] = now[k];
        }
    }
}

/* --------------------------------------------------------------------------------- the random walk */

static void inside_noise(const char *what, double got, lq_walk_mean walk, double tolerance, double *worst) {
    const double noise = hypot(walk.error, 3.0 / 300000);
    const double z = fmax(0.0, fabs(got - walk.mean) - tolerance) / noise;
    *worst = fmax(*worst, z);
    if (!(z <= 4.5)) fail_msg("%s: %.7g, walk %.7g +- %.1e (z %.1f)", what, got, walk.mean, walk.error, z);
}

static lq_walk walk_into(double alpha, double n, size_t samples, size_t purpose) {
    lq_walk walk = lq_walk_default();
    walk.fresnel = LQ_WALK_DIELECTRIC;
    walk.alpha = alpha;
    walk.n = n;
    walk.samples = samples;
    walk.purpose = purpose;
    return walk;
}

static void random_walks_agree(void **state) {
    (void)state;
    const double points[][4] = {/* mu, alpha, eta, tau */
                                {.3, .2, 1.5, .5},        {.05, .05, 1.5, .9}, {.9, .7, 2.2, .5},
                                {.6, .3, .6, .5},         {.1, .8, .4, .7},    {.2, .02, 1.01, .5},
                                {.74, .02, 1 / 1.5, 1.0}, {.5, 1.0, 3.7, .5}};
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(points); i++) {
        const double *p = points[i];
        lq_walk walk = walk_into(p[1], p[2], 300000, i);
        lq_walk_sides sides;
        char what[80];
        walk.mu = p[0];
        walk.tau_far = p[3];
        assert_int_equal(lq_walk_two_sided(&walk, &sides, NULL), LQ_OK);
        snprintf(what, sizeof what, "R01 at mu %g alpha %g eta %g", p[0], p[1], p[2]);
        inside_noise(what, r01(p[0], p[1], p[2], 1e-5), sides.reflected, 1e-5, &worst);
        snprintf(what, sizeof what, "T01 at mu %g alpha %g eta %g tau %g", p[0], p[1], p[2], p[3]);
        inside_noise(what, t01(p[0], p[1], p[2], p[3], 1e-5), sides.transmitted, 1e-5, &worst);
    }
    const double bases[][3] = {
        {1.5, .3, .5}, {1.33, .05, .8}, {2.2, 1.0, .5}, {.8, .4, .5}}; /* eta alpha tau */
    for (size_t i = 0; i < COUNT(bases); i++) {
        const double *b = bases[i];
        lq_walk walk = walk_into(b[1], 1.0 / b[0], 300000, 100 + i);
        lq_walk_sides sides;
        walk.cosine = true;
        walk.tau_near = b[2];
        assert_int_equal(lq_walk_two_sided(&walk, &sides, NULL), LQ_OK);
        inside_noise("R10mean", diffuse("diffuse-reflection", b[0], b[1], b[2], 1e-5), sides.reflected, 1e-5,
                     &worst);
        inside_noise("T10mean", diffuse("diffuse-transmission", b[0], b[1], b[2], 1e-5), sides.transmitted,
                     1e-5, &worst);
        walk.tau_near = 1.0;
        assert_int_equal(lq_walk_two_sided(&walk, &sides, NULL), LQ_OK);
        inside_noise("variance", variance(b[0], b[1], NULL), sides.transmitted_sin2, 1e-5, &worst);
    }
    print_message("random walks: largest |z| %.2f\n", worst);
}

/* Light meets alpha / mu_c facets on its way between nearly matched media, mu_c = sqrt(2 |eta - 1|): solved
 * with 21 of them, taken from a similar interface with 224 and 707. Below the critical cosine, near it, above
 * it. */
static void nearly_matched_media_agree_with_walks(void **state) {
    (void)state;
    const double points[][3] = {{.00707, .3, 1 - 1e-4}, {.016, .3, 1 - 1e-4},  {.001, .3, 1 + 1e-4},
                                {1e-4, 1.0, 1 - 1e-6},  {5e-3, 1.0, 1 - 1e-6}, {.001, 1.0, 1 + 1e-5}};
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(points); i++) {
        const double *p = points[i];
        lq_walk walk = walk_into(p[1], p[2], 100000, 200 + i);
        lq_walk_sides sides;
        char what[80];
        walk.mu = p[0];
        assert_int_equal(lq_walk_two_sided(&walk, &sides, NULL), LQ_OK);
        snprintf(what, sizeof what, "R01 at mu %g alpha %g eta %.7g", p[0], p[1], p[2]);
        inside_noise(what, r01(p[0], p[1], p[2], 1e-4), sides.reflected, 1e-4, &worst);
    }
    print_message("nearly matched media, random walks: largest |z| %.2f\n", worst);
}

/* Where many facets leave a step, values miss their tolerance, but not their estimate: 212 facets, both sides
 * of the critical cosine and on it. */
static void the_step_of_matched_media_is_within_its_estimate(void **state) {
    (void)state;
    const double cosines[] = {.0012, .00141421, .0015};
    const lq_settings settings = settings_of(1e-4, LQ_MULTIPLE);
    double worst = 0.0;
    for (size_t i = 0; i < COUNT(cosines); i++) {
        const double point[] = {cosines[i], 0.3, 1.0 - 1e-6};
        lq_walk walk = walk_into(point[1], point[2], 1000, 300 + i);
        lq_walk_sides sides;
        double value, estimate;
        walk.mu = point[0];
        assert_int_equal(lq_walk_two_sided(&walk, &sides, NULL), LQ_OK);
        assert_int_equal(
            lq_eval(lq_kind_find("fgd-dielectric", NULL), &settings, point, &value, &estimate, NULL),
            LQ_NOT_CONVERGED);
        assert_true(estimate < 0.5);
        inside_noise("R01 at the step", value, sides.reflected, estimate, &worst);
    }
}

/* ------------------------------------------------------------------------------------- hard cases */

static const double hard_mu[] = {0.0, 1e-6, 1e-4, 0.02, 0.3, 0.745355, 0.96824583, 1.0};
static const double hard_alpha[] = {0.0, 1e-9, 1e-4, 1e-3, 0.3, 1.0};
static const double hard_eta[] = {0.25, 2.0 / 3.0, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.5, 4.0};
static const double hard_tau[] = {0.0, 1e-6, 0.5, 1.0};
static const double hard_rho[] = {0.0, 1.0};

static const struct {
    const char *name;
    const double *nodes;
    size_t count;
} hard_axes[] = {{"mu", hard_mu, COUNT(hard_mu)},
                 {"alpha", hard_alpha, COUNT(hard_alpha)},
                 {"eta", hard_eta, COUNT(hard_eta)},
                 {"tau", hard_tau, COUNT(hard_tau)},
                 {"rho", hard_rho, COUNT(hard_rho)}};

/* Matched media reflect nothing and pass everything, at any cosine and roughness. */
static void check_matched(const lq_table *table, size_t entry, const char *id, float value) {
    size_t index = entry;
    double at[5] = {0.0}, tau = 1.0;
    bool matched = false;
    for (int a = 0; a < table->axis_count; a++) {
        at[a] = table->axes[a].nodes[index % table->axes[a].size];
        index /= table->axes[a].size;
        if (table->axes[a].name[0] == 'e') matched = at[a] == 1.0;
        if (table->axes[a].name[0] == 't') tau = at[a];
    }
    if (!(value >= 0.0f && value <= 1.0f))
        fail_msg("%s at %g %g %g %g is %g", id, at[0], at[1], at[2], at[3], (double)value);
    if (!matched) return;
    if (id[0] == 'f' || (id[0] == 'd' && id[8] == 'r' && tau == 1.0)) assert_near((double)value, 0.0, 1e-4);
    if (strcmp(id, "transmission") == 0 && tau == 1.0) assert_near((double)value, 1.0, 1e-6);
}

static void hard_cases_have_values(void **state) {
    (void)state;
    const char *const ids[] = {"fgd-dielectric",     "transmission", "diffuse-transmission",
                               "diffuse-reflection", "variance",     "coated-lambertian"};
    for (size_t k = 0; k < COUNT(ids); k++) {
        lq_error error = {""};
        const lq_kind *kind = lq_kind_find(ids[k], &error);
        lq_axis axes[LQ_MAX_AXES];
        for (int a = 0; a < kind->axis_count; a++)
            for (size_t h = 0; h < COUNT(hard_axes); h++)
                if (strcmp(hard_axes[h].name, kind->axes[a].name) == 0)
                    assert_int_equal(lq_axis_make_custom(&axes[a], hard_axes[h].name, hard_axes[h].nodes,
                                                         hard_axes[h].count, &error),
                                     LQ_OK);
        lq_settings settings = lq_settings_default();
        settings.tolerance = 5.0 * kind->tolerance;
        lq_table *table = NULL;
        const lq_status status = lq_precompute(kind, &settings, axes, NULL, &table, &error);
        if (!table) fail_msg("%s: status %d, %s", ids[k], status, error.text);
        print_message("%s: %s, error %s\n", ids[k], status == LQ_OK ? "converged" : "NOT CONVERGED",
                      lq_table_fact(table, "error"));
        for (int c = 0; c < table->channel_count; c++)
            for (size_t i = 0; i < lq_table_entries(table); i++)
                check_matched(table, i, ids[k], table->channels[c][i]);
        lq_table_free(table);
        for (int a = 0; a < kind->axis_count; a++) lq_axis_free(&axes[a]);
    }
}

/* A step in mu at the critical angle, rounded off over cosines of alpha. */
static void critical_angle_is_a_step(void **state) {
    (void)state;
    const double eta = 1.0 / 1.5, critical = sqrt(1.0 - eta * eta);
    for (double alpha = 1e-4; alpha <= 2e-3; alpha *= 10.0) {
        assert_true(r01(critical - 30.0 * alpha, alpha, eta, 1e-4) > 0.99);
        double previous = 1.0 + 1e-4;
        for (int i = -3; i <= 3; i++) {
            const double now = r01(critical + i * alpha, alpha, eta, 1e-4);
            assert_true(now <= previous + 1e-4);
            previous = now;
        }
        assert_true(r01(critical + 30.0 * alpha, alpha, eta, 1e-4) < 0.75);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_walks_of_glass),
        cmocka_unit_test(smooth_interface_is_walsh),
        cmocka_unit_test(smooth_coating_absorbs),
        cmocka_unit_test(variance_of_what_leaves),
        cmocka_unit_test(nothing_is_lost),
        cmocka_unit_test(first_hits_are_some_of_all),
        cmocka_unit_test(inside_follows_from_outside),
        cmocka_unit_test(variance_follows_from_transmission),
        cmocka_unit_test(white_base_returns_everything),
        cmocka_unit_test(smooth_interface_is_fresnel),
        cmocka_unit_test(more_absorption_leaves_less),
        cmocka_unit_test(random_walks_agree),
        cmocka_unit_test(nearly_matched_media_agree_with_walks),
        cmocka_unit_test(the_step_of_matched_media_is_within_its_estimate),
        cmocka_unit_test(hard_cases_have_values),
        cmocka_unit_test(critical_angle_is_a_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

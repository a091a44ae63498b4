/* Light of layered stacks: checked values, the library's other solvers, reciprocity, and honest estimates. */
#include <math.h>

#include "microfacet/fresnel.h"
#include "microfacet/gauss.h"
#include "tests/stack_light.h"

enum { MOST = 256 };

/* ======================================================================================
 *                                     Checked values
 * ====================================================================================== */

/* Random walks of 4e6 rays; sin2 and mean of them to 4e-4. Four standard errors. */
static void test_checked_values(void **state) {
    (void)state;
    static const struct {
        const char *stack;
        double mu, reflected, sigma, transmitted, sigma_transmitted, sin2, mean;
    } walks[] = {
        {FROSTED, 1.0, .915303, 4e-5, 0, 0, .16106, 0},
        {FROSTED, 0.6, .858651, 7e-5, 0, 0, .59837, .61600},
        {FROSTED, 0.15, .814363, 8e-5, 0, 0, .71115, .64033},
        {VARNISHED, 1.0, .107233, 9e-5, 0, 0, .40691, 0},
        {VARNISHED, 0.6, .115720, 1e-4, 0, 0, .53345, .26799},
        {VARNISHED, 0.15, .302440, 2e-4, 0, 0, .84668, .79257},
        {SLAB, 1.0, .061473, 1e-4, .585676, 1e-4, .23455, 0},
        {SLAB, 0.6, .096334, 1e-4, .402038, 2e-4, .62635, .64862},
        {SLAB, 0.15, .332007, 2e-4, .155681, 1e-4, .88463, .89774},
        {WHITE, 1.0, 1.0, 1e-11, 0, 0, .22480, 0},
    };
    for (size_t i = 0; i < sizeof walks / sizeof *walks; i++) {
        const lq_stack_light light = light_at(walks[i].stack, walks[i].mu, 1e-5);
        assert_near(light.reflected.energy, walks[i].reflected, 4.0 * walks[i].sigma);
        assert_near(light.transmitted.energy, walks[i].transmitted, 4.0 * walks[i].sigma_transmitted);
        assert_near(light.reflected.sin2, walks[i].sin2, 1.6e-3);
        assert_near(light.reflected.mean, walks[i].mean, 1.6e-3);
    }
}

/* ======================================================================================
 *                            Other solvers of this library
 * ====================================================================================== */

static double eval(const char *table, lq_scattering scattering, const double *point) {
    lq_error error = {""};
    lq_settings settings = lq_settings_default();
    const lq_kind *kind = lq_kind_find(table, &error);
    double value[LQ_MAX_CHANNELS], estimate;
    assert_non_null(kind);
    settings.tolerance = fmax(1e-5, kind->finest_tolerance);
    settings.scattering = scattering;
    const lq_status status = lq_eval(kind, &settings, point, value, &estimate, &error);
    if (status != LQ_OK && status != LQ_NOT_CONVERGED) fail_msg("%s", error.text);
    assert_true(estimate <= 1.2e-4);
    return value[0];
}

static void test_single_interfaces(void **state) {
    (void)state;
    const double at[][2] = {{0.9, 0.3}, {0.3, 1.0}, {0.1, 0.05}};
    for (size_t i = 0; i < 3; i++) {
        char text[200];
        snprintf(text, sizeof text, "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": %g}}]}",
                 at[i][1]);
        const double point[3] = {at[i][0], at[i][1], 1.5};
        const lq_stack_light light = light_at(text, at[i][0], 1e-5);
        assert_near(light.reflected.energy, eval("fgd-dielectric", LQ_MULTIPLE, point), 2e-5);
        snprintf(text, sizeof text,
                 "{\"layers\": [{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": %g}}]}", at[i][1]);
        const double metal[4] = {at[i][0], at[i][1], 0.2, 3.9};
        assert_near(light_at(text, at[i][0], 1e-5).reflected.energy, eval("fgd", LQ_MULTIPLE, metal), 2e-5);
    }
}

static void test_coated_lambertian(void **state) {
    (void)state;
    /* mu, alpha, eta, tau, rho in the order of the kind */
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find("coated-lambertian", &error);
    assert_non_null(kind);
    const double mu[] = {0.9, 0.25}, alpha[] = {0.1, 0.6}, tau[] = {0.8, 1.0}, rho[] = {0.5, 0.9};
    for (int i = 0; i < 2; i++) {
        char text[240];
        double point[LQ_MAX_AXES] = {0};
        for (int a = 0; a < kind->axis_count; a++) {
            const char *name = kind->axes[a].name;
            point[a] = strcmp(name, "mu") == 0      ? mu[i]
                       : strcmp(name, "alpha") == 0 ? alpha[i]
                       : strcmp(name, "tau") == 0   ? tau[i]
                       : strcmp(name, "rho") == 0   ? rho[i]
                                                    : 1.5;
        }
        snprintf(text, sizeof text,
                 "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": %g}, \"medium\": {\"tau\": %g}},"
                 "{\"lambertian\": {\"rho\": %g}}]}",
                 alpha[i], tau[i], rho[i]);
        assert_near(light_at(text, mu[i], 1e-5).reflected.energy,
                    eval("coated-lambertian", LQ_MULTIPLE, point), 3e-5);
    }
}

/* 2 mu dmu on [0,1], dense at both ends of [0, cut] and [cut, 1]. */
static size_t hemisphere(double cut, double *mu, double *weight) {
    lq_gauss rule;
    lq_gauss_make(&rule, 24);
    for (int i = 0; i < 48; i++) {
        const double from = i < 24 ? 0.0 : cut, width = i < 24 ? cut : 1.0 - cut, x = rule.node[i % 24];
        mu[i] = from + width * x * x;
        weight[i] = 4.0 * x * width * mu[i] * rule.weight[i % 24];
    }
    return 48;
}

/* mu0 r(mu0 -> mu) = mu r(mu -> mu0): the mean of sin2 over diffuse light is that of what diffuse light
 * arrives with; and T from above is n^2 times T from below. */
static void test_reciprocity(void **state) {
    (void)state;
    const char *stack = LAYERS(COATING(1.5, 0.1, 0.7) "," COATING(1.2, 0.4, 0.9));
    double mu[MOST], weight[MOST], out = 0.0, in = 0.0, down = 0.0, up = 0.0;
    lq_stack_light light[MOST];
    lq_stack_query query = {.mu = mu, .tolerance = 5e-5};
    query.mu_count = hemisphere(0.3, mu, weight);
    solve(stack, &query, light);
    for (size_t i = 0; i < query.mu_count; i++) {
        out += weight[i] * light[i].reflected.energy * light[i].reflected.sin2;
        in += weight[i] * light[i].reflected.energy * (1.0 - mu[i] * mu[i]);
        down += weight[i] * light[i].transmitted.energy;
    }
    assert_near(out, in, 2e-5);
    query.mu_count = hemisphere(sqrt(1.0 - 1.0 / 1.44), mu, weight);
    query.from_below = true;
    solve(stack, &query, light);
    for (size_t i = 0; i < query.mu_count; i++) up += weight[i] * light[i].transmitted.energy;
    assert_near(down, up * 1.44, 2e-5);
}

static void test_channels(void **state) {
    (void)state;
    const char *rgb =
        "{\"layers\": [{\"dielectric\": {\"n\": [1.5, 1.5, 1.6], \"alpha\": 0.2}, \"medium\": {\"tau\": "
        "[0.8, 0.5, 0.3]}}, {\"conductor\": {\"n\": [0.2, 0.9, 1.5], \"kappa\": [3.9, 2.5, 1.9], "
        "\"alpha\": 0.05}}]}";
    static const char *const one[3] = {LAYERS(COATING(1.5, 0.2, 0.8) "," CONDUCTOR(0.2, 3.9, 0.05)),
                                       LAYERS(COATING(1.5, 0.2, 0.5) "," CONDUCTOR(0.9, 2.5, 0.05)),
                                       LAYERS(COATING(1.6, 0.2, 0.3) "," CONDUCTOR(1.5, 1.9, 0.05))};
    const double mu = 0.5;
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .tolerance = 1e-5};
    lq_stack_light light[3];
    solve(rgb, &query, light);
    for (int c = 0; c < 3; c++) {
        const lq_stack_light alone = light_at(one[c], mu, 1e-5);
        assert_near(light[c].reflected.energy, alone.reflected.energy, 2e-5);
        assert_near(light[c].reflected.across, alone.reflected.across, 2e-5);
    }
}

/* ======================================================================================
 *                                      Estimates
 * ====================================================================================== */

static double apart(const lq_stack_lobe *a, const lq_stack_lobe *b) {
    return fmax(fmax(fabs(a->energy - b->energy), fabs(a->sin2 - b->sin2)),
                fmax(fabs(a->mean - b->mean), fabs(a->across - b->across)));
}

/* A stack of 1 to 4 layers from a counter: roughnesses smooth, small, 1 and between, indices from 1 to 2.5.
 */
static void random_stack(unsigned seed, char *text, size_t size) {
    unsigned long long x = 6364136223846793005ull * (seed + 1);
    double u[16];
    for (int i = 0; i < 16; i++) {
        x = 6364136223846793005ull * x + 1442695040888963407ull;
        u[i] = (double)(x >> 11) / 9007199254740992.0;
    }
    const int layers = 1 + (int)(4.0 * u[0]);
    size_t at = (size_t)snprintf(text, size, "{\"layers\": [");
    for (int i = 0; i < layers; i++) {
        const double *v = u + 1 + 3 * i, alpha = v[0] < 0.2 ? 0.0 : v[0] > 0.9 ? 1.0 : v[0] * v[0];
        const bool base = i + 1 == layers && v[2] < 0.5;
        const char *comma = i ? "," : "";
        if (base)
            at += (size_t)snprintf(text + at, size - at,
                                   "%s{\"conductor\": {\"n\": %.4f, \"kappa\": %.4f, \"alpha\": %.4f}}",
                                   comma, 2.0 * v[1], 4.0 * v[2], alpha);
        else
            at += (size_t)snprintf(
                text + at, size - at,
                "%s{\"dielectric\": {\"n\": %.4f, \"alpha\": %.4f}, \"medium\": {\"tau\": %.4f}}", comma,
                1.0 + 1.5 * v[1], alpha, v[2]);
    }
    snprintf(text + at, size - at, "]}");
}

static void test_estimates_cover(void **state) {
    (void)state;
    const double mu[] = {1.0, 0.7, 0.4, 0.1};
    for (unsigned seed = 0; seed < 8; seed++) {
        char text[1024];
        random_stack(seed, text, sizeof text);
        lq_stack_query query = {.mu = mu, .mu_count = 4, .tolerance = 1e-3};
        lq_stack_light coarse[4], fine[4];
        solve(text, &query, coarse);
        query.tolerance = 1e-4;
        solve(text, &query, fine);
        for (int m = 0; m < 4; m++) {
            const double off = fmax(apart(&coarse[m].reflected, &fine[m].reflected),
                                    apart(&coarse[m].transmitted, &fine[m].transmitted));
            if (off > coarse[m].error + fine[m].error)
                fail_msg("%s at mu = %g: off by %.2g, estimates %.2g and %.2g", text, mu[m], off,
                         coarse[m].error, fine[m].error);
        }
    }
}

/* The first hit alone: what is blocked is lost, of one interface and of a stack. */
static void test_single(void **state) {
    (void)state;
    const double mu = 0.3;
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .single = true, .tolerance = 1e-5};
    lq_stack_light light;
    solve(LAYERS(CONDUCTOR(0, 1, 0.5)), &query, &light);
    const double point[2] = {mu, 0.5};
    assert_near(light.reflected.energy, eval("albedo", LQ_MULTIPLE, point), 2e-5);
    solve(LAYERS(DIELECTRIC(1.5, 0.5)), &query, &light);
    const double coating[4] = {mu, 0.5, 1.5, 1.0};
    assert_near(light.transmitted.energy, eval("transmission", LQ_SINGLE, coating), 3e-5);
    assert_true(light.reflected.energy + light.transmitted.energy < 0.8);
    solve(LAYERS(DIELECTRIC(1.5, 0)), &query, &light);
    assert_near(light.reflected.energy + light.transmitted.energy, 1.0, 1e-12);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_checked_values),
        cmocka_unit_test(test_single_interfaces),
        cmocka_unit_test(test_coated_lambertian),
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_estimates_cover),
        cmocka_unit_test(test_single),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

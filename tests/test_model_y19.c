/* The anisotropic statistical model: what it is for round roughness, turned frames, energies and covariances.
 */
#include <math.h>

#include "tests/model_shape.h"

/* As released: that asks for no tables from inside, which take longest. */
static const lq_shape_query y19 = {.model = LQ_MODEL_Y19, .variant = LQ_MODEL_RELEASED, .f = LQ_MODEL_F_B18};
static const lq_shape_query b18 = {.variant = LQ_MODEL_RELEASED, .f = LQ_MODEL_F_B18};

#define TURNED(x, y, rotate) "{\"x\": " #x ", \"y\": " #y ", \"rotate\": " #rotate "}"
#define COAT(alpha)          "{\"dielectric\": {\"n\": 1.5, \"alpha\": " alpha "}}"
#define METAL(alpha)         "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": " alpha "}}"

/* Of light that travels that way, in degrees from the x axis. */
static lq_shape_query at(lq_shape_query query, double azimuth) {
    query.azimuth = azimuth;
    return query;
}

static const double somewhere[][3] = {
    {0.6, 0.0, 0.8}, {-0.1, 0.3, 0.9486833}, {0.0, -0.8, 0.6}, {0.36, 0.48, -0.8}};

/* All lobes, in a direction. */
static double value(const shaped *s, int which) {
    double direct[3], rest[3];
    lq_model_shape_value(&s->shape, somewhere[which][0], somewhere[which][1], somewhere[which][2], direct,
                         rest);
    return direct[0] + rest[0];
}

static void assert_same(const char *one, lq_shape_query query, double azimuth, const char *other,
                        lq_shape_query other_query, double other_azimuth, double tolerance) {
    for (double mu = 0.3; mu < 1.0; mu += 0.5) {
        shaped a = make(one, at(query, azimuth), mu), b = make(other, at(other_query, other_azimuth), mu);
        for (int i = 0; i < 4; i++)
            if (value(&b, i) > 0.0) assert_near(value(&a, i) / value(&b, i), 1.0, tolerance);
        drop(&a);
        drop(&b);
    }
}

/* Round roughness is b18-forward's, wherever light comes from and however its frame is turned. */
static void test_round_is_b18(void **state) {
    (void)state;
    assert_same(FROSTED, y19, 25.0, FROSTED, b18, 0.0, 1e-9);
    assert_same(SLAB, y19, 25.0, SLAB, b18, 0.0, 1e-9);
    assert_same(LAYERS(COAT(TURNED(0.2, 0.2, 70)) "," METAL(TURNED(0.05, 0.05, -10))), y19, 0.0, FROSTED, b18,
                0.0, 1e-9);
}

/* Only the angle between light and layers matters; a quarter turn changes the names of the axes. */
static void test_turning_all(void **state) {
    (void)state;
    const char *there = LAYERS(COAT(TURNED(0.3, 0.1, 10)) "," METAL(TURNED(0.05, 0.2, 40)));
    const char *turned = LAYERS(COAT(TURNED(0.3, 0.1, 55)) "," METAL(TURNED(0.05, 0.2, 85)));
    const char *renamed = LAYERS(COAT(TURNED(0.1, 0.3, 100)) "," METAL(TURNED(0.2, 0.05, -50)));
    assert_same(turned, y19, 65.0, there, y19, 20.0, 1e-9);
    assert_same(renamed, y19, 20.0, there, y19, 20.0, 1e-9);
    assert_same(there, y19, 200.0, there, y19, 20.0, 1e-9);
}

/* Seen from the other side of a plane of symmetry all is mirrored. */
static void test_mirrored(void **state) {
    (void)state;
    const char *left = LAYERS(METAL(TURNED(0.3, 0.1, 30))), *right = LAYERS(METAL(TURNED(0.3, 0.1, -30)));
    shaped a = make(left, y19, 0.6), b = make(right, y19, 0.6);
    double one[3], other[3], rest[3];
    lq_model_shape_value(&a.shape, 0.36, 0.48, 0.8, one, rest);
    lq_model_shape_value(&b.shape, 0.36, -0.48, 0.8, other, rest);
    assert_near(one[0] / other[0], 1.0, 1e-6);
    lq_model_shape_value(&b.shape, 0.36, 0.48, 0.8, other, rest);
    assert_true(fabs(one[0] / other[0] - 1.0) > 0.1);
    drop(&a);
    drop(&b);
}

/* One interface keeps its roughnesses and has the energy of the projected one, at two angles of a metal:
 * 0.2984 and 0.5800 from an implementation of its own. */
static void test_one_interface(void **state) {
    (void)state;
    const char *text =
        LAYERS("{\"conductor\": {\"n\": 1.45, \"kappa\": 1, \"alpha\": {\"x\": 0.3, \"y\": 0.05}}}");
    const double azimuth[] = {0.0, 45.0, 90.0}, energy[] = {0.2984, 0.3464, 0.5800};
    for (int i = 0; i < 3; i++) {
        lq_shape_query query = y19;
        query.variant = LQ_MODEL_PAPER;
        shaped s = make(text, at(query, azimuth[i]), 0.1);
        const lq_shape_lobe *lobe = &s.shape.lobes[0];
        assert_near(lobe->energy, energy[i], 2e-4);
        assert_near(lobe->ggx.x, 0.3, 1e-9);
        assert_near(lobe->ggx.y, 0.05, 1e-9);
        assert_near(lobe->ggx.cosine, cos(azimuth[i] * 3.14159265358979 / 180.0), 1e-9);
        assert_near(s.shape.sharpest, 0.05, 1e-9);
        drop(&s);
    }
}

/* Layers with the same axes are two isotropic stacks, one an axis, of the same energies. */
static void test_each_axis_alone(void **state) {
    (void)state;
    for (double mu = 0.5; mu <= 1.0; mu += 0.5) {
        shaped s = make(LAYERS(COAT(TURNED(0.3, 0.1, 0)) "," METAL(TURNED(0.2, 0.05, 180))), y19, mu);
        shaped x = make(LAYERS(COAT("0.3") "," METAL("0.2")), b18, mu);
        assert_near(s.shape.lobes[1].ggx.x, x.shape.lobes[1].alpha, 1e-9);
        assert_near(s.shape.lobes[1].energy, x.shape.lobes[1].energy, 1e-9);
        assert_true(s.shape.lobes[1].ggx.y < s.shape.lobes[1].ggx.x);
        drop(&s);
        drop(&x);
    }
}

static double f(double alpha) {
    return pow(alpha, 1.1) / (1.0 - pow(alpha, 1.1));
}

static double inverse(double variance) {
    return pow(variance / (1.0 + variance), 1.0 / 1.1);
}

/* A coat and a base at 45 degrees to it, from above, as eq. 47 has them: up + J (down + base + again (base +
 * coat)). `again` is that of the isotropic stack of the roughnesses in the plane of incidence. */
static void test_covariance_by_hand(void **state) {
    (void)state;
    char text[256];
    const double plane = sqrt(0.05);
    snprintf(text, sizeof text, LAYERS(COAT("0.3") "," METAL("%.17g")), plane);
    shaped s = make(LAYERS(COAT(TURNED(0.3, 0.1, 0)) "," METAL(TURNED(0.3, 0.1, 45))), y19, 1.0);
    shaped round = make(text, b18, 1.0);
    const double round_alpha = round.shape.lobes[1].alpha, variance = f(round_alpha);
    const double again = ((variance - f(0.3 / 4)) / 1.5 - f(0.3 / 6) - f(plane)) / (f(plane) + f(0.3));
    const double mean = 0.5 * (f(0.3) + f(0.1)), off = 0.5 * (f(0.3) - f(0.1));
    const double xx = f(0.3 / 4) + 1.5 * (f(0.3 / 6) + mean + again * (mean + f(0.3)));
    const double yy = f(0.1 / 4) + 1.5 * (f(0.1 / 6) + mean + again * (mean + f(0.1)));
    const double xy = 1.5 * (1.0 + again) * off, half = 0.5 * (xx - yy), radius = sqrt(half * half + xy * xy);
    const lq_shape_lobe *lobe = &s.shape.lobes[1];
    assert_true(again > 0.01);
    assert_near(lobe->energy, round.shape.lobes[1].energy, 1e-12);
    assert_near(lobe->ggx.x, inverse(0.5 * (xx + yy) + radius), 1e-9);
    assert_near(lobe->ggx.y, inverse(0.5 * (xx + yy) - radius), 1e-9);
    assert_near(atan2(lobe->ggx.sine, lobe->ggx.cosine), 0.5 * atan2(xy, half), 1e-9);
    drop(&s);
    drop(&round);
}

/* What it sends is what it says, in energy, and lies along the wider axis. */
static void test_sums(void **state) {
    (void)state;
    shaped s = make(LAYERS(METAL(TURNED(0.4, 0.05, 0))), y19, 1.0);
    const lq_stack_lobe along = lq_model_shape_moments(&s.shape, 0, 0);
    shaped t = make(LAYERS(METAL(TURNED(0.4, 0.05, 0))), at(y19, 90.0), 1.0);
    const lq_stack_lobe across = lq_model_shape_moments(&t.shape, 0, 0);
    assert_near(along.energy, s.shape.lobes[0].energy, 1e-12);
    assert_near(across.across, along.sin2 - along.across, 2e-3);
    assert_true(across.across > 4.0 * along.across);
    /* By directions: on cells of half a degree. */
    double sum = 0.0;
    const double step = 3.14159265358979 / 360.0;
    for (int r = 0; r < 180; r++)
        for (int p = 0; p < 720; p++) {
            const double theta = (r + 0.5) * step, phi = (p + 0.5) * step;
            sum +=
                sin(theta) * step * step *
                lq_model_shape_lobe(&s.shape, 0, 0, sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
        }
    assert_near(sum, s.shape.lobes[0].energy, 3e-3);
    drop(&s);
    drop(&t);
}

static void test_refused(void **state) {
    (void)state;
    lq_shape_query first = y19;
    first.first = LQ_FIRST_EXACT;
    assert_refused(LAYERS(COAT("0.2") "," LAMBERTIAN(0.5)), y19, 0.5, "a lambertian base; accepted by y19");
    assert_refused(FROSTED, first, 0.5, "the first lobe of y19");
    assert_refused(LAYERS(METAL(TURNED(0.3, 0.1, 0))), b18, 0.5, "layer 1 is anisotropic");
    assert_refused(LAYERS(COAT(TURNED(1, 0.1, 0)) "," METAL(TURNED(0.3, 0.1, 30))), y19, 0.5,
                   "alpha next to 1 on one axis");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_is_b18),
        cmocka_unit_test(test_turning_all),
        cmocka_unit_test(test_mirrored),
        cmocka_unit_test(test_one_interface),
        cmocka_unit_test(test_each_axis_alone),
        cmocka_unit_test(test_covariance_by_hand),
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

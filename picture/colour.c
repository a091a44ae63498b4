/* colour.c - colour maps as splines through OKLab, with lightness linear in the value. */
#include "picture/colour.h"

#include <math.h>

/* ======================================================================================
 *                                         OKLab
 * ====================================================================================== */

/* Ottosson 2020, "A perceptual color space for image processing". */
static const double to_cones[3][3] = {{0.4122214708, 0.5363325363, 0.0514459929},
                                      {0.2119034982, 0.6806995451, 0.1073969566},
                                      {0.0883024619, 0.2817188376, 0.6299787005}};
static const double to_lab[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                    {1.9779984951, -2.4285922050, 0.4505937099},
                                    {0.0259040371, 0.7827717662, -0.8086757660}};
static const double from_lab[3][3] = {{1.0, 0.3963377774, 0.2158037573},
                                      {1.0, -0.1055613458, -0.0638541728},
                                      {1.0, -0.0894841775, -1.2914855480}};
static const double from_cones[3][3] = {{4.0767416621, -3.3077115913, 0.2309699292},
                                        {-1.2684380046, 2.6097574011, -0.3413193965},
                                        {-0.0041960863, -0.7034186147, 1.7076147010}};

static void multiply(const double m[3][3], const double in[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
}

static double to_linear(unsigned char value) {
    const double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static unsigned char from_linear(double v) {
    v = fmin(fmax(v, 0.0), 1.0);
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055;
    return (unsigned char)lround(255.0 * v);
}

void lq_colour_to_oklab(lq_rgb rgb, double lab[3]) {
    const double linear[3] = {to_linear(rgb.r), to_linear(rgb.g), to_linear(rgb.b)};
    double cones[3];
    multiply(to_cones, linear, cones);
    for (int i = 0; i < 3; i++) cones[i] = cbrt(cones[i]);
    multiply(to_lab, cones, lab);
}

void lq_colour_from_oklab(const double lab[3], double linear[3]) {
    double cones[3];
    multiply(from_lab, lab, cones);
    for (int i = 0; i < 3; i++) cones[i] = cones[i] * cones[i] * cones[i];
    multiply(from_cones, cones, linear);
}

static lq_rgb from_oklab(const double lab[3]) {
    double linear[3];
    lq_colour_from_oklab(lab, linear);
    return (lq_rgb){from_linear(linear[0]), from_linear(linear[1]), from_linear(linear[2])};
}

/* ======================================================================================
 *                                         Maps
 * ====================================================================================== */

enum { KNOTS = 5 };

/* Lightness at both ends, and hue at even steps between them, each about as far from the next as the others.
 */
typedef struct path {
    double dark, light;
    double hue[KNOTS][2];
} path;

static const path value_path = {
    0.18, 0.96, {{0.025, -0.085}, {0.13, -0.09}, {0.165, 0.05}, {0.085, 0.125}, {0.0, 0.06}}};

/* Blue and red of the same lightness; `hue` of the two ends, towards white in the middle. */
static const double signed_dark = 0.42, signed_light = 0.97;
static const double signed_hue[2][2] = {{-0.03, -0.145}, {0.145, 0.075}};

/* Catmull-Rom through a column of knots, at t in [0,1]. */
static double along(const double hue[KNOTS][2], int column, double t) {
    const double at = t * (KNOTS - 1);
    const int k = at >= KNOTS - 1 ? KNOTS - 2 : (int)at;
    const double f = at - k, b = hue[k][column], c = hue[k + 1][column];
    const double a = k > 0 ? hue[k - 1][column] : 2.0 * b - c;
    const double d = k + 2 < KNOTS ? hue[k + 2][column] : 2.0 * c - b;
    return b + 0.5 * f * (c - a + f * (2.0 * a - 5.0 * b + 4.0 * c - d + f * (3.0 * (b - c) + d - a)));
}

static lq_rgb value_colour(double t) {
    const double lab[3] = {value_path.dark + (value_path.light - value_path.dark) * t,
                           along(value_path.hue, 0, t), along(value_path.hue, 1, t)};
    return from_oklab(lab);
}

static lq_rgb signed_colour(double t) {
    const double far = fabs(2.0 * t - 1.0);
    const double *hue = signed_hue[t > 0.5];
    const double lab[3] = {signed_light + (signed_dark - signed_light) * far, far * hue[0], far * hue[1]};
    return from_oklab(lab);
}

void lq_colour_steps(lq_colours colours, lq_rgb steps[LQ_COLOUR_STEPS]) {
    for (int i = 0; i < LQ_COLOUR_STEPS; i++) {
        const double t = i / (LQ_COLOUR_STEPS - 1.0);
        steps[i] = colours == LQ_COLOURS_SIGNED ? signed_colour(t) : value_colour(t);
    }
}

int lq_colour_step(double value, double low, double high) {
    if (!isfinite(value)) return -1;
    const double t = fmin(fmax((value - low) / (high - low), 0.0), 1.0);
    return (int)lround(t * (LQ_COLOUR_STEPS - 1));
}

lq_rgb lq_colour_bad(void) {
    return (lq_rgb){0x13, 0xc2, 0x7b};
}

lq_rgb lq_colour_hue(size_t i) {
    static const lq_rgb hues[LQ_COLOUR_HUES] = {
        {0x2a, 0x6f, 0xdb}, {0xc8, 0x50, 0x1e}, {0x0f, 0x8a, 0x66}, {0x8a, 0x4f, 0xc7}};
    return hues[i % LQ_COLOUR_HUES];
}

lq_rgb lq_colour_ordered(size_t i, size_t count) {
    return value_colour(0.25 + 0.6 * (double)i / (double)(count > 1 ? count - 1 : 1));
}

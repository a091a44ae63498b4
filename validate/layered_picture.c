/* layered_picture.c - colours of cells. */
#include "validate/layered_picture.h"

#include <math.h>

#include "picture/draw.h"

enum { DECADES = 4, GAP = 4, ROWS = 2 * LQ_SLICE_THETA + GAP };

static void all_light(const lq_slice_pair *pair, int channels, size_t cell, double rgb[LQ_STACK_CHANNELS]) {
    for (int c = 0; c < LQ_STACK_CHANNELS; c++) {
        const int from = c < channels ? c : 0;
        rgb[c] =
            (double)pair->value[LQ_PART_DIRECT][from][cell] + (double)pair->value[LQ_PART_REST][from][cell];
    }
}

static double most_of(const double rgb[LQ_STACK_CHANNELS]) {
    return fmax(fmax(rgb[0], rgb[1]), rgb[2]);
}

double lq_slice_peak(const lq_slice_pair *pair, int channels) {
    double peak = 0.0, rgb[LQ_STACK_CHANNELS];
    for (size_t cell = 0; cell < LQ_FOLDED_CELLS; cell++) {
        all_light(pair, channels, cell, rgb);
        peak = fmax(peak, most_of(rgb));
    }
    return peak;
}

static unsigned char byte(double value) {
    return (unsigned char)(fmin(fmax(value, 0.0), 1.0) * 255.0 + 0.5);
}

/* The hue is kept: lightness by the logarithm, the colours' proportions by the square root. */
static lq_rgb tone(const double rgb[LQ_STACK_CHANNELS], double peak) {
    const double most = most_of(rgb);
    if (!(most > 0.0 && peak > 0.0)) return (lq_rgb){0, 0, 0};
    const double light = 1.0 + log10(most / peak) / DECADES;
    return (lq_rgb){byte(light * sqrt(rgb[0] / most)), byte(light * sqrt(rgb[1] / most)),
                    byte(light * sqrt(rgb[2] / most))};
}

static void put_value(const lq_slice_pair *pair, int channels, double peak, lq_rgb *pixels) {
    for (size_t cell = 0; cell < LQ_FOLDED_CELLS; cell++) {
        double rgb[LQ_STACK_CHANNELS];
        all_light(pair, channels, cell, rgb);
        const size_t row = LQ_SLICE_THETA - 1 - cell / LQ_FOLDED_PHI;
        pixels[row * LQ_FOLDED_PHI + cell % LQ_FOLDED_PHI] = tone(rgb, peak);
    }
}

static void put_difference(const lq_slice_pair *pair, const lq_slice_pair *against, int channels, double peak,
                           lq_rgb *pixels) {
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(LQ_COLOURS_SIGNED, steps);
    for (size_t cell = 0; cell < LQ_FOLDED_CELLS; cell++) {
        double is[LQ_STACK_CHANNELS], want[LQ_STACK_CHANNELS], difference = 0.0;
        all_light(pair, channels, cell, is);
        all_light(against, channels, cell, want);
        for (int c = 0; c < LQ_STACK_CHANNELS; c++) difference += (is[c] - want[c]) / LQ_STACK_CHANNELS;
        const size_t row = LQ_SLICE_THETA - 1 - cell / LQ_FOLDED_PHI;
        const int step = lq_colour_step(difference, -0.1 * peak - 1e-30, 0.1 * peak + 1e-30);
        pixels[row * LQ_FOLDED_PHI + cell % LQ_FOLDED_PHI] = step < 0 ? lq_colour_bad() : steps[step];
    }
}

lq_status lq_slice_picture(const lq_slice_pair *pair, const lq_slice_pair *against, int channels, double peak,
                           const char *path, lq_error *error) {
    lq_rgb pixels[ROWS * LQ_FOLDED_PHI];
    put_value(pair, channels, peak, pixels);
    if (!against) return lq_draw_pixels(pixels, LQ_FOLDED_PHI, LQ_SLICE_THETA, path, error);
    for (size_t i = 0; i < GAP * LQ_FOLDED_PHI; i++) pixels[LQ_FOLDED_CELLS + i] = (lq_rgb){255, 255, 255};
    put_difference(pair, against, channels, peak, &pixels[LQ_FOLDED_CELLS + GAP * LQ_FOLDED_PHI]);
    return lq_draw_pixels(pixels, LQ_FOLDED_PHI, ROWS, path, error);
}

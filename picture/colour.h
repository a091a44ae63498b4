/* colour.h - colour maps made for the purpose: lightness grows evenly, so that they read in grey and for
 * colour-blind eyes. */
#ifndef LACQUER_PICTURE_COLOUR_H
#define LACQUER_PICTURE_COLOUR_H

#include <stddef.h>

typedef struct lq_rgb {
    unsigned char r, g, b;
} lq_rgb;

enum { LQ_COLOUR_STEPS = 256 };

typedef enum lq_colours {
    LQ_COLOURS_VALUE, /* dark indigo, lacquer red, cream: the more, the lighter */
    LQ_COLOURS_SIGNED /* blue, white, red: white is zero */
} lq_colours;

void lq_colour_steps(lq_colours colours, lq_rgb steps[LQ_COLOUR_STEPS]);

/* Which step shows `value` on a scale from `low` to `high`, which clamps; -1: it is not a number. */
int lq_colour_step(double value, double low, double high);

/* What no step is: of values that are not numbers. */
lq_rgb lq_colour_bad(void);

/* Of series `i` of `count`: hues that keep apart, as many as there are; or steps from dark to light. */
enum { LQ_COLOUR_HUES = 4 };
lq_rgb lq_colour_hue(size_t i);
lq_rgb lq_colour_ordered(size_t i, size_t count);

/* Lightness and the two hue coordinates in OKLab (Ottosson 2020), and back in linear light, unclamped. */
void lq_colour_to_oklab(lq_rgb rgb, double lab[3]);
void lq_colour_from_oklab(const double lab[3], double linear[3]);

#endif

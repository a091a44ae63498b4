/* The Illinois variant of regula falsi: an end that stays is taken for half as far off. */
#include "microfacet/root.h"

#include <math.h>

double lq_root(lq_gap *gap, const void *user, double low, double below, double high, double above,
               double rounding) {
    for (int step = 0, side = 0; step < 60 && high - low > 1e-14; step++) {
        const double at = (low * above - high * below) / (above - below), here = gap(user, at);
        if (fabs(here) < rounding || at == low || at == high) return at;
        if (here < 0.0) {
            low = at;
            below = here;
            if (side < 0) above *= 0.5;
            side = -1;
        } else {
            high = at;
            above = here;
            if (side > 0) below *= 0.5;
            side = 1;
        }
    }
    return 0.5 * (low + high);
}

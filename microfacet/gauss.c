/* Gauss-Legendre nodes by Newton's method on the Legendre recurrence. */
#include "microfacet/gauss.h"

#include <math.h>

/* P_n(x) and its derivative. */
static double legendre(int n, double x, double *derivative) {
    double previous = 1.0, value = x;
    for (int k = 2; k <= n; k++) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * previous) / k;
        previous = value;
        value = next;
    }
    *derivative = n * (x * value - previous) / (x * x - 1.0);
    return value;
}

void lq_gauss_make(lq_gauss *rule, int count) {
    rule->count = count;
    if (count == 1) {
        rule->node[0] = 0.5;
        rule->weight[0] = 1.0;
        return;
    }
    for (int i = 0; i < (count + 1) / 2; i++) {
        /* Asymptotic start (Abramowitz & Stegun 22.16.6); five steps reach rounding for any count. */
        double x = cos(3.14159265358979323846 * (i + 0.75) / (count + 0.5)), derivative = 1.0;
        for (int step = 0; step < 6; step++) x -= legendre(count, x, &derivative) / derivative;
        legendre(count, x, &derivative);
        const double weight = 1.0 / ((1.0 - x * x) * derivative * derivative);
        rule->node[i] = 0.5 * (1.0 - x);
        rule->node[count - 1 - i] = 0.5 * (1.0 + x);
        rule->weight[i] = rule->weight[count - 1 - i] = weight;
    }
}

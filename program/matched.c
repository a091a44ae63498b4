/* matched.c - the window of relative indices near 1 where light crosses a rough interface hundreds of times.
 *
 * Measured on one core at default tolerances, mu = 0.004: eta = 0.999 takes 0.9 s at alpha = 1 and 0.2 s at
 * 0.3; 0.9999 takes 2.5 s and 0.4 s; 0.99999 takes 0.5 s and misses, and 3.8 s. */
#include "program/matched.h"

#include "program/message.h"

#include <math.h>
#include <string.h>

static const double NEAREST = 1e-6, FARTHEST = 1e-3;

static bool is_slow(double eta) {
    const double away = fabs(eta - 1.0);
    return away > NEAREST && away < FARTHEST;
}

static int find_axis(const lq_kind *kind, const char *name) {
    for (int a = 0; a < kind->axis_count; a++)
        if (strcmp(kind->axes[a].name, name) == 0) return a;
    return -1;
}

/* The kinds of one facet integral a value are quick everywhere. */
static bool is_solved(const lq_kind *kind) {
    return strncmp(kind->id, "tir-", 4) != 0 && find_axis(kind, "eta") >= 0 && find_axis(kind, "alpha") >= 0;
}

static void warn(size_t pairs, double eta) {
    if (pairs == 0) return;
    cli_message(
        "note: eta = %.9g is nearly 1: %zu pair%s of eta and alpha may take 10 s each and miss the "
        "tolerance; quick are 1 and what is 0.001 or more from it",
        eta, pairs, pairs > 1 ? "s" : "");
}

void cli_warn_matched(const lq_kind *kind, const lq_axis *axes) {
    if (!is_solved(kind)) return;
    const lq_axis *eta = &axes[find_axis(kind, "eta")], *alpha = &axes[find_axis(kind, "alpha")];
    size_t slow = 0, rough = 0;
    double worst = 1.0;
    for (size_t i = 0; i < eta->size; i++)
        if (is_slow(eta->nodes[i])) worst = eta->nodes[i], slow++;
    for (size_t i = 0; i < alpha->size; i++) rough += alpha->nodes[i] > 0.0;
    warn(slow * rough, worst);
}

bool cli_warn_matched_at(const lq_kind *kind, const double *point) {
    if (!is_solved(kind)) return false;
    const double eta = point[find_axis(kind, "eta")];
    const bool slow = is_slow(eta) && point[find_axis(kind, "alpha")] > 0.0;
    warn(slow, eta);
    return slow;
}

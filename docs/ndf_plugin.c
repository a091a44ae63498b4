/* An NDF plugin for lacquer: slopes of density sech(t), t = tan(theta)/alpha. Lighter tails than GGX, heavier
 * than Beckmann. Build it against an installed lacquer.h:
 *
 *     cc -O2 -shared -fPIC $(pkg-config --cflags lacquer) ndf_plugin.c -o sech.so -lm
 *     lacquer eval albedo mu=0.3 alpha=0.5 --ndf plugin:sech.so
 */
#include <lacquer.h>
#include <math.h>

/* D(theta) = P(tan theta) / cos^4 theta; the scale does not matter. */
static void density(double alpha, size_t count, const double *cos2, const double *sin2, double *d) {
    for (size_t i = 0; i < count; i++) {
        const double slope = cos2[i] > 0.0 ? sqrt(sin2[i] / cos2[i]) : INFINITY;
        const double fall = 1.0 / cosh(slope / alpha);
        d[i] = fall > 0.0 ? fall / (cos2[i] * cos2[i]) : 0.0;
    }
}

const lq_ndf_plugin *lacquer_ndf_plugin(void) {
    static const lq_ndf_plugin plugin = {
        .version = LQ_NDF_PLUGIN_VERSION,
        .struct_size = sizeof plugin,
        .title = "hyperbolic secant slopes",
        .source = "docs/tutorial-ndf.md",
        .alpha_min = 0.0,
        .alpha_max = 1.0,
        .density = density,
    };
    return &plugin;
}

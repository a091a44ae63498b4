/* The three spheres of docs/examples/spheres.mjs with the shipped decode.h. Without arguments: reads pixels
 * as spheres.mjs prints them, and says how many of each sphere there are and how far the furthest is. With
 * cosines: the energy that each sphere reflects there. */
#include "decode.h"

#include "atlas.h"

#include <stdio.h>
#include <stdlib.h>

enum { SPHERES = 3 };

static const char *const names[SPHERES] = {"gold", "wood", "paint"};

static lacquer_lobes look(int sphere, float mu) {
    if (sphere == 0) return lacquer_gold(lacquer_atlas_texels, mu, 0.25f);
    if (sphere == 1)
        return lacquer_lacquered_wood(lacquer_atlas_texels, mu, 0.1f, lacquer_make3(0.5f, 0.28f, 0.13f));
    return lacquer_car_paint(lacquer_atlas_texels, mu, 0.3f);
}

static lacquer_vec3 energy(lacquer_lobes l) {
    return lacquer_make3(l.top.x + l.inner.x + l.base.x, l.top.y + l.inner.y + l.base.y,
                         l.top.z + l.inner.z + l.base.z);
}

/* Relative where the colour is larger than 1. */
static double apart(float want, float got) {
    return fabs((double)want - (double)got) / fmax(1.0, fabs((double)want));
}

static void compare(void) {
    int sphere, count[SPHERES] = {0, 0, 0};
    float mu, light, half, r, g, b;
    double worst[SPHERES] = {0.0, 0.0, 0.0}, brightest[SPHERES] = {0.0, 0.0, 0.0};
    while (scanf("%d %f %f %f %f %f %f", &sphere, &mu, &light, &half, &r, &g, &b) == 7) {
        if (sphere < 0 || sphere >= SPHERES) exit(1);
        const lacquer_lobes l = look(sphere, mu);
        const lacquer_vec3 s = lacquer_shade(lacquer_atlas_texels, l, mu, light, half), e = energy(l);
        const double error = fmax(fmax(apart(2.0f * s.x + 0.3f * e.x, r), apart(2.0f * s.y + 0.3f * e.y, g)),
                                  apart(2.0f * s.z + 0.3f * e.z, b));
        count[sphere]++;
        worst[sphere] = error <= worst[sphere] ? worst[sphere] : error;
        brightest[sphere] = fmax(brightest[sphere], (double)r);
    }
    for (int i = 0; i < SPHERES; i++) printf("%s %d %.2f %.1e\n", names[i], count[i], brightest[i], worst[i]);
}

int main(int argc, char **argv) {
    if (argc == 1) compare();
    for (int i = 0; i < SPHERES; i++)
        for (int a = 1; a < argc; a++) {
            const lacquer_vec3 e = energy(look(i, (float)atof(argv[a])));
            printf("%s %s %.6f %.6f %.6f\n", names[i], argv[a], (double)e.x, (double)e.y, (double)e.z);
        }
    return 0;
}

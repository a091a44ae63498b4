/* Prints, as JSON, what the shipped decode.h of tests/consumers/scene.json says at points of every material
 * and of its tables: a list of {subject, outside, q, values}, the values being those that scene.html also
 * computes. */
#include "decode.h"

#include "atlas.h"

#include <stdio.h>

enum { POINTS = 400, MATERIALS = 6, TABLES = MATERIALS, SUBJECTS };

static const char *const names[SUBJECTS] = {"metal",        "wood",       "white", "chalk",
                                            "coated_metal", "two_ranges", "tables"};

static lacquer_lobes ask(int material, lacquer_vec4 q) {
    const lacquer_vec3 rho = lacquer_make3(q.z, q.w, q.x);
    switch (material) {
    case 0:
        return lacquer_metal(lacquer_atlas_texels, q.x, q.y);
    case 1:
        return lacquer_wood(lacquer_atlas_texels, q.x, q.y, rho);
    case 2:
        return lacquer_white(lacquer_atlas_texels, q.x, q.y, rho);
    case 3:
        return lacquer_chalk(lacquer_atlas_texels, q.x);
    case 4:
        return lacquer_coated_metal(lacquer_atlas_texels, q.x, q.y);
    default:
        return lacquer_two_ranges(lacquer_atlas_texels, q.x, q.y, q.z);
    }
}

/* Between low and high; the points of a sequence fill all four dimensions evenly. */
static float place(int i, int dimension, float low, float high) {
    const double u = 0.5 + (i + 1) * pow(1.2207440846, -dimension);
    return low + (high - low) * (float)(u - floor(u));
}

static int outside(int material, lacquer_vec4 q) {
    if (q.x < 0.0f || q.x > 1.0f) return 1;
    if (material == 3) return 0;
    return q.y < 0.1f || q.y > 0.5f || (material == 5 && (q.z < 0.3f || q.z > 0.5f));
}

static void print(int subject, lacquer_vec4 q, const float *values) {
    printf("{\"subject\": \"%s\", \"outside\": %s, \"q\": [%.9g, %.9g, %.9g, %.9g], \"values\": [",
           names[subject], outside(subject, q) ? "true" : "false", (double)q.x, (double)q.y, (double)q.z,
           (double)q.w);
    for (int k = 0; k < 16; k++) printf("%s%.9g", k ? ", " : "", (double)values[k]);
    printf("]}");
}

static void print_material(int material, lacquer_vec4 q) {
    const lacquer_lobes l = ask(material, q);
    const lacquer_vec3 s = lacquer_shade(lacquer_atlas_texels, l, q.x, q.w, q.w);
    const float values[16] = {l.top.x,   l.top.y,      l.top.z,       l.top_alpha, l.inner.x,
                              l.inner.y, l.inner.z,    l.inner_alpha, l.base.x,    l.base.y,
                              l.base.z,  l.base_alpha, s.x,           s.y,         s.z};
    print(material, q, values);
}

static void print_tables(lacquer_vec4 q) {
    const float *atlas = lacquer_atlas_texels;
    const lacquer_vec2 dfg = lacquer_dfg(atlas, q.x, q.y);
    const float values[16] = {lacquer_transmission(atlas, q.x, q.y, q.x + q.y + q.w, q.w),
                              lacquer_tir_pass(atlas, q.x, q.y, q.w), dfg.x, dfg.y};
    print(TABLES, q, values);
}

int main(void) {
    for (int m = 0; m < SUBJECTS; m++)
        for (int i = 0; i < POINTS; i++) {
            const lacquer_vec4 q = lacquer_make4(place(i, 1, -0.02f, 1.02f), place(i, 2, 0.05f, 0.6f),
                                                 place(i, 3, 0.05f, 0.6f), place(i, 4, 0.0f, 1.0f));
            printf(m + i ? ",\n" : "[");
            if (m == TABLES) print_tables(q);
            else print_material(m, q);
        }
    puts("]");
    return 0;
}

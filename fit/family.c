/* The families as data, their values and their inverses. */
#include "fit/family.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#define FAMILY_FUNCTION static
#define REAL            double
#include "fit/family_formula.h"

/* The scale of f cancels where bounces add; this one makes B18's f agree with f ~ v1 at alpha = 0.237. */
static const double b18_f[] = {1.5753, 1.1};
static const double b18_sigma[] = {1.0, 0.8, 1.0};
static const double b18_slope[] = {0.5, 1.0};

static const lq_family families[LQ_FAMILIES] = {
    [LQ_FAMILY_RATIONAL] = {"b18",
                            LQ_MAP_VARIANCE,
                            "f = a t / (1 - t), t = alpha^b",
                            "alpha = (f / (a + f))^(1/b)",
                            1,
                            2,
                            "ab",
                            {1.5, 1.1},
                            {1e-3, 0.2},
                            {1e3, 6.0},
                            b18_f,
                            "B18 sec. 4.1"},
    [LQ_FAMILY_EXPONENTIAL] = {"exponential",
                               LQ_MAP_VARIANCE,
                               "f = a (exp(b w^c) - 1)^(2/(c d)), w = u^d / (1 - u^d), "
                               "u = (1 + e) alpha / (sqrt(alpha) + e)",
                               "w = (ln(1 + (f/a)^(c d/2)) / b)^(1/c), u = (w / (1 + w))^(1/d) / (1 + e), "
                               "alpha = ((u + sqrt(u^2 + 4 e u)) / 2)^2",
                               1,
                               5,
                               "abcde",
                               {1.0, 1.0, 1.0, 2.0, 0.26},
                               {1e-4, 1e-4, 0.1, 0.1, 0.0},
                               {1e3, 50.0, 12.0, 12.0, 8.0},
                               NULL,
                               "lacquer"},
    [LQ_FAMILY_PHASE] = {"b18",
                         LQ_MAP_HG,
                         "sigma = a ((1 - g) / g)^b / (1 + c g)",
                         NULL,
                         1,
                         3,
                         "abc",
                         {1.0, 0.8, 1.0},
                         {1e-3, 0.05, -0.95},
                         {1e3, 8.0, 50.0},
                         b18_sigma,
                         "B18 eq. 21"},
    [LQ_FAMILY_PHASE_EXPONENTIAL] = {"exponential",
                                     LQ_MAP_HG,
                                     "sigma = a (exp(b w^c) - 1)^(1/(c d)), w = u^d / (1 - u^d), "
                                     "u = (1 + e) h / (1 + e h), h = 1 - g",
                                     "w = (ln(1 + (sigma/a)^(c d)) / b)^(1/c), u = (w / (1 + w))^(1/d), "
                                     "g = 1 - u / (1 + e - e u)",
                                     1,
                                     5,
                                     "abcde",
                                     {1.0, 2.0, 0.95, 1.9, -0.2},
                                     {1e-4, 1e-4, 0.1, 0.1, -0.95},
                                     {1e3, 50.0, 12.0, 12.0, 20.0},
                                     NULL,
                                     "lacquer"},
    [LQ_FAMILY_SLOPE] = {"b18",
                         LQ_MAP_TRANSMISSION,
                         "alpha_t = alpha a |1 - b r|, r = eta12 mu_i / mu_t",
                         "alpha = alpha_t / (a |1 - b r|)",
                         4,
                         2,
                         "ab",
                         {0.5, 1.0},
                         {1e-3, 0.2},
                         {10.0, 5.0},
                         b18_slope,
                         "B18 eq. 10"},
    [LQ_FAMILY_POWERS] =
        {"powers",
         LQ_MAP_TRANSMISSION,
         "alpha_t = a |1 - eta12|^b m^c alpha^(1 - d - e (1 - m)), m = min cosine (thin side)",
         "alpha = (alpha_t / (a |1 - eta12|^b m^c))^(1 / (1 - d - e (1 - m)))",
         4,
         5,
         "abcde",
         {0.5, 1.0, -0.3, 0.0, 0.1},
         {1e-3, 0.2, -4.0, -2.0, -2.0},
         {10.0, 3.0, 4.0, 0.9, 2.0},
         NULL,
         "lacquer"},
    [LQ_FAMILY_POWER] = {"power",
                         LQ_MAP_TAIL,
                         "k = a alpha^-b",
                         "alpha = (a / k)^(1/b)",
                         1,
                         2,
                         "ab",
                         {1.2, 1.0},
                         {1e-3, 1e-6},
                         {1e3, 8.0},
                         NULL,
                         "a power law, for comparison"},
    [LQ_FAMILY_TAIL] = {"shifted",
                        LQ_MAP_TAIL,
                        "k = a + b (alpha^-c - 1)^d",
                        "alpha = (1 + ((k - a) / b)^(1/d))^(-1/c)",
                        1,
                        4,
                        "abcd",
                        {1.2, 0.2, 1.5, 1.0},
                        {0.8, 1e-6, 0.01, 0.1},
                        {4.0, 1e3, 8.0, 8.0},
                        NULL,
                        "lacquer"},
};

static const int defaults[LQ_MAPPINGS] = {LQ_FAMILY_EXPONENTIAL, LQ_FAMILY_PHASE_EXPONENTIAL,
                                          LQ_FAMILY_POWERS, LQ_FAMILY_TAIL};

const lq_family *lq_family_at(int family) {
    return family >= 0 && family < LQ_FAMILIES ? &families[family] : NULL;
}

int lq_family_find(lq_mapping mapping, const char *name) {
    if (!name) return defaults[mapping];
    for (int i = 0; i < LQ_FAMILIES; i++)
        if (families[i].mapping == mapping && strcmp(families[i].name, name) == 0) return i;
    return -1;
}

const char *lq_mapping_name(lq_mapping mapping) {
    static const char *const names[LQ_MAPPINGS] = {"variance", "hg", "transmission", "tail"};
    return names[mapping];
}

double lq_family_value(int family, const double *p, const double *x) {
    return family_of(family, p, x);
}

double lq_family_inverse(int family, const double *p, double value) {
    switch (family) {
    case LQ_FAMILY_RATIONAL:
        return pow(value / (p[0] + value), 1.0 / p[1]);
    case LQ_FAMILY_EXPONENTIAL:
    case LQ_FAMILY_PHASE_EXPONENTIAL: {
        const bool roughness = family == LQ_FAMILY_EXPONENTIAL;
        const double power = p[2] * p[3] / (roughness ? 2.0 : 1.0);
        const double w = pow(log1p(pow(value / p[0], power)) / p[1], 1.0 / p[2]);
        double u = pow(w / (1.0 + w), 1.0 / p[3]);
        if (!(w < INFINITY)) return roughness ? 1.0 : 0.0;
        if (!roughness) return 1.0 - u / (1.0 + p[4] - p[4] * u);
        u /= 1.0 + p[4];
        const double root = 0.5 * (u + sqrt(u * u + 4.0 * p[4] * u));
        return root * root;
    }
    case LQ_FAMILY_POWER:
        return pow(p[0] / value, 1.0 / p[1]);
    case LQ_FAMILY_TAIL:
        return pow(1.0 + pow((value - p[0]) / p[1], 1.0 / p[3]), -1.0 / p[2]);
    default:
        return NAN;
    }
}

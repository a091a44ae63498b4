/* The single hard cases, row by row; included by hard_cases.c alone. */

/* Of the value at `at`. */
typedef enum rule {
    SMOOTH, /* what a smooth interface has there: at alpha = 0, or between equal media */
    NUMBER, /* `other[0]` */
    SAME,   /* the value of `other_kind` (NULL: the same) at `other` */
    REST    /* 1 minus that */
} rule;

typedef struct hard_case {
    const char *group, *kind;
    double at[LQ_MAX_AXES];
    rule rule;
    double within; /* besides the tolerances of what is compared */
    const char *other_kind;
    double other[LQ_MAX_AXES];
    bool ggx; /* holds for that NDF only */
} hard_case;

static const hard_case cases[] = {
    /* Axes: fgd mu alpha n kappa; albedo, dfg mu alpha; albedo-average alpha; tir-pass, tir-loss,
     * fgd-dielectric mu alpha eta; transmission mu alpha eta tau; diffuse-transmission, diffuse-reflection
     * eta alpha tau; variance eta alpha; coated-lambertian mu alpha eta tau rho. */
    {"alpha = 0", "fgd", {0.4, 0.0, 0.2, 3.9}, .rule = SMOOTH},
    {"alpha = 0", "fgd", {0.0, 0.0, 0.2, 3.9}, .rule = SMOOTH},
    {"alpha = 0", "albedo", {0.0, 0.0}, .rule = SMOOTH},
    {"alpha = 0", "albedo-average", {0.0}, .rule = SMOOTH},
    {"alpha = 0", "dfg", {0.3, 0.0}, .rule = SMOOTH},
    {"alpha = 0", "tir-pass", {0.3, 0.0, 0.7}, .rule = SMOOTH},
    {"alpha = 0", "tir-pass", {0.8, 0.0, 0.7}, .rule = SMOOTH},
    {"alpha = 0", "tir-loss", {0.3, 0.0, 0.7}, .rule = SMOOTH},
    {"alpha = 0", "tir-loss", {0.8, 0.0, 0.7}, .rule = SMOOTH},
    {"alpha = 0", "fgd-dielectric", {0.4, 0.0, 1.5}, .rule = SMOOTH},
    {"alpha = 0", "fgd-dielectric", {0.8, 0.0, 2.0 / 3.0}, .rule = SMOOTH},
    {"alpha = 0", "transmission", {0.4, 0.0, 1.5, 0.3}, .rule = SMOOTH},
    {"alpha = 0", "diffuse-transmission", {1.5, 0.0, 0.5}, .rule = SMOOTH},
    {"alpha = 0", "diffuse-reflection", {1.5, 0.0, 0.5}, .rule = SMOOTH},
    {"alpha = 0", "variance", {1.5, 0.0}, .rule = SMOOTH},
    {"alpha = 0", "coated-lambertian", {0.4, 0.0, 1.5, 0.5, 0.8}, .rule = SMOOTH},

    /* energies move as alpha^2 away from grazing and critical angles */
    {"alpha = 1e-4", "fgd", {0.5, 1e-4, 0.2, 3.9}, .rule = SMOOTH, 1e-5, .ggx = true},
    {"alpha = 1e-4", "fgd-dielectric", {0.5, 1e-4, 1.5}, .rule = SMOOTH, 1e-5, .ggx = true},
    {"alpha = 1e-4", "transmission", {0.5, 1e-4, 1.5, 0.3}, .rule = SMOOTH, 1e-5, .ggx = true},
    {"alpha = 1e-4", "tir-pass", {0.9, 1e-4, 0.7}, .rule = SMOOTH, 1e-5, .ggx = true},
    {"alpha = 1e-4", "diffuse-transmission", {1.5, 1e-4, 0.5}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-4", "diffuse-reflection", {1.5, 1e-4, 0.5}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-4", "variance", {1.5, 1e-4}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-3", "fgd", {0.5, 1e-3, 0.2, 3.9}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-3", "fgd-dielectric", {0.5, 1e-3, 1.5}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-3", "transmission", {0.5, 1e-3, 1.5, 0.3}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"alpha = 1e-3", "tir-pass", {0.9, 1e-3, 0.7}, .rule = SMOOTH, 1e-4, .ggx = true},

    {"mu = 0, 1e-6", "fgd", {0.0, 0.5, 0.2, 3.9}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5, 0.2, 3.9}},
    {"mu = 0, 1e-6", "albedo", {0.0, 0.5}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5}},
    {"mu = 0, 1e-6", "dfg", {0.0, 0.5}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5}},
    {"mu = 0, 1e-6", "tir-pass", {0.0, 0.5, 0.7}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5, 0.7}},
    {"mu = 0, 1e-6", "tir-loss", {0.0, 0.5, 0.7}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5, 0.7}},
    {"mu = 0, 1e-6", "fgd-dielectric", {0.0, 0.5, 1.5}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5, 1.5}},
    {"mu = 0, 1e-6", "transmission", {0.0, 0.5, 1.5, 0.3}, .rule = SAME, 1e-4, NULL, {1e-6, 0.5, 1.5, 0.3}},

    /* at (0, 0) only mu/alpha matters */
    {"(mu, alpha) to (0, 0)", "albedo", {1e-5, 1e-4}, .rule = SAME, 2e-3, NULL, {1e-4, 1e-3}, true},
    {"(mu, alpha) to (0, 0)", "albedo", {1e-4, 1e-4}, .rule = SAME, 2e-3, NULL, {1e-3, 1e-3}, true},
    {"(mu, alpha) to (0, 0)", "albedo", {1e-3, 1e-4}, .rule = SAME, 2e-3, NULL, {1e-2, 1e-3}, true},
    {"(mu, alpha) to (0, 0)", "fgd", {1e-3, 1e-4, 0.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},
    {"(mu, alpha) to (0, 0)", "fgd", {1e-5, 1e-4, 0.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},

    {"eta = 1", "fgd-dielectric", {0.3, 0.5, 1.0}, .rule = NUMBER},
    {"eta = 1", "fgd-dielectric", {0.0, 1e-3, 1.0}, .rule = NUMBER},
    {"eta = 1", "transmission", {0.3, 0.5, 1.0, 0.3}, .rule = SMOOTH},
    {"eta = 1", "diffuse-transmission", {1.0, 0.5, 0.3}, .rule = SMOOTH},
    {"eta = 1", "diffuse-reflection", {1.0, 0.5, 0.3}, .rule = NUMBER},
    {"eta = 1", "variance", {1.0, 0.5}, .rule = NUMBER, 0.0, NULL, {0.5}},
    {"eta = 1", "coated-lambertian", {0.3, 0.5, 1.0, 1.0, 0.7}, .rule = NUMBER, 0.0, NULL, {0.7}},
    {"eta = 1", "tir-loss", {0.0, 0.5, 1.0}, .rule = NUMBER},
    {"eta = 1", "tir-pass", {0.5, 0.5, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},
    {"eta = 1 - 1e-6", "fgd-dielectric", {0.3, 0.5, 1.0 - 1e-6}, .rule = NUMBER, 1e-4},
    {"eta = 1 + 1e-6", "fgd-dielectric", {0.3, 0.5, 1.0 + 1e-6}, .rule = NUMBER, 1e-4},
    {"eta = 1 - 1e-6",
     "transmission",
     {0.3, 0.5, 1.0 - 1e-6, 0.3},
     .rule = SAME,
     1e-4,
     NULL,
     {0.3, 0.5, 1.0, 0.3}},
    {"eta = 1 + 1e-6",
     "transmission",
     {0.3, 0.5, 1.0 + 1e-6, 0.3},
     .rule = SAME,
     1e-4,
     NULL,
     {0.3, 0.5, 1.0, 0.3}},
    {"eta = 1 + 1e-6", "diffuse-reflection", {1.0 + 1e-6, 0.5, 0.3}, .rule = NUMBER, 1e-4},

    /* random walks of 10^6 samples, standard error 1.5e-4 and 1.5e-5 */
    {"eta = 1 - 1e-6",
     "fgd-dielectric",
     {1e-3, 0.03, 1.0 - 1e-6},
     .rule = NUMBER,
     1e-3,
     NULL,
     {0.9732},
     true},
    {"eta = 1 + 1e-6",
     "fgd-dielectric",
     {1e-3, 0.03, 1.0 + 1e-6},
     .rule = NUMBER,
     1e-4,
     NULL,
     {0.000757},
     true},

    {"eta = 0.25",
     "fgd-dielectric",
     {0.5, 0.3, 0.25},
     .rule = REST,
     0.0,
     "transmission",
     {0.5, 0.3, 0.25, 1.0}},
    {"eta = 4", "fgd-dielectric", {0.5, 0.3, 4.0}, .rule = REST, 0.0, "transmission", {0.5, 0.3, 4.0, 1.0}},
    {"eta = 0.25",
     "diffuse-reflection",
     {0.25, 0.3, 1.0},
     .rule = REST,
     0.0,
     "diffuse-transmission",
     {0.25, 0.3, 1.0}},
    {"eta = 4",
     "diffuse-reflection",
     {4.0, 0.3, 1.0},
     .rule = REST,
     0.0,
     "diffuse-transmission",
     {4.0, 0.3, 1.0}},

    /* the critical cosines are 0.745 and 0.0447 */
    {"critical step, small alpha",
     "fgd-dielectric",
     {0.695, 1e-3, 2.0 / 3.0},
     .rule = SMOOTH,
     1e-3,
     .ggx = true},
    {"critical step, small alpha",
     "fgd-dielectric",
     {0.795, 1e-3, 2.0 / 3.0},
     .rule = SMOOTH,
     1e-3,
     .ggx = true},
    {"critical step, small alpha", "fgd-dielectric", {0.02, 1e-4, 0.999}, .rule = SMOOTH, 1e-3, .ggx = true},
    {"critical step, small alpha", "fgd-dielectric", {0.09, 1e-4, 0.999}, .rule = SMOOTH, 1e-3, .ggx = true},
    {"critical step, small alpha",
     "fgd-dielectric",
     {0.05, 1e-3, 1.0 - 1e-6},
     .rule = SMOOTH,
     1e-3,
     .ggx = true},
    {"critical step, small alpha", "tir-loss", {0.66, 1e-3, 0.7}, .rule = SMOOTH, 1e-3, .ggx = true},
    {"critical step, small alpha", "tir-loss", {0.76, 1e-3, 0.7}, .rule = SMOOTH, 1e-3, .ggx = true},

    {"kappa = 0, 1e-6", "fgd", {0.3, 0.3, 1.5, 0.0}, .rule = SAME, 1e-5, NULL, {0.3, 0.3, 1.5, 1e-6}},
    {"kappa = 0, 1e-6", "fgd", {0.3, 0.0, 1.5, 0.0}, .rule = SMOOTH},
    {"kappa = 10", "fgd", {0.3, 0.0, 1.5, 10.0}, .rule = SMOOTH},
    {"kappa = 10", "fgd", {0.3, 1e-3, 1.5, 10.0}, .rule = SMOOTH, 1e-4, .ggx = true},
    {"n < 1, small kappa", "fgd", {0.3, 0.3, 0.2, 0.0}, .rule = SAME, 1e-4, NULL, {0.3, 0.3, 0.2, 1e-6}},
    {"n < 1, small kappa", "fgd", {0.3, 0.0, 0.2, 1e-3}, .rule = SMOOTH},
    {"n < 1, small kappa", "fgd", {0.99, 1e-4, 0.2, 1e-3}, .rule = SMOOTH, 1e-3, .ggx = true},

    {"F = 1", "fgd", {0.0, 0.3, 0.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},
    {"F = 1", "fgd", {0.5, 0.3, 0.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},
    {"F = 1", "fgd", {0.5, 1.0, 0.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},

    {"tau = 0", "transmission", {0.5, 0.3, 1.5, 0.0}, .rule = NUMBER},
    {"tau = 0", "diffuse-transmission", {1.5, 0.3, 0.0}, .rule = NUMBER},
    {"tau = 0", "diffuse-reflection", {1.5, 0.3, 0.0}, .rule = NUMBER},
    {"tau = 0",
     "coated-lambertian",
     {0.5, 0.3, 1.5, 0.0, 1.0},
     .rule = SAME,
     0.0,
     "fgd-dielectric",
     {0.5, 0.3, 1.5}},
    {"tau = 1e-6", "transmission", {0.5, 0.0, 1.5, 1e-6}, .rule = SMOOTH},
    {"tau = 1e-6", "diffuse-reflection", {1.5, 0.0, 1e-6}, .rule = SMOOTH},
    {"tau = 1", "transmission", {0.5, 0.3, 1.5, 1.0}, .rule = REST, 0.0, "fgd-dielectric", {0.5, 0.3, 1.5}},
    {"tau = 1",
     "diffuse-transmission",
     {1.5, 0.3, 1.0},
     .rule = REST,
     0.0,
     "diffuse-reflection",
     {1.5, 0.3, 1.0}},
    {"rho = 0",
     "coated-lambertian",
     {0.5, 0.3, 1.5, 0.5, 0.0},
     .rule = SAME,
     0.0,
     "fgd-dielectric",
     {0.5, 0.3, 1.5}},
    {"rho = tau = 1", "coated-lambertian", {0.5, 0.3, 1.5, 1.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},
    {"rho = tau = 1", "coated-lambertian", {0.05, 1.0, 2.0, 1.0, 1.0}, .rule = NUMBER, 0.0, NULL, {1.0}},

    /* E1 = 1 - mu ln(1 + 1/mu), its mean 4 (1 - ln 2)/3 */
    {"alpha = 1", "albedo", {0.05, 1.0}, .rule = NUMBER, 0.0, NULL, {0.84777387811}, true},
    {"alpha = 1", "albedo", {1.0, 1.0}, .rule = NUMBER, 0.0, NULL, {0.30685281944}, true},
    {"alpha = 1", "albedo-average", {1.0}, .rule = NUMBER, 0.0, NULL, {0.40913709259}, true},
    {"alpha = 1", "fgd-dielectric", {0.5, 1.0, 1.5}, .rule = REST, 0.0, "transmission", {0.5, 1.0, 1.5, 1.0}},
    {"alpha = 1", "fgd-dielectric", {0.5, 1.0, 0.6}, .rule = REST, 0.0, "transmission", {0.5, 1.0, 0.6, 1.0}},
};

/* Values of axes that the grid of a kind is made of, as far as it accepts them. */
static const struct {
    const char *axis;
    size_t count;
    double values[8];
} hard_values[] = {
    {"mu", 5, {0.0, 1e-6, 1e-3, 0.5, 1.0}},
    {"alpha", 6, {0.0, 1e-4, 1e-3, 0.03, 0.3, 1.0}},
    {"n", 5, {0.0, 0.05, 0.2, 1.0, 4.0}},
    {"kappa", 4, {0.0, 1e-6, 0.01, 10.0}},
    {"eta", 7, {0.0, 0.25, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.5, 4.0}},
    {"tau", 4, {0.0, 1e-6, 0.5, 1.0}},
    {"rho", 2, {0.0, 1.0}},
};

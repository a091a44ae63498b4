/* Materials that are put together from general tables in the shader: the shipped C, as C99 and as C++,
 * against the exact stack and the models' formulas; light is never made; the shading languages compile. */
#include "fit/curve.h"
#include "tests/expect.h"
#include "tests/scratch.h"
#include "tests/stack_light.h"

enum { STACKS = 30, COSINES = 4, NUMBERS = 12 };

/* Small ranges, so that few nodes will do: T and R err by some 5e-3 at most. */
static const char recipe[] =
    "{\"name\": \"small\", \"formats\": [\"c\"], \"points\": 100, \"atlas\": true, \"budget\": {\"max\": "
    "1e-2}, "
    "\"tables\": [\n"
    "{\"table\": \"fgd\", \"tolerance\": 1e-3, \"axes\": {\"mu\": \"0.1:1:20:sqrt\", \"alpha\": "
    "\"0.04:0.7:12\",\n"
    " \"n\": \"0.05:2:12:sqrt\", \"kappa\": \"1:6:12:sqrt\"}, \"pca\": {\"separate\": \"n+kappa:8\", "
    "\"sweeps\": 5}},\n"
    "{\"table\": \"fgd-dielectric\", \"tolerance\": 1e-3, \"axes\": {\"mu\": \"0.1:1:20:sqrt\", \"alpha\": "
    "\"0.1:0.6:6\",\n \"eta\": \"1.35:1.7:4\"}, \"pca\": {\"separate\": \"eta:3\", \"sweeps\": 5}},\n"
    "{\"table\": \"fgd-dielectric\", \"name\": \"inside\", \"tolerance\": 1e-3, \"budget\": {\"max\": "
    "2e-2},\n"
    " \"axes\": {\"mu\": \"0.6:1:32\", \"alpha\": \"0.1:0.6:8\", \"eta\": \"0.58:0.75:6\"},\n"
    " \"pca\": {\"separate\": \"alpha:4\", \"critical\": true, \"sweeps\": 5}},\n"
    "{\"table\": \"tir-pass\", \"tolerance\": 1e-3, \"axes\": {\"mu\": \"0.6:1:64\", \"alpha\": "
    "\"0.04:0.7:16\",\n"
    " \"eta\": \"0.58:0.75:10\"}, \"pca\": {\"separate\": \"alpha:8\", \"critical\": true, \"sweeps\": 5}},\n"
    "{\"mapping\": \"f\", \"axes\": {\"alpha\": \"0.005:0.9:256\"}, \"pca\": {\"value\": \"square\"}},\n"
    "{\"mapping\": \"f-inverse\", \"axes\": {\"f\": \"0.0001:1000:256:power6\"}},\n"
    "{\"table\": \"transmission\", \"tolerance\": 1e-3, \"axes\": {\"mu\": \"0.1:1:20:sqrt\", \"alpha\": "
    "\"0.1:0.6:6\",\n \"eta\": \"1.35:1.7:4\", \"tau\": \"0.2:1:6\"}, \"pca\": {\"separate\": \"tau,eta\", "
    "\"value\": "
    "\"beer\", \"bases\": \"3,4\", \"sweeps\": 5}},\n"
    "{\"table\": \"diffuse-transmission\", \"tolerance\": 1e-3, \"axes\": {\"eta\": \"1.35:1.7:4\", "
    "\"alpha\": "
    "\"0.1:0.6:4\", \"tau\": \"0.2:1:6\"},\n \"pca\": {\"separate\": \"tau\", \"value\": \"beer\", "
    "\"bases\": \"1,2\", "
    "\"sweeps\": 5}},\n"
    "{\"table\": \"diffuse-reflection\", \"tolerance\": 1e-3, \"axes\": {\"eta\": \"1.35:1.7:4\", \"alpha\": "
    "\"0.1:0.6:4\", \"tau\": \"0.2:1:6\"},\n \"pca\": {\"separate\": \"tau\", \"value\": \"beer\", "
    "\"bases\": \"1,2\", "
    "\"sweeps\": 5}},\n"
    "{\"table\": \"variance\", \"tolerance\": 1e-3, \"axes\": {\"eta\": \"1.35:1.7:4\", \"alpha\": "
    "\"0.1:0.6:4\"}},\n"
    "{\"table\": \"albedo\", \"tolerance\": 1e-3, \"axes\": {\"mu\": \"0:1:20:sqrt\", \"alpha\": "
    "\"0:1:16:sqrt\"}}"
    "]}\n";

static int run(const char *format, const char *a, const char *b) {
    char command[2048];
    int used = snprintf(command, sizeof command, "cd %s && ", folder);
    snprintf(command + used, sizeof command - (size_t)used, format, a, b);
    return system(command);
}

static int make_pack(const char *name) {
    const char *program = getenv("LACQUER");
    FILE *out = fopen(at("recipe.json"), "w");
    fputs(recipe, out);
    fclose(out);
    char path[512] = "";
    if (!program && !realpath("build/release/lacquer", path)) return -1;
    return run("%s pack recipe.json -o %s --cache cache >/dev/null", program ? program : path, name);
}

/* ---------------------------------------------------------------------- the shipped C as a filter */

/* Reads lines "FUNCTION mu alpha eta tau*3 rho*3 base_alpha n*3 kappa*3"; 0: the conductor of alpha. */
static const char use[] =
    "#include \"pack/atlas.h\"\n#include \"pack/decode.h\"\n#include <stdio.h>\n"
    "int main(void) {\n    const float *t = lacquer_atlas_texels;\n    int which;\n    float x[16];\n"
    "    while (scanf(\"%d\", &which) == 1) {\n"
    "        for (int i = 0; i < 16; i++) if (scanf(\"%f\", &x[i]) != 1) return 1;\n"
    "        const lacquer_vec3 tau = lacquer_make3(x[3], x[4], x[5]), rho = lacquer_make3(x[6], x[7], "
    "x[8]);\n"
    "        const lacquer_vec3 n = lacquer_make3(x[10], x[11], x[12]), k = lacquer_make3(x[13], x[14], "
    "x[15]);\n"
    "        const lacquer_lobes l = which == 0 ? lacquer_conductor(t, x[0], x[1], n, k)\n"
    "            : which == 1 ? lacquer_coated_lambertian(t, x[0], x[1], x[2], tau, rho)\n"
    "            : lacquer_layered(t, x[0], x[1], x[2], tau, x[9], n, k);\n"
    "        printf(\"%.7g %.7g %.7g %.7g %.7g %.7g %.7g %.7g %.7g %.7g %.7g %.7g\\n\", (double)l.top.x, "
    "(double)l.top.y, (double)l.top.z,\n"
    "            (double)l.top_alpha, (double)l.inner.x, (double)l.inner.y, (double)l.inner.z, "
    "(double)l.inner_alpha,\n"
    "            (double)l.base.x, (double)l.base.y, (double)l.base.z, (double)l.base_alpha);\n"
    "    }\n    return 0;\n}\n";

typedef struct point {
    int which;
    double mu, alpha, eta, tau[3], rho[3], base_alpha, n[3], kappa[3];
} point;

enum { TOP = 0, TOP_ALPHA = 3, INNER = 4, INNER_ALPHA = 7, BASE = 8, BASE_ALPHA = 11 };

static void decode(const point *points, size_t count, double (*numbers)[NUMBERS]) {
    FILE *out = fopen(at("in.txt"), "w");
    for (size_t i = 0; i < count; i++) {
        const point *p = &points[i];
        fprintf(out, "%d %.9g %.9g %.9g", p->which, p->mu, p->alpha, p->eta);
        for (int c = 0; c < 3; c++) fprintf(out, " %.9g", p->tau[c]);
        for (int c = 0; c < 3; c++) fprintf(out, " %.9g", p->rho[c]);
        fprintf(out, " %.9g", p->base_alpha);
        for (int c = 0; c < 3; c++) fprintf(out, " %.9g", p->n[c]);
        for (int c = 0; c < 3; c++) fprintf(out, " %.9g", p->kappa[c]);
        fputc('\n', out);
    }
    fclose(out);
    assert_int_equal(run("./use <in.txt >out.txt && ./use_cpp <in.txt | cmp -s - out.txt%s%s", "", ""), 0);
    FILE *in = fopen(at("out.txt"), "r");
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < NUMBERS; k++) assert_int_equal(fscanf(in, "%lf", &numbers[i][k]), 1);
    fclose(in);
}

static int prepare(void **state) {
    if (make_folder(state) != 0 || make_pack("pack") != 0) return -1;
    const char *cc = getenv("CC"), *cxx = getenv("CXX");
    FILE *out = fopen(at("use.c"), "w");
    fputs(use, out);
    fclose(out);
    if (run("%s -std=c99 -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off use.c -lm -o use%s",
            cc ? cc : "cc", "") != 0)
        return -1;
    return run("%s -x c++ -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off use.c -o use_cpp%s",
               cxx ? cxx : "c++", "");
}

static int clear(void **state) {
    run("rm -rf pack less cache use.c use use_cpp in.txt out.txt recipe.json main.* log%s%s", "", "");
    return remove_folder(state);
}

/* ------------------------------------------------------------------------------------- values */

static double between(double low, double high, size_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*seed >> 40) / (double)(1 << 24);
}

static point random_point(int which, size_t *seed) {
    point p = {.which = which};
    p.mu = between(0.1, 1, seed);
    p.alpha = between(0.1, 0.6, seed);
    p.eta = between(1.35, 1.7, seed);
    for (int c = 0; c < 3; c++) {
        p.tau[c] = between(0.2, 1, seed);
        p.rho[c] = between(0, 1, seed);
        p.n[c] = between(0.2, 2, seed);
        p.kappa[c] = between(1.8, 6, seed);
    }
    p.base_alpha = between(0.1, 0.6, seed);
    return p;
}

static void exact(const char *text, const double *mu, lq_stack_light *light) {
    const lq_stack_query query = {.mu = mu, .mu_count = COSINES, .tolerance = 1e-3};
    solve(text, &query, light);
}

/* The model takes what the base sends back to be spread evenly again, which it is but for absorption: 2 %. */
static void test_coated_lambertian(void **state) {
    (void)state;
    size_t seed = 1;
    double worst = 0.0, error = 0.0;
    for (int s = 0; s < STACKS; s++) {
        point p = random_point(1, &seed), points[COSINES];
        double mu[COSINES], numbers[COSINES][NUMBERS];
        lq_stack_light light[3 * COSINES];
        char text[512];
        for (int m = 0; m < COSINES; m++) {
            points[m] = p;
            points[m].mu = mu[m] = between(0.1, 1.0, &seed);
        }
        snprintf(text, sizeof text,
                 LAYERS("{\"dielectric\": {\"n\": %.9g, \"alpha\": %.9g}, \"medium\": {\"tau\": [%.9g, %.9g, "
                        "%.9g]}}, {\"lambertian\": {\"rho\": [%.9g, %.9g, %.9g]}}"),
                 p.eta, p.alpha, p.tau[0], p.tau[1], p.tau[2], p.rho[0], p.rho[1], p.rho[2]);
        exact(text, mu, light);
        decode(points, COSINES, numbers);
        for (int m = 0; m < COSINES; m++)
            for (int c = 0; c < 3; c++) {
                const double got = numbers[m][TOP + c] + numbers[m][BASE + c];
                const double want = light[m * 3 + c].reflected.energy;
                worst = fmax(worst, fabs(got - want));
                error = fmax(error, fabs(got - want) - 0.02 * want);
                assert_near(numbers[m][INNER + c], 0.0, 0.0);
            }
        assert_near(numbers[0][TOP_ALPHA], p.alpha, 1e-6);
    }
    print_message("coated Lambertian: %.1e from the exact stack\n", worst);
    assert_true(error < 1e-2);
}

static void test_conductor(void **state) {
    (void)state;
    enum { POINTS = 120 };
    static point points[POINTS];
    static double numbers[POINTS][NUMBERS];
    size_t seed = 2;
    double worst = 0.0;
    const lq_kind *kind = lq_kind_find("fgd", NULL);
    lq_settings settings = lq_settings_default();
    settings.tolerance = 1e-4;
    for (int i = 0; i < POINTS; i++) points[i] = random_point(0, &seed);
    decode(points, POINTS, numbers);
    for (int i = 0; i < POINTS; i++)
        for (int c = 0; c < 3; c++) {
            const double x[] = {points[i].mu, points[i].alpha, points[i].n[c], points[i].kappa[c]};
            double value, estimate;
            assert_int_equal(lq_eval(kind, &settings, x, &value, &estimate, NULL), LQ_OK);
            worst = fmax(worst, fabs(numbers[i][TOP + c] - value));
            assert_near(numbers[i][BASE + c] + numbers[i][INNER + c], 0.0, 0.0);
        }
    print_message("conductor: %.1e from the exact table\n", worst);
    assert_true(worst < 1e-2 && worst > 0.0);
}

static double value_of(const char *id, double a, double b, double c, double d) {
    const double x[] = {a, b, c, d};
    double value, estimate;
    lq_settings settings = lq_settings_default();
    settings.tolerance = 1e-3;
    assert_int_equal(lq_eval(lq_kind_find(id, NULL), &settings, x, &value, &estimate, NULL), LQ_OK);
    return value;
}

/* B18's forward model with exact tables: the energy and the roughness of what was inside. */
static void model(const lq_curve *curve, const point *p, double *energy, double *alpha) {
    const double t = sqrt(1.0 - (1.0 - p->mu * p->mu) / (p->eta * p->eta));
    const double r01 = value_of("fgd-dielectric", p->mu, p->alpha, p->eta, 0.0);
    const double t10 = (1.0 - value_of("fgd-dielectric", t, p->alpha, 1.0 / p->eta, 0.0)) *
                       value_of("tir-pass", t, p->base_alpha, 1.0 / p->eta, 0.0);
    const double r12 =
        value_of("fgd", t, p->base_alpha, p->n[0] / p->eta, p->kappa[0] / p->eta) * pow(p->tau[0], 2.0 / t);
    const double x = (1.0 - t10) * r12, slope = p->eta * t / p->mu;
    const double base = lq_curve_f(curve, p->base_alpha), top = lq_curve_f(curve, p->alpha);
    *energy = (1.0 - r01) * r12 * t10 / (1.0 - x);
    *alpha = lq_curve_inverse(
        curve, lq_curve_f(curve, 0.5 * p->alpha * fabs(1.0 - slope)) +
                   slope * (lq_curve_f(curve, 0.5 * p->alpha * fabs(1.0 - p->mu / (p->eta * t))) + base +
                            x / (1.0 - x) * (base + top)));
}

/* The frosted metal whose energies by the model are known, and others by the model with exact tables. */
static void test_layered(void **state) {
    (void)state;
    enum { POINTS = 12 };
    static const double mu[] = {1.0, 0.6, 0.15}, want[] = {0.927, 0.903, 0.782};
    static lq_curve curve;
    const lq_ndf *ndf;
    point points[POINTS];
    double numbers[POINTS][NUMBERS], energy, alpha, worst = 0.0, rough = 0.0;
    size_t seed = 3;
    assert_int_equal(lq_ndf_open(&ndf, "ggx", NULL), LQ_OK);
    assert_int_equal(lq_curve_make(&curve, ndf, NULL), LQ_OK);
    for (int i = 0; i < POINTS; i++) {
        points[i] = random_point(2, &seed);
        if (i < 3)
            points[i] = (point){2, mu[i], 0.2, 1.5, {1, 1, 1}, {0}, .05, {0.2, 0.2, 0.2}, {3.9, 3.9, 3.9}};
        for (int c = 1; c < 3; c++) { /* the mean of the colours is one of them */
            points[i].tau[c] = points[i].tau[0];
            points[i].n[c] = points[i].n[0];
            points[i].kappa[c] = points[i].kappa[0];
        }
    }
    decode(points, POINTS, numbers);
    for (int i = 0; i < POINTS; i++) {
        if (i < 3) assert_near(numbers[i][TOP] + numbers[i][INNER], want[i], 5e-3);
        model(&curve, &points[i], &energy, &alpha);
        worst = fmax(worst, fabs(numbers[i][INNER] - energy));
        rough = fmax(rough, fabs(numbers[i][INNER_ALPHA] / alpha - 1.0));
        assert_near(numbers[i][INNER + 1], numbers[i][INNER], 1e-6);
    }
    print_message("layered: energy %.1e, roughness %.1e (relative) from the model\n", worst, rough);
    assert_true(worst < 2e-2);
    assert_true(rough < 2e-2);
    lq_ndf_close(ndf);
}

/* Lossless layers return what arrives and no more; NaN goes through. */
static void test_furnace(void **state) {
    (void)state;
    enum { POINTS = 400 };
    static point points[POINTS + 2];
    static double numbers[POINTS + 2][NUMBERS];
    size_t seed = 4;
    for (int i = 0; i < POINTS; i++) {
        points[i] = random_point(i % 3, &seed);
        if (i % 4 == 0) points[i].mu = between(-0.5, 1.5, &seed), points[i].eta = between(0.5, 4.0, &seed);
        for (int c = 0; c < 3; c++) {
            points[i].tau[c] = points[i].rho[c] = 1.0;
            points[i].n[c] = 0.05;
            points[i].kappa[c] = 8.0;
        }
    }
    for (int w = 0; w < 2; w++) points[POINTS + w] = random_point(w + 1, &seed), points[POINTS + w].mu = NAN;
    decode(points, POINTS + 2, numbers);
    for (int i = 0; i < POINTS; i++)
        for (int c = 0; c < 3; c++) {
            const double sum = numbers[i][TOP + c] + numbers[i][INNER + c] + numbers[i][BASE + c];
            assert_true(sum <= 1.0 + 1e-6 && numbers[i][TOP + c] >= 0.0 && numbers[i][INNER + c] >= 0.0);
            if (i % 3 == 1) assert_true(sum > 1.0 - 2e-2);
        }
    assert_true(isnan(numbers[POINTS][BASE]) && isnan(numbers[POINTS + 1][INNER]));
}

/* ---------------------------------------------------------------------------------- languages */

static const char calls[] =
    "lacquer_shade(%s, lacquer_conductor(%s, v.x, v.y, v.xyz, v.zyx), v.x, v.y, v.z) + "
    "lacquer_shade(%s, lacquer_coated_lambertian(%s, v.x, v.y, v.z, v.xyz, v.zyx), "
    "v.x, v.y, v.z) + "
    "lacquer_shade(%s, lacquer_layered(%s, v.x, v.y, v.z, v.xyz, v.y, v.zyx, v.yyy), "
    "v.x, v.y, v.z)";

static void write_main(const char *name, const char *before, const char *atlas, const char *after) {
    FILE *out = fopen(at(name), "w");
    fputs(before, out);
    fprintf(out, calls, atlas, atlas, atlas, atlas, atlas, atlas);
    fputs(after, out);
    fclose(out);
}

static void test_languages(void **state) {
    (void)state;
    if (run("command -v glslangValidator >log%s%s", "", "") != 0) skip();
    write_main("main.es.frag",
               "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n#define LACQUER_CHECK\n"
               "#include \"pack/decode.glsl\"\nuniform sampler2D atlas;\nin vec4 v;\nout vec4 colour;\n"
               "void main() { colour = vec4(",
               "atlas", ", 1.0); }\n");
    write_main("main.vk.frag",
               "#version 450\n#extension GL_GOOGLE_include_directive : enable\n"
               "#include \"pack/decode.vulkan.glsl\"\nlayout(set = 0, binding = 0) uniform texture2D atlas;\n"
               "layout(set = 0, binding = 1) uniform sampler s;\nlayout(location = 0) in vec4 v;\n"
               "layout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(",
               "atlas, s", ", 1.0); }\n");
    write_main(
        "main.hlsl",
        "#define LACQUER_CHECK\n#include \"pack/decode.hlsl\"\nTexture2D<float4> atlas;\nSamplerState s;\n"
        "float4 main(float4 v : TEXCOORD0) : SV_Target { return float4(",
        "atlas, s", ", 1.0); }\n");
    assert_int_equal(run("sed -e '/#include/{r pack/decode.glsl%s%s' -e 'd;}' main.es.frag >main.frag && "
                         "glslangValidator main.frag >log || { cat log; false; }",
                         "", ""),
                     0);
    assert_int_equal(
        run("glslangValidator -V main.vk.frag -o main.spv >log || { cat log; false; }%s%s", "", ""), 0);
    assert_int_equal(
        run("glslangValidator -D -V -S frag -e main main.hlsl -o main.spv >log || { cat log; false; }%s%s",
            "", ""),
        0);
}

/* A function whose tables are not all there is left out. */
static void test_less(void **state) {
    (void)state;
    char text[sizeof recipe];
    const char *program = getenv("LACQUER");
    char path[512] = "";
    if (!program && realpath("build/release/lacquer", path)) program = path;
    memcpy(text, recipe, sizeof text);
    char *line = strstr(text, "{\"table\": \"fgd-dielectric\", \"name\""),
         *next = strstr(line, "{\"table\": \"tir");
    memmove(line, next, strlen(next) + 1);
    FILE *out = fopen(at("recipe.json"), "w");
    fputs(text, out);
    fclose(out);
    assert_int_equal(run("%s pack recipe.json -o less --cache cache >/dev/null%s", program, ""), 0);
    assert_int_equal(
        run("grep -q 'lacquer_coated_lambertian(' less/decode.glsl && grep -q 'lacquer_conductor(' "
            "less/decode.h && ! grep -q 'lacquer_layered(' less/decode.*%s%s",
            "", ""),
        0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coated_lambertian), cmocka_unit_test(test_conductor),
        cmocka_unit_test(test_layered),           cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_languages),         cmocka_unit_test(test_less)};
    return cmocka_run_group_tests_name("general-source", tests, prepare, clear);
}

/* A scene as an engine has it: decode.glsl, decode.hlsl and decode.vulkan.glsl (through glslangValidator and
 * spirv-cross) on a software GPU, and decode.metal compiled as C++, against the shipped decode.h at thousands
 * of points of every material; the energy of lacquer_shade over all lights; LACQUER_CHECK and NaN. Skipped
 * where there is no EGL. */
#include "tests/expect.h"
#include "tests/scratch.h"

#include <stdlib.h>
#include <string.h>

#ifndef LACQUER_EGL
int main(void) {
    fputs("built without EGL and GLES\n", stderr);
    return 77;
}
#else

#include "tests/gl.h"

#include <dlfcn.h>

/* tests/consumers/scene.json: ranges go from 0.1 to 0.5, and no error is allowed to be larger. */
#define RECIPE "tests/consumers/scene.json"
static const double budget = 1.5e-2;

/* How each is called with a point q: q.x a cosine, q.y and q.z roughnesses. The same text in all languages.
 */
typedef struct material {
    const char *name, *arguments, *rho;
    int ranges;
    double second; /* the least of the second */
} material;
static const material materials[] = {{"metal", "q.x, q.y", NULL, 1, 0.0},
                                     {"wood", "q.x, q.y", "q.z, q.w, q.x", 1, 0.0},
                                     {"white", "q.x, q.y", "q.z, q.w, q.x", 1, 0.0},
                                     {"chalk", "q.x", NULL, 0, 0.0},
                                     {"coated_metal", "q.x, q.y", NULL, 1, 0.0},
                                     {"two_ranges", "q.x, q.y, q.z", NULL, 2, 0.3}};
enum { MATERIALS = sizeof materials / sizeof materials[0], TABLES = MATERIALS, SUBJECTS };

/* What is no material: the functions of tables, with q.w for indices and transmittances. */
static const char tables[] =
    "    VEC4 v = MAKE4(lacquer_transmission(ATLAS, q.x, q.y, q.x + q.y + q.w, q.w),\n"
    "        lacquer_tir_pass(ATLAS, q.x, q.y, q.w),\n"
    "        lacquer_dfg(ATLAS, q.x, q.y).x, lacquer_dfg(ATLAS, q.x, q.y).y);\n";

/* What is compared: four numbers each, one a column of pixels, so that each is seen at a quarter of the
 * points.
 */
enum { PARTS = 4, TOP = 0, INNER, BASE, SHADE };
static const char *const parts[PARTS] = {"l.top.x, l.top.y, l.top.z, l.top_alpha",
                                         "l.inner.x, l.inner.y, l.inner.z, l.inner_alpha",
                                         "l.base.x, l.base.y, l.base.z, l.base_alpha", "s.x, s.y, s.z, r.x"};

/* Declares l, the lobes, s, what they shade, and r, with another half vector; last v, one part of them. */
static void print_point(FILE *out, int subject) {
    if (subject == TABLES) {
        fputs(tables, out);
        return;
    }
    const material *m = &materials[subject];
    fprintf(out, "    LOBES l = lacquer_%s(ATLAS, %s", m->name, m->arguments);
    if (m->rho) fprintf(out, ", MAKE3(%s)", m->rho);
    fputs(");\n    VEC3 s = lacquer_shade(ATLAS, l, q.x, q.w, q.w);\n"
          "    VEC3 r = lacquer_shade(ATLAS, l, q.x, q.w, q.y);\n",
          out);
    fprintf(out, "    VEC4 v = MAKE4(%s);\n", parts[0]);
    for (int k = 1; k < PARTS; k++) fprintf(out, "    if (part == %d) { v = MAKE4(%s); }\n", k, parts[k]);
}

static char *pack(const char *file) {
    static char path[600];
    snprintf(path, sizeof path, "%s/pack/%s", folder, file);
    return path;
}

static void run(const char *command) {
    if (system(command) != 0) fail_msg("%s", command);
}

static int make_pack(void **state) {
    char command[1024];
    const char *program = getenv("LACQUER");
    if (make_folder(state) != 0) return -1;
    snprintf(command, sizeof command, "%s pack " RECIPE " -o %s/pack --cache %s/cache >/dev/null",
             program ? program : "build/release/lacquer", folder, folder);
    return system(command);
}

static int remove_pack(void **state) {
    char command[600];
    snprintf(command, sizeof command, "rm -rf %s/*", folder);
    return system(command) == 0 ? remove_folder(state) : -1;
}

/* Points that fill the ranges, and go beyond them. */
static void place(float *points) {
    static const double min[4] = {-0.02, 0.05, 0.05, 0.0}, max[4] = {1.02, 0.6, 0.6, 1.0};
    for (size_t i = 0; i < POINTS; i++)
        for (size_t a = 0; a < 4; a++) {
            const double u = fmod(0.5 + (double)(i + 1) * pow(1.2207440846, -(double)(a + 1)), 1.0);
            points[4 * i + a] = (float)(min[a] + (max[a] - min[a]) * u);
        }
}

static size_t part_of(size_t point) {
    return point % SIDE % PARTS;
}

/* ---------------------------------------------------------------------- decoders that are C or C++ */

typedef struct native {
    void *library;
    void (*decode)(int material, int part, const float *point, float *value);
    void (*furnace)(int material, int lobe, const float *point, float cos_h, float *value);
} native;

static const char plain_c[] =
    "#include \"decode.h\"\n#include \"atlas.h\"\n#define ATLAS lacquer_atlas_texels\n"
    "#define LOBES lacquer_lobes\n#define VEC3 lacquer_vec3\n#define VEC4 lacquer_vec4\n"
    "#define MAKE3 lacquer_make3\n#define MAKE4 lacquer_make4\n";
static const char metal[] =
    "#include \"decode.metal\"\n#include \"atlas.h\"\n"
    "#define ATLAS (metal::texture2d<float>{lacquer_atlas_texels, WIDTH, HEIGHT}), (metal::sampler())\n"
    "#define LOBES LacquerLobes\n#define VEC3 metal::float3\n#define VEC4 metal::float4\n"
    "#define MAKE3 metal::float3\n#define MAKE4 metal::float4\n";

static void print_decode(FILE *out) {
    fputs("void decode(int material, int part, const float *p, float *value);\n"
          "void decode(int material, int part, const float *p, float *value) {\n"
          "    const VEC4 q = MAKE4(p[0], p[1], p[2], p[3]);\n",
          out);
    for (int m = 0; m < (int)SUBJECTS; m++) {
        fprintf(out, "    if (material == %d) {\n", m);
        print_point(out, m);
        fputs("    value[0] = v.x; value[1] = v.y; value[2] = v.z; value[3] = v.w;\n    }\n", out);
    }
    fputs("    (void)part;\n}\n", out);
}

/* One lobe alone, of a white base, and its roughness. */
static void print_furnace(FILE *out) {
    fputs(
        "void furnace(int material, int lobe, const float *p, float cos_h, float *value);\n"
        "void furnace(int material, int lobe, const float *p, float cos_h, float *value) {\n"
        "    const VEC4 q = MAKE4(p[0], p[1], p[2], p[3]);\n    LOBES l = lacquer_metal(ATLAS, q.x, q.y);\n",
        out);
    for (int m = 1; m < (int)MATERIALS; m++)
        fprintf(out, "    if (material == %d) l = lacquer_%s(ATLAS, %s%s);\n", m, materials[m].name,
                materials[m].arguments, materials[m].rho ? ", MAKE3(1.0f, 1.0f, 1.0f)" : "");
    static const char *const lobes[] = {"top", "inner", "base"};
    for (int k = 0; k < 3; k++)
        fprintf(out, "    if (lobe != %d) l.%s = MAKE3(0.0f, 0.0f, 0.0f);\n    else value[3] = l.%s_alpha;\n",
                k, lobes[k], lobes[k]);
    fputs("    const VEC3 s = lacquer_shade(ATLAS, l, q.x, q.w, cos_h);\n"
          "    value[0] = s.x; value[1] = s.y; value[2] = s.z;\n}\n",
          out);
}

static void read_size(uint32_t size[2]) {
    size_t bytes;
    char *file = read_whole(pack("atlas.ktx2"), &bytes);
    memcpy(size, file + 20, 2 * sizeof *size);
    free(file);
}

/* Undefined behaviour ends the test: it traps. */
static native compile_native(const char *name, const char *compiler, const char *language, const char *head) {
    char command[2048], path[600];
    uint32_t size[2];
    native n = {NULL, NULL, NULL};
    read_size(size);
    FILE *out = fopen(at("use"), "w");
    fprintf(out, "#include <math.h>\n%s#ifdef __cplusplus\nextern \"C\" {\n#endif\n", head);
    print_decode(out);
    print_furnace(out);
    fputs("#ifdef __cplusplus\n}\n#endif\n", out);
    fclose(out);
    snprintf(path, sizeof path, "%s/%s.so", folder, name);
    snprintf(command, sizeof command,
             "%s %s -O2 -ffp-contract=off -Wall -Wextra -Wconversion -Wshadow -Werror -DWIDTH=%u -DHEIGHT=%u "
             "-fsanitize=undefined,float-cast-overflow -fsanitize-undefined-trap-on-error -shared -fPIC "
             "-I%s/pack -Itests/consumers %s/use -o %s -lm",
             compiler, language, size[0], size[1], folder, folder, path);
    run(command);
    n.library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!n.library) fail_msg("%s", dlerror());
    *(void **)&n.decode = dlsym(n.library, "decode");
    *(void **)&n.furnace = dlsym(n.library, "furnace");
    return n;
}

static native compile_c(const char *name, const char *options) {
    char language[128];
    const char *compiler = getenv("CC");
    snprintf(language, sizeof language, "-std=c99 -pedantic -x c %s", options);
    return compile_native(name, compiler ? compiler : "cc", language, plain_c);
}

static void run_native(const native *n, int m, const float *points, float *values) {
    for (size_t i = 0; i < POINTS; i++) n->decode(m, (int)part_of(i), points + 4 * i, values + 4 * i);
}

/* ------------------------------------------------------------------------------------ shaders */

typedef struct shader {
    const char *file, *before, *after, *fetch, *translate; /* `translate`: the options of glslangValidator */
    const char *vec;
} shader;

static const shader shaders[] = {
    {"decode.glsl", "#version 300 es\n",
     "uniform sampler2D unit3, points;\nout vec4 value;\n#define ATLAS unit3\nvoid main() {\n",
     "texelFetch(points, ivec2(gl_FragCoord.xy), 0);\n    int part = int(gl_FragCoord.x) % 4", NULL, "vec"},
    {"decode.hlsl", "",
     "Texture2D<float4> unit3 : register(t3), points : register(t1);\nSamplerState linear_clamp : "
     "register(s2);\n"
     "#define ATLAS unit3, linear_clamp\nfloat4 main(float4 at : SV_Position) : SV_Target\n{\n",
     "points.Load(int3(at.xy, 0));\n    int part = int(at.x) % 4", "-D -V -S frag -e main", "float"},
    {"decode.vulkan.glsl", "#version 450\n",
     "layout(binding = 3) uniform texture2D unit3;\nlayout(binding = 1) uniform texture2D points;\n"
     "layout(binding = 2) uniform sampler linear_clamp;\nlayout(location = 0) out vec4 value;\n"
     "#define ATLAS unit3, linear_clamp\nvoid main() {\n",
     "texelFetch(sampler2D(points, linear_clamp), ivec2(gl_FragCoord.xy), 0);\n"
     "    int part = int(gl_FragCoord.x) % 4",
     "-V -S frag", "vec"},
};
enum { SHADERS = sizeof shaders / sizeof shaders[0] };

static void print_shader(FILE *out, const shader *s, int subject, bool checked) {
    size_t size;
    char *decode = read_whole(pack(s->file), &size);
    fprintf(out, "%s%s%s%s", s->before, checked ? "#define LACQUER_CHECK\n" : "", decode, s->after);
    free(decode);
    fputs("#define LOBES LacquerLobes\n", out);
    for (int k = 3; k <= 4; k++)
        fprintf(out, "#define MAKE%d %s%d\n#define VEC%d %s%d\n", k, s->vec, k, k, s->vec, k);
    fprintf(out, "    %s4 q = %s;\n", s->vec, s->fetch);
    print_point(out, subject);
    fputs(strcmp(s->vec, "vec") == 0 ? "    value = v;\n}\n" : "    return v;\n}\n", out);
}

/* What glslangValidator and spirv-cross make of the text in `shader`. */
static char *translate(const shader *s) {
    char command[2000];
    size_t size;
    snprintf(
        command, sizeof command,
        "cd %s && glslangValidator %s -o h.spv shader >h.log && "
        "spirv-cross --version 300 --es h.spv --output h.glsl >>h.log 2>&1 || { tail -20 h.log >&2; false; }",
        folder, s->translate);
    run(command);
    char *text = read_whole(at("h.glsl"), &size);
    plain_names(text);
    return text;
}

static void run_shader(const shader *s, int subject, bool checked, const float *points, float *values) {
    size_t size;
    FILE *out = fopen(at("shader"), "w");
    print_shader(out, s, subject, checked);
    fclose(out);
    char *text = s->translate ? translate(s) : read_whole(at("shader"), &size);
    memset(values, 0, POINTS * 4 * sizeof *values);
    render(text, points, values);
    free(text);
}

static bool can_run(const shader *s) {
    if (!s->translate || (have("glslangValidator") && have("spirv-cross"))) return true;
    print_message("%s is not tested: glslangValidator and spirv-cross are needed\n", s->file);
    return false;
}

/* ------------------------------------------------------------------------------------- tests */

typedef struct numbers {
    float points[4 * POINTS], c[4 * POINTS], values[4 * POINTS];
} numbers;

/* Relative where values are larger than 1; NaN is far from all. */
static double apart(const float *a, const float *b) {
    double worst = 0.0, spread = 0.0;
    for (size_t i = 0; i < 4 * (size_t)POINTS; i++) {
        const double x = (double)a[i], y = (double)b[i], error = fabs(x - y) / fmax(1.0, fabs(y));
        if (!(error <= worst)) worst = isnan(error) ? INFINITY : error;
        spread = fmax(spread, fabs(y - (double)b[0]));
    }
    assert_true(spread > 0.01);
    return worst;
}

static void test_alike(void **state) {
    (void)state;
    numbers *n = calloc(1, sizeof *n);
    const native c = compile_c("c", ""), cpp = compile_native("cpp", "c++", "-std=c++11 -x c++", plain_c);
    const native msl = compile_native("metal", "c++", "-std=c++14 -x c++", metal);
    place(n->points);
    upload(GL_TEXTURE3, pack("atlas.ktx2"));
    for (int m = 0; m < (int)SUBJECTS; m++) {
        run_native(&c, m, n->points, n->c);
        run_native(&cpp, m, n->points, n->values);
        assert_memory_equal(n->values, n->c, sizeof n->c);
        run_native(&msl, m, n->points, n->values);
        double error = apart(n->values, n->c);
        print_message("%-13s decode.metal %.1e", m == TABLES ? "tables" : materials[m].name, error);
        assert_near(error, 0.0, 1e-5);
        for (size_t s = 0; s < SHADERS; s++) {
            if (!can_run(&shaders[s])) continue;
            run_shader(&shaders[s], m, false, n->points, n->values);
            error = apart(n->values, n->c);
            print_message(", %s %.1e", shaders[s].file, error);
            assert_near(error, 0.0, 1e-5);
        }
        print_message(" from the C decoder\n");
    }
    free(n);
}

/* Light that a lobe sends to all sides, from half vectors as dense as its own normals, seen from cosine mu; a
 * base's is about the normal. */
static void integrate(const native *c, int m, int lobe, double mu, double out[3]) {
    enum { NORMALS = 1000, AZIMUTHS = 200 };
    float point[4] = {(float)mu, 0.15f, 0.4f, 0.5f}, value[4];
    const double v = lobe == BASE ? 1.0 : mu, sine = sqrt(1.0 - v * v);
    c->furnace(m, lobe, point, 1.0f, value);
    const double a2 = fmax((double)value[3] * (double)value[3], 1e-7);
    memset(out, 0, 3 * sizeof *out);
    for (int i = 0; i < NORMALS; i++)
        for (int j = 0; j < AZIMUTHS; j++) {
            const double u = (i + 0.5) / NORMALS, phi = 2.0 * M_PI * (j + 0.5) / AZIMUTHS;
            const double cos2 = (1.0 - u) / (1.0 + (a2 - 1.0) * u), h = sqrt(cos2);
            const double vh = sine * sqrt(1.0 - cos2) * cos(phi) + v * h, light = 2.0 * vh * h - v;
            const double d = (cos2 * (a2 - 1.0) + 1.0), density = a2 / (M_PI * d * d) * h / (4.0 * vh);
            if (vh <= 0.0 || light <= 0.0) continue;
            point[3] = (float)light;
            c->furnace(m, lobe, point, (float)h, value);
            for (int k = 0; k < 3; k++) out[k] += (double)value[k] / density / (NORMALS * AZIMUTHS);
        }
}

/* All lights white: what a material reflects is its lobes' energies, and no more than arrives. */
static void test_furnace(void **state) {
    (void)state;
    const native c = compile_c("furnace", "");
    static const double cosines[] = {0.1, 0.5, 1.0};
    double largest = 0.0, apart_most = 0.0;
    for (int m = 0; m < (int)MATERIALS; m++)
        for (size_t i = 0; i < 3; i++) {
            const float point[4] = {(float)cosines[i], 0.15f, 0.4f, 1.0f};
            double sum[3] = {0.0}, part[3];
            for (int lobe = TOP; lobe <= BASE; lobe++) {
                float value[4];
                c.decode(m, lobe, point, value);
                integrate(&c, m, lobe, cosines[i], part);
                for (int k = 0; k < 3; k++) {
                    sum[k] += part[k];
                    if (lobe != BASE || !materials[m].rho)
                        apart_most = fmax(apart_most, fabs(part[k] - (double)value[k]));
                }
            }
            for (int k = 0; k < 3; k++) largest = fmax(largest, sum[k]);
            if (strcmp(materials[m].name, "white") == 0) assert_near(sum[0], 1.0, budget);
        }
    print_message("white furnace: at most %.4f; a lobe %.1e from its energy\n", largest, apart_most);
    assert_true(largest > 0.9 && largest <= 1.0 + budget);
    assert_near(apart_most, 0.0, budget);
}

static bool outside(const material *m, const float *q) {
    bool out = q[0] < 0.0f || q[0] > 1.0f;
    for (int r = 0; r < m->ranges; r++)
        out = out || q[1 + r] < (r == 0 ? 0.1f : (float)m->second) || q[1 + r] > 0.5f;
    return out;
}

/* Outside its range a material is magenta, in C NaN, and nothing else changes. */
static void test_check(void **state) {
    (void)state;
    numbers *n = calloc(1, sizeof *n);
    const native c = compile_c("c2", ""), checked = compile_c("checked", "-DLACQUER_CHECK");
    static const float magenta[4] = {1.0f, 0.0f, 1.0f, 1.0f};
    place(n->points);
    upload(GL_TEXTURE3, pack("atlas.ktx2"));
    for (int m = 0; m < (int)MATERIALS; m++) {
        run_native(&c, m, n->points, n->c);
        run_native(&checked, m, n->points, n->values);
        for (size_t i = 0; i < POINTS; i++)
            if (outside(&materials[m], n->points + 4 * i)) assert_true(isnan(n->values[4 * i]));
            else assert_memory_equal(n->values + 4 * i, n->c + 4 * i, 4 * sizeof(float));
        for (size_t s = 0; s < SHADERS; s++) {
            if (!can_run(&shaders[s])) continue;
            run_shader(&shaders[s], m, true, n->points, n->values);
            for (size_t i = 0; i < POINTS; i++) {
                const float *v = n->values + 4 * i;
                if (outside(&materials[m], n->points + 4 * i)) {
                    if (part_of(i) == TOP) assert_memory_equal(v, magenta, sizeof magenta);
                    if (part_of(i) == SHADE) assert_true(v[0] > 0.0f && v[1] == 0.0f && v[2] == v[0]);
                } else {
                    assert_near((double)v[0], (double)n->c[4 * i], 1e-5 * fmax(1.0, (double)n->c[4 * i]));
                }
            }
        }
    }
    free(n);
}

/* What is shaded with a NaN is NaN, and infinite arguments are ends of ranges; neither is undefined. */
static void test_nan(void **state) {
    (void)state;
    const native c = compile_c("nan", "");
    for (int m = 0; m < (int)MATERIALS; m++)
        for (int a = 0; a < 4; a++) {
            float q[4] = {0.5f, 0.3f, 0.4f, 0.5f}, value[4];
            c.decode(m, SHADE, q, value);
            assert_true(isfinite(value[0]) && value[0] > 0.0f);
            q[a] = NAN;
            c.decode(m, SHADE, q, value);
            const bool takes = a == 0 || a == 3 || a <= materials[m].ranges || (a == 2 && materials[m].rho);
            if (takes) assert_true(isnan(value[0]) || isnan(value[1]));
            for (int sign = -1; sign <= 1; sign += 2) {
                q[a] = (float)sign * INFINITY;
                for (int k = TOP; k <= BASE; k++) {
                    c.decode(m, k, q, value);
                    assert_true(isfinite(value[0]) && isfinite(value[3]));
                }
            }
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_alike), cmocka_unit_test(test_furnace),
                                       cmocka_unit_test(test_check), cmocka_unit_test(test_nan)};
    if (!start_gl()) {
        fputs("no surfaceless EGL with float targets\n", stderr);
        return 77;
    }
    return cmocka_run_group_tests_name("scene-decode", tests, make_pack, remove_pack);
}
#endif

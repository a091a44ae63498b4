/* A pack as an engine has it: its KTX2 files and decode.glsl, and decode.hlsl through glslangValidator and
 * spirv-cross, on a software GPU, with textures of their own and in an atlas, against its decode.h compiled
 * with its arrays, and against the exact values within its budget. The pack is the folder of the first
 * argument, or one made here. Skipped where there is no EGL. */
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

#include "fit/curve.h"
#include "pack/factored.h"
#include "pack/mapping.h"
#include "pack/measure.h"
#include "pack/read.h"
#include "tables/origin.h"
#include "tests/gl.h"

#include <dlfcn.h>

enum { EXACT = 40 };

static const char *shipped = NULL; /* the folder */
static bool in_atlas;              /* its textures are one */

static const char recipe[] =
    "{\"name\": \"small\", \"atlas\": %s, \"formats\": [\"ktx2\", \"c\"], \"points\": 125, \"budget\": "
    "{\"max\": 5e-2}, "
    "\"tables\": [\n"
    "{\"table\": \"transmission\", \"tolerance\": 1e-3,\n"
    " \"axes\": {\"mu\": \"0.02:1:16:sqrt\", \"alpha\": \"0.02:1:8:sqrt\", \"eta\": \"1.2:2:6\", \"tau\": "
    "\"0.02:1:8\"},\n"
    " \"pca\": {\"separate\": \"tau,eta\", \"value\": \"beer\", \"bases\": \"2,3\", \"pairs\": 2, "
    "\"sweeps\": 6}},\n"
    "{\"table\": \"tir-pass\", \"axes\": {\"mu\": \"0.02:1:96\", \"alpha\": \"0.02:1:16\", \"eta\": "
    "\"0.4:0.9:20\"},\n"
    " \"tolerance\": 1e-3, \"budget\": {\"max\": 2e-1}, \"pca\": {\"separate\": \"alpha:5\", \"critical\": "
    "true}},\n"
    "{\"table\": \"fgd-dielectric\", \"name\": \"one-alpha\", \"tolerance\": 1e-3,\n"
    " \"axes\": {\"mu\": \"0.02:1:24:sqrt\", \"alpha\": \"0.3\", \"eta\": \"1.2:2:8\"}, \"pca\": "
    "{\"separate\": \"eta:3\"}},\n"
    "{\"table\": \"dfg\", \"axes\": {\"mu\": \"0.02:1:24:sqrt\", \"alpha\": \"0.02:1:24\"}, \"tolerance\": "
    "1e-4},\n"
    "{\"mapping\": \"f\", \"axes\": {\"alpha\": \"0.02:0.9:256\"}, \"pca\": {\"value\": \"square\"}},\n"
    "{\"mapping\": \"f-inverse\", \"axes\": {\"f\": \"0.001:1000:128:power6\"}}]}\n";

static void make_pack(const char *atlas) {
    char command[2048];
    const char *program = getenv("LACQUER");
    FILE *out = fopen(at("recipe.json"), "w");
    fprintf(out, recipe, atlas);
    fclose(out);
    snprintf(command, sizeof command, "%s pack %s/recipe.json -o %s/pack --cache %s/cache >/dev/null",
             program ? program : "build/release/lacquer", folder, folder, folder);
    assert_int_equal(system(command), 0);
    static char made[1024];
    snprintf(made, sizeof made, "%s", at("pack"));
    shipped = made;
}

static char *text_of(const char *name) {
    char path[1024];
    size_t size;
    snprintf(path, sizeof path, "%s/%s", shipped, name);
    return read_whole(path, &size);
}

/* ------------------------------------------------------------------------------- one table */

/* Of the table that is looked at: its images' file stems, identifiers, and what its function takes. */
typedef struct table {
    const lq_shipped *s;
    char name[64];            /* an identifier */
    size_t count;             /* textures */
    char suffix[16][24];      /* "0_1", or "" */
    int axis_count, channels; /* of the function */
    int from[LQ_MAX_AXES];    /* which axis of the kind each argument is */
    double min[LQ_MAX_AXES], max[LQ_MAX_AXES];
    double fixed[LQ_MAX_AXES]; /* of the kind's axes: the value of those that are no argument */
} table;

static table describe(const lq_shipped *s) {
    table t = {.s = s, .channels = s->factored ? 1 : s->texture.channel_count};
    snprintf(t.name, sizeof t.name, "%s", s->name);
    for (char *c = t.name; *c; c++)
        if (*c == '-' || *c == '.') *c = '_';
    if (!s->factored || in_atlas) {
        t.count = 1;
    } else {
        for (int p = 0; p < s->factored->piece_count; p++)
            for (int f = 0; f < s->factored->pieces[p].factor_count; f++)
                snprintf(t.suffix[t.count++], sizeof t.suffix[0], "%d_%d", p, f);
    }
    for (int a = 0; a < s->kind->axis_count; a++) {
        const double min = s->factored ? s->factored->axes[a].min : s->table->axes[a].min;
        const double max = s->factored ? s->factored->axes[a].max : s->table->axes[a].max;
        t.fixed[a] = min;
        if (min == max) continue; /* no argument */
        t.from[t.axis_count] = a;
        t.min[t.axis_count] = min;
        t.max[t.axis_count++] = max;
    }
    return t;
}

static void file_of(const table *t, size_t i, const char *ending, char *file, size_t size) {
    if (in_atlas) snprintf(file, size, "atlas%s", ending);
    else snprintf(file, size, "%s%s%s%s", t->s->name, *t->suffix[i] ? "." : "", t->suffix[i], ending);
}

/* Points that fill the ranges evenly, x..w the arguments. */
static void place(const table *t, float *points) {
    for (size_t i = 0; i < POINTS; i++)
        for (int a = 0; a < 4; a++) {
            const double u = fmod(0.5 + (double)(i + 1) * pow(1.2207440846, -(a + 1)), 1.0);
            points[4 * i + (size_t)a] =
                a < t->axis_count ? (float)(t->min[a] + (t->max[a] - t->min[a]) * u) : 0.0f;
        }
}

/* ---------------------------------------------------------------------------- the C decoder */

typedef void decoder(const float *x, float *value);

/* With an atlas a value is returned, of several channels as a vector. */
static void print_c_call(FILE *out, const table *t) {
    const bool scalar = t->s->factored || (in_atlas && t->channels == 1);
    if (scalar) fputs("value[0] = ", out);
    else if (in_atlas) fprintf(out, "const lacquer_vec%d v = ", t->channels);
    fprintf(out, "lacquer_%s(%s", t->name, in_atlas ? "lacquer_atlas_texels" : "");
    for (size_t i = 0; i < t->count && !in_atlas; i++)
        fprintf(out, "%slacquer_%s%s%s_texels", i ? ", " : "", t->name, *t->suffix[i] ? "_" : "",
                t->suffix[i]);
    for (int a = 0; a < t->axis_count; a++) fprintf(out, ", x[%d]", a);
    fprintf(out, "%s);\n", scalar || in_atlas ? "" : ", value");
    for (int c = 0; c < t->channels && in_atlas && !scalar; c++)
        fprintf(out, "    value[%d] = v.%c;\n", c, "xyzw"[c]);
    fputs("}\n", out);
}

/* decode.h with the arrays of one table, compiled as it was shipped. */
static void run_c(const table *t, const float *points, float *values) {
    char command[2048], file[128];
    const char *compiler = getenv("CC");
    FILE *out = fopen(at("use.c"), "w");
    fputs("#include \"decode.h\"\n", out);
    for (size_t i = 0; i < t->count; i++) {
        file_of(t, i, ".h", file, sizeof file);
        fprintf(out, "#include \"%s\"\n", file);
    }
    fputs("void decode(const float *x, float *value);\nvoid decode(const float *x, float *value) {\n    ",
          out);
    print_c_call(out, t);
    fclose(out);
    snprintf(command, sizeof command,
             "%s -std=c17 -O2 -Wall -Wextra -Werror -shared -fPIC -I%s %s/use.c -o %s/use.so -lm",
             compiler ? compiler : "cc", shipped, folder, folder);
    assert_int_equal(system(command), 0);
    void *library = dlopen(at("use.so"), RTLD_NOW | RTLD_LOCAL);
    assert_non_null(library);
    decoder *decode;
    *(void **)&decode = dlsym(library, "decode");
    assert_non_null(decode);
    for (size_t i = 0; i < POINTS; i++) decode(points + 4 * i, values + 4 * i);
    dlclose(library);
    remove(at("use.c"));
    remove(at("use.so"));
}

/* ----------------------------------------------------------------------------- the shaders */

static const char *const zeros[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};

/* "unit3, unit4, [sampler,] q.x, q.y", then what makes four components of it. */
static void print_call(FILE *out, const table *t, const char *sampler) {
    fprintf(out, "4(lacquer_%s(", t->name);
    for (size_t i = 0; i < t->count; i++) fprintf(out, "%sunit%zu", i ? ", " : "", i + 3);
    fputs(sampler, out);
    for (int a = 0; a < t->axis_count; a++) fprintf(out, ", q.%c", "xyzw"[a]);
    fprintf(out, ")%s);\n}\n", zeros[t->channels]);
}

static const char *dimension(const table *t) {
    return in_atlas ? "2D" : t->s->factored ? "2DArray" : t->axis_count > 2 ? "3D" : "2D";
}

static void run_glsl(const table *t, const float *points, float *values) {
    char *text = NULL, *source = text_of("decode.glsl");
    size_t size;
    FILE *out = open_memstream(&text, &size);
    fprintf(
        out,
        "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\nprecision highp sampler3D;\n"
        "precision highp sampler2DArray;\n%s\nuniform sampler2D points;\nout vec4 value;\n",
        source);
    for (size_t i = 0; i < t->count; i++) fprintf(out, "uniform sampler%s unit%zu;\n", dimension(t), i + 3);
    fputs("void main() {\n    vec4 q = texelFetch(points, ivec2(gl_FragCoord.xy), 0);\n    value = vec", out);
    print_call(out, t, "");
    fclose(out);
    render(text, points, values);
    free(source);
    free(text);
}

static void run_hlsl(const table *t, const float *points, float *values) {
    size_t size;
    char command[2000], *source = text_of("decode.hlsl");
    FILE *out = fopen(at("decode.hlsl"), "w");
    fputs(source, out);
    for (size_t i = 0; i < t->count; i++)
        fprintf(out, "Texture%s<float4> unit%zu : register(t%zu);\n", dimension(t), i + 3, i + 3);
    fputs("Texture2D<float4> points : register(t1);\nSamplerState linear_clamp : register(s2);\n"
          "float4 main(float4 at : SV_Position) : SV_Target\n{\n    float4 q = points.Load(int3(at.xy, 0));\n"
          "    return float",
          out);
    print_call(out, t, ", linear_clamp");
    fclose(out);
    snprintf(command, sizeof command,
             "cd %s && glslangValidator -D -V -S frag -e main -o h.spv decode.hlsl >h.log && "
             "spirv-cross --version 300 --es h.spv --output h.glsl >>h.log 2>&1 || { cat h.log >&2; false; }",
             folder);
    assert_int_equal(system(command), 0);
    char *text = read_whole(at("h.glsl"), &size);
    plain_names(text);
    render(text, points, values);
    free(text);
    free(source);
    static const char *const left[] = {"decode.hlsl", "h.spv", "h.log", "h.glsl"};
    for (size_t i = 0; i < 4; i++) remove(at(left[i]));
}

/* ------------------------------------------------------------------------------- comparing */

/* Errors are relative where values are larger than 1. */
static double apart(const table *t, const float *a, const float *b) {
    double worst = 0.0, spread = 0.0;
    for (size_t i = 0; i < POINTS; i++)
        for (int c = 0; c < t->channels; c++) {
            const double x = (double)a[4 * i + (size_t)c], y = (double)b[4 * i + (size_t)c];
            worst = fmax(worst, fabs(x - y) / fmax(1.0, fabs(y)));
            spread = fmax(spread, fabs(y - (double)b[c]));
        }
    assert_true(spread > 0.01); /* the image is not empty */
    return worst;
}

static double from_exact(const table *t, const float *points, const float *values) {
    const lq_shipped *s = t->s;
    const lq_fact *facts = s->factored ? s->factored->facts : s->table->facts;
    const size_t count = s->factored ? s->factored->fact_count : s->table->fact_count;
    lq_error error = {""};
    lq_origin origin;
    lq_curve curve;
    const lq_ndf *ndf;
    double worst = 0.0;
    if (s->relative) {
        assert_int_equal(lq_ndf_open(&ndf, "ggx", &error), LQ_OK);
        assert_int_equal(lq_curve_make(&curve, ndf, &error), LQ_OK);
    } else {
        assert_int_equal(lq_origin_of_facts(facts, count, NULL, &origin, &error), LQ_OK);
    }
    for (size_t i = 0; i < EXACT; i++) {
        double x[LQ_MAX_AXES], exact[LQ_MAX_CHANNELS], estimate;
        memcpy(x, t->fixed, sizeof x);
        for (int a = 0; a < t->axis_count; a++) x[t->from[a]] = (double)points[4 * i + (size_t)a];
        if (s->relative) exact[0] = lq_mapping_value(s->kind, &curve, x[0]);
        else lq_eval(s->kind, &origin.settings, x, exact, &estimate, &error);
        for (int c = 0; c < t->channels; c++)
            worst = fmax(worst,
                         fabs((double)values[4 * i + (size_t)c] - exact[c]) / (s->relative ? exact[c] : 1.0));
    }
    return worst;
}

static void check(const lq_shipped *s) {
    const table t = describe(s);
    float *points = calloc(POINTS, 4 * sizeof *points), *c = calloc(POINTS, 4 * sizeof *c);
    float *values = calloc(POINTS, 4 * sizeof *values);
    char file[128], path[1024];
    place(&t, points);
    run_c(&t, points, c);
    for (size_t i = 0; i < t.count; i++) {
        file_of(&t, i, ".ktx2", file, sizeof file);
        snprintf(path, sizeof path, "%s/%s", shipped, file);
        upload(GL_TEXTURE3 + (GLenum)i, path);
    }
    run_glsl(&t, points, values);
    const double glsl = apart(&t, values, c), exact = from_exact(&t, points, values);
    double hlsl = 0.0;
    if (have("glslangValidator") && have("spirv-cross")) {
        memset(values, 0, POINTS * 4 * sizeof *values);
        run_hlsl(&t, points, values);
        hlsl = apart(&t, values, c);
    } else {
        print_message("HLSL is not tested: glslangValidator and spirv-cross are needed\n");
    }
    print_message("%-22s GLSL %.1e, HLSL %.1e from the C decoder; %.1e from exact values, budget %.1e\n",
                  s->name, glsl, hlsl, exact, s->max);
    /* Where a texel is in a large texture has fewer digits. */
    assert_near(glsl, 0.0, in_atlas ? 3e-5 : 1e-5);
    assert_near(hlsl, 0.0, in_atlas ? 3e-5 : 1e-5);
    assert_near(exact, 0.0, s->max);
    free(points);
    free(values);
    free(c);
}

static void test_shipped(void **state) {
    (void)state;
    lq_error error = {""};
    lq_pack pack;
    char command[1024];
    const bool own = shipped == NULL;
    for (int atlas = 0; atlas < (own ? 2 : 1); atlas++) {
        if (own) make_pack(atlas ? "true" : "false");
        if (lq_pack_read(&pack, shipped, &error) != LQ_OK) fail_msg("%s", error.text);
        in_atlas = pack.atlas.texture.image.data != NULL;
        if (own) assert_int_equal(in_atlas, atlas);
        for (size_t i = 0; i < pack.count; i++) check(&pack.tables[i]);
        lq_pack_free(&pack);
        snprintf(command, sizeof command, "rm -rf %s/pack", folder);
        if (own) assert_int_equal(system(command), 0);
    }
    snprintf(command, sizeof command, "rm -rf %s/*", folder);
    if (own) assert_int_equal(system(command), 0);
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shipped)};
    if (!start_gl()) {
        fputs("no surfaceless EGL with float targets\n", stderr);
        return 77;
    }
    if (argc > 1) shipped = argv[1];
    return cmocka_run_group_tests_name("pack-gl-shipped", tests, make_folder, remove_folder);
}
#endif

/* A software GPU reads the shipped textures through the shipped GLSL and HLSL. Skipped where there is no EGL.
 */
#include "tests/expect.h"
#include "tests/scratch.h"

#include "pack/factored.h"
#include "pack/measure.h"
#include "pack/source.h"
#include "pack/source_text.h"

#include <stdlib.h>
#include <string.h>

#ifndef LACQUER_EGL
int main(void) {
    fputs("built without EGL and GLES\n", stderr);
    return 77;
}
#else

#include "tests/gl.h"

enum { EXACT = 200 };

typedef struct subject {
    const lq_kind *kind;
    lq_table *table;
    lq_texture texture;
    float points[4 * POINTS];
} subject;

static void make(subject *s, const char *id, const char *const *nodes) {
    lq_axis axes[LQ_MAX_AXES];
    lq_settings settings = lq_settings_default();
    lq_error error = {""};
    s->kind = lq_kind_find(id, &error);
    for (int a = 0; a < s->kind->axis_count; a++)
        assert_int_equal(lq_axis_parse(&axes[a], s->kind->axes[a].name, nodes[a], &error), LQ_OK);
    settings.tolerance = 1e-4;
    assert_int_equal(lq_precompute(s->kind, &settings, axes, NULL, &s->table, &error), LQ_OK);
    assert_int_equal(lq_texture_make(&s->texture, s->table, id, &error), LQ_OK);
    for (size_t i = 0; i < POINTS; i++) {
        double point[LQ_MAX_AXES];
        lq_measure_point(s->table->axes, s->kind->axis_count, i, point);
        for (int a = 0; a < 4; a++)
            s->points[4 * i + (size_t)a] = a < s->kind->axis_count ? (float)point[a] : 0;
    }
    for (int a = 0; a < s->kind->axis_count; a++) lq_axis_free(&axes[a]);
    assert_int_equal(lq_image_write(&s->texture.image, LQ_CONTAINER_KTX2, "t", at("t.ktx2"), &error), LQ_OK);
    upload(GL_TEXTURE0, at("t.ktx2"));
}

/* Against the decoder in C at all points, and against the exact integral at some. */
static void compare(const subject *s, const float *values, double budget) {
    const lq_settings settings = lq_settings_default();
    double apart = 0.0, off = 0.0, spread = 0.0;
    for (size_t i = 0; i < POINTS; i++) {
        double point[LQ_MAX_AXES], decoded[4], exact[LQ_MAX_CHANNELS], estimate;
        for (int a = 0; a < s->kind->axis_count; a++) point[a] = (double)s->points[4 * i + (size_t)a];
        lq_texture_sample(&s->texture, point, 0, decoded);
        if (i < EXACT) lq_eval(s->kind, &settings, point, exact, &estimate, NULL);
        for (int c = 0; c < s->texture.channel_count; c++) {
            const double value = (double)values[4 * i + (size_t)c];
            apart = fmax(apart, fabs(value - decoded[c]));
            spread = fmax(spread, fabs(value - (double)values[c]));
            if (i < EXACT) off = fmax(off, fabs(value - exact[c]));
        }
    }
    print_message("%s: %.2e from the C decoder, %.2e from the exact integral\n", s->kind->id, apart, off);
    assert_true(spread > 0.1); /* the image is not empty */
    assert_near(apart, 0.0, 1e-5);
    assert_near(off, 0.0, budget);
}

static const char *const zeros[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};

static void arguments(const subject *s, char *text) {
    text[0] = '\0';
    for (int a = 0; a < s->texture.axis_count; a++)
        sprintf(text + strlen(text), ", q.%c", "xyzw"[s->texture.from[a]]);
}

static void run_glsl(const subject *s, float *values) {
    size_t size;
    lq_error error;
    char call[64], *text = calloc(1, 1 << 16), *source;
    assert_int_equal(lq_source_write(LQ_GLSL, &(lq_source_table){s->kind, &s->texture, NULL}, 1,
                                     at("decode.glsl"), &error),
                     LQ_OK);
    source = read_whole(at("decode.glsl"), &size);
    arguments(s, call);
    sprintf(text,
            "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\nprecision highp "
            "sampler3D;\n%s\n"
            "uniform sampler%dD table;\nuniform sampler2D points;\nout vec4 value;\nvoid main() {\n"
            "    vec4 q = texelFetch(points, ivec2(gl_FragCoord.xy), 0);\n"
            "    value = vec4(lacquer_%s(table%s)%s);\n}\n",
            source, s->texture.axis_count > 2 ? 3 : 2, s->texture.name, call,
            zeros[s->texture.channel_count]);
    render(text, s->points, values);
    free(source);
    free(text);
    remove(at("decode.glsl"));
}

static void run_hlsl(const subject *s, float *values) {
    size_t size;
    lq_error error;
    char call[64], command[2000];
    assert_int_equal(lq_source_write(LQ_HLSL, &(lq_source_table){s->kind, &s->texture, NULL}, 1,
                                     at("decode.hlsl"), &error),
                     LQ_OK);
    FILE *out = fopen(at("decode.hlsl"), "a");
    arguments(s, call);
    fprintf(out,
            "Texture%dD<float4> table : register(t0);\nTexture2D<float4> points : register(t1);\n"
            "SamplerState linear_clamp : register(s2);\nfloat4 main(float4 at : SV_Position) : SV_Target\n{\n"
            "    float4 q = points.Load(int3(at.xy, 0));\n"
            "    return float4(lacquer_%s(table, linear_clamp%s)%s);\n}\n",
            s->texture.axis_count > 2 ? 3 : 2, s->texture.name, call, zeros[s->texture.channel_count]);
    fclose(out);
    snprintf(command, sizeof command,
             "cd %s && glslangValidator -D -V -S frag -e main -o h.spv decode.hlsl >h.log && "
             "spirv-cross --version 300 --es h.spv --output h.glsl >>h.log 2>&1 || { cat h.log >&2; false; }",
             folder);
    assert_int_equal(system(command), 0);
    char *text = read_whole(at("h.glsl"), &size);
    plain_names(text);
    render(text, s->points, values);
    free(text);
    static const char *const left[] = {"decode.hlsl", "h.spv", "h.log", "h.glsl"};
    for (size_t i = 0; i < 4; i++) remove(at(left[i]));
}

static void check(const char *id, const char *const *nodes, double budget) {
    subject *s = calloc(1, sizeof *s);
    float *values = calloc(POINTS, 4 * sizeof *values);
    make(s, id, nodes);
    run_glsl(s, values);
    compare(s, values, budget);
    if (have("glslangValidator") && have("spirv-cross")) {
        memset(values, 0, POINTS * 4 * sizeof *values);
        run_hlsl(s, values);
        compare(s, values, budget);
    } else {
        print_message("HLSL is not tested: glslangValidator and spirv-cross are needed\n");
    }
    remove(at("t.ktx2"));
    lq_table_free(s->table);
    lq_texture_free(&s->texture);
    free(values);
    free(s);
}

static void test_two_channels(void **state) {
    (void)state;
    check("dfg", (const char *const[]){"0:1:48:sqrt", "0:1:48"}, 1e-2);
}

static void test_one_axis(void **state) {
    (void)state;
    check("albedo-average", (const char *const[]){"0:1:32:power1.5"}, 2e-3);
}

static void test_volume(void **state) {
    (void)state;
    check("fgd", (const char *const[]){"0:1:24:sqrt", "0:1:16", "0.2:2:12", "3.9"}, 1e-2);
}

/* ------------------------------------------------------------------ factored tables */

static void upload_array(GLenum unit, const lq_image *image) {
    const size_t count = lq_image_texels(image) * (size_t)image->channels;
    GLuint texture;
    glActiveTexture(unit);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    assert_true(count > 0);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA16F, (int)image->width, (int)image->height,
                 (int)image->layers, 0, GL_RGBA, GL_FLOAT, image->data); /* all exact in half */
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

static char *factored_shader(const lq_factored_textures *textures, const lq_kind *kind) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    fputs("#version 300 es\nprecision highp float;\nprecision highp sampler2D;\n"
          "precision highp sampler2DArray;\n",
          out);
    lq_print_helpers(out, LQ_GLSL);
    lq_factored_source(out, LQ_GLSL, textures, kind);
    fputs("#endif\nuniform sampler2D points;\nout vec4 value;\n", out);
    for (size_t i = 0; i < textures->count; i++) fprintf(out, "uniform sampler2DArray unit%zu;\n", i + 3);
    fprintf(out,
            "void main() {\n    vec4 q = texelFetch(points, ivec2(gl_FragCoord.xy), 0);\n"
            "    value = vec4(lacquer_%s(",
            textures->name);
    for (size_t i = 0; i < textures->count; i++) fprintf(out, "%sunit%zu", i > 0 ? ", " : "", i + 3);
    for (int a = 0; a < textures->factored->axis_count; a++) fprintf(out, ", q.%c", "xyzw"[a]);
    fputs("), 0.0, 0.0, 0.0);\n}\n", out);
    fclose(out);
    return text;
}

static void test_factored(void **state) {
    (void)state;
    const char *const nodes[] = {"0:1:16:sqrt", "0:1:12", "0:2:6", "0:4:6"};
    lq_axis axes[4];
    lq_settings settings = lq_settings_default();
    lq_pca_options options = lq_pca_options_default();
    lq_table *table;
    lq_factored *factored;
    lq_factored_textures textures;
    lq_error error = {""};
    const lq_kind *kind = lq_kind_find("fgd", &error);
    for (int a = 0; a < 4; a++)
        assert_int_equal(lq_axis_parse(&axes[a], kind->axes[a].name, nodes[a], &error), LQ_OK);
    settings.tolerance = 1e-3;
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, &error), LQ_OK);
    options.scheme = LQ_SEQUENTIAL;
    options.separation_count = 2;
    options.separations[0] = (lq_separation){1, {3}, 2};
    options.separations[1] = (lq_separation){1, {2}, 3};
    if (lq_pca(table, 0, &options, NULL, &factored, &error) != LQ_OK) fail_msg("%s", error.text);
    assert_int_equal(lq_factored_layout(&textures, factored, "fgd", &error), LQ_OK);
    float *points = calloc(POINTS, 4 * sizeof *points), *values = calloc(POINTS, 4 * sizeof *values);
    double apart = 0.0, highest = 0.0;
    for (size_t i = 0; i < POINTS; i++) {
        double point[4];
        lq_measure_point(axes, 4, i, point);
        for (int a = 0; a < 4; a++) points[4 * i + (size_t)a] = (float)point[a];
    }
    for (size_t i = 0; i < textures.count; i++)
        upload_array(GL_TEXTURE3 + (GLenum)i, &textures.bases[i].image);
    char *text = factored_shader(&textures, kind);
    render(text, points, values);
    for (size_t i = 0; i < POINTS; i++) {
        double point[4];
        for (int a = 0; a < 4; a++) point[a] = (double)points[4 * i + (size_t)a];
        apart = fmax(apart, fabs((double)values[4 * i] - lq_factored_lookup(factored, point)));
        highest = fmax(highest, (double)values[4 * i]);
    }
    print_message("factored fgd: %.2e from the C decoder\n", apart);
    assert_near(apart, 0.0, 1e-5);
    assert_true(highest > 0.5);
    for (int a = 0; a < 4; a++) lq_axis_free(&axes[a]);
    lq_factored_textures_free(&textures);
    lq_factored_free(factored);
    lq_table_free(table);
    free(points);
    free(values);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_two_channels), cmocka_unit_test(test_one_axis),
                                       cmocka_unit_test(test_volume), cmocka_unit_test(test_factored)};
    if (!start_gl()) {
        fputs("no surfaceless EGL with float targets\n", stderr);
        return 77;
    }
    return cmocka_run_group_tests_name("pack-gl", tests, make_folder, remove_folder);
}
#endif

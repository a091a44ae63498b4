/* A software GPU for tests: surfaceless EGL, KTX2 files through their headers, a shader run over many points.
 */
#ifndef LACQUER_TESTS_GL_H
#define LACQUER_TESTS_GL_H

#include "tests/expect.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 100, POINTS = SIDE * SIDE };

static const char vertex[] = "#version 300 es\nvoid main() {\n"
                             "    vec2 at[3] = vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3));\n"
                             "    gl_Position = vec4(at[gl_VertexID], 0, 1);\n}\n";

static inline bool start_gl(void) {
    PFNEGLGETPLATFORMDISPLAYEXTPROC get =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLDisplay display = get ? get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL) : EGL_NO_DISPLAY;
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    if (!display || !eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_ES_API)) return false;
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    return context && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) &&
           strstr((const char *)glGetString(GL_EXTENSIONS), "GL_EXT_color_buffer_float");
}

static inline char *read_whole(const char *path, size_t *size) {
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    char *bytes = calloc(1, 1 << 20);
    *size = fread(bytes, 1, (1 << 20) - 1, in);
    fclose(in);
    return bytes;
}

static inline GLuint compile(GLenum type, const char *text) {
    GLuint shader = glCreateShader(type);
    GLint fine = 0;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &fine);
    if (!fine) {
        char log[2000];
        glGetShaderInfoLog(shader, sizeof log, NULL, log);
        fprintf(stderr, "%s\n%s\n", text, log);
    }
    assert_true(fine);
    return shader;
}

/* Upload what a KTX2 file holds, found through its header alone. */
static inline void upload(GLenum unit, const char *path) {
    static const struct {
        uint32_t vulkan;
        GLint internal;
        GLenum format;
    } formats[] = {{76, GL_R16F, GL_RED}, {83, GL_RG16F, GL_RG}, {97, GL_RGBA16F, GL_RGBA}};
    size_t size;
    char *file = read_whole(path, &size);
    uint32_t head[9];
    uint64_t level[3];
    memcpy(head, file + 12, sizeof head);
    memcpy(level, file + 80, sizeof level);
    assert_true(level[0] + level[1] == size);
    const GLenum target = head[5] > 0 ? GL_TEXTURE_2D_ARRAY : head[4] > 0 ? GL_TEXTURE_3D : GL_TEXTURE_2D;
    const GLsizei deep = (GLsizei)(head[5] > 0 ? head[5] : head[4]);
    GLuint texture;
    int f = 0;
    while (formats[f].vulkan != head[0]) assert_true(++f < 3);
    glActiveTexture(unit);
    glGenTextures(1, &texture);
    glBindTexture(target, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (target == GL_TEXTURE_2D)
        glTexImage2D(target, 0, formats[f].internal, (int)head[2], (int)head[3], 0, formats[f].format,
                     GL_HALF_FLOAT, file + level[0]);
    else
        glTexImage3D(target, 0, formats[f].internal, (int)head[2], (int)head[3], deep, 0, formats[f].format,
                     GL_HALF_FLOAT, file + level[0]);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    free(file);
}

static inline GLuint float_texture(GLenum unit, const float *data) {
    GLuint texture;
    glActiveTexture(unit);
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, SIDE, SIDE, 0, GL_RGBA, GL_FLOAT, data);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

/* Run a fragment shader over all points. Its samplers have "table" and "points" in their names. */
static inline void render(const char *fragment, const float *points, float *values) {
    GLuint program = glCreateProgram(), frame, target;
    GLint linked, uniforms;
    glAttachShader(program, compile(GL_VERTEX_SHADER, vertex));
    glAttachShader(program, compile(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    assert_true(linked);
    glUseProgram(program);
    glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &uniforms);
    for (GLuint i = 0; i < (GLuint)uniforms; i++) {
        char name[128];
        GLint size;
        GLenum type;
        glGetActiveUniform(program, i, sizeof name, NULL, &size, &type, name);
        /* unit3: that unit */
        const int unit = strstr(name, "points") ? 1 : strncmp(name, "unit", 4) == 0 ? atoi(name + 4) : 0;
        glUniform1i(glGetUniformLocation(program, name), unit);
    }
    float_texture(GL_TEXTURE1, points);
    target = float_texture(GL_TEXTURE2, NULL);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glViewport(0, 0, SIDE, SIDE);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, values);
    assert_int_equal(glGetError(), GL_NO_ERROR);
}

/* ---------------------------------------------------------------- shaders through other tools */

static inline bool have(const char *tool) {
    char command[64];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", tool);
    return system(command) == 0;
}

/* spirv-cross names a texture with its sampler "SPIRV_Cross_Combinedunit3linear_clamp": let it start with
 * unit3. */
static inline void plain_names(char *text) {
    static const char before[] = "SPIRV_Cross_Combinedunit";
    for (char *name; (name = strstr(text, before));)
        memmove(name, name + sizeof before - 5, strlen(name + sizeof before - 5) + 1);
    /* What it leaves at the medium precision of ES is a choice of the engine: highp, here. */
    for (char *p; (p = strstr(text, "mediump"));) memcpy(p, "highp  ", 7);
}

#endif

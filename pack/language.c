/* language.c - what shading languages call the same things. */
#include "pack/language.h"

#include "system/number.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

typedef struct words {
    const char *file, *f, *storage;
    const char *types[5]; /* of 0: a truth value */
    const char *lobes, *make[5];
    const char *atlas, *arguments;
    bool types_after; /* "fn f(x: f32) -> f32", "let x = " */
    const char *mix;
} words;

static const words all[LQ_LANGUAGES] = {
    [LQ_GLSL] = {"decode.glsl",
                 "",
                 "",
                 {"bool", "float", "vec2", "vec3", "vec4"},
                 "LacquerLobes",
                 {"", "float", "vec2", "vec3", "vec4"},
                 "sampler2D atlas",
                 "atlas",
                 false,
                 "mix"},
    [LQ_HLSL] = {"decode.hlsl",
                 "",
                 "",
                 {"bool", "float", "float2", "float3", "float4"},
                 "LacquerLobes",
                 {"", "float", "float2", "float3", "float4"},
                 "Texture2D<float4> atlas, SamplerState linear_clamp",
                 "atlas, linear_clamp",
                 false,
                 "lerp"},
    [LQ_C] = {"decode.h",
              "f",
              "static inline ",
              {"int", "float", "lacquer_vec2", "lacquer_vec3", "lacquer_vec4"},
              "lacquer_lobes",
              {"", "", "lacquer_make2", "lacquer_make3", "lacquer_make4"},
              "const float *atlas",
              "atlas",
              false,
              "lacquer_mix"},
    [LQ_VULKAN] = {"decode.vulkan.glsl",
                   "",
                   "",
                   {"bool", "float", "vec2", "vec3", "vec4"},
                   "LacquerLobes",
                   {"", "float", "vec2", "vec3", "vec4"},
                   "texture2D atlas, sampler linear_clamp",
                   "atlas, linear_clamp",
                   false,
                   "mix"},
    [LQ_WGSL] = {"decode.wgsl",
                 "",
                 "",
                 {"bool", "f32", "vec2f", "vec3f", "vec4f"},
                 "LacquerLobes",
                 {"", "f32", "vec2f", "vec3f", "vec4f"},
                 "atlas: texture_2d<f32>, linear_clamp: sampler",
                 "atlas, linear_clamp",
                 true,
                 "mix"},
    [LQ_METAL] = {"decode.metal",
                  "f",
                  "static inline ",
                  {"bool", "float", "metal::float2", "metal::float3", "metal::float4"},
                  "LacquerLobes",
                  {"", "float", "metal::float2", "metal::float3", "metal::float4"},
                  "metal::texture2d<float> atlas, metal::sampler linear_clamp",
                  "atlas, linear_clamp",
                  false,
                  "metal::mix"},
};

const char *lq_language_file(lq_language language) {
    return all[language].file;
}

static const char *type_of(const words *w, char c) {
    return c == 'L' ? w->lobes : c == 'B' ? w->types[0] : w->types[c - '0'];
}

/* The function `name`, `length` characters, as the language has it. */
static void put_function(FILE *out, lq_language language, const char *name, size_t length) {
    const words *w = &all[language];
    if (length == 3 && strncmp(name, "mix", 3) == 0) fputs(w->mix, out);
    else if (language == LQ_C && length == 5 && strncmp(name, "clamp", 5) == 0) fputs("lacquer_clamp", out);
    else if (language == LQ_C && length == 3 && strncmp(name, "m", 1) == 0) fprintf(out, "f%.3sf", name);
    else if (language == LQ_C) fprintf(out, "%.*sf", (int)length, name);
    else fprintf(out, "%s%.*s", language == LQ_METAL ? "metal::" : "", (int)length, name);
}

/* One argument, "1 x" or "A"; its length. */
static size_t put_argument(FILE *out, const words *w, const char *text) {
    const size_t length = strcspn(text, "|$");
    if (*text == 'A') fputs(w->atlas, out);
    else if (w->types_after) fprintf(out, "%.*s: %s", (int)length - 2, text + 2, type_of(w, *text));
    else fprintf(out, "%s %.*s", type_of(w, *text), (int)length - 2, text + 2);
    return length;
}

/* "1 name|A|1 x$)"; what follows it. */
static const char *put_head(FILE *out, const words *w, const char *text) {
    const char type = *text;
    const char *name = text + 2;
    const size_t length = strcspn(name, "|$");
    if (w->types_after) fprintf(out, "fn %.*s(", (int)length, name);
    else fprintf(out, "%s%s %.*s(", w->storage, type_of(w, type), (int)length, name);
    text = name + length;
    for (bool first = true; *text == '|'; first = false) {
        fputs(first ? "" : ", ", out);
        text += 1 + put_argument(out, w, text + 1);
    }
    if (w->types_after) fprintf(out, ") -> %s", type_of(w, type));
    else fputc(')', out);
    return text + 2;
}

static const char *put_token(FILE *out, lq_language language, const char *at) {
    const words *w = &all[language];
    switch (*at) {
    case '(':
        return put_head(out, w, at + 1);
    case 'a':
        fputs(w->arguments, out);
        return at + 1;
    case 'f':
        fputs(w->f, out);
        return at + 1;
    case 'c':
        fputs(w->make[at[1] - '0'], out);
        return at + 2;
    case '=':
        fputs(w->types_after ? "let" : type_of(w, at[1]), out);
        return at + 2;
    case '~':
        if (!w->types_after) fputs(type_of(w, at[1]), out);
        else {
            const size_t length = strcspn(at + 3, " ;");
            fprintf(out, "var %.*s: %s", (int)length, at + 3, type_of(w, at[1]));
            return at + 3 + length;
        }
        return at + 2;
    default:
        fputs(type_of(w, *at), out);
        return at + 1;
    }
}

static void expand(FILE *out, lq_language language, const char *text) {
    while (*text) {
        const size_t plain = strcspn(text, "$@");
        fwrite(text, 1, plain, out);
        text += plain;
        if (*text == '$') text = put_token(out, language, text + 1);
        else if (*text == '@') {
            const size_t length = strcspn(text + 1, "(");
            put_function(out, language, text + 1, length);
            text += 1 + length;
        }
    }
}

void lq_say(FILE *out, lq_language language, const char *format, ...) {
    char text[LQ_SAY_SIZE];
    va_list arguments;
    va_start(arguments, format);
    lq_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    expand(out, language, text);
}

const char *lq_literal(double value, lq_language language, char text[LQ_LITERAL_SIZE]) {
    for (int digits = 6; digits <= 9; digits++) {
        lq_print(text, LQ_LITERAL_SIZE - 4, "%.*g", digits, value);
        if (lq_strtof(text, NULL) == (float)value) break;
    }
    if (!strpbrk(text, ".e")) strcat(text, ".0");
    return strcat(text, all[language].f);
}

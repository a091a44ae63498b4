/* f and its inverse as source: GLSL, HLSL or C, by the ending of the file. */
#include "program/fit/fit.h"
#include "program/message.h"
#include "system/output.h"

#include <stdio.h>
#include <string.h>

typedef struct snippet {
    const char *forward, *inverse; /* bodies, with REAL numbers A to E */
} snippet;

static const snippet bodies[LQ_FAMILIES] = {
    [LQ_FAMILY_RATIONAL] = {"float t = pow(x, B);\n    return A * t / (1.0 - t);",
                            "return pow(y / (A + y), 1.0 / B);"},
    [LQ_FAMILY_EXPONENTIAL] = {"float t = pow((1.0 + E) * x / (sqrt(x) + E), D);\n"
                               "    float z = B * pow(t / (1.0 - t), C);\n"
                               "    float m = z < 0.01 ? z * (1.0 + 0.5 * z + z * z / 6.0) : exp(z) - 1.0;\n"
                               "    return A * pow(m, 2.0 / (C * D));",
                               "float q = pow(y / A, 0.5 * C * D);\n"
                               "    float l = q < 0.01 ? q * (1.0 - 0.5 * q + q * q / 3.0) : log(1.0 + q);\n"
                               "    float w = pow(l / B, 1.0 / C);\n"
                               "    float u = pow(w / (1.0 + w), 1.0 / D) / (1.0 + E);\n"
                               "    float s = 0.5 * (u + sqrt(u * u + 4.0 * E * u));\n"
                               "    return s * s;"},
    [LQ_FAMILY_PHASE] = {"return A * pow((1.0 - x) / x, B) / (1.0 + C * x);", NULL},
    [LQ_FAMILY_PHASE_EXPONENTIAL] =
        {"float h = 1.0 - x;\n"
         "    float t = pow((1.0 + E) * h / (1.0 + E * h), D);\n"
         "    float z = B * pow(t / (1.0 - t), C);\n"
         "    float m = z < 0.01 ? z * (1.0 + 0.5 * z + z * z / 6.0) : exp(z) - 1.0;\n"
         "    return A * pow(m, 1.0 / (C * D));",
         "float q = pow(y / A, C * D);\n"
         "    float l = q < 0.01 ? q * (1.0 - 0.5 * q + q * q / 3.0) : log(1.0 + q);\n"
         "    float w = pow(l / B, 1.0 / C);\n"
         "    float u = pow(w / (1.0 + w), 1.0 / D);\n"
         "    return 1.0 - u / (1.0 + E - E * u);"},
    [LQ_FAMILY_POWER] = {"return A * pow(x, -B);", "return pow(A / y, 1.0 / B);"},
    [LQ_FAMILY_TAIL] = {"return A + B * pow(pow(x, -C) - 1.0, D);",
                        "return pow(1.0 + pow((y - A) / B, 1.0 / D), -1.0 / C);"},
    [LQ_FAMILY_SLOPE] = {"return x * A * abs(1.0 - B * eta12 * mu_i / mu_t);",
                         "return y / (A * abs(1.0 - B * eta12 * mu_i / mu_t));"},
    [LQ_FAMILY_POWERS] =
        {"float m = min(mu_i, mu_t);\n"
         "    return A * pow(abs(1.0 - eta12), B) * pow(m, C) * pow(x, 1.0 - D - E * (1.0 - m));",
         "float m = min(mu_i, mu_t);\n"
         "    return pow(y / (A * pow(abs(1.0 - eta12), B) * pow(m, C)), "
         "1.0 / (1.0 - D - E * (1.0 - m)));"},
};

static bool ends(const char *path, const char *ending) {
    const size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcmp(path + length - tail, ending) == 0;
}

static void substitute(char *out, size_t size, const char *body, const fit_job *job, bool c) {
    out[0] = '\0';
    for (const char *at = body; *at && strlen(out) + 40 < size; at++) {
        char *end = out + strlen(out);
        const size_t left = size - strlen(out);
        const int k = *at - 'A';
        if (k >= 0 && k < LQ_FAMILY_PARAMETERS)
            snprintf(end, left, "(%.9e%s)", job->answer.p[k], c ? "f" : "");
        else snprintf(end, left, "%c", *at);
    }
}

/* C: the functions of tgmath.h are those of the shading languages, but for two names. */
static const char c_head[] =
    "#include <math.h>\n#include <tgmath.h>\n#define abs fabsf\n#define min fminf\n\n";

bool fit_write_snippet(const fit_job *job) {
    const char *path = job->request.snippet;
    const lq_family *family = lq_family_at(job->request.family);
    const snippet *body = &bodies[job->request.family];
    const bool c = ends(path, ".h") || ends(path, ".c");
    const char *name = lq_mapping_name(job->request.mapping);
    const char *extra = family->coordinates > 1 ? ", float eta12, float mu_i, float mu_t" : "";
    const char *qualifier = c ? "static inline " : "";
    char forward[2048], inverse[2048];
    substitute(forward, sizeof forward, body->forward, job, c);
    substitute(inverse, sizeof inverse, body->inverse ? body->inverse : "", job, c);
    lq_error error = {""};
    lq_output *output = NULL;
    lq_status status = lq_output_open(&output, path, &error);
    if (status == LQ_OK)
        status =
            lq_output_print(output, &error,
                            "// lacquer %s: %s of NDF %s, family %s\n// %s\n// relative error on [%g, %g]: "
                            "rms %.2g, max %.2g\n%s%sfloat lacquer_fitted_%s(float x%s) {\n    %s\n}\n",
                            LQ_VERSION, name, lq_ndf_text(job->ndf), family->name, family->formula,
                            job->request.low, job->request.high, job->errors.rms, job->errors.max,
                            c ? c_head : "", qualifier, name, extra, forward);
    if (status == LQ_OK && body->inverse)
        status =
            lq_output_print(output, &error, "\n%sfloat lacquer_fitted_%s_inverse(float y%s) {\n    %s\n}\n",
                            qualifier, name, extra, inverse);
    if (status == LQ_OK) status = lq_output_commit(output, &error);
    else lq_output_abandon(output);
    return status == LQ_OK || (cli_fail_status(status, &error), false);
}

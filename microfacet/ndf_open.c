/* From what --ndf takes to an NDF: the list of families, and the reading of their parameters. */
#include "microfacet/gtr.h"
#include "microfacet/ndf.h"
#include "microfacet/ndf_file.h"
#include "microfacet/student_t.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct family {
    const char *id, *syntax, *title;
    /* `text` is what follows "id:", or NULL. */
    lq_status (*open)(const lq_ndf **ndf, const struct family *of, const char *text, lq_error *error);
} family;

/* The one parameter `gamma=NUMBER`. */
static lq_status read_gamma(const family *of, const char *text, double *gamma, lq_error *error) {
    static const char name[] = "gamma=";
    char *end = NULL;
    if (text && strncmp(text, name, sizeof name - 1) == 0) *gamma = lq_strtod(text + sizeof name - 1, &end);
    if (end && end > text + sizeof name - 1 && *end == '\0') return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "NDF '%s%s%s' is not read; write %s", of->id, text ? ":" : "",
                   text ? text : "", of->syntax);
}

static lq_status open_closed(const lq_ndf **ndf, const family *of, const char *text, lq_error *error) {
    if (text) return lq_fail(error, LQ_BAD_INPUT, "NDF %s takes no parameters, not '%s'", of->id, text);
    *ndf = lq_ndf_find(of->id);
    return LQ_OK;
}

static lq_status open_gtr(const lq_ndf **ndf, const family *of, const char *text, lq_error *error) {
    double gamma = 0.0;
    const lq_status status = read_gamma(of, text, &gamma, error);
    return status == LQ_OK ? lq_gtr_open(ndf, gamma, error) : status;
}

static lq_status open_student_t(const lq_ndf **ndf, const family *of, const char *text, lq_error *error) {
    double gamma = 0.0;
    const lq_status status = read_gamma(of, text, &gamma, error);
    return status == LQ_OK ? lq_student_t_open(ndf, gamma, error) : status;
}

static lq_status open_file(const lq_ndf **ndf, const family *of, const char *text, lq_error *error) {
    (void)of;
    return lq_ndf_file_open(ndf, text, error);
}

static lq_status open_plugin(const lq_ndf **ndf, const family *of, const char *text, lq_error *error) {
    (void)of;
    return lq_ndf_plugin_open(ndf, text, error);
}

static const family families[] = {
    {"ggx", "ggx", "GGX (Trowbridge-Reitz): alpha is the slope scale itself", open_closed},
    {"beckmann", "beckmann", "normally distributed slopes: alpha is sqrt(2) times their rms", open_closed},
    {"gtr", "gtr:gamma=G", "generalised Trowbridge-Reitz (Burley 2012), G in [1, 10]; 2 is GGX", open_gtr},
    {"student-t", "student-t:gamma=G",
     "Student-t slopes (Ribardiere et al. 2017), G in [2, 100]; 2 is GGX, large G Beckmann", open_student_t},
    {"file", "file:PATH", "samples of D in a CSV: theta_deg,D or, for a family, theta_deg,alpha=0.1,...",
     open_file},
    {"plugin", "plugin:PATH.so", "D compiled from C, see lq_ndf_plugin in lacquer.h", open_plugin},
};

enum { FAMILIES = sizeof families / sizeof families[0] };

size_t lq_ndf_count(void) {
    return FAMILIES;
}

const char *lq_ndf_id(size_t i) {
    return i < FAMILIES ? families[i].id : NULL;
}

const char *lq_ndf_syntax(size_t i) {
    return i < FAMILIES ? families[i].syntax : NULL;
}

const char *lq_ndf_title(size_t i) {
    return i < FAMILIES ? families[i].title : NULL;
}

lq_status lq_ndf_open(const lq_ndf **ndf, const char *text, lq_error *error) {
    const char *colon = strchr(text, ':');
    const size_t length = colon ? (size_t)(colon - text) : strlen(text);
    char known[LQ_MESSAGE_SIZE / 2] = "";
    *ndf = NULL;
    for (size_t i = 0, used = 0; i < FAMILIES; i++) {
        const family *f = &families[i];
        if (strlen(f->id) == length && strncmp(f->id, text, length) == 0)
            return f->open(ndf, f, colon ? colon + 1 : NULL, error);
        if (used < sizeof known)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", f->syntax);
    }
    return lq_fail(error, LQ_BAD_INPUT, "unknown NDF '%s'; known: %s", text, known);
}

/* The end of FAMILY:PATH in FAMILY:PATH#HASH. */
static size_t before_hash(const char *text) {
    const char *mark = strrchr(text, '#');
    return mark ? (size_t)(mark - text) : strlen(text);
}

static bool same_path(const char *a, const char *b) {
    const size_t length = before_hash(a);
    return length == before_hash(b) && strncmp(a, b, length) == 0;
}

static bool same_hash(const char *a, const char *b) {
    const char *x = strrchr(a, '#'), *y = strrchr(b, '#');
    return x && y && strcmp(x, y) == 0 && strcspn(a, ":") == strcspn(b, ":") &&
           strncmp(a, b, strcspn(a, ":")) == 0;
}

/* Only the families of closed form open nothing; one that is added later is not trusted by oversight. A
 * family that is not known opens nothing either: opening it says which are. */
static bool needs_no_file(const char *text) {
    const size_t length = strcspn(text, ":");
    for (size_t i = 0; i < FAMILIES; i++) {
        const family *f = &families[i];
        if (strlen(f->id) == length && strncmp(f->id, text, length) == 0)
            return f->open == open_closed || f->open == open_gtr || f->open == open_student_t;
    }
    return true;
}

lq_status lq_ndf_trusted(const char *text, const lq_trust *trust, const char **ndf, lq_error *error) {
    const char *named = trust ? trust->ndf : NULL;
    const bool plugin = strncmp(text, "plugin:", 7) == 0;
    *ndf = text;
    if (needs_no_file(text) || (named && same_path(text, named))) return LQ_OK;
    if (plugin && trust && trust->plugins) return LQ_OK;
    if (named && same_hash(text, named)) {
        *ndf = named;
        return LQ_OK;
    }
    *ndf = NULL;
    return lq_fail(error, LQ_BAD_INPUT,
                   "the recorded NDF '%.200s' is not opened unless you name it; accepted: --ndf %.*s%s", text,
                   (int)(before_hash(text) < 150 ? before_hash(text) : 150), text,
                   plugin ? ", or --allow-plugin if you trust its code" : "");
}

void lq_ndf_close(const lq_ndf *ndf) {
    if (ndf && ndf->release) ndf->release((lq_ndf *)ndf);
}

const char *lq_ndf_text(const lq_ndf *ndf) {
    return ndf->id;
}

const char *lq_ndf_note(const lq_ndf *ndf) {
    return ndf->note;
}

void lq_ndf_range(const lq_ndf *ndf, double *alpha_min, double *alpha_max) {
    *alpha_min = ndf->alpha_min;
    *alpha_max = ndf->alpha_max > 0.0 ? ndf->alpha_max : 1.0;
}

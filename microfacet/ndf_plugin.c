/* NDFs compiled by their user: a shared object that exports one function (lacquer.h, "Plugins"). */
#define _GNU_SOURCE /* memfd_create */
#include "microfacet/ndf_file.h"
#include "microfacet/profile.h"
#include "system/number.h"
#include "system/status.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

typedef struct loaded {
    lq_profiled profiled;
    const lq_ndf_plugin *plugin;
    void *object;
    int file; /* that it was loaded from */
    lq_ndf_path path;
    char note[LQ_MESSAGE_SIZE];
} loaded;

static void shape(const lq_profiled *of, double alpha, size_t count, const double *cos2, const double *sin2,
                  double *d) {
    const loaded *l = of->ndf.parameters;
    l->plugin->density(alpha, count, cos2, sin2, d);
}

/* What was hashed, in a file of this process's own that nobody can write: the one at the path may be another
 * by now. -1: not to be had. */
static int private_copy(const lq_ndf_path *path) {
    enum { SEALS = F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE };
    const int file = memfd_create("lacquer-plugin", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    size_t done = 0;
    for (ssize_t wrote = 1; file >= 0 && wrote > 0 && done<path->size; done += wrote> 0 ? (size_t)wrote : 0)
        wrote = write(file, path->bytes + done, path->size - done);
    if (file < 0 || (done == path->size && fcntl(file, F_ADD_SEALS, SEALS) == 0)) return file;
    close(file);
    return -1;
}

/* The loader knows a library by its name, which is the number of the open file: that stays open as long as
 * the library is there, or another one would be taken for it. */
static lq_status load(loaded *l, lq_error *error) {
    char name[64];
    l->file = private_copy(&l->path);
    if (l->file < 0) return lq_fail(error, LQ_IO, "%s is not loaded: no memory file: %m", l->path.path);
    snprintf(name, sizeof name, "/proc/self/fd/%d", l->file);
    l->object = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (l->object) return LQ_OK;
    const char *cause = dlerror(),
               *colon = strncmp(cause, name, strlen(name)) == 0 ? strstr(cause, ": ") : NULL;
    return lq_fail(error, LQ_FORMAT, "%s is not loaded: %s", l->path.path, colon ? colon + 2 : cause);
}

/* Some libraries stay loaded: those keep their file. */
static void unload(loaded *l) {
    char name[64];
    snprintf(name, sizeof name, "/proc/self/fd/%d", l->file);
    if (l->object) dlclose(l->object);
    void *kept = l->object ? dlopen(name, RTLD_LAZY | RTLD_NOLOAD) : NULL;
    if (kept) dlclose(kept);
    else if (l->file >= 0) close(l->file);
}

static void release(lq_ndf *ndf) {
    loaded *l = (loaded *)ndf->parameters;
    lq_profiled_free(&l->profiled);
    unload(l);
    lq_ndf_path_free(&l->path);
    free(l);
}

static lq_status find(loaded *l, lq_error *error) {
    const char *path = l->path.path;
    const lq_ndf_plugin *(*describe)(void) = NULL;
    const lq_status status = load(l, error);
    if (status != LQ_OK) return status;
    void *symbol = dlsym(l->object, "lacquer_ndf_plugin");
    if (!symbol)
        return lq_fail(error, LQ_FORMAT, "%s is no NDF plugin: it lacks the function lacquer_ndf_plugin",
                       path);
    memcpy(&describe, &symbol, sizeof describe); /* ISO C has no cast from object to function pointers */
    l->plugin = describe();
    if (!l->plugin) return lq_fail(error, LQ_FORMAT, "%s: lacquer_ndf_plugin returns NULL", path);
    return LQ_OK;
}

static lq_status check(const loaded *l, lq_error *error) {
    const lq_ndf_plugin *p = l->plugin;
    const char *path = l->path.path;
    if (p->version != LQ_NDF_PLUGIN_VERSION)
        return lq_fail(error, LQ_FORMAT, "%s is an NDF plugin of version %u; accepted: %d", path, p->version,
                       LQ_NDF_PLUGIN_VERSION);
    if (p->struct_size != sizeof *p)
        return lq_fail(error, LQ_FORMAT,
                       "%s: its lq_ndf_plugin has %zu bytes, not %zu; set struct_size to sizeof", path,
                       p->struct_size, sizeof *p);
    if (!p->density) return lq_fail(error, LQ_FORMAT, "%s lacks the function density", path);
    if (!(p->alpha_min >= 0.0 && p->alpha_max > 0.0 && p->alpha_min <= p->alpha_max && p->alpha_max <= 1.0))
        return lq_fail(error, LQ_FORMAT, "%s: alpha from %g to %g is not a range in [0, 1]", path,
                       p->alpha_min, p->alpha_max);
    return LQ_OK;
}

/* D is asked once where it is widest: what is wrong everywhere shows there. */
static lq_status start(loaded *l, lq_error *error) {
    const lq_ndf_plugin *p = l->plugin;
    l->profiled.shape = shape;
    l->profiled.ndf = (lq_ndf){.id = l->path.id,
                               .title = p->title ? p->title : "plugin",
                               .source = p->source ? p->source : l->path.path,
                               .parameters = l,
                               .density = lq_profiled_density,
                               .area_below = lq_profiled_area_below,
                               .areas_below = lq_profiled_areas_below,
                               .slope_quantile = lq_profiled_quantile,
                               .prepare = lq_profiled_prepare,
                               .release = release,
                               .alpha_min = p->alpha_min,
                               .alpha_max = p->alpha_max,
                               .pieces = true,
                               .note = l->note};
    const lq_status status = lq_ndf_prepare(&l->profiled.ndf, p->alpha_max, error);
    if (status != LQ_OK) return status;
    const lq_profile *widest = lq_profiled_at(&l->profiled, p->alpha_max);
    lq_print(l->note, sizeof l->note, "%s: %s; D scaled by %.6g at alpha = %g", l->path.path,
             l->profiled.ndf.title, widest->factor, p->alpha_max);
    for (char *c = l->note; *c; c++)
        if ((unsigned char)*c < ' ') *c = ' ';
    return LQ_OK;
}

lq_status lq_ndf_plugin_open(const lq_ndf **ndf, const char *text, lq_error *error) {
    loaded *l = calloc(1, sizeof *l);
    if (!l) return lq_fail(error, LQ_NO_MEMORY, "no memory for an NDF");
    l->profiled.ndf.parameters = l;
    l->file = -1;
    lq_status status = lq_ndf_path_make(&l->path, "plugin", text, error);
    if (status == LQ_OK) status = find(l, error);
    if (status == LQ_OK) status = check(l, error);
    if (status == LQ_OK) status = start(l, error);
    if (status == LQ_OK) *ndf = &l->profiled.ndf;
    else {
        l->profiled.ndf.parameters = l;
        release(&l->profiled.ndf);
    }
    return status;
}

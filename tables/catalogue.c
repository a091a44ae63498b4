/* The catalogue of table kinds: what each is, its axes and where it comes from. */
#include "lacquer.h"

#include "tables/status.h"

#include <stdio.h>
#include <string.h>

#define MU_AXIS                                                                                              \
    { "mu", "cosine of incidence", 0.0, 1.0, 0.0, 1.0, 64, LQ_MAP_LINEAR }
#define ALPHA_AXIS                                                                                           \
    { "alpha", "roughness, the GGX slope scale", 0.0, 1.0, 0.0, 1.0, 64, LQ_MAP_LINEAR }

static const lq_kind kinds[] = {
    {
        .id = "fgd",
        .title = "directional albedo of a rough conductor, all orders of scattering or the first",
        .quantity = "reflected flux / incident flux; single: integral F D_omega G dm",
        .source = "B18 eq. 2 and sec. 4.1; H16",
        .axis_count = 4,
        .axes = {MU_AXIS,
                 ALPHA_AXIS,
                 {"n", "real part of the index relative to above", 0.0, 100.0, 0.0, 4.0, 64, LQ_MAP_LINEAR},
                 {"kappa", "imaginary part of the index", 0.0, 100.0, 0.0, 4.0, 64, LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"fgd"},
        .takes = LQ_TAKES_SCATTERING | LQ_TAKES_MASKING,
        .tolerance = 1e-5,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "albedo",
        .title = "directional albedo of the bare microsurface: F = 1, first bounce",
        .quantity = "E = integral D_omega G dm",
        .source = "B18 eq. 2 with F = 1",
        .axis_count = 2,
        .axes = {MU_AXIS, ALPHA_AXIS},
        .channel_count = 1,
        .channels = {"albedo"},
        .takes = LQ_TAKES_MASKING,
        .tolerance = 1e-6,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "albedo-average",
        .title = "cosine-weighted mean of albedo",
        .quantity = "2 integral E(mu) mu dmu",
        .source = "Kulla & Conty 2017; B18 eq. 2",
        .axis_count = 1,
        .axes = {ALPHA_AXIS},
        .channel_count = 1,
        .channels = {"average"},
        .takes = LQ_TAKES_MASKING,
        .tolerance = 1e-6,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "dfg",
        .title = "split sum for Schlick's Fresnel: FGD = F0 A + F90 B, first bounce",
        .quantity = "A = integral (1 - (1-c)^5) D_omega G dm, B = integral (1-c)^5 D_omega G dm",
        .source = "Karis 2013; Lazarov 2013; Schlick 1994",
        .axis_count = 2,
        .axes = {MU_AXIS, ALPHA_AXIS},
        .channel_count = 2,
        .channels = {"A", "B"},
        .takes = LQ_TAKES_MASKING,
        .tolerance = 1e-6,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
};

size_t lq_kind_count(void) {
    return sizeof kinds / sizeof kinds[0];
}

const lq_kind *lq_kind_at(size_t i) {
    return i < lq_kind_count() ? &kinds[i] : NULL;
}

const lq_kind *lq_kind_find(const char *id, lq_error *error) {
    char known[256] = "";
    for (size_t i = 0, used = 0; i < lq_kind_count(); i++) {
        if (strcmp(kinds[i].id, id) == 0) return &kinds[i];
        if (used < sizeof known)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", kinds[i].id);
    }
    lq_fail(error, LQ_BAD_INPUT, "unknown table '%s'; known: %s", id, known);
    return NULL;
}

lq_status lq_kind_axes(const lq_kind *kind, lq_axis *axes, lq_error *error) {
    for (int a = 0; a < kind->axis_count; a++) {
        const lq_axis_info *info = &kind->axes[a];
        const lq_status status =
            lq_axis_make(&axes[a], info->name, info->min, info->max, info->size, info->map, 0.0, error);
        if (status != LQ_OK) {
            while (a-- > 0) lq_axis_free(&axes[a]);
            return status;
        }
    }
    return LQ_OK;
}

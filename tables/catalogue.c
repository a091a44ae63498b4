/* The catalogue of table kinds: what each is, its axes and where it comes from. */
#include "lacquer.h"

#include "system/status.h"

#include <stdio.h>
#include <string.h>

#define MU_AXIS                                                                                              \
    { "mu", "cosine of incidence", 0.0, 1.0, 0.0, 1.0, 64, LQ_MAP_LINEAR }
/* Two-sided scattering: precompute/dielectric.h says why. */
#define MU_AXIS_TWO_SIDED                                                                                    \
    { "mu", "cosine of incidence; below 1e-6 it is taken for 1e-6", 0.0, 1.0, 0.0, 1.0, 64, LQ_MAP_LINEAR }
#define ALPHA_AXIS                                                                                           \
    { "alpha", "roughness, the slope scale of the NDF", 0.0, 1.0, 0.0, 1.0, 64, LQ_MAP_LINEAR }

static const lq_kind kinds[] = {
    {
        .id = "fgd",
        .title = "directional albedo of a rough conductor, all orders of scattering or the first",
        .quantity = "reflected flux / incident flux; single: integral F D_omega G dm",
        .source = "B18 eq. 2 and sec. 4.1; H16",
        .interface = "conductor",
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
    {
        .id = "tir-pass",
        .title = "light off a rough base that passes the coating's upper side: mean of 1 - F",
        .quantity =
            "mean of 1 - F_dielectric(cos theta_o, eta) over the lobe of a rough mirror at mu, separable "
            "masking, normalised above the horizon",
        .source = "B18 eq. 32-35",
        .usage = "TIR = this table, at cosine mu inside the coating: r21 += (1 - TIR) t21, then t21 *= TIR; "
                 "counts partial Fresnel reflection twice where t21 = 1 - FGD already has it; not "
                 "interchangeable with tir-loss",
        .axis_count = 3,
        .axes = {MU_AXIS,
                 ALPHA_AXIS,
                 {"eta", "n_out / n_in, seen from inside the coating", 0.0, 100.0, 0.0, 4.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"pass"},
        .tolerance = 1e-5,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "tir-loss",
        .title = "light off a rough base that is beyond the coating's critical angle",
        .quantity = "fraction of the lobe of a rough mirror at mu with sin theta_o > eta, separable masking, "
                    "normalised above the horizon",
        .source = "B18 sec. 5.1, critical angle only",
        .usage = "TIR = this table, at cosine mu inside the coating: r += TIR t, then t -= TIR t; no partial "
                 "Fresnel reflection in it; not interchangeable with tir-pass",
        .axis_count = 3,
        .axes = {MU_AXIS,
                 ALPHA_AXIS,
                 {"eta", "n_out / n_in, seen from inside the coating", 0.0, 1.0, 0.0, 1.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"loss"},
        .tolerance = 1e-5,
        .finest_tolerance = 1e-8,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "fgd-dielectric",
        .title = "directional albedo of a rough dielectric, light that refracted in and came back included",
        .quantity = "R01 = flux that leaves on the incident side / incident flux; T01 = 1 - R01",
        .source = "B18 sec. 4.1; H16",
        .interface = "dielectric",
        .axis_count = 3,
        .axes = {MU_AXIS_TWO_SIDED,
                 ALPHA_AXIS,
                 {"eta", "relative index n_below / n_above, seen from the light", 0.1, 10.0, 0.25, 4.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"fgd"},
        .takes = LQ_TAKES_SCATTERING,
        .tolerance = 1e-4,
        .finest_tolerance = 1e-6,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "transmission",
        .title = "light that enters a coating, attenuated over its first crossing",
        .quantity = "T01 = integral t01(mu -> w) tau^(1/|mu_t|) dw",
        .source = "D22 sec. 3.1 and 4",
        .interface = "dielectric",
        .axis_count = 4,
        .axes = {MU_AXIS_TWO_SIDED,
                 ALPHA_AXIS,
                 {"eta", "relative index n_below / n_above, seen from the light", 0.1, 10.0, 0.4, 2.5, 64,
                  LQ_MAP_LINEAR},
                 {"tau", "transmittance of the coating at normal incidence", 0.0, 1.0, 0.0, 1.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"transmission"},
        .takes = LQ_TAKES_SCATTERING,
        .tolerance = 1e-4,
        .finest_tolerance = 1e-6,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "diffuse-transmission",
        .title = "light of a diffuse base that leaves the coating",
        .quantity = "T10 = (1/pi) integral mu tau^(1/mu) t10(mu -> all) dw",
        .source = "D22 sec. 3.1",
        .interface = "dielectric",
        .axis_count = 3,
        .axes = {{"eta", "index of the coating relative to the air above", 0.1, 10.0, 1.0, 2.5, 64,
                  LQ_MAP_LINEAR},
                 ALPHA_AXIS,
                 {"tau", "transmittance of the coating at normal incidence", 0.0, 1.0, 0.0, 1.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"transmission"},
        .takes = 0,
        .tolerance = 1e-4,
        .finest_tolerance = 1e-6,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "diffuse-reflection",
        .title = "light of a diffuse base that the coating returns to it",
        .quantity = "R10 = (1/pi) double integral mu tau^(1/mu) r10(mu -> mu2) tau^(1/mu2)",
        .source = "D22 sec. 3.1",
        .interface = "dielectric",
        .axis_count = 3,
        .axes = {{"eta", "index of the coating relative to the air above", 0.1, 10.0, 1.0, 2.5, 64,
                  LQ_MAP_LINEAR},
                 ALPHA_AXIS,
                 {"tau", "transmittance of the coating at normal incidence", 0.0, 1.0, 0.0, 1.0, 64,
                  LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"reflection"},
        .takes = 0,
        .tolerance = 1e-4,
        .finest_tolerance = 1e-6,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "variance",
        .title = "spread of the light that leaves a coated diffuse base, and the roughness with the same",
        .quantity =
            "sigma^2 = E[sin^2 theta], flux-weighted, tau = 1; alpha: lobe variance v1(alpha) = sigma^2",
        .source = "D22 sec. 3.3",
        .interface = "dielectric",
        .axis_count = 2,
        .axes = {{"eta", "index of the coating relative to the air above", 0.1, 10.0, 1.0, 2.5, 64,
                  LQ_MAP_LINEAR},
                 ALPHA_AXIS},
        .channel_count = 2,
        .channels = {"variance", "alpha"},
        .takes = 0,
        .tolerance = 1e-4,
        .finest_tolerance = 1e-6,
        .value_min = 0.0,
        .value_max = 1.0,
    },
    {
        .id = "coated-lambertian",
        .title = "albedo of a diffuse base under a rough dielectric coating",
        .quantity = "FGD + T01 rho/(1 - rho R10) T10",
        .source = "D22 eq. 3",
        .interface = "dielectric",
        .axis_count = 5,
        .axes = {{"mu", "cosine of incidence", 0.0, 1.0, 0.0, 1.0, 16, LQ_MAP_LINEAR},
                 {"alpha", "roughness, the slope scale of the NDF", 0.0, 1.0, 0.0, 1.0, 16, LQ_MAP_LINEAR},
                 {"eta", "index of the coating relative to the air above", 0.1, 10.0, 1.0, 2.5, 8,
                  LQ_MAP_LINEAR},
                 {"tau", "transmittance of the coating at normal incidence", 0.0, 1.0, 0.0, 1.0, 8,
                  LQ_MAP_LINEAR},
                 {"rho", "albedo of the base", 0.0, 1.0, 0.0, 1.0, 8, LQ_MAP_LINEAR}},
        .channel_count = 1,
        .channels = {"albedo"},
        .takes = 0,
        .tolerance = 1e-3,
        .finest_tolerance = 1e-4,
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
    char known[512] = "";
    for (size_t i = 0; i < lq_kind_count(); i++) {
        if (strcmp(kinds[i].id, id) == 0) return &kinds[i];
        lq_list_add(known, sizeof known, kinds[i].id);
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

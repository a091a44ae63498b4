/* model_kind.c - the list of models. */
#include "stack/model_kind.h"

#include <string.h>

#include "system/status.h"

const char *const lq_model_names[LQ_MODELS + 1] = {
    [LQ_MODEL_B18_FORWARD] = "b18-forward",
    [LQ_MODEL_B18_SYMMETRIC] = "b18-symmetric",
    [LQ_MODEL_Y19] = "y19",
    [LQ_MODEL_WEIDLICH_WILKIE] = "weidlich-wilkie",
    [LQ_MODEL_WEIDLICH_WILKIE_CORRECTED] = "weidlich-wilkie-corrected",
    [LQ_MODEL_BAKED] = "baked",
    [LQ_MODEL_BAKED_WINDOW] = "baked-window",
};

const lq_model_kind lq_model_kinds[LQ_MODELS] = {
    [LQ_MODEL_B18_FORWARD] = {.title = "the statistical model of Belcour 2018, lobes of the incidence",
                              .varied = true,
                              .one_coat = true,
                              .scattering = true},
    [LQ_MODEL_B18_SYMMETRIC] = {.title = "the same, lobes of the angle to the half vector",
                                .varied = true,
                                .one_coat = true,
                                .scattering = true,
                                .of_pairs = true},
    [LQ_MODEL_Y19] = {.title = "b18-forward with anisotropic interfaces, Yamaguchi et al. 2019",
                      .varied = true,
                      .one_coat = true,
                      .scattering = true,
                      .anisotropic = true},
    [LQ_MODEL_WEIDLICH_WILKIE] = {.title = "Weidlich and Wilkie 2007, a ray refracted by the facet",
                                  .of_pairs = true},
    [LQ_MODEL_WEIDLICH_WILKIE_CORRECTED] = {.title = "the same, refracted by the surface, 1/eta^2",
                                            .of_pairs = true},
    [LQ_MODEL_BAKED] = {.title = "what scenes bake: exact energies, roughness from exact spread"},
    [LQ_MODEL_BAKED_WINDOW] = {.title =
                                   "the same, inner light as two lobes inside the coat, a roughness a colour",
                               .windowed = true},
};

lq_status lq_model_find(const char *name, lq_model_id *id, lq_error *error) {
    char known[200] = "";
    for (int i = 0; i < LQ_MODELS; i++) {
        if (strcmp(name, lq_model_names[i]) == 0) {
            *id = (lq_model_id)i;
            return LQ_OK;
        }
        lq_list_add(known, sizeof known, lq_model_names[i]);
    }
    return lq_fail(error, LQ_BAD_INPUT, "no model '%.40s'; accepted: %s", name, known);
}

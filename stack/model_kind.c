/* model_kind.c - the list of models. */
#include "stack/model_kind.h"

#include <string.h>

#include "system/status.h"

const char *const lq_model_names[LQ_MODELS + 1] = {[LQ_MODEL_B18_FORWARD] = "b18-forward",
                                                   [LQ_MODEL_B18_SYMMETRIC] = "b18-symmetric",
                                                   [LQ_MODEL_BAKED] = "baked",
                                                   [LQ_MODELS] = NULL};

const lq_model_kind lq_model_kinds[LQ_MODELS] = {
    [LQ_MODEL_B18_FORWARD] = {"the statistical model of Belcour 2018, its lobes those of the incidence",
                              "GGX interfaces, media that absorb, a lambertian base under one coat or none",
                              true, false},
    [LQ_MODEL_B18_SYMMETRIC] = {"the same, its lobes those of the angle to the half vector",
                                "GGX interfaces, media that absorb, no lambertian base", true, true},
    [LQ_MODEL_BAKED] = {"what scenes bake: the top's lobe, and all else as one of exact energy and spread",
                        "GGX interfaces, media that absorb", false, false},
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

/* settings.c - what a table is asked for, and the version of whoever asks. */
#include "tables/settings.h"

#include "system/extend.h"

#include <stddef.h>

lq_settings lq_settings_default(void) {
    return (lq_settings){.struct_size = sizeof(lq_settings),
                         .ndf = "ggx",
                         .scattering = LQ_MULTIPLE,
                         .masking = LQ_CORRELATED,
                         .tolerance = 0.0,
                         .threads = 0};
}

lq_status lq_settings_read(lq_settings *settings, const lq_settings *given, lq_error *error) {
    const size_t first = offsetof(lq_settings, opened) + sizeof given->opened;
    *settings = lq_settings_default();
    return lq_extend(settings, sizeof *settings, given, first, "settings", error);
}

const char *lq_version(void) {
    return LQ_VERSION;
}

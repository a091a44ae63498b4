/* settings.h - the options that say how numbers are computed, the same for every verb that does. */
#ifndef LACQUER_PROGRAM_SETTINGS_H
#define LACQUER_PROGRAM_SETTINGS_H

#include "lacquer.h"
#include "program/options.h"

enum { CLI_NDF = 512, CLI_SCATTERING, CLI_MASKING, CLI_TOLERANCE, CLI_THREADS, CLI_ALLOW_PLUGIN };
enum { CLI_MAX_THREADS = 4096 };

/* Rows for the option list of a verb whose request has a cli_settings `settings`, for these modes of it. */
#define CLI_NDF_OPTION(REQUEST, mask)                                                                        \
    {                                                                                                        \
        CLI_NDF, "ndf", "NDF", "distribution of microfacet normals, see `lacquer list` (default ggx)",       \
            CLI_READ(REQUEST, settings, cli_read_ndf), .modes = (mask)                                       \
    }
#define CLI_SCATTERING_OPTION(REQUEST, mask)                                                                 \
    {                                                                                                        \
        CLI_SCATTERING, "scattering", "single|multiple", "hits on the microsurface (default multiple)",      \
            CLI_CHOICE(REQUEST, settings.settings.scattering, cli_scatterings), .modes = (mask)              \
    }
#define CLI_MASKING_OPTION(REQUEST, mask)                                                                    \
    {                                                                                                        \
        CLI_MASKING, "masking", "correlated|separable", "Smith masking (default correlated)",                \
            CLI_CHOICE(REQUEST, settings.settings.masking, cli_maskings), .modes = (mask)                    \
    }
#define CLI_TOLERANCE_OPTION(REQUEST, mask)                                                                  \
    {                                                                                                        \
        CLI_TOLERANCE, "tolerance", "T", "absolute error of every value (default: the table's)",             \
            CLI_NUMBER(REQUEST, settings.settings.tolerance, 1e-15, 1), .modes = (mask)                      \
    }
#define CLI_SETTINGS_OPTIONS(REQUEST, mask)                                                                  \
    CLI_NDF_OPTION(REQUEST, mask), CLI_SCATTERING_OPTION(REQUEST, mask), CLI_MASKING_OPTION(REQUEST, mask),  \
        CLI_TOLERANCE_OPTION(REQUEST, mask)
/* For a request with a size_t `threads`, 0 where it was not given. */
#define CLI_THREADS_OPTION(REQUEST, mask)                                                                    \
    {                                                                                                        \
        CLI_THREADS, "threads", "N", "threads; results do not depend on it (default: one per core)",         \
            CLI_COUNT(REQUEST, threads, 1, CLI_MAX_THREADS), .modes = (mask), .silent = true                 \
    }

/* For a verb that reads files which record an NDF, and whose request has an lq_trust `trust`. */
#define CLI_ALLOW_PLUGIN_OPTION(REQUEST, mask)                                                               \
    {                                                                                                        \
        CLI_ALLOW_PLUGIN, "allow-plugin", NULL, "load the NDF plugin a file names: that runs its code",      \
            CLI_FLAG(REQUEST, trust.plugins), .modes = (mask), .silent = true                                \
    }
#define CLI_TRUST_OPTIONS(REQUEST, mask)                                                                     \
    {CLI_NDF,                                                                                                \
     "ndf",                                                                                                  \
     "NDF",                                                                                                  \
     "the file: or plugin: a file names, which otherwise is not opened",                                     \
     CLI_READ(REQUEST, trust, cli_read_trust),                                                               \
     .modes = (mask),                                                                                        \
     .silent = true},                                                                                        \
        CLI_ALLOW_PLUGIN_OPTION(REQUEST, mask)

typedef struct cli_settings {
    lq_settings settings;
} cli_settings;

extern const char *const cli_scatterings[], *const cli_maskings[];
bool cli_read_ndf(void *settings, const char *value);
/* --ndf as the name of what may be opened. */
bool cli_read_trust(void *trust, const char *value);

cli_settings cli_settings_default(void);

/* Refuse, in one line, an option that was given but that `kind` does not listen to. */
bool cli_settings_suit(const cli_given *given, const lq_kind *kind);

#endif

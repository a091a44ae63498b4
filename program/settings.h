/* settings.h - the options that say how numbers are computed, the same for every verb that does. */
#ifndef LACQUER_PROGRAM_SETTINGS_H
#define LACQUER_PROGRAM_SETTINGS_H

#include "lacquer.h"

enum { CLI_NDF = 512, CLI_SCATTERING, CLI_MASKING, CLI_TOLERANCE, CLI_THREADS };

/* Rows for the option list of a verb. */
#define CLI_SETTINGS_OPTIONS                                                                                 \
    {CLI_NDF, "ndf", "NDF", "distribution of microfacet normals, see `lacquer list` (default ggx)"},         \
        {CLI_SCATTERING, "scattering", "single|multiple", "hits on the microsurface (default multiple)"},    \
        {CLI_MASKING, "masking", "correlated|separable", "Smith masking (default correlated)"}, {            \
        CLI_TOLERANCE, "tolerance", "T", "absolute error of every value (default: the table's)"              \
    }
#define CLI_THREADS_OPTION                                                                                   \
    { CLI_THREADS, "threads", "N", "threads; results do not depend on it (default: one per core)" }

typedef struct cli_settings {
    lq_settings settings;
    const char *given[5]; /* by id - CLI_NDF: the text the user gave, or NULL */
} cli_settings;

cli_settings cli_settings_default(void);

/* Take one option: 1 taken, 0 not one of these, -1 refused (a line was printed). */
int cli_settings_take(cli_settings *settings, int id, const char *value);

/* Refuse, in one line, an option that was given but that `kind` does not listen to. */
bool cli_settings_suit(const cli_settings *settings, const lq_kind *kind);

/* The name of the first of these options that was given, or NULL: for modes that take none. */
const char *cli_settings_given(const cli_settings *settings);

#endif

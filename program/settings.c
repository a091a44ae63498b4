/* settings.c - reads the options that say how numbers are computed. */
#include "program/settings.h"

#include "program/message.h"
#include "program/options.h"

#include <stdlib.h>

const char *const cli_scatterings[] = {[LQ_SINGLE] = "single", [LQ_MULTIPLE] = "multiple", NULL};
const char *const cli_maskings[] = {[LQ_CORRELATED] = "correlated", [LQ_SEPARABLE] = "separable", NULL};

cli_settings cli_settings_default(void) {
    return (cli_settings){.settings = lq_settings_default()};
}

/* The NDF of the command, for as long as the program runs: whoever copied the settings may use it. */
static const lq_ndf *opened;

static void close_ndf(void) {
    lq_ndf_close(opened);
}

bool cli_read_ndf(void *field, const char *value) {
    lq_settings *settings = &((cli_settings *)field)->settings;
    lq_error error = {""};
    if (!opened) atexit(close_ndf);
    lq_ndf_close(opened);
    if (lq_ndf_open(&opened, value, &error) != LQ_OK) {
        cli_message("--ndf: %s", error.text);
        return false;
    }
    settings->opened = opened;
    settings->ndf = lq_ndf_text(opened);
    if (lq_ndf_note(opened)) cli_message("%s", lq_ndf_note(opened));
    return true;
}

bool cli_read_trust(void *field, const char *value) {
    cli_settings settings;
    const char *needs_no_trust;
    if (!cli_read_ndf(&settings, value)) return false;
    if (lq_ndf_trusted(value, NULL, &needs_no_trust, NULL) == LQ_OK) {
        cli_message("--ndf has no effect with %s, which opens no file; accepted there: the file: or plugin: "
                    "that is recorded",
                    value);
        return false;
    }
    ((lq_trust *)field)->ndf = settings.settings.ndf;
    return true;
}

bool cli_settings_suit(const cli_given *given, const lq_kind *kind) {
    const char *refused = NULL, *text = cli_given_text(given, CLI_TOLERANCE);
    double tolerance = 0.0;
    if (cli_given_text(given, CLI_MASKING) && !(kind->takes & LQ_TAKES_MASKING)) refused = "--masking";
    if (cli_given_text(given, CLI_SCATTERING) && !(kind->takes & LQ_TAKES_SCATTERING))
        refused = "--scattering";
    if (refused) {
        cli_message("%s takes no %s: it is defined for one choice only (%s)", kind->id, refused,
                    kind->quantity);
    } else if (text && cli_number(text, &tolerance) &&
               (tolerance < kind->finest_tolerance || tolerance > LQ_LOOSEST_TOLERANCE)) {
        cli_message("--tolerance: %s accepts %g to %g, not %s", kind->id, kind->finest_tolerance,
                    LQ_LOOSEST_TOLERANCE, text);
        return false;
    }
    return !refused;
}

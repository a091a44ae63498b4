/* settings.c - reads the options that say how numbers are computed. */
#include "program/settings.h"

#include "program/message.h"
#include "program/options.h"

#include <stdlib.h>

static const char *const scatterings[] = {[LQ_SINGLE] = "single", [LQ_MULTIPLE] = "multiple"};
static const char *const maskings[] = {[LQ_CORRELATED] = "correlated", [LQ_SEPARABLE] = "separable"};
static const char *const names[] = {"--ndf", "--scattering", "--masking", "--tolerance", "--threads"};

enum { MAX_THREADS = 1024 };

cli_settings cli_settings_default(void) {
    return (cli_settings){.settings = lq_settings_default()};
}

/* The NDF of the command, for as long as the program runs: whoever copied the settings may use it. */
static const lq_ndf *opened;

static void close_ndf(void) {
    lq_ndf_close(opened);
}

static bool take_ndf(lq_settings *settings, const char *value) {
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

static bool take_scattering(lq_settings *settings, const char *value) {
    int choice = cli_parse_choice("--scattering", value, scatterings, 2);
    if (choice >= 0) settings->scattering = (lq_scattering)choice;
    return choice >= 0;
}

static bool take_masking(lq_settings *settings, const char *value) {
    int choice = cli_parse_choice("--masking", value, maskings, 2);
    if (choice >= 0) settings->masking = (lq_masking)choice;
    return choice >= 0;
}

static bool take_threads(lq_settings *settings, const char *value) {
    size_t threads;
    if (!cli_parse_count("--threads", value, 1, MAX_THREADS, &threads)) return false;
    settings->threads = (int)threads;
    return true;
}

static bool take(lq_settings *settings, int id, const char *value) {
    switch (id) {
    case CLI_NDF:
        return take_ndf(settings, value);
    case CLI_SCATTERING:
        return take_scattering(settings, value);
    case CLI_MASKING:
        return take_masking(settings, value);
    case CLI_TOLERANCE:
        return cli_parse_number("--tolerance", value, 1e-15, 1, &settings->tolerance);
    default:
        return take_threads(settings, value);
    }
}

int cli_settings_take(cli_settings *settings, int id, const char *value) {
    if (id < CLI_NDF || id > CLI_THREADS) return 0;
    settings->given[id - CLI_NDF] = value;
    return take(&settings->settings, id, value) ? 1 : -1;
}

static bool refuses(const cli_settings *settings, const lq_kind *kind, int id, unsigned flag) {
    return settings->given[id - CLI_NDF] && !(kind->takes & flag);
}

bool cli_settings_suit(const cli_settings *settings, const lq_kind *kind) {
    const char *refused = NULL;
    if (refuses(settings, kind, CLI_SCATTERING, LQ_TAKES_SCATTERING)) refused = "--scattering";
    if (refuses(settings, kind, CLI_MASKING, LQ_TAKES_MASKING)) refused = "--masking";
    double tolerance = settings->settings.tolerance;
    if (refused) {
        cli_message("%s takes no %s: it is defined for one choice only (%s)", kind->id, refused,
                    kind->quantity);
    } else if (settings->given[CLI_TOLERANCE - CLI_NDF] &&
               (tolerance < kind->finest_tolerance || tolerance > LQ_LOOSEST_TOLERANCE)) {
        cli_message("--tolerance: %s accepts %g to %g, not %s", kind->id, kind->finest_tolerance,
                    LQ_LOOSEST_TOLERANCE, settings->given[CLI_TOLERANCE - CLI_NDF]);
        return false;
    }
    return !refused;
}

const char *cli_settings_given(const cli_settings *settings) {
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (settings->given[i]) return names[i];
    return NULL;
}

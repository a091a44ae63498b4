/* list.c - `lacquer list`: what can be computed and written, one line each. */
#include "lacquer.h"
#include "program/catalogue.h"
#include "program/message.h"
#include "program/options.h"
#include "program/verb.h"

static void print_ndfs(void) {
    printf("NDFs (--ndf)\n");
    for (size_t i = 0; i < lq_ndf_count(); i++) printf("  %-17s %s\n", lq_ndf_syntax(i), lq_ndf_title(i));
    printf("  Every NDF: all tables, random walks, pca, packs with their decode source, certificates, bench. "
           "Those whose\n"
           "  roughness reaches from 0 to 1 also: fit, and the mappings f, f-inverse and sigma-g of recipes. "
           "A file of one\n"
           "  column or a plugin may have fewer roughnesses: its tables take alpha from there. See "
           "docs/ndf.md.\n");
}

static void print_formats(void) {
    printf(
        "Formats (--format, or the ending of the output file)\n"
        "  %-15s archive: float32 with axes and provenance; every verb reads it\n"
        "  %-15s NumPy: float32, C order, last table axis first\n"
        "  %-15s published binary, last axis fastest: fgd, tir-pass\n"
        "  %-15s published binary, first axis fastest: fgd, tir-loss, albedo (separable masking)\n"
        "  %-15s Mitsuba 0.6 .dat: transmission, both sides and their means (its inside: mitsuba-inside)\n",
        "exr", "npy", "belcour", "tm", "mitsuba");
}

static int run(int argc, char **argv) {
    cli_given given;
    if (!cli_parse(&cli_verb_list, argc, argv, NULL, NULL, &given)) return CLI_FAILED;
    cli_print_tables(stdout);
    printf("\n");
    print_ndfs();
    printf("\n");
    print_formats();
    return CLI_DONE;
}

static const cli_option options[] = {{0}};

const cli_verb cli_verb_list = {
    .name = "list",
    .summary = "tables, NDFs and file formats, one line each",
    .usage = "",
    .options = options,
    .option_count = CLI_COUNTED(options),
    .examples = "lacquer list",
    .run = run,
};

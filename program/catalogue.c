/* catalogue.c - prints the catalogue of tables for `list` and for --help. */
#include "program/catalogue.h"

#include "lacquer.h"
#include "program/options.h"
#include "system/status.h"

static void print_table(FILE *out, const lq_kind *kind) {
    char axes[LQ_MAX_AXES * (LQ_NAME_SIZE + 2)] = "";
    for (int i = 0; i < kind->axis_count; i++) lq_list_add(axes, sizeof axes, kind->axes[i].name);
    fprintf(out, "  %-15s %-22s %s\n", kind->id, axes, kind->title);
}

void cli_print_tables(FILE *out) {
    fprintf(out, "Tables (id, axes, title)\n");
    for (size_t i = 0; i < lq_kind_count(); i++) print_table(out, lq_kind_at(i));
}

static void print_axis(FILE *out, const lq_axis_info *axis) {
    char range[64], nodes[64];
    snprintf(range, sizeof range, "[%g, %g]", axis->lowest, axis->highest);
    snprintf(nodes, sizeof nodes, "%g:%g:%zu:%s", axis->min, axis->max, axis->size, lq_map_name(axis->map));
    fprintf(out, "    %-8s accepts %-12s default %-16s %s\n", axis->name, range, nodes, axis->meaning);
}

void cli_print_axes(FILE *out) {
    cli_print_tables(out);
    for (size_t i = 0; i < lq_kind_count(); i++) {
        const lq_kind *kind = lq_kind_at(i);
        fprintf(out, "\n  %s: %s\n    %s (%s)\n", kind->id, kind->title, kind->quantity, kind->source);
        for (int a = 0; a < kind->axis_count; a++) print_axis(out, &kind->axes[a]);
        if (kind->usage) fprintf(out, "    usage: %s\n", kind->usage);
        fprintf(out, "    tolerance %g, finest %g\n", kind->tolerance, kind->finest_tolerance);
    }
}

/* table.c - a table as a picture: a slice, and on a page all that was recorded. */
#include "program/view/view.h"

#include <stdio.h>

#include "tables/facts.h"

static void describe(const lq_table *table, const char *name, char *text, size_t size) {
    const char *kind = lq_table_fact(table, "table");
    const lq_kind *known = kind ? lq_kind_find(kind, NULL) : NULL;
    snprintf(text, size, "%s%s%s", name, known ? " · " : "", known ? known->title : "");
}

lq_status view_begin(const lq_fact *facts, size_t count, const char *name, const char *subtitle,
                     lq_figure **figure, lq_error *error) {
    const char *kind = lq_facts_find(facts, count, "table");
    lq_status status = lq_figure_create(figure, kind ? kind : name, subtitle, error);
    for (size_t i = 0; status == LQ_OK && i < count; i++)
        status = lq_figure_tell(*figure, facts[i].key, facts[i].value, error);
    return status;
}

lq_status view_table(const lq_table *table, const lq_slice *slice, const char *name, lq_figure **figure,
                     lq_error *error) {
    char text[LQ_MESSAGE_SIZE];
    describe(table, name, text, sizeof text);
    const lq_status status = view_begin(table->facts, table->fact_count, name, text, figure, error);
    return status == LQ_OK ? lq_figure_add_slice(*figure, slice, error) : status;
}

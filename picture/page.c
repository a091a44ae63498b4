/* page.c - the page around the numbers: what can be read without its script, and the script. */
#include "picture/page_parts.h"

#include <math.h>

#include "picture/document.h"
#include "picture/text.h"
#include "system/stream.h"

/* ======================================================================================
 *                                  A table too large
 * ====================================================================================== */

void lq_page_thin(const lq_table *table, int x, int y, size_t budget, size_t kept[LQ_MAX_AXES]) {
    double entries = 1.0;
    for (int a = 0; a < table->axis_count; a++) entries *= (double)(kept[a] = table->axes[a].size);
    while (entries > (double)budget) {
        int most = -1;
        double longest = 0.0;
        for (int a = 0; a < table->axis_count; a++) {
            const double length = (double)kept[a] * (a == x || a == y ? 0.5 : 1.0);
            if (kept[a] > 2 && length > longest) longest = length, most = a;
        }
        if (most < 0) return; /* two nodes of each: at most 64 entries */
        entries *= (double)(kept[most] - 1) / (double)kept[most];
        kept[most]--;
    }
}

size_t lq_page_node(size_t i, size_t kept, size_t size) {
    if (kept < 2) return 0;
    return (size_t)llround((double)i * (double)(size - 1) / (double)(kept - 1));
}

/* ======================================================================================
 *                                        The page
 * ====================================================================================== */

void lq_page_unscripted(FILE *out) {
    fputs("<noscript><p class=\"note\">The pictures of this page are drawn by its script, which does not run."
          "</p></noscript>\n",
          out);
}

static void put_head(FILE *out, const lq_figure *figure) {
    lq_document_begin(out, figure->title);
    fputs("<p>", out);
    lq_text_put(out, figure->subtitle);
    fputs("</p>\n", out);
    lq_page_unscripted(out);
}

static void put_facts(FILE *out, const lq_figure *figure) {
    if (figure->fact_count == 0) return;
    fputs("<details open><summary>What is recorded</summary>\n<table>\n", out);
    for (size_t i = 0; i < figure->fact_count; i++) {
        fputs("<tr><th>", out);
        lq_text_put(out, figure->facts[i].key);
        fputs("</th><td>", out);
        lq_text_put(out, figure->facts[i].value);
        fputs("</td></tr>\n", out);
    }
    fputs("</table></details>\n", out);
}

/* "Thinned: 33 of 64 nodes of mu, ..." */
static void put_thinned(FILE *out, const lq_table *table, const size_t *kept) {
    const char *before = "<p class=\"note\" id=\"thinned\">Thinned to fit this page: ";
    for (int a = 0; a < table->axis_count; a++) {
        if (kept[a] == table->axes[a].size) continue;
        fprintf(out, "%s%zu of %zu nodes of ", before, kept[a], table->axes[a].size);
        lq_text_put(out, table->axes[a].name);
        before = ", ";
    }
    if (*before == ',') fputs(". Values between the nodes that are left are interpolated.</p>\n", out);
}

/* What the script reads, and how many panels that holds. */
static lq_status put_data(FILE *out, const lq_page *page, const size_t *kept, size_t *shown,
                          lq_error *error) {
    lq_status status = LQ_OK;
    fputs("<script type=\"application/json\" id=\"data\">\n{\"colours\":", out);
    lq_page_colours(out);
    fputs(",\n\"table\":", out);
    if (page->start) status = lq_page_table(out, page->start, kept, error);
    else fputs("null", out);
    fputs(",\n\"panels\":", out);
    *shown = 0;
    if (page->start) fputs("[]", out);
    else *shown = lq_page_panels(out, page->figure, LQ_PAGE_BYTES);
    fputs("}\n</script>\n", out);
    return status;
}

static lq_status put_page(FILE *out, const lq_page *page, lq_error *error) {
    const lq_figure *figure = page->figure;
    size_t kept[LQ_MAX_AXES], shown = 0;
    put_head(out, figure);
    if (page->start) {
        const lq_table *table = page->start->table;
        const size_t entries = (size_t)LQ_PAGE_BYTES * 3 / 16 / (size_t)table->channel_count;
        lq_page_thin(table, page->start->x, page->start->y, entries, kept);
        put_thinned(out, table, kept);
    }
    if (page->facts_first) put_facts(out, figure);
    fputs("<main id=\"main\"></main>\n<div id=\"panels\"></div>\n", out);
    if (!page->facts_first) put_facts(out, figure);
    const lq_status status = put_data(out, page, kept, &shown, error);
    if (!page->start && shown < figure->panel_count)
        fprintf(out,
                "<p class=\"note\">%zu of %zu pictures are left out, so that the page stays small.</p>\n",
                figure->panel_count - shown, figure->panel_count);
    fprintf(out, "<script>\n%s</script>\n", lq_page_script);
    lq_document_end(out);
    return status;
}

lq_status lq_page_write(const lq_page *page, const char *path, lq_error *error) {
    lq_stream stream;
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    return lq_stream_close(&stream, put_page(stream.out, page, error), error);
}

/* page_json.c - the numbers of a page, for its script. */
#include "picture/page_parts.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour.h"
#include "system/status.h"

void lq_page_string(FILE *out, const char *text) {
    fputc('"', out);
    for (const char *c = text; *c; c++) {
        if (*c == '<') fputs("\\u003c", out);
        else if (*c == '"' || *c == '\\') fprintf(out, "\\%c", *c);
        else fputc(*c, out);
    }
    fputc('"', out);
}

/* ======================================================================================
 *                                         Base64
 * ====================================================================================== */

static unsigned char byte_of(const float *values, size_t i) {
    uint32_t bits;
    memcpy(&bits, &values[i / 4], sizeof bits);
    return (unsigned char)(bits >> 8 * (i % 4));
}

void lq_page_values(FILE *out, const float *values, size_t count) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const size_t size = 4 * count;
    fputc('"', out);
    for (size_t i = 0; i < size; i += 3) {
        uint32_t three = 0;
        for (size_t k = 0; k < 3; k++)
            three = three << 8 | (i + k < size ? byte_of(values, i + k) : (uint32_t)0);
        for (int k = 0; k < 4; k++)
            fputc(i + (size_t)k <= size ? digits[three >> (18 - 6 * k) & 63] : '=', out);
    }
    fputc('"', out);
}

/* ======================================================================================
 *                                         Parts
 * ====================================================================================== */

static void put_steps(FILE *out, lq_colours colours) {
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(colours, steps);
    for (int i = 0; i < LQ_COLOUR_STEPS; i++)
        fprintf(out, "%02x%02x%02x", steps[i].r, steps[i].g, steps[i].b);
}

void lq_page_colours(FILE *out) {
    const lq_rgb bad = lq_colour_bad();
    fputs("{\"value\":\"", out);
    put_steps(out, LQ_COLOURS_VALUE);
    fputs("\",\"signed\":\"", out);
    put_steps(out, LQ_COLOURS_SIGNED);
    fprintf(out, "\",\"bad\":\"%02x%02x%02x\"}", bad.r, bad.g, bad.b);
}

/* An axis of which `kept` nodes are told; where these are some, "at" says where they lie. */
static void put_axis(FILE *out, const lq_axis *axis, size_t kept, const char *meaning) {
    const bool power = axis->map == LQ_MAP_POWER;
    fputs("{\"name\":", out);
    lq_page_string(out, axis->name);
    fprintf(out, ",\"size\":%zu,\"exponent\":%.17g,\"map\":\"%s", axis->size, axis->exponent,
            axis->map == LQ_MAP_LINEAR ? "" : lq_map_name(axis->map));
    if (power) fprintf(out, " %g", axis->exponent);
    fputs("\",\"nodes\":[", out);
    for (size_t i = 0; i < kept; i++)
        fprintf(out, "%s%.12g", i ? "," : "", axis->nodes[lq_page_node(i, kept, axis->size)]);
    fputs(kept < axis->size ? "],\"at\":[" : "]", out);
    for (size_t i = 0; kept < axis->size && i < kept; i++)
        fprintf(out, "%s%.9g", i ? "," : "",
                (double)lq_page_node(i, kept, axis->size) / (double)(axis->size - 1));
    fputs(kept < axis->size ? "],\"meaning\":" : ",\"meaning\":", out);
    lq_page_string(out, meaning);
    fputc('}', out);
}

static void put_panel(FILE *out, const lq_panel *panel) {
    static const char *const forms[] = {"map", "lines", "areas"};
    fprintf(out, "{\"form\":\"%s\",\"title\":", forms[panel->form]);
    lq_page_string(out, panel->title);
    fputs(",\"caption\":", out);
    lq_page_string(out, panel->caption);
    fputs(",\"quantity\":", out);
    lq_page_string(out, panel->quantity);
    fputs(",\"series\":[", out);
    for (size_t i = 0; panel->form != LQ_PANEL_MAP && i < panel->series_count; i++) {
        if (i > 0) fputc(',', out);
        lq_page_string(out, panel->series[i]);
    }
    fputs("],\"x\":", out);
    put_axis(out, &panel->x, panel->x.size, "");
    if (panel->form == LQ_PANEL_MAP) {
        fputs(",\"y\":", out);
        put_axis(out, &panel->y, panel->y.size, "");
    }
    fprintf(out, ",\"low\":%.9g,\"high\":%.9g,\"signed\":%s,\"ordered\":%s,\"reference\":%s,\"values\":",
            panel->low, panel->high, panel->is_signed ? "true" : "false", panel->ordered ? "true" : "false",
            panel->reference ? "true" : "false");
    lq_page_values(out, panel->values, panel->x.size * lq_panel_rows(panel));
    fputc('}', out);
}

size_t lq_page_panels(FILE *out, const lq_figure *figure, size_t bytes) {
    size_t shown = 0, used = 0;
    fputc('[', out);
    for (; shown < figure->panel_count; shown++) {
        const lq_panel *panel = &figure->panels[shown];
        used += panel->x.size * lq_panel_rows(panel) * 16 / 3 + 14 * (panel->x.size + panel->y.size) + 400;
        if (used > bytes) break;
        if (shown > 0) fputs(",\n", out);
        put_panel(out, panel);
    }
    fputc(']', out);
    return shown;
}

/* ======================================================================================
 *                                         A table
 * ====================================================================================== */

/* The entries of a channel that the page keeps. */
static void gather(const lq_table *table, int channel, const size_t *kept, size_t count, float *values) {
    for (size_t i = 0; i < count; i++) {
        size_t offset = 0, stride = 1, rest = i;
        for (int a = 0; a < table->axis_count; a++) {
            offset += stride * lq_page_node(rest % kept[a], kept[a], table->axes[a].size);
            stride *= table->axes[a].size;
            rest /= kept[a];
        }
        values[i] = table->channels[channel][offset];
    }
}

static const char *meaning_of(const lq_table *table, int axis) {
    const char *name = lq_table_fact(table, "table");
    const lq_kind *kind = name ? lq_kind_find(name, NULL) : NULL;
    for (int a = 0; kind && a < kind->axis_count; a++)
        if (strcmp(kind->axes[a].name, table->axes[axis].name) == 0) return kind->axes[a].meaning;
    return "";
}

static void put_start(FILE *out, const lq_slice *start) {
    fprintf(out, "\"start\":{\"x\":%d,\"y\":%d,\"channel\":%d,\"at\":[", start->x, start->y, start->channel);
    for (int a = 0; a < start->table->axis_count; a++) fprintf(out, "%s%.12g", a ? "," : "", start->at[a]);
    fputs("]},\"range\":", out);
    if (start->range) fprintf(out, "[%.9g,%.9g]", start->range[0], start->range[1]);
    else fputs("null", out);
}

lq_status lq_page_table(FILE *out, const lq_slice *start, const size_t *kept, lq_error *error) {
    const lq_table *table = start->table;
    size_t count = 1;
    for (int a = 0; a < table->axis_count; a++) count *= kept[a];
    float *values = malloc(count * sizeof *values);
    if (!values) return lq_fail(error, LQ_NO_MEMORY, "no memory for a page");
    fputs("{\"axes\":[", out);
    for (int a = 0; a < table->axis_count; a++) {
        if (a > 0) fputs(",\n", out);
        put_axis(out, &table->axes[a], kept[a], meaning_of(table, a));
    }
    fputs("],\"channels\":[", out);
    for (int c = 0; c < table->channel_count; c++) {
        if (c > 0) fputc(',', out);
        lq_page_string(out, table->channel_names[c]);
    }
    fputs("],", out);
    put_start(out, start);
    fputs(",\n\"values\":[", out);
    for (int c = 0; c < table->channel_count; c++) {
        if (c > 0) fputs(",\n", out);
        gather(table, c, kept, count, values);
        lq_page_values(out, values, count);
    }
    fputs("]}", out);
    free(values);
    return LQ_OK;
}

/* writer.c - a stack back as JSON text: what a table's facts record. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stack/description.h"
#include "system/draft.h"
#include "system/number.h"
#include "system/status.h"

/* The shortest text that reads as the same double. */
static void put_number(FILE *out, double value) {
    char text[40];
    for (int digits = 6; digits <= 17; digits++) {
        lq_print(text, sizeof text, "%.*g", digits, value);
        if (lq_strtod(text, NULL) == value) break;
    }
    fputs(text, out);
}

static void put_string(FILE *out, const char *text) {
    fputc('"', out);
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 0x20) fprintf(out, "\\u%04x", c);
        else if (c == '"' || c == '\\') fprintf(out, "\\%c", c);
        else fputc(c, out);
    }
    fputc('"', out);
}

static void put_quantity(FILE *out, const lq_quantity *q) {
    if (q->form == LQ_RGB) {
        for (int c = 0; c < LQ_STACK_CHANNELS; c++) {
            fputs(c ? ", " : "[", out);
            put_number(out, q->value[c]);
        }
        fputc(']', out);
        return;
    }
    if (q->form == LQ_RANGE) fputs("{\"min\": ", out);
    put_number(out, q->value[0]);
    if (q->form != LQ_RANGE) return;
    fputs(", \"max\": ", out);
    put_number(out, q->highest);
    fputc('}', out);
}

static void put_member(FILE *out, const char *before, const char *key, const lq_quantity *q) {
    fprintf(out, "%s\"%s\": ", before, key);
    put_quantity(out, q);
}

static void put_alpha(FILE *out, const lq_layer *layer) {
    if (!layer->anisotropic) {
        put_member(out, ", ", "alpha", &layer->alpha_x);
        return;
    }
    put_member(out, ", \"alpha\": {", "x", &layer->alpha_x);
    put_member(out, ", ", "y", &layer->alpha_y);
    put_member(out, ", ", "rotate", &layer->rotate);
    fputc('}', out);
}

static void put_medium(FILE *out, const lq_medium *medium) {
    if (!medium->by_sigma) {
        put_member(out, ", \"medium\": {", "tau", &medium->tau);
    } else {
        put_member(out, ", \"medium\": {", "sigma_a", &medium->sigma_a);
        put_member(out, ", ", "sigma_s", &medium->sigma_s);
        put_member(out, ", ", "depth", &medium->depth);
        put_member(out, ", ", "g", &medium->g);
    }
    fputc('}', out);
}

static void put_layer(FILE *out, const lq_layer *layer) {
    fprintf(out, "{\"%s\": {", lq_layer_type_name(layer->type));
    if (layer->type == LQ_LAYER_LAMBERTIAN) {
        put_member(out, "", "rho", &layer->rho);
    } else {
        put_member(out, "", "n", &layer->n);
        if (layer->type == LQ_LAYER_CONDUCTOR) put_member(out, ", ", "kappa", &layer->kappa);
        put_alpha(out, layer);
        if (strcmp(layer->ndf, "ggx") != 0) {
            fputs(", \"ndf\": ", out);
            put_string(out, layer->ndf);
        }
    }
    fputc('}', out);
    if (layer->type == LQ_LAYER_DIELECTRIC) put_medium(out, &layer->medium);
    fputc('}', out);
}

lq_status lq_stack_text(const lq_stack *stack, char **text, lq_error *error) {
    lq_draft draft = {.text = NULL};
    FILE *out = lq_draft_open(&draft);
    *text = NULL;
    if (!out) return lq_fail(error, LQ_NO_MEMORY, "no memory for the text of a stack");
    fputc('{', out);
    if (stack->name[0]) {
        fputs("\"name\": ", out);
        put_string(out, stack->name);
        fputs(", ", out);
    }
    fputs("\"layers\": [", out);
    for (size_t i = 0; i < stack->layer_count; i++) {
        if (i) fputs(", ", out);
        put_layer(out, &stack->layers[i]);
    }
    fputs("]}", out);
    const bool whole = lq_draft_close(&draft, out);
    *text = draft.text;
    return whole ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for the text of a stack");
}

/* Reads tables and factors, and makes the factors as they may have been before they were rounded to half. */
#include "validate/certificate_subject.h"

#include "fit/curve.h"
#include "pack/mapping.h"
#include "pca/factors.h"
#include "pca/factors_json.h"
#include "system/status.h"
#include "tables/facts.h"
#include "tables/half.h"
#include "validate/stream.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ----------------------------------------------------------------------- texels before rounding */

/* A value that is as likely as any to have been rounded to `half`: between the middles to its neighbours. */
static float before_rounding(float half, double u) {
    const uint16_t bits = lq_half_from_float(half);
    const double up = (double)lq_half_to_float((uint16_t)(bits + 1));
    const double x = (double)half, gap = isfinite(up) ? fabs(up - x) : 0.0;
    return half == 0.0f ? 0.0f : (float)(x + (u - 0.5) * gap);
}

/* Purpose of the random stream. */
enum { STREAM_TEXELS = 0x746578 };

static void unround_list(float *values, size_t count, uint64_t number) {
    lq_stream stream = lq_stream_open(0, STREAM_TEXELS, number);
    for (size_t i = 0; i < count; i++) values[i] = before_rounding(values[i], lq_stream_uniform(&stream));
}

static void unround(lq_factored *factored) {
    uint64_t number = 0;
    for (int p = 0; p < factored->piece_count; p++)
        for (int f = 0; f < factored->pieces[p].factor_count; f++, number++) {
            lq_factor *factor = &factored->pieces[p].factors[f];
            unround_list(factor->data, lq_factor_texels(factor) * factor->base_count, number);
        }
}

/* ------------------------------------------------------------------------------------- reading */

static lq_status check_axes(const lq_factored *factored, const lq_kind *kind, lq_error *error) {
    if (factored->axis_count != kind->axis_count)
        return lq_fail(error, LQ_FORMAT, "%d axes, but table '%s' has %d", factored->axis_count, kind->id,
                       kind->axis_count);
    for (int a = 0; a < kind->axis_count; a++)
        if (strcmp(factored->axes[a].name, kind->axes[a].name) != 0)
            return lq_fail(error, LQ_FORMAT, "axis %d is '%s', but '%s' in table '%s'", a + 1,
                           factored->axes[a].name, kind->axes[a].name, kind->id);
    if (kind->channel_count != 1)
        return lq_fail(error, LQ_FORMAT, "factors hold one channel, table '%s' has %d", kind->id,
                       kind->channel_count);
    return LQ_OK;
}

static lq_status read_factored(lq_subject *s, const char *path, const lq_trust *trust, lq_error *error) {
    lq_status status = lq_factored_read(&s->factored, path, error);
    if (status == LQ_OK) status = lq_factored_read(&s->unrounded, path, error);
    if (status == LQ_OK)
        status = lq_origin_of_facts(s->factored->facts, s->factored->fact_count, trust, &s->origin, error);
    if (status == LQ_OK) status = check_axes(s->factored, s->origin.kind, error);
    if (status == LQ_OK) unround(s->unrounded);
    return status;
}

lq_status lq_subject_read(lq_subject *s, const char *path, const lq_trust *trust, lq_error *error) {
    *s = (lq_subject){.table = NULL};
    const char *slash = strrchr(path, '/');
    snprintf(s->name, sizeof s->name, "%s", slash ? slash + 1 : path);
    lq_error cause = {""};
    lq_status status = lq_table_read_exr(&s->table, path, error);
    if (status != LQ_OK) return status;
    if (lq_table_fact(s->table, "factors")) {
        lq_table_free(s->table);
        s->table = NULL;
        status = read_factored(s, path, trust, &cause);
    } else {
        status = lq_origin_of(s->table, trust, &s->origin, &cause);
    }
    /* Once, not at every block: an NDF may tabulate. */
    if (status == LQ_OK) status = lq_ndf_open(&s->origin.settings.opened, s->origin.settings.ndf, &cause);
    return status == LQ_OK ? LQ_OK : lq_fail(error, status, "%.200s: %.300s", path, cause.text);
}

/* --------------------------------------------------------------------------- tables of a pack */

static lq_status copy_factored(const lq_factored *from, lq_factored **copy, lq_error *error) {
    char *structure = lq_factored_to_json(from);
    lq_factored *made = calloc(1, sizeof *made);
    *copy = made;
    lq_status status = structure && made
                           ? lq_factored_from_json(structure, SIZE_MAX, made, error)
                           : lq_fail(error, LQ_NO_MEMORY, "no memory for a copy of the factors");
    free(structure);
    for (int p = 0; status == LQ_OK && p < from->piece_count; p++)
        for (int f = 0; f < from->pieces[p].factor_count; f++) {
            const lq_factor *factor = &from->pieces[p].factors[f];
            memcpy(made->pieces[p].factors[f].data, factor->data,
                   lq_factor_texels(factor) * factor->base_count * sizeof *factor->data);
        }
    return status;
}

static lq_status copy_unrounded(const lq_table *from, lq_table **copy, lq_error *error) {
    const char *channels[LQ_MAX_CHANNELS];
    for (int c = 0; c < from->channel_count; c++) channels[c] = from->channel_names[c];
    const lq_status status =
        lq_table_create(copy, from->axes, from->axis_count, channels, from->channel_count, error);
    for (int c = 0; status == LQ_OK && c < from->channel_count; c++) {
        memcpy((*copy)->channels[c], from->channels[c], lq_table_entries(from) * sizeof(float));
        unround_list((*copy)->channels[c], lq_table_entries(from), (uint64_t)c);
    }
    return status;
}

/* What lq_mapping_table sets: the NDF. The tolerance is that of the curve. */
static lq_status mapping_origin(lq_subject *s, const lq_kind *kind, const lq_fact *facts, size_t count,
                                const lq_trust *trust, lq_error *error) {
    const char *ndf = lq_facts_find(facts, count, "ndf");
    if (!ndf) return lq_fail(error, LQ_FORMAT, "the manifest does not say its ndf");
    s->origin.kind = kind;
    s->origin.settings = lq_settings_default();
    const lq_status status = lq_ndf_trusted(ndf, trust, &s->origin.settings.ndf, error);
    if (status != LQ_OK) return status;
    s->curve = malloc(sizeof *s->curve);
    return s->curve ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for a curve");
}

lq_status lq_subject_ship(lq_subject *s, lq_shipped *shipped, const lq_trust *trust, lq_error *error) {
    *s = (lq_subject){.table = shipped->table, .factored = shipped->factored, .texture = shipped->texture};
    s->relative = shipped->relative;
    s->files = shipped->files;
    s->altered = shipped->altered;
    s->differing = shipped->differing;
    snprintf(s->name, sizeof s->name, "%s", shipped->name);
    snprintf(s->suspect, sizeof s->suspect, "%s", shipped->suspect);
    const lq_kind *kind = shipped->kind;
    shipped->table = NULL;
    shipped->factored = NULL;
    shipped->texture = (lq_texture){0};
    lq_error cause = {""};
    lq_status status = s->factored ? copy_factored(s->factored, &s->unrounded, &cause)
                                   : copy_unrounded(s->table, &s->unrounded_table, &cause);
    if (status == LQ_OK && s->unrounded) unround(s->unrounded);
    const lq_fact *facts = s->factored ? s->factored->facts : s->table->facts;
    const size_t count = s->factored ? s->factored->fact_count : s->table->fact_count;
    if (status == LQ_OK)
        status = lq_is_mapping(kind) ? mapping_origin(s, kind, facts, count, trust, &cause)
                                     : lq_origin_of_facts(facts, count, trust, &s->origin, &cause);
    if (status == LQ_OK && s->origin.kind != kind)
        status = lq_fail(&cause, LQ_FORMAT, "made as '%s', listed as '%s'", s->origin.kind->id, kind->id);
    if (status == LQ_OK && s->factored) status = check_axes(s->factored, kind, &cause);
    if (status == LQ_OK) status = lq_ndf_open(&s->origin.settings.opened, s->origin.settings.ndf, &cause);
    if (status == LQ_OK && s->curve) status = lq_curve_make(s->curve, s->origin.settings.opened, &cause);
    return status == LQ_OK ? LQ_OK : lq_fail(error, status, "%.200s: %.300s", s->name, cause.text);
}

lq_status lq_subject_make_table(lq_subject *s, const lq_axis *axes, const lq_progress *progress,
                                lq_error *error) {
    const lq_kind *kind = s->origin.kind;
    const lq_status status = lq_is_mapping(kind)
                                 ? lq_mapping_table(kind, &s->origin.settings, axes, &s->table, error)
                                 : lq_precompute(kind, &s->origin.settings, axes, progress, &s->table, error);
    return status == LQ_NOT_CONVERGED ? LQ_OK : status;
}

lq_status lq_subject_add_table(lq_subject *s, const char *path, const lq_trust *trust, lq_error *error) {
    lq_origin origin;
    lq_error cause = {""};
    lq_status status = lq_table_read_exr(&s->table, path, error);
    if (status != LQ_OK) return status;
    status = lq_origin_of(s->table, trust, &origin, &cause);
    if (status == LQ_OK && origin.kind != s->origin.kind)
        status = lq_fail(&cause, LQ_BAD_INPUT, "a table of kind '%s', but the factors are of '%s'",
                         origin.kind->id, s->origin.kind->id);
    return status == LQ_OK ? LQ_OK : lq_fail(error, status, "%.200s: %.300s", path, cause.text);
}

void lq_subject_free(lq_subject *s) {
    lq_ndf_close(s->origin.settings.opened);
    lq_table_free(s->table);
    lq_factored_free(s->factored);
    lq_factored_free(s->unrounded);
    lq_table_free(s->unrounded_table);
    lq_texture_free(&s->texture);
    free(s->curve);
    *s = (lq_subject){.table = NULL};
}

/* ------------------------------------------------------------------------------------ decoders */

lq_domain lq_subject_domain(const lq_subject *s) {
    lq_domain domain = {.min = {0.0}};
    for (int a = 0; a < s->origin.kind->axis_count; a++) {
        domain.min[a] = s->factored ? s->factored->axes[a].min : s->table->axes[a].min;
        domain.max[a] = s->factored ? s->factored->axes[a].max : s->table->axes[a].max;
    }
    return domain;
}

int lq_subject_stages(const lq_subject *s, lq_stage *stages) {
    int count = 0;
    if (s->texture.axis_count > 0) {
        stages[0] = (lq_stage){"unrounded", "interpolation", lq_decode_table, s->unrounded_table};
        stages[1] = (lq_stage){"texels", "half-float", lq_decode_table, s->table};
        stages[2] = (lq_stage){"gpu", "filter", lq_decode_texture, &s->texture};
        return 3;
    }
    if (s->table) stages[count++] = (lq_stage){"table", "interpolation", lq_decode_table, s->table};
    if (!s->factored) return count;
    stages[count] = (lq_stage){"unrounded", count ? "factorisation" : "table and factors", lq_decode_factored,
                               s->unrounded};
    stages[++count] = (lq_stage){"factors", "half-float", lq_decode_factored, s->factored};
    stages[++count] = (lq_stage){"gpu", "filter", lq_decode_gpu, s->factored};
    return count + 1;
}

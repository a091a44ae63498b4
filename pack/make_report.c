/* make_report.c - what a pack came to, and whether that is within its budgets. */
#include "pack/make.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct lq_pack_report {
    size_t count, bytes, max_bytes;
    bool atlas;
    lq_pack_entry *entries;
};

static lq_pack_entry table_entry(const lq_packed *p) {
    const lq_measure *m = &p->measure;
    const char *bends = p->factored ? NULL : lq_texture_bends(&p->texture, m->worst);
    lq_pack_entry entry = {
        .line = p->from->line,
        .bytes = lq_packed_bytes(p),
        .points = m->points,
        .relative = m->relative,
        .rms = m->rms,
        .p99 = m->p99,
        .max = m->max,
        .budget_p99 = p->from->p99,
        .budget_max = p->from->max,
    };
    snprintf(entry.name, sizeof entry.name, "%s", p->from->name);
    snprintf(entry.refine, sizeof entry.refine, "%s", bends ? bends : "");
    return entry;
}

static lq_pack_entry material_entry(const lq_recipe *recipe, const lq_packed_material *p) {
    const lq_lobes_measure *m = &p->measure;
    lq_pack_entry entry = {
        .material = true,
        .line = p->from->line,
        .bytes = lq_image_bytes(&p->lobes.image),
        .points = m->points,
        .rms = m->rms,
        .p99 = m->p99,
        .max = m->max,
        .budget_p99 = recipe->p99,
        .budget_max = recipe->max,
    };
    snprintf(entry.name, sizeof entry.name, "%s", p->from->name);
    return entry;
}

lq_pack_report *lq_report_packing(const lq_packing *packing) {
    const lq_recipe *recipe = packing->recipe;
    lq_pack_report *report = calloc(1, sizeof *report);
    if (!report) return NULL;
    *report = (lq_pack_report){.count = recipe->count + recipe->material_count,
                               .bytes = lq_packing_bytes(packing),
                               .max_bytes = recipe->max_bytes,
                               .atlas = recipe->atlas};
    report->entries = calloc(report->count + 1, sizeof *report->entries);
    if (!report->entries) return free(report), NULL;
    for (size_t i = 0; i < recipe->count; i++) report->entries[i] = table_entry(&packing->tables[i]);
    for (size_t i = 0; i < recipe->material_count; i++)
        report->entries[recipe->count + i] = material_entry(recipe, &packing->materials[i]);
    return report;
}

static void say_miss(const lq_pack_entry *e, const char *recipe, char *text, size_t size) {
    char asked[64] = "";
    if (isfinite(e->budget_p99)) lq_print(asked, sizeof asked, " p99 %.3g", e->budget_p99);
    if (isfinite(e->budget_max))
        lq_print(asked + strlen(asked), 32, "%s max %.3g", *asked ? "," : "", e->budget_max);
    lq_print(text, size, "%.200s:%d: %s misses its budget: best reached p99 %.3g, max %.3g; asked%s%s%s",
             recipe, e->line, e->name, e->p99, e->max, asked, *e->refine ? "; refine " : "", e->refine);
}

lq_status lq_report_judge(const lq_pack_report *report, const char *recipe, lq_error *error) {
    char first[LQ_MESSAGE_SIZE], others[LQ_MESSAGE_SIZE] = "";
    size_t missed = 0;
    for (size_t i = 0; i < report->count; i++) {
        const lq_pack_entry *e = &report->entries[i];
        if (e->p99 <= e->budget_p99 && e->max <= e->budget_max) continue;
        if (missed++ > 0) lq_list_add(others, sizeof others, e->name);
        else say_miss(e, recipe, first, sizeof first);
    }
    if (missed > 0)
        return lq_fail(error, LQ_NOT_CONVERGED, "%s%s%s", first, missed > 1 ? "; so do " : "", others);
    if (report->max_bytes == 0 || report->bytes <= report->max_bytes) return LQ_OK;
    return lq_fail(error, LQ_NOT_CONVERGED, "%s: the textures take %zu bytes; asked are at most %zu", recipe,
                   report->bytes, report->max_bytes);
}

size_t lq_pack_report_count(const lq_pack_report *report) {
    return report->count;
}

const lq_pack_entry *lq_pack_report_entry(const lq_pack_report *report, size_t i) {
    return i < report->count ? &report->entries[i] : NULL;
}

size_t lq_pack_report_bytes(const lq_pack_report *report, bool *atlas) {
    if (atlas) *atlas = report->atlas;
    return report->bytes;
}

void lq_pack_report_free(lq_pack_report *report) {
    if (report) free(report->entries);
    free(report);
}

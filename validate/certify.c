/* certify.c - lq_certify: what is at the path is read, each table of it is certified, then what they owe each
 * other. */
#include "validate/certify.h"

#include "pack/measure.h"
#include "system/extend.h"
#include "system/status.h"
#include "validate/certificate_pack.h"
#include "validate/report.h"

#include <dirent.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* The rule for one table; the domain asked for goes before the ranges of the budgets. */
static lq_rule rule_for(const lq_certifying *asked, const char *name, const char *kind) {
    lq_rule rule = *lq_budgets_rule(&asked->budgets, name, kind);
    if (asked->domain.range_count > 0) {
        rule.range_count = asked->domain.range_count;
        memcpy(rule.ranges, asked->domain.ranges, sizeof rule.ranges);
    }
    return rule;
}

/* The subject is read. `own`: the budget it came with, for where none was asked for. */
static lq_status certify(const lq_certifying *asked, const lq_rule *own, lq_certified *certified,
                         lq_error *error) {
    const char *kind = certified->subject.origin.kind->id;
    lq_rule rule = rule_for(asked, certified->subject.name, kind);
    if (own && !asked->has_budget) rule.budget = own->budget;
    if (own && rule.range_count == 0) {
        rule.range_count = own->range_count;
        memcpy(rule.ranges, own->ranges, sizeof rule.ranges);
    }
    const lq_judging judging = {.rule = rule,
                                .points = asked->points,
                                .tolerance = asked->tolerance,
                                .seed = asked->seed,
                                .threads = asked->threads};
    lq_step step;
    lq_step_begin(&step, &asked->watch, certified->subject.name);
    const lq_status status = lq_certified_make(certified, &judging, &step.progress, error);
    lq_step_end(&step);
    return status;
}

static lq_status certify_file(const lq_certifying *asked, const char *path, lq_certified *certified,
                              lq_error *error) {
    lq_subject *s = &certified->subject;
    lq_status status = lq_subject_read(s, path, &asked->trust, error);
    if (status == LQ_OK && asked->table)
        status = s->factored ? lq_subject_add_table(s, asked->table, &asked->trust, error)
                             : lq_fail(error, LQ_BAD_INPUT,
                                       "the table of factors needs a factor file; '%.200s' is a table", path);
    return status == LQ_OK ? certify(asked, NULL, certified, error) : status;
}

/* ======================================================================================
 *                                        Folders
 * ====================================================================================== */

static int is_archive(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > 4 && strcmp(entry->d_name + length - 4, ".exr") == 0 && entry->d_name[0] != '.';
}

static bool is_folder(const char *path) {
    struct stat facts;
    return stat(path, &facts) == 0 && S_ISDIR(facts.st_mode);
}

static lq_status make_room(lq_certificates *made, size_t count, lq_error *error) {
    made->tables = calloc(count, sizeof *made->tables);
    return made->tables ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "out of memory");
}

/* Every table of the folder, and what they owe each other. */
static lq_status certify_folder(const lq_certifying *asked, const char *folder, lq_certificates *made,
                                lq_error *error) {
    struct dirent **entries;
    const int found = scandir(folder, &entries, is_archive, alphasort);
    lq_status status = found > 0 ? make_room(made, (size_t)found, error)
                                 : lq_fail(error, LQ_BAD_INPUT,
                                           "no table in the folder '%.300s'; accepted: EXR files of lacquer "
                                           "precompute and lacquer pca",
                                           folder);
    for (int i = 0; i < found; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        if (status == LQ_OK) status = certify_file(asked, path, &made->tables[made->count++], error);
        free(entries[i]);
    }
    if (found >= 0) free(entries);
    if (status == LQ_OK) lq_check_pack(made->tables, made->count);
    return status;
}

/* What the manifest promises: errors within the budget, for mu, alpha and tau from LQ_MEASURE_FROM up. */
static lq_rule promise(const lq_shipped *shipped) {
    static const char *const bounded[] = {"mu", "alpha", "tau"};
    lq_rule rule = {.range_count = 0};
    if (isfinite(shipped->p99)) rule.budget.bound[LQ_NORM_P99] = shipped->p99;
    if (isfinite(shipped->max)) rule.budget.bound[LQ_NORM_MAX] = shipped->max;
    for (size_t i = 0; i < 3; i++) {
        lq_range *range = &rule.ranges[rule.range_count++];
        *range = (lq_range){.min = LQ_MEASURE_FROM, .max = 1.0};
        snprintf(range->axis, sizeof range->axis, "%s", bounded[i]);
    }
    return rule;
}

/* What the factors of a pack were made from, where they are factors. */
static lq_status make_table(const lq_certifying *asked, const lq_shipped *shipped, lq_certified *certified,
                            lq_error *error) {
    lq_subject *s = &certified->subject;
    lq_step step;
    char label[300];
    if (!s->factored || shipped->axes[0].size == 0) return LQ_OK;
    snprintf(label, sizeof label, "%s, its table", s->name);
    lq_step_begin(&step, &asked->watch, label);
    const lq_status status = lq_subject_make_table(s, shipped->axes, &step.progress, error);
    lq_step_end(&step);
    return status;
}

static lq_status certify_shipped(const lq_certifying *asked, lq_shipped *shipped, lq_certified *certified,
                                 lq_error *error) {
    const lq_rule own = promise(shipped);
    lq_status status = lq_subject_ship(&certified->subject, shipped, &asked->trust, error);
    if (status == LQ_OK && asked->parts) status = make_table(asked, shipped, certified, error);
    return status == LQ_OK ? certify(asked, &own, certified, error) : status;
}

static lq_status certify_pack(const lq_certifying *asked, const char *folder, lq_certificates *made,
                              lq_error *error) {
    lq_pack pack;
    lq_status status = lq_pack_read(&pack, folder, error);
    if (status != LQ_OK) return status;
    snprintf(made->name, sizeof made->name, "%s", pack.name);
    status = lq_certify_materials(asked, &pack, made, error);
    if (status == LQ_OK) status = make_room(made, pack.count, error);
    for (size_t i = 0; i < pack.count && status == LQ_OK; i++)
        status = certify_shipped(asked, &pack.tables[i], &made->tables[made->count++], error);
    lq_pack_free(&pack);
    if (status == LQ_OK) lq_check_pack(made->tables, made->count);
    return status;
}

/* The last part of a path; a pack has a name of its own. */
static void name_by_path(lq_certificates *made, const char *path) {
    const char *last = strrchr(path, '/');
    snprintf(made->name, sizeof made->name, "%s", last && last[1] ? last + 1 : path);
}

lq_status lq_certify_read(const lq_certifying *asked, const char *path, lq_certificates **made,
                          lq_error *error) {
    lq_certificates *m = *made = calloc(1, sizeof *m);
    if (!m) return lq_fail(error, LQ_NO_MEMORY, "out of memory");
    name_by_path(m, path);
    if (is_folder(path) && asked->table)
        return lq_fail(error, LQ_BAD_INPUT, "the table of factors needs a factor file; '%.200s' is a folder",
                       path);
    if (is_folder(path) && lq_pack_found(path)) return certify_pack(asked, path, m, error);
    if (is_folder(path)) return certify_folder(asked, path, m, error);
    lq_status status = make_room(m, 1, error);
    if (status == LQ_OK) m->count = 1;
    return status == LQ_OK ? certify_file(asked, path, m->tables, error) : status;
}

/* ======================================================================================
 *                                  What the header declares
 * ====================================================================================== */

lq_certify_options lq_certify_options_default(void) {
    return (lq_certify_options){.struct_size = sizeof(lq_certify_options), .seed = 1};
}

static lq_status read_options(lq_certifying *asked, const lq_certify_options *given, lq_error *error) {
    const size_t first = offsetof(lq_certify_options, watch) + sizeof given->watch;
    lq_certify_options o = lq_certify_options_default();
    lq_status status = given ? lq_extend(&o, sizeof o, given, first, "certify options", error) : LQ_OK;
    if (status != LQ_OK) return status;
    *asked = (lq_certifying){.has_budget = o.budget || o.budget_file,
                             .budgets = {.count = 1},
                             .table = o.table,
                             .parts = o.parts,
                             .points = o.points,
                             .tolerance = o.tolerance,
                             .seed = o.seed,
                             .threads = o.threads,
                             .trust = o.trust};
    if (o.budget && o.budget_file)
        return lq_fail(error, LQ_BAD_INPUT, "a budget and a file of budgets; accepted is one of them");
    if (o.budget) status = lq_budget_parse(&asked->budgets.rules[0].budget, o.budget, error);
    if (o.budget_file) status = lq_budgets_read(&asked->budgets, o.budget_file, error);
    if (status == LQ_OK && o.domain) status = lq_ranges_parse(&asked->domain, o.domain, error);
    return status == LQ_OK ? lq_watch_read(&asked->watch, o.watch, error) : status;
}

lq_status lq_certify(const char *path, const lq_certify_options *options, lq_certificates **certificates,
                     lq_error *error) {
    lq_certifying asked;
    lq_error own = {""};
    *certificates = NULL;
    if (!error) error = &own;
    lq_status status = read_options(&asked, options, error);
    if (status == LQ_OK) status = lq_certify_read(&asked, path, certificates, error);
    if (status == LQ_OK) return LQ_OK;
    lq_certificates_free(*certificates);
    *certificates = NULL;
    return status;
}

void lq_certificates_free(lq_certificates *c) {
    if (!c) return;
    for (size_t i = 0; i < c->count; i++) lq_certified_free(&c->tables[i]);
    free(c->tables);
    free(c->materials);
    free(c);
}

size_t lq_certificates_count(const lq_certificates *c) {
    return c->count + c->material_count;
}

static lq_certificate of_table(const lq_certified *t) {
    const lq_sampled *s = &t->certificate;
    return (lq_certificate){.name = t->subject.name,
                            .kind = s->request.kind,
                            .passed = !lq_certified_failure(t),
                            .points = s->points * (size_t)s->request.kind->channel_count,
                            .relative = s->request.relative,
                            .rms = s->total.rms,
                            .p99 = s->total.p99,
                            .max = s->max,
                            .p99_limit = s->total.p99_limit,
                            .estimate = s->estimate,
                            .check_count = (size_t)t->check_count,
                            .checks = t->checks,
                            .failure = lq_certified_failure(t)};
}

static lq_certificate of_material(const lq_certified_material *m) {
    return (lq_certificate){.name = m->name,
                            .passed = !lq_material_failure(m),
                            .points = m->measure.points,
                            .rms = m->measure.rms,
                            .p99 = m->measure.p99,
                            .max = m->measure.max,
                            .p99_limit = INFINITY};
}

bool lq_certificates_get(const lq_certificates *c, size_t i, lq_certificate *certificate) {
    if (i >= lq_certificates_count(c)) return false;
    *certificate = i < c->count ? of_table(&c->tables[i]) : of_material(&c->materials[i - c->count]);
    return true;
}

static lq_report report_of(const lq_certificates *c, const char *date) {
    return (lq_report){c->name, date ? date : "", c->count, c->tables, c->material_count, c->materials};
}

bool lq_certificates_passed(const lq_certificates *c) {
    const lq_report report = report_of(c, NULL);
    return lq_report_failures(&report) == 0;
}

lq_status lq_certificates_json(const lq_certificates *c, char **text, lq_error *error) {
    const lq_report report = report_of(c, NULL);
    return lq_report_json(&report, text, error);
}

lq_status lq_certificates_junit(const lq_certificates *c, const char *path, lq_error *error) {
    const lq_report report = report_of(c, NULL);
    return lq_report_junit(&report, path, error);
}

lq_status lq_certificates_page(const lq_certificates *c, const char *folder, const char *date,
                               lq_error *error) {
    const lq_report report = report_of(c, date);
    return lq_report_html(&report, folder, error);
}

/* Certificates as JSON: docs/certificates.md lists the members. */
#include "validate/report.h"

#include "system/json.h"
#include "system/status.h"
#include "validate/certificate_confidence.h"

#include <math.h>
#include <stdlib.h>

static json_t *point_json(const lq_kind *kind, const double *at) {
    json_t *root = json_object();
    for (int a = 0; a < kind->axis_count; a++) lq_json_set(&root, kind->axes[a].name, lq_json_number(at[a]));
    return root;
}

static json_t *figures_json(const lq_sampled *c, const lq_figures *f) {
    const size_t axes = (size_t)c->request.kind->axis_count;
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "max", lq_json_number(f->max), "p99",
                     lq_json_number(f->p99), "p99_limit", lq_json_number(f->p99_limit), "rms",
                     lq_json_number(f->rms), "mean", lq_json_number(f->mean), "bias", lq_json_number(f->bias),
                     "effective_points", lq_json_number(f->effective), "worst",
                     point_json(c->request.kind, c->at + f->worst % c->points * axes));
}

static json_t *stages_json(const lq_sampled *c) {
    json_t *list = json_array();
    for (int s = 0; s < c->request.stage_count; s++)
        for (int k = 0; k < c->request.kind->channel_count; k++)
            lq_json_append(&list,
                           json_pack("{s:s, s:s, s:s, s:o, s:o}", "stage", c->request.stages[s].name,
                                     "channel", c->request.kind->channels[k], "part",
                                     c->request.stages[s].part, "error", figures_json(c, &c->error[s][k]),
                                     "difference", figures_json(c, &c->part[s][k])));
    return list;
}

static json_t *domain_json(const lq_sampled *c) {
    json_t *root = json_object();
    for (int a = 0; a < c->request.kind->axis_count; a++)
        lq_json_set(&root, c->request.kind->axes[a].name,
                    json_pack("[f, f]", c->request.domain.min[a], c->request.domain.max[a]));
    return root;
}

static json_t *found_json(const lq_sampled *c) {
    json_t *root = point_json(c->request.kind, c->found.at);
    lq_json_set(&root, "decoded", lq_json_number(c->found.decoded));
    lq_json_set(&root, "exact", lq_json_number(c->found.exact));
    lq_json_set(&root, "error", lq_json_number(c->found.error));
    lq_json_set(&root, "evaluations", json_integer((json_int_t)c->found.evaluations));
    return root;
}

static json_t *checks_json(const lq_certified *certified) {
    static const char *const words[] = {[LQ_PASSED] = "passed", [LQ_FAILED] = "failed", [LQ_NOTED] = "noted"};
    json_t *list = json_array();
    for (int i = 0; i < certified->check_count; i++) {
        const lq_check *check = &certified->checks[i];
        lq_json_append(&list,
                       json_pack("{s:o, s:s, s:o, s:o, s:o}", "check", lq_json_text(check->name), "outcome",
                                 words[check->outcome], "value", lq_json_number(check->value), "limit",
                                 lq_json_number(check->limit), "detail", lq_json_text(check->detail)));
    }
    return list;
}

static json_t *certified_json(const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const lq_check *failed = lq_certified_failure(certified);
    json_t *root = json_pack("{s:o, s:s, s:o, s:o, s:I, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:b}", "file",
                             lq_json_text(certified->subject.name), "table", c->request.kind->id, "ndf",
                             lq_json_text(certified->subject.origin.settings.ndf), "domain", domain_json(c),
                             "points", (json_int_t)(c->points * (size_t)c->request.kind->channel_count),
                             "blocks", (json_int_t)c->plan.count, "seed", (json_int_t)c->request.seed,
                             "solver_error", lq_json_number(c->estimate), "total", figures_json(c, &c->total),
                             "stages", stages_json(c), "search", found_json(c), "unseen_share",
                             lq_json_number(c->unseen), "checks", checks_json(certified), "passed", !failed);
    if (certified->integration.count > 0)
        lq_json_set(&root, "integration",
                    json_pack("{s:I, s:o, s:o}", "entries", (json_int_t)certified->integration.count, "max",
                              lq_json_number(certified->integration.max), "rms",
                              lq_json_number(certified->integration.rms)));
    lq_json_set(&root, "complaint", failed ? lq_json_text(failed->name) : json_null());
    return root;
}

static json_t *bounds_json(const lq_budget *budget) {
    json_t *root = json_object();
    for (int n = 0; n < LQ_NORMS; n++)
        if (budget->bound[n] > 0.0 && isfinite(budget->bound[n]))
            lq_json_set(&root, lq_norm_name((lq_norm)n), lq_json_number(budget->bound[n]));
    return root;
}

static json_t *material_json(const lq_certified_material *m) {
    const char *failure = lq_material_failure(m);
    json_t *worst = json_pack("{s:o}", "mu", lq_json_number(m->measure.worst[0]));
    for (int r = 0; r < m->range_count; r++)
        lq_json_set(&worst, m->ranges[r], lq_json_number(m->measure.worst[1 + r]));
    return json_pack("{s:o, s:I, s:o, s:o, s:o, s:o, s:o, s:b, s:o}", "material", lq_json_text(m->name),
                     "points", (json_int_t)m->measure.points, "max", lq_json_number(m->measure.max), "p99",
                     lq_json_number(m->measure.p99), "rms", lq_json_number(m->measure.rms), "worst", worst,
                     "budget", bounds_json(&m->budget), "passed", !failure, "complaint",
                     failure ? lq_json_text(failure) : json_null());
}

lq_status lq_report_json(const lq_report *report, char **text, lq_error *error) {
    json_t *tables = json_array(), *materials = json_array();
    for (size_t i = 0; i < report->count; i++) lq_json_append(&tables, certified_json(&report->list[i]));
    for (size_t i = 0; i < report->material_count; i++)
        lq_json_append(&materials, material_json(&report->materials[i]));
    json_t *root = json_pack("{s:o, s:f, s:b, s:o, s:o}", "name", lq_json_text(report->name), "confidence",
                             LQ_CONFIDENCE, "passed", lq_report_failures(report) == 0, "tables", tables,
                             "materials", materials);
    *text = lq_json_dump(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9));
    return *text ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for a report");
}

/* certify_print.c - a certificate as text. */
#include "program/validate/certify.h"

#include "validate/certificate_confidence.h"

#include <math.h>
#include <stdio.h>

static void print_head(const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const lq_kind *kind = c->request.kind;
    char what[128];
    lq_origin_describe(kind, &certified->subject.origin.settings, what, sizeof what);
    printf("%s: %s\n", certified->subject.name, what);
    printf("  domain      ");
    for (int a = 0; a < kind->axis_count; a++)
        printf("%s %g to %g%s", kind->axes[a].name, c->request.domain.min[a], c->request.domain.max[a],
               a + 1 < kind->axis_count ? ", " : "\n");
    printf("  points      %zu exact values in %zu independent blocks, seed %llu, solver error <= %.1e\n",
           c->points * (size_t)kind->channel_count, c->plan.count, (unsigned long long)c->request.seed,
           c->estimate);
}

static void print_figures(const char *name, const lq_figures *f) {
    printf("  %-18s %9.2e %9.2e %9.2e %+9.1e", name, f->max, f->p99, f->rms, f->bias);
    if (isfinite(f->p99_limit)) printf("  %9.2e\n", f->p99_limit);
    else printf("  not settled\n");
}

static void print_errors(const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    printf("\n  %-18s %9s %9s %9s %9s  %s\n", "decoded - exact", "max", "p99", "rms", "bias", "p99 (95 %)");
    for (int s = 0; s < c->request.stage_count; s++)
        for (int k = 0; k < c->request.kind->channel_count; k++) {
            char name[64];
            snprintf(name, sizeof name, c->request.kind->channel_count > 1 ? "%s, %s" : "%s",
                     c->request.stages[s].name, c->request.kind->channels[k]);
            print_figures(name, &c->error[s][k]);
        }
    printf("\n  %-18s %9s %9s %9s %9s\n", "part of the error", "max", "p99", "rms", "bias");
    printf("  %-18s %9.1e (largest estimate of the exact values)\n", "solver", c->estimate);
    if (certified->integration.count > 0)
        printf("  %-18s %9.2e %9s %9.2e           (%zu stored entries)\n", "integration",
               certified->integration.max, "", certified->integration.rms, certified->integration.count);
    for (int s = 0; s < c->request.stage_count; s++) {
        const lq_figures *f = &c->part[s][0];
        printf("  %-18s %9.2e %9.2e %9.2e %+9.1e\n", c->request.stages[s].part, f->max, f->p99, f->rms,
               f->bias);
    }
}

static void print_confidence(const lq_sampled *c) {
    char at[160];
    lq_point_text(c->request.kind, c->found.at, at, sizeof at);
    printf("\n  confidence  p99 rests on %.0f points worth of independence; with 95 %% confidence at most\n"
           "              %.2g %% of the domain is off by more than the sampled max\n",
           c->total.effective, 100.0 * c->unseen);
    printf("  search      %.3e at %s: decoded %.7f, exact %.7f\n", c->found.error, at, c->found.decoded,
           c->found.exact);
    printf("              (%zu more exact values from the %zu worst blocks)\n\n", c->found.evaluations,
           c->request.starts);
}

static void print_checks(const lq_certified *certified) {
    static const char *const words[] = {[LQ_PASSED] = "passed", [LQ_FAILED] = "FAILED", [LQ_NOTED] = "noted"};
    for (int i = 0; i < certified->check_count; i++) {
        const lq_check *check = &certified->checks[i];
        printf("  %s  %-18s %9.2e", words[check->outcome], check->name, check->value);
        if (isnan(check->limit)) printf("             ");
        else printf(" <= %9.2e", check->limit);
        printf("  %s\n", check->detail);
    }
    const lq_check *failed = lq_certified_failure(certified);
    printf("\n%s%s\n\n", failed ? "FAILED: " : "passed", failed ? failed->name : "");
}

void certify_print_text(const lq_certified *certified) {
    print_head(certified);
    print_errors(certified);
    print_confidence(&certified->certificate);
    print_checks(certified);
}

static void print_material(const lq_certified_material *m) {
    char at[160];
    lq_material_worst(m, at, sizeof at);
    printf("  %-6s  %-20s %6zu %9.2e %9.2e %9.2e  at %s\n", lq_material_failure(m) ? "FAILED" : "passed",
           m->name, m->measure.points, m->measure.rms, m->measure.p99, m->measure.max, at);
}

void certify_print_materials(const lq_certificates *made) {
    printf("materials: energies and roughness against the exact stack, mu >= %g\n"
           "  %-6s  %-20s %6s %9s %9s %9s\n",
           LQ_MATERIAL_FROM, "", "material", "points", "rms", "p99", "max");
    for (size_t i = 0; i < made->material_count; i++) print_material(&made->materials[i]);
    putchar('\n');
}

/* report_table.c - the section of one table on a certificate's page. */
#include "picture/document.h"
#include "picture/text.h"
#include "validate/report_maps.h"
#include "validate/report_parts.h"
#include "validate/report_ranks.h"

#include <math.h>

/* ======================================================================================
 *                                         Tables
 * ====================================================================================== */

static void put_figures(FILE *out, const char *name, const char *channel, const lq_figures *f) {
    fprintf(
        out,
        "<tr><td>%s%s%s</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%+.1e</td>"
        "</tr>\n",
        name, *channel ? ", " : "", channel, f->max, f->p99, f->p99_limit, f->rms, f->mean, f->bias);
}

static void put_errors(FILE *out, const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const int channels = c->request.kind->channel_count;
    const char *head =
        "<th>max</th><th>p99</th><th>p99, 95 %</th><th>rms</th><th>mean</th><th>bias</th></tr>\n";
    fprintf(out, "<div class=\"wide\"><table><tr><th>decoded &minus; exact</th>%s", head);
    for (int s = 0; s < c->request.stage_count; s++)
        for (int k = 0; k < channels; k++)
            put_figures(out, c->request.stages[s].name, channels > 1 ? c->request.kind->channels[k] : "",
                        &c->error[s][k]);
    fprintf(out, "<tr><th>part of the error</th>%s", head);
    if (certified->integration.count > 0)
        fprintf(out,
                "<tr><td>integration (%zu entries)</td><td>%.2e</td><td></td><td></td><td>%.2e</td></tr>\n",
                certified->integration.count, certified->integration.max, certified->integration.rms);
    for (int s = 0; s < c->request.stage_count; s++)
        for (int k = 0; k < channels; k++)
            put_figures(out, c->request.stages[s].part, channels > 1 ? c->request.kind->channels[k] : "",
                        &c->part[s][k]);
    lq_document_table_end(out);
}

static void put_checks(FILE *out, const lq_certified *certified) {
    static const char *const heads[] = {"check", "result", "value", "limit", ""};
    lq_document_table(out, heads, 5);
    for (int i = 0; i < certified->check_count; i++) {
        const lq_check *check = &certified->checks[i];
        fprintf(out, "<tr><td>%s</td><td class=\"%s\">%s</td><td>%.2e</td>", check->name,
                lq_report_word(check->outcome), lq_report_word(check->outcome), check->value);
        if (isnan(check->limit)) fputs("<td></td>", out);
        else fprintf(out, "<td>%.2e</td>", check->limit);
        fputs("<td class=\"text\">", out);
        lq_text_put(out, check->detail);
        fputs("</td></tr>\n", out);
    }
    lq_document_table_end(out);
}

static lq_status put_ranks(FILE *out, const lq_certified *certified, lq_error *error) {
    lq_rank ranks[LQ_RANKS_MAX];
    const size_t count = lq_ranks(certified, ranks);
    if (count < 2) return LQ_OK;
    static const char *const heads[] = {"terms", "bytes", "max", "p99", "rms"};
    lq_document_heading(out, 3, NULL, "What each term buys");
    lq_document_table(out, heads, 5);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "<tr><td>%zu</td><td>%zu</td><td>%.2e</td><td>%.2e</td><td>%.2e</td></tr>\n",
                ranks[i].terms, ranks[i].bytes, ranks[i].max, ranks[i].p99, ranks[i].rms);
    lq_document_table_end(out);
    return lq_report_ranks(ranks, count, out, error);
}

/* ======================================================================================
 *                                         Section
 * ====================================================================================== */

static void put_summary(FILE *out, const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    const lq_check *failed = lq_certified_failure(certified);
    char at[160];
    lq_point_text(c->request.kind, lq_report_worst(c), at, sizeof at);
    fprintf(out, "<p><b class=\"%s\">%s</b>", failed ? "failed" : "passed", failed ? "Failed" : "Passed");
    if (failed) {
        fputs(": ", out);
        lq_text_put(out, failed->name);
        fputs(", ", out);
        lq_text_put(out, failed->detail);
    }
    fprintf(out, ". Worst %.2e at %s; 99 %% of the points within %.2e, rms %.2e.</p>\n", c->max, at,
            c->total.p99, c->total.rms);
}

static void put_method(FILE *out, const lq_certified *certified) {
    const lq_sampled *c = &certified->certificate;
    char what[128], at[160];
    lq_origin_describe(c->request.kind, &certified->subject.origin.settings, what, sizeof what);
    lq_point_text(c->request.kind, c->found.at, at, sizeof at);
    fprintf(out, "<p>%s: ", c->request.kind->title);
    lq_text_put(out, what);
    fputs(". Domain", out);
    for (int a = 0; a < c->request.kind->axis_count; a++)
        fprintf(out, "%s %s %g to %g", a ? "," : "", c->request.kind->axes[a].name, c->request.domain.min[a],
                c->request.domain.max[a]);
    fprintf(
        out,
        ". %zu exact values (solver error at most %.1e) in %zu independent blocks, seed %llu; p99 rests on "
        "the "
        "worth of %.0f independent points. With 95 %% confidence at most %.2g %% of the domain is off by "
        "more "
        "than the largest error of the sample. The search from the worst points, %zu more values, found %.3e "
        "at %s: decoded %.7f, exact %.7f.</p>\n",
        c->points * (size_t)c->request.kind->channel_count, c->estimate, c->plan.count,
        (unsigned long long)c->request.seed, c->total.effective, 100.0 * c->unseen, c->found.evaluations,
        c->found.error, at, c->found.decoded, c->found.exact);
}

lq_status lq_report_table(FILE *out, const lq_certified *certified, size_t number, lq_error *error) {
    fprintf(out, "<section class=\"part\"><h2 id=\"t%zu\">", number);
    lq_text_put(out, certified->subject.name);
    fputs("</h2>\n", out);
    put_summary(out, certified);
    fputs("<p class=\"soft\">Largest error in each cell, over every pair of axes; the ring is the worst "
          "point.</p>\n",
          out);
    lq_status status = lq_report_maps(certified, out, error);
    fprintf(out, "<details%s><summary>Judgements</summary>\n",
            lq_certified_failure(certified) ? " open" : "");
    put_checks(out, certified);
    fputs("</details>\n<details><summary>Errors by step, and their distribution</summary>\n", out);
    put_method(out, certified);
    put_errors(out, certified);
    if (status == LQ_OK) status = lq_report_histogram(&certified->certificate, out, error);
    if (status == LQ_OK) status = put_ranks(out, certified, error);
    fputs("</details>\n</section>\n", out);
    return status;
}

/* The page of a certificate: one file that needs no other, readable without scripts. */
#include "validate/report.h"

#include "picture/text.h"
#include "system/status.h"
#include "system/stream.h"
#include "validate/report_maps.h"
#include "validate/report_ranks.h"

#include <math.h>
#include <unistd.h>

static const char style[] =
    "body{font:15px/1.5 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;margin:2em "
    "auto;max-width:60em;"
    "padding:0 1em;background:#fcfcfb;color:#1a1a19}\n"
    "table{border-collapse:collapse;margin:1em 0;font-variant-numeric:tabular-nums}\n"
    "th,td{padding:.2em .8em;text-align:right;border-bottom:1px solid #e6e5e0}"
    "th:first-child,td:first-child,td.text{text-align:left}\n"
    ".passed{color:#0f6b4f}.failed{color:#b3260e;font-weight:600}.noted{color:#63625e}\n"
    ".maps{display:flex;flex-wrap:wrap;gap:1em}h2{margin-top:2.5em;border-top:2px solid #8f8e88}\n"
    "svg{max-width:100%;height:auto}.map text{font-size:12px}\n"
    "@media (prefers-color-scheme:dark){body{background:#1a1a19;color:#f4f3ef}th,td{border-color:#33332f}"
    ".passed{color:#35b78f}.failed{color:#f0824f}.noted{color:#b3b2ab}.ink{fill:#f4f3ef}.soft{fill:#b3b2ab}}"
    "\n";

static const char *word(lq_outcome outcome) {
    return outcome == LQ_PASSED ? "passed" : outcome == LQ_FAILED ? "failed" : "noted";
}

/* ------------------------------------------------------------------------------------ the tables */

static void put_summary(FILE *out, const lq_certified *list, size_t count) {
    fputs("<table><tr><th>table</th><th>kind</th><th>max</th><th>p99</th><th>rms</th><th>points</th>"
          "<th>result</th></tr>\n",
          out);
    for (size_t i = 0; i < count; i++) {
        const lq_sampled *c = &list[i].certificate;
        const lq_check *failed = lq_certified_failure(&list[i]);
        fprintf(out, "<tr><td><a href=\"#t%zu\">", i);
        lq_text_put(out, list[i].subject.name);
        fprintf(out,
                "</a></td><td class=\"text\">%s</td><td>%.2e</td><td>%.2e</td><td>%.2e</td><td>%zu</td>"
                "<td class=\"%s\">%s%s</td></tr>\n",
                c->request.kind->id, c->max, c->total.p99, c->total.rms, c->points,
                failed ? "failed" : "passed", failed ? "failed: " : "passed", failed ? failed->name : "");
    }
    fputs("</table>\n", out);
}

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
    fprintf(out, "<table><tr><th>decoded &minus; exact</th>%s", head);
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
    fputs("</table>\n", out);
}

static void put_checks(FILE *out, const lq_certified *certified) {
    fputs("<table><tr><th>check</th><th>result</th><th>value</th><th>limit</th><th></th></tr>\n", out);
    for (int i = 0; i < certified->check_count; i++) {
        const lq_check *check = &certified->checks[i];
        fprintf(out, "<tr><td>%s</td><td class=\"%s\">%s</td><td>%.2e</td>", check->name,
                word(check->outcome), word(check->outcome), check->value);
        if (isnan(check->limit)) fputs("<td></td>", out);
        else fprintf(out, "<td>%.2e</td>", check->limit);
        fputs("<td class=\"text\">", out);
        lq_text_put(out, check->detail);
        fputs("</td></tr>\n", out);
    }
    fputs("</table>\n", out);
}

/* ---------------------------------------------------------------------------------- the pictures */

static void put_maps(FILE *out, const lq_sampled *c) {
    const lq_domain *d = &c->request.domain;
    fputs("<h3>Where the errors are</h3>\n<p>Largest error in each cell, over every pair of axes. ", out);
    fputs("<svg class=\"map\" width=\"420\" height=\"34\" viewBox=\"0 0 420 34\" "
          "role=\"img\"><title>scale</title>",
          out);
    for (int i = 0; i < 9; i++)
        fprintf(out, "<rect class=\"e%d\" x=\"%d\" y=\"0\" width=\"46\" height=\"14\"/>", i, 46 * i);
    for (int i = 0; i < 4; i++)
        fprintf(out, "<text class=\"soft\" x=\"%d\" y=\"29\" text-anchor=\"middle\">1e-%d</text>",
                46 + 92 * i, 5 - i);
    fputs("</svg></p>\n<div class=\"maps\">\n", out);
    for (int y = 1; y < c->request.kind->axis_count; y++)
        for (int x = 0; x < y; x++)
            if (d->max[x] > d->min[x] && d->max[y] > d->min[y]) lq_report_map(c, x, y, out);
    fputs("</div>\n", out);
}

static lq_status put_ranks(FILE *out, const lq_certified *certified, lq_error *error) {
    lq_rank ranks[LQ_RANKS_MAX];
    const size_t count = lq_ranks(certified, ranks);
    if (count < 2) return LQ_OK;
    fputs("<h3>What each term buys</h3>\n<table><tr><th>terms</th><th>bytes</th><th>max</th><th>p99</th>"
          "<th>rms</th></tr>\n",
          out);
    for (size_t i = 0; i < count; i++)
        fprintf(out, "<tr><td>%zu</td><td>%zu</td><td>%.2e</td><td>%.2e</td><td>%.2e</td></tr>\n",
                ranks[i].terms, ranks[i].bytes, ranks[i].max, ranks[i].p99, ranks[i].rms);
    fputs("</table>\n", out);
    return lq_report_ranks(ranks, count, out, error);
}

static lq_status put_one(FILE *out, const lq_certified *certified, size_t number, lq_error *error) {
    const lq_sampled *c = &certified->certificate;
    char what[128], at[160];
    lq_origin_describe(c->request.kind, &certified->subject.origin.settings, what, sizeof what);
    lq_point_text(c->request.kind, c->found.at, at, sizeof at);
    fprintf(out, "<h2 id=\"t%zu\">", number);
    lq_text_put(out, certified->subject.name);
    fprintf(out, "</h2>\n<p>%s: ", c->request.kind->title);
    lq_text_put(out, what);
    fputs(". Domain", out);
    for (int a = 0; a < c->request.kind->axis_count; a++)
        fprintf(out, "%s %s %g to %g", a ? "," : "", c->request.kind->axes[a].name, c->request.domain.min[a],
                c->request.domain.max[a]);
    fprintf(out,
            ". %zu exact values (solver error at most %.1e) in %zu independent blocks, seed %llu; p99 rests "
            "on the "
            "worth of %.0f independent points. With 95 %% confidence at most %.2g %% of the domain is off by "
            "more "
            "than the largest error of the sample. The search from the worst points, %zu more values, found "
            "%.3e at "
            "%s: decoded %.7f, exact %.7f.</p>\n",
            c->points * (size_t)c->request.kind->channel_count, c->estimate, c->plan.count,
            (unsigned long long)c->request.seed, c->total.effective, 100.0 * c->unseen, c->found.evaluations,
            c->found.error, at, c->found.decoded, c->found.exact);
    put_checks(out, certified);
    put_errors(out, certified);
    put_maps(out, c);
    const lq_status status = lq_report_histogram(c, out, error);
    return status == LQ_OK ? put_ranks(out, certified, error) : status;
}

static lq_status put_page(FILE *out, const lq_certified *list, size_t count, lq_error *error) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>lacquer "
          "certificate</title>\n<style>\n",
          out);
    fprintf(out, "%s%s</style></head><body>\n<h1>Certificate</h1>\n<p>lacquer " LQ_VERSION "</p>\n", style,
            lq_report_map_style);
    put_summary(out, list, count);
    lq_status status = LQ_OK;
    for (size_t i = 0; status == LQ_OK && i < count; i++) status = put_one(out, &list[i], i, error);
    fputs("</body></html>\n", out);
    return status;
}

static lq_status save_page(const lq_certified *list, size_t count, const char *folder, lq_error *error) {
    char path[4096];
    lq_stream stream;
    if ((size_t)snprintf(path, sizeof path, "%s/index.html", folder) >= sizeof path)
        return lq_fail(error, LQ_BAD_INPUT, "the name of the report's folder is too long");
    const lq_status opened = lq_stream_open(&stream, path, error);
    if (opened != LQ_OK) return opened;
    return lq_stream_close(&stream, put_page(stream.out, list, count, error), error);
}

lq_status lq_report_html(const lq_certified *list, size_t count, const char *folder, lq_error *error) {
    const bool was_there = access(folder, F_OK) == 0;
    lq_status status = lq_output_folder(folder, error);
    if (status != LQ_OK) return status;
    status = save_page(list, count, folder, error);
    if (status != LQ_OK && !was_there) rmdir(folder); /* no stray folder for a page that is not */
    return status;
}

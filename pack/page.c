/* page.c - the page of a pack: verdict, stage, functions, how to use them. stage.js draws. */
#include "pack/page.h"

#include "pack/contents.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "picture/document.h"
#include "picture/page_parts.h"
#include "picture/text.h"
#include "system/draft.h"
#include "system/output.h"
#include "system/status.h"

extern const char lq_stage_script[];

/* ======================================================================================
 *                                       Reference
 * ====================================================================================== */

/* The same materials from finer texels: an atlas and source of their own. */
typedef struct reference {
    lq_atlas atlas;
    lq_atlas_material materials[LQ_RECIPE_MATERIALS];
    lq_atlas_table albedo;
    size_t albedo_count;
} reference;

static lq_status make_reference(reference *r, const lq_packing *packing, lq_error *error) {
    const lq_recipe *recipe = packing->recipe;
    lq_status status = LQ_OK;
    *r = (reference){.albedo_count = 0};
    for (size_t i = 0; i < recipe->count && status == LQ_OK; i++) {
        const lq_packed *table = &packing->tables[i];
        if (strcmp(table->from->kind->id, "albedo") != 0 || table->factored || r->albedo_count > 0) continue;
        r->albedo = (lq_atlas_table){{table->from->kind, &table->texture, NULL}, 0};
        r->albedo_count = 1;
        status = lq_atlas_add(&r->atlas, &table->texture.image, table->texture.channel_count,
                              table->from->name, &r->albedo.tile, error);
    }
    for (size_t i = 0; i < recipe->material_count && status == LQ_OK; i++) {
        const lq_packed_material *m = &packing->materials[i];
        r->materials[i] = (lq_atlas_material){m->name, &m->reference, 0};
        if (m->reference.channel_count > 0)
            status = lq_atlas_add(&r->atlas, &m->reference.image, LQ_LOBES_PER_TEXEL, m->name,
                                  &r->materials[i].tile, error);
    }
    return status == LQ_OK ? lq_atlas_make(&r->atlas, error) : status;
}

/* ======================================================================================
 *                                        The data
 * ====================================================================================== */

static void put_texels(FILE *out, const char *name, const lq_image *image) {
    fprintf(out, ",\n\"%s\":{\"width\":%zu,\"height\":%zu,\"texels\":", name, image->width, image->height);
    lq_page_values(out, image->data, lq_image_texels(image) * (size_t)image->channels);
    fputc('}', out);
}

static void put_material(FILE *out, const lq_packed_material *m) {
    const lq_material *of = &m->from->material;
    fprintf(out, "{\"name\":\"%s\",\"function\":\"lacquer_%s\",\"ranges\":[", m->from->name, m->name);
    for (int r = 0; r < of->range_count; r++)
        fprintf(out, "%s{\"name\":\"%s\",\"min\":%g,\"max\":%g}", r > 0 ? "," : "", of->ranges[r].name,
                of->ranges[r].min, of->ranges[r].max);
    fputs("],\"rho\":", out);
    if (of->open_rho) fprintf(out, "{\"min\":%g,\"max\":%g}}", of->rho_min, of->rho_max);
    else fputs("null}", out);
}

static void put_data(FILE *out, const lq_packing *packing, const reference *r) {
    const lq_recipe *recipe = packing->recipe;
    fputs("<script type=\"application/json\" id=\"data\">\n{\"max\":", out);
    if (isfinite(recipe->max)) fprintf(out, "%g", recipe->max);
    else fputs("null", out);
    fputs(",\"materials\":[", out);
    for (size_t i = 0; i < recipe->material_count; i++) {
        fputs(i > 0 ? ",\n" : "\n", out);
        put_material(out, &packing->materials[i]);
    }
    fputc(']', out);
    put_texels(out, "atlas", &packing->atlas.image);
    put_texels(out, "reference", &r->atlas.image);
    fputs("}\n</script>\n", out);
}

static lq_status put_source(FILE *out, const char *id, const lq_atlas_contents *contents, lq_error *error) {
    char *text = NULL;
    lq_status status = lq_atlas_source_text(LQ_GLSL, contents, &text, error);
    if (status == LQ_OK)
        fprintf(out, "<script type=\"x-shader/x-fragment\" id=\"%s\">\n%s</script>\n", id, text);
    free(text);
    return status;
}

/* ======================================================================================
 *                                        The page
 * ====================================================================================== */

/* The material with the largest error, of those and tables. */
static void put_verdict(FILE *out, const lq_packing *packing) {
    const lq_recipe *recipe = packing->recipe;
    double worst = 0.0;
    size_t points = 0;
    const char *name = "";
    for (size_t i = 0; i < recipe->material_count; i++) {
        const lq_lobes_measure *m = &packing->materials[i].measure;
        points += m->points;
        if (m->max < worst) continue;
        worst = m->max;
        name = packing->materials[i].from->name;
    }
    fputs("<p class=\"verdict\"><b class=\"passed\">Within its budget</b>", out);
    if (isfinite(recipe->p99)) fprintf(out, ", 99 %% of errors at most %g", recipe->p99);
    if (isfinite(recipe->max)) fprintf(out, ", none above %g", recipe->max);
    fprintf(out,
            ": the largest of %zu points is %.2g, in %s.</p>\n<p>%zu materials in one texture of %zu x %zu "
            "texels, %zu bytes. Made by lacquer " LQ_VERSION
            "; <code>lacquer validate</code> of this folder checks "
            "it anew.</p>\n",
            points, worst, name, recipe->material_count, packing->atlas.image.width,
            packing->atlas.image.height, lq_packing_bytes(packing));
}

static void put_stage(FILE *out) {
    fputs("<div id=\"gallery\"></div>\n<p class=\"note\" id=\"stage-note\" hidden></p>\n<div "
          "id=\"stage\"><figure>"
          "<canvas id=\"view\" width=\"1536\" height=\"512\"></canvas><div class=\"under\"><span>this "
          "pack</span>"
          "<span>the exact stack</span><span>difference of energies × 10</span></div></figure>\n"
          "<div id=\"knobs\"></div></div>\n<noscript><p class=\"note\">The spheres are drawn by a script, "
          "which "
          "does not run.</p></noscript>\n",
          out);
}

static void put_function(FILE *out, const lq_packed_material *m) {
    const lq_material *of = &m->from->material;
    const lq_atlas_material source = {m->name, &m->lobes, 0};
    fprintf(out, "<tr><td><code>lacquer_%s(mu", m->name);
    for (int r = 0; r < of->range_count; r++) fprintf(out, ", %s", of->ranges[r].name);
    fprintf(out, "%s)</code></td><td>", of->open_rho ? ", rho" : "");
    for (int r = 0; r < of->range_count; r++)
        fprintf(out, "%s%s %g to %g", r > 0 ? ", " : "", of->ranges[r].name, of->ranges[r].min,
                of->ranges[r].max);
    fprintf(out,
            "</td><td class=\"number\">%zu</td><td class=\"number\">%zu</td><td class=\"number\">%.1e</td>"
            "<td class=\"number\">%.1e</td><td>mu %.2g",
            lq_image_bytes(&m->lobes.image), lq_atlas_material_fetches(&source), m->measure.p99,
            m->measure.max, m->measure.worst[0]);
    for (int r = 0; r < of->range_count; r++)
        fprintf(out, ", %s %.2g", of->ranges[r].name, m->measure.worst[1 + r]);
    fputs("</td><td>", out);
    if (m->from->source) lq_text_put(out, m->from->source);
    fputs("</td></tr>\n", out);
}

static void put_functions(FILE *out, const lq_packing *packing) {
    fputs("<h2 class=\"apart\">Functions</h2>\n<div "
          "class=\"wide\"><table>\n<tr><th>function</th><th>ranges</th><th>bytes</th>"
          "<th>fetches</th><th>p99</th><th>max</th><th>worst at</th><th>constants from</th></tr>\n",
          out);
    for (size_t i = 0; i < packing->recipe->material_count; i++) put_function(out, &packing->materials[i]);
    fputs("</table></div>\n", out);
}

static void put_use(FILE *out, const lq_packing *packing) {
    const lq_packed_material *m = &packing->materials[0];
    fputs("<h2 class=\"apart\">How to use it</h2>\n<p>Bind the texture <code>atlas</code> with linear "
          "filtering, clamped, "
          "without mip "
          "levels; include the source of your language; ask at the cosine of the "
          "view.</p>\n<pre>LacquerLobes lobes = ",
          out);
    fprintf(out, "lacquer_%s(atlas, mu_view", m->name);
    for (int r = 0; r < m->from->material.range_count; r++)
        fprintf(out, ", %s", m->from->material.ranges[r].name);
    fprintf(
        out,
        "%s);\nvec3 radiance = lacquer_shade(atlas, lobes, mu_view, mu_light, cos_half) * light;</pre>\n<p>",
        m->from->material.open_rho ? ", rho" : "");
    for (int l = 0; l < LQ_LANGUAGES; l++)
        fprintf(out, "%s<a href=\"%s\">%s</a>", l > 0 ? ", " : "", lq_language_file((lq_language)l),
                lq_language_file((lq_language)l));
    fputs(", <a href=\"" LQ_MANIFEST "\">" LQ_MANIFEST "</a></p>\n", out);
}

static lq_status put_page(FILE *out, const lq_packing *packing, const reference *r, lq_error *error) {
    const size_t count = packing->recipe->material_count;
    const lq_atlas_contents finer = {&r->atlas, r->albedo_count, count, &r->albedo, r->materials};
    char *decode = NULL;
    lq_document_begin(out, packing->recipe->name);
    put_verdict(out, packing);
    put_stage(out);
    put_functions(out, packing);
    put_use(out, packing);
    lq_status status = lq_packing_source_text(packing, LQ_GLSL, &decode, error);
    if (status == LQ_OK)
        fprintf(out, "<script type=\"x-shader/x-fragment\" id=\"decode\">\n%s</script>\n", decode);
    free(decode);
    if (status == LQ_OK) status = put_source(out, "reference", &finer, error);
    put_data(out, packing, r);
    fprintf(out, "<script>\n%s</script>\n", lq_stage_script);
    lq_document_end(out);
    return status;
}

lq_status lq_pack_page_write(const lq_packing *packing, const char *path, lq_error *error) {
    reference r;
    lq_draft draft = {.text = NULL};
    lq_status status = make_reference(&r, packing, error);
    FILE *out = status == LQ_OK ? lq_draft_open(&draft) : NULL;
    if (status == LQ_OK && !out) status = lq_fail(error, LQ_NO_MEMORY, "no memory for a page");
    if (status == LQ_OK) status = put_page(out, packing, &r, error);
    if (out && !lq_draft_close(&draft, out) && status == LQ_OK)
        status = lq_fail(error, LQ_NO_MEMORY, "no memory for a page");
    if (status == LQ_OK) status = lq_output_save(path, draft.text, draft.size, error);
    free(draft.text);
    lq_atlas_free(&r.atlas);
    return status;
}

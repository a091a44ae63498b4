/* recipe_pca.c - the "pca" of a recipe's entry: how its table is factored. */
#include "pack/recipe_text.h"

#include "pca/options_text.h"
#include "pca/piece.h"
#include "system/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char pca_keys[] =
    "separate, value, bases, pairs, critical, texels, split, scheme, norm, power, sweeps, "
    "channel, budget, bytes";

/* What a search finds itself. */
static const char *const searched[] = {"separate", "value", "bases", "pairs", "critical", "texels", "scheme"};

/* A text under a key, or NULL where there is none; *status is set where it is no text. */
static const char *text_of(const lq_recipe_reader *r, json_t *pca, const char *key, const char *accepted,
                           lq_status *status) {
    json_t *item = json_object_get(pca, key);
    if (item && !json_is_string(item) && *status == LQ_OK) *status = lq_refuse_value(r, key, accepted);
    return json_string_value(item);
}

static lq_status explain(const lq_recipe_reader *r, const char *key, lq_status status, const lq_error *why) {
    if (status == LQ_OK || status == LQ_NO_MEMORY) return status;
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%d: %s: %s", r->path, lq_recipe_line(r, key), key, why->text);
}

static lq_status read_texts(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table) {
    lq_pca_options *o = &table->pca;
    const int count = table->kind->axis_count;
    lq_status status = LQ_OK;
    lq_error why = {""};
    const char *separate = text_of(r, pca, "separate", "\"tau:2,alpha:4\", \"n+kappa:8\"", &status);
    const char *split = text_of(r, pca, "split", "\"eta=1\"", &status);
    const char *texels = text_of(r, pca, "texels", "\"mu=64,eta=32:sqrt\"", &status);
    const char *bases = text_of(r, pca, "bases", "\"4\", \"4,8\"", &status);
    if (status == LQ_OK && separate)
        status = explain(r, "separate", lq_pca_read_separations(o, separate, table->axes, count, &why), &why);
    if (status == LQ_OK && split)
        status = explain(r, "split", lq_pca_read_split(o, split, table->axes, count, &why), &why);
    if (status == LQ_OK && texels)
        status = explain(r, "texels", lq_pca_read_texels(o, texels, table->axes, count, &why), &why);
    if (status == LQ_OK && bases) status = explain(r, "bases", lq_pca_read_bases(o, bases, &why), &why);
    return status;
}

static lq_status read_choices(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table) {
    static const char *const schemes[] = {"sequential", "joint", NULL},
                             *const values[] = {"plain", "square", "beer", NULL},
                             *const norms[] = {"max", "rms", "p99", NULL};
    static const double powers[] = {8.0, 2.0, 4.0}; /* of the norms: as `lacquer pca` sets them */
    lq_pca_options *o = &table->pca;
    int scheme = (int)o->scheme, value = (int)o->value, norm = LQ_PCA_MAX;
    size_t sweeps = (size_t)o->sweeps;
    lq_status status = lq_recipe_choice(r, pca, "scheme", schemes, &scheme);
    if (status == LQ_OK) status = lq_recipe_choice(r, pca, "value", values, &value);
    if (status == LQ_OK) status = lq_recipe_choice(r, pca, "norm", norms, &norm);
    o->scheme = (lq_scheme)scheme;
    o->value = (lq_value)value;
    o->power = powers[norm];
    table->pca_norm = (lq_pca_norm)norm;
    if (status == LQ_OK) status = lq_recipe_number(r, pca, "power", 2.0, 64.0, &o->power);
    if (status == LQ_OK) status = lq_recipe_count(r, pca, "pairs", 1, 8, &o->pairs);
    if (status == LQ_OK) status = lq_recipe_count(r, pca, "sweeps", 0, 10000, &sweeps);
    if (status == LQ_OK) status = lq_recipe_number(r, pca, "budget", 0x1p-12, 1.0, &table->pca_budget);
    if (status == LQ_OK) status = lq_recipe_count(r, pca, "bytes", 64, (size_t)1 << 40, &table->pca_bytes);
    o->sweeps = (int)sweeps;
    json_t *critical = json_object_get(pca, "critical");
    if (status == LQ_OK && critical && !json_is_boolean(critical))
        return lq_refuse_value(r, "critical", "true, false");
    o->critical = json_is_true(critical);
    return status;
}

static lq_status read_channel(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table) {
    lq_status status = LQ_OK;
    const lq_kind *kind = table->kind;
    const char *name = text_of(r, pca, "channel", "a channel of the table", &status);
    char accepted[LQ_MESSAGE_SIZE] = "";
    for (table->channel = 0; name && table->channel < kind->channel_count; table->channel++) {
        if (strcmp(name, kind->channels[table->channel]) == 0) return LQ_OK;
        lq_list_add(accepted, sizeof accepted, kind->channels[table->channel]);
    }
    return name ? lq_refuse_word(r, "channel", name, accepted) : status;
}

/* Whether a table of these axes can be factored so, before it is there. */
static lq_status check(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table) {
    const bool search = table->pca_budget > 0.0 || table->pca_bytes > 0;
    lq_table shape = {.axis_count = table->kind->axis_count};
    lq_error why = {""};
    memcpy(shape.axes, table->axes, sizeof shape.axes);
    table->pca.value_axis = lq_table_axis(&shape, "tau");
    for (size_t i = 0; search && i < sizeof searched / sizeof *searched; i++)
        if (json_object_get(pca, searched[i]))
            return lq_refuse(
                r, searched[i],
                "budget and bytes search separations, bases, values and texels; leave those out");
    const lq_status status = search ? lq_pca_check_splits(&shape, &table->pca, &why)
                                    : lq_pca_check_options(&shape, &table->pca, &why);
    return explain(r, "pca", status, &why);
}

lq_status lq_recipe_read_pca(const lq_recipe_reader *r, json_t *pca, lq_recipe_table *table) {
    if (!json_is_object(pca))
        return lq_refuse_value(r, "pca", "{\"separate\": \"tau,eta\", \"value\": \"beer\", ...}");
    table->pca = lq_pca_options_default();
    lq_status status = lq_recipe_keys(r, pca, pca_keys);
    if (status == LQ_OK) status = read_choices(r, pca, table);
    if (status == LQ_OK) status = read_texts(r, pca, table);
    if (status == LQ_OK) status = read_channel(r, pca, table);
    if (status == LQ_OK) status = check(r, pca, table);
    if (status != LQ_OK) return status;
    char *text = lq_json_dump(json_incref(pca), JSON_SORT_KEYS | JSON_REAL_PRECISION(9));
    if (!text) return lq_fail(r->error, LQ_NO_MEMORY, "%s: no memory to read it", r->path);
    if (strlen(text) >= sizeof table->pca_text) status = lq_refuse(r, "pca", "pca: more than 511 characters");
    snprintf(table->pca_text, sizeof table->pca_text, "%s", text);
    free(text);
    return status;
}

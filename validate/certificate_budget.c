/* Budgets from text and from JSON; whatever is not understood is refused by name. */
#include "validate/certificate_budget.h"

#include "system/json.h"
#include "system/number.h"
#include "system/status.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *lq_norm_name(lq_norm norm) {
    static const char *const names[LQ_NORMS] = {"max", "p99", "rms", "mean"};
    return norm < LQ_NORMS ? names[norm] : "unknown";
}

static lq_norm norm_of(const char *name, size_t length) {
    lq_norm n = LQ_NORM_MAX;
    while (n < LQ_NORMS && !(strlen(lq_norm_name(n)) == length && !memcmp(name, lq_norm_name(n), length)))
        n++;
    return n;
}

/* ----------------------------------------------------------------------------- command line */

lq_status lq_budget_parse(lq_budget *budget, const char *text, lq_error *error) {
    *budget = (lq_budget){{0.0}};
    for (const char *at = text;; at++) {
        const char *equals = at + strcspn(at, "=,");
        const lq_norm norm = *equals == '=' ? norm_of(at, (size_t)(equals - at)) : LQ_NORM_MAX;
        const char *number = *equals == '=' ? equals + 1 : at;
        char *end;
        const double bound = lq_strtod(number, &end);
        if (norm == LQ_NORMS || end == number || (*end && *end != ',') || !(bound > 0.0 && bound <= 1.0))
            return lq_fail(error, LQ_BAD_INPUT,
                           "budget '%s' is not understood; accepted: a number in (0, 1], a list such as "
                           "max=1e-2,p99=2e-3 (max, p99, rms, mean), or a budget file",
                           text);
        budget->bound[norm] = bound;
        at = end;
        if (!*at) return LQ_OK;
    }
}

static lq_status add_range(lq_rule *rule, const char *axis, size_t length, double min, double max,
                           lq_error *error) {
    if (rule->range_count == LQ_MAX_AXES || length == 0 || length >= LQ_NAME_SIZE || !(min <= max) ||
        !isfinite(min) || !isfinite(max))
        return lq_fail(error, LQ_BAD_INPUT, "range of axis '%.*s' is not a pair of ascending numbers",
                       (int)(length < 32 ? length : 32), axis);
    lq_range *range = &rule->ranges[rule->range_count++];
    memcpy(range->axis, axis, length);
    range->axis[length] = '\0';
    range->min = min;
    range->max = max;
    return LQ_OK;
}

/* "=0.02:1", and what ends it. */
static bool read_range(const char *text, double *min, double *max, size_t *used) {
    char *colon, *end;
    if (*text != '=') return false;
    *min = lq_strtod(text + 1, &colon);
    if (colon == text + 1 || *colon != ':') return false;
    *max = lq_strtod(colon + 1, &end);
    *used = (size_t)(end - text);
    return end != colon + 1 && (!*end || *end == ',');
}

lq_status lq_ranges_parse(lq_rule *rule, const char *text, lq_error *error) {
    for (const char *at = text;; at++) {
        const size_t length = strcspn(at, "=");
        double min, max;
        size_t used;
        if (!read_range(at + length, &min, &max, &used))
            return lq_fail(error, LQ_BAD_INPUT,
                           "domain '%s' is not understood; accepted: mu=0.02:1,tau=0.02:1", text);
        const lq_status status = add_range(rule, at, length, min, max, error);
        if (status != LQ_OK) return status;
        at += length + used;
        if (!*at) return LQ_OK;
    }
}

/* ------------------------------------------------------------------------------------- file */

static lq_status take_ranges(lq_rule *rule, const json_t *on, lq_error *error) {
    const char *axis;
    json_t *pair;
    rule->range_count = 0;
    if (!json_is_object(on)) return lq_fail(error, LQ_FORMAT, "'on' is not an object of axis: [min, max]");
    json_object_foreach((json_t *)on, axis, pair) {
        const json_t *min = json_array_get(pair, 0), *max = json_array_get(pair, 1);
        if (json_array_size(pair) != 2 || !json_is_number(min) || !json_is_number(max))
            return lq_fail(error, LQ_FORMAT, "'on': '%s' is not [min, max]", axis);
        const lq_status status =
            add_range(rule, axis, strlen(axis), json_number_value(min), json_number_value(max), error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

static lq_status take_rule(lq_rule *rule, const json_t *object, bool top, lq_error *error) {
    const char *key;
    json_t *value;
    if (!json_is_object(object)) return lq_fail(error, LQ_FORMAT, "a budget is not an object");
    json_object_foreach((json_t *)object, key, value) {
        const lq_norm norm = norm_of(key, strlen(key));
        lq_status status = LQ_OK;
        if (top && strcmp(key, "tables") == 0) continue;
        if (strcmp(key, "on") == 0) status = take_ranges(rule, value, error);
        else if (norm == LQ_NORMS)
            status = lq_fail(error, LQ_FORMAT, "unknown key '%s'; accepted: max, p99, rms, mean, on%s", key,
                             top ? ", tables" : "");
        else if (!json_is_number(value) || !(json_number_value(value) > 0.0))
            status = lq_fail(error, LQ_FORMAT, "'%s' is not a number above 0", key);
        else rule->budget.bound[norm] = json_number_value(value);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

static lq_status take_file(lq_budgets *budgets, const json_t *root, lq_error *error) {
    const char *name;
    json_t *object, *tables = json_object_get(root, "tables");
    budgets->count = 1;
    budgets->rules[0] = (lq_rule){.table = ""};
    lq_status status = take_rule(&budgets->rules[0], root, true, error);
    if (status == LQ_OK && tables && !json_is_object(tables))
        status = lq_fail(error, LQ_FORMAT, "'tables' is not an object");
    if (status != LQ_OK || !tables) return status;
    json_object_foreach(tables, name, object) {
        if (budgets->count == LQ_RULES_MAX || strlen(name) >= LQ_NAME_SIZE)
            return lq_fail(error, LQ_FORMAT, "more than %d tables, or too long a name '%.40s'", LQ_RULES_MAX,
                           name);
        lq_rule *rule = &budgets->rules[budgets->count++];
        *rule = budgets->rules[0];
        strcpy(rule->table, name);
        status = take_rule(rule, object, false, error);
        if (status != LQ_OK) return status;
    }
    return LQ_OK;
}

lq_status lq_budgets_read(lq_budgets *budgets, const char *path, lq_error *error) {
    json_t *root;
    lq_status status = lq_json_read(&root, path, error);
    if (status != LQ_OK) return status;
    lq_error cause = {""};
    status = take_file(budgets, root, &cause);
    json_decref(root);
    return status == LQ_OK ? LQ_OK : lq_fail(error, status, "%s: %s", path, cause.text);
}

const lq_rule *lq_budgets_rule(const lq_budgets *budgets, const char *name, const char *kind) {
    for (int pass = 0; pass < 2; pass++)
        for (int i = 1; i < budgets->count; i++)
            if (strcmp(budgets->rules[i].table, pass == 0 ? name : kind) == 0) return &budgets->rules[i];
    return &budgets->rules[0];
}

lq_status lq_domain_cut(lq_domain *domain, const lq_kind *kind, const lq_rule *rule, lq_error *error) {
    for (int i = 0; i < rule->range_count; i++)
        for (int a = 0; a < kind->axis_count; a++) {
            if (strcmp(kind->axes[a].name, rule->ranges[i].axis) != 0) continue;
            domain->min[a] = fmax(domain->min[a], rule->ranges[i].min);
            domain->max[a] = fmin(domain->max[a], rule->ranges[i].max);
            if (!(domain->min[a] <= domain->max[a]))
                return lq_fail(error, LQ_BAD_INPUT, "no part of axis %s lies in %g to %g", kind->axes[a].name,
                               rule->ranges[i].min, rule->ranges[i].max);
        }
    return LQ_OK;
}

/* axis.c - table axes: the node map, its inverse, and the command-line form. */
#define _POSIX_C_SOURCE 200809L /* strdup, strtok_r */
#include "tables/axis.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "system/number.h"
#include "system/status.h"

#define AXIS_FORMS                                                                                           \
    "accepted are MIN:MAX:N, MIN:MAX:N:MAP with MAP linear, sqrt or powerP (P > 0), one value, or an "       \
    "increasing list A,B,..."

/* ------------------------------------------------------------------ names */

static bool name_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
}

lq_status lq_name_check(const char *what, const char *name, lq_error *error) {
    size_t length = name ? strlen(name) : 0;
    if (length == 0)
        return lq_fail(error, LQ_BAD_INPUT, "%s without a name; accepted are 1 to %d characters", what,
                       LQ_NAME_SIZE - 1);
    if (length >= LQ_NAME_SIZE)
        return lq_fail(error, LQ_BAD_INPUT, "the %s name '%.40s%s' has %zu characters; accepted are 1 to %d",
                       what, name, length > 40 ? "..." : "", length, LQ_NAME_SIZE - 1);
    for (size_t i = 0; i < length; i++)
        if (!name_character(name[i]))
            return lq_fail(error, LQ_BAD_INPUT,
                           "the %s name '%s' is not plain; accepted are letters, digits, '_', '-' and '.'",
                           what, name);
    return LQ_OK;
}

const char *lq_map_name(lq_map map) {
    switch (map) {
    case LQ_MAP_LINEAR:
        return "linear";
    case LQ_MAP_SQRT:
        return "sqrt";
    case LQ_MAP_POWER:
        return "power";
    case LQ_MAP_CUSTOM:
        return "custom";
    }
    return "unknown";
}

bool lq_map_find(const char *name, lq_map *map) {
    for (lq_map m = LQ_MAP_LINEAR; m <= LQ_MAP_CUSTOM; m++) {
        if (strcmp(name, lq_map_name(m)) != 0) continue;
        *map = m;
        return true;
    }
    return false;
}

/* ------------------------------------------------------------------ the map and its inverse */

/* w: [0,1] -> [0,1], see lq_map. */
static double warp(const lq_axis *axis, double u) {
    switch (axis->map) {
    case LQ_MAP_SQRT:
        return u * u;
    case LQ_MAP_POWER:
        return pow(u, axis->exponent);
    default:
        return u;
    }
}

static double unwarp(const lq_axis *axis, double w) {
    switch (axis->map) {
    case LQ_MAP_SQRT:
        return sqrt(w);
    case LQ_MAP_POWER:
        return pow(w, 1 / axis->exponent);
    default:
        return w;
    }
}

static double node_at(const lq_axis *axis, size_t i) {
    if (i == 0) return axis->min;
    if (i == axis->size - 1) return axis->max;
    double u = (double)i / (double)(axis->size - 1);
    return axis->min + (axis->max - axis->min) * warp(axis, u);
}

/* Largest i with nodes[i] <= x, for min < x < max. */
static size_t search(const lq_axis *axis, double x) {
    size_t low = 0, high = axis->size - 1;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (axis->nodes[middle] <= x) low = middle;
        else high = middle;
    }
    return low;
}

/* The closed-form inverse is off by the rounding of the nodes, which on a short range far from zero
 * (1e9 to 1e9 + 1) is a visible part of a cell: walk to the cell the stored nodes say. */
static size_t cell_near(const lq_axis *axis, double x, double guess) {
    size_t last = axis->size - 2;
    size_t i = guess >= (double)last ? last : (size_t)guess;
    while (i > 0 && x < axis->nodes[i]) i--;
    while (i < last && x >= axis->nodes[i + 1]) i++;
    return i;
}

double lq_axis_locate(const lq_axis *axis, double x) {
    if (!(x > axis->min)) return 0; /* also NaN, and an axis of one node */
    if (x >= axis->max) return (double)(axis->size - 1);
    if (axis->map == LQ_MAP_CUSTOM) {
        size_t i = search(axis, x);
        return (double)i + (x - axis->nodes[i]) / (axis->nodes[i + 1] - axis->nodes[i]);
    }
    double u = unwarp(axis, (x - axis->min) / (axis->max - axis->min));
    double index = u * (double)(axis->size - 1);
    size_t i = cell_near(axis, x, index);
    if (x == axis->nodes[i]) return (double)i;
    return fmin(fmax(index, (double)i), (double)(i + 1));
}

/* ------------------------------------------------------------------ construction */

static lq_status refuse_size(const char *name, size_t size, size_t most, lq_error *error) {
    return lq_fail(error, LQ_BAD_INPUT, "axis '%s' of %zu nodes; accepted are 1 to %zu", name, size, most);
}

static lq_status check_size(const char *name, size_t size, lq_error *error) {
    if (size >= 1 && size <= LQ_MAX_AXIS_SIZE) return LQ_OK;
    return refuse_size(name, size, LQ_MAX_AXIS_SIZE, error);
}

static lq_status check_range(const lq_axis *axis, lq_error *error) {
    double min = axis->min, max = axis->max;
    if (!isfinite(min) || !isfinite(max) || !isfinite(max - min))
        return lq_fail(error, LQ_BAD_INPUT, "axis '%s' from %g to %g; accepted are finite numbers",
                       axis->name, min, max);
    if (axis->size == 1 && min != max)
        return lq_fail(
            error, LQ_BAD_INPUT,
            "axis '%s' has one node but goes from %.17g to %.17g; accepted are equal ends, or 2 or "
            "more nodes",
            axis->name, min, max);
    if (axis->size > 1 && !(min < max))
        return lq_fail(error, LQ_BAD_INPUT,
                       "axis '%s' goes from %.17g to %.17g; accepted is a minimum below the maximum",
                       axis->name, min, max);
    return LQ_OK;
}

static lq_status check_map(lq_axis *axis, lq_map map, double exponent, lq_error *error) {
    if (map != LQ_MAP_LINEAR && map != LQ_MAP_SQRT && map != LQ_MAP_POWER)
        return lq_fail(error, LQ_BAD_INPUT,
                       "axis '%s' with map %s from a range; accepted are linear, sqrt and power", axis->name,
                       lq_map_name(map));
    axis->map = map;
    axis->exponent = map == LQ_MAP_LINEAR ? 1 : map == LQ_MAP_SQRT ? 2 : exponent;
    if (isfinite(axis->exponent) && axis->exponent > 0) return LQ_OK;
    return lq_fail(error, LQ_BAD_INPUT, "axis '%s' with exponent %g; accepted are finite exponents above 0",
                   axis->name, exponent);
}

static lq_status check_increasing(const lq_axis *axis, lq_error *error) {
    for (size_t i = 0; i + 1 < axis->size; i++)
        if (!(axis->nodes[i] < axis->nodes[i + 1]))
            return lq_fail(
                error, LQ_BAD_INPUT,
                "axis '%s': node %zu is %.17g and the next %.17g; accepted are strictly increasing "
                "nodes%s",
                axis->name, i, axis->nodes[i], axis->nodes[i + 1],
                axis->map == LQ_MAP_CUSTOM ? "" : " (fewer of them, or a smaller exponent)");
    return LQ_OK;
}

static lq_status start(lq_axis *axis, const char *name, size_t size, lq_error *error) {
    memset(axis, 0, sizeof *axis);
    lq_status status = lq_name_check("axis", name, error);
    if (status == LQ_OK) status = check_size(name, size, error);
    if (status) return status;
    memcpy(axis->name, name, strlen(name) + 1);
    axis->size = size;
    return LQ_OK;
}

static lq_status allocate_nodes(lq_axis *axis, lq_error *error) {
    axis->nodes = malloc(axis->size * sizeof *axis->nodes);
    if (axis->nodes) return LQ_OK;
    return lq_fail(error, LQ_NO_MEMORY, "axis '%s': no memory for %zu nodes", axis->name, axis->size);
}

/* Every error leaves an axis that owns nothing. */
static lq_status finish(lq_axis *axis, lq_status status) {
    if (status) lq_axis_free(axis);
    return status;
}

lq_status lq_axis_make(lq_axis *axis, const char *name, double min, double max, size_t size, lq_map map,
                       double exponent, lq_error *error) {
    lq_status status = start(axis, name, size, error);
    if (status) return finish(axis, status);
    axis->min = min;
    axis->max = max;
    status = check_map(axis, map, exponent, error);
    if (status == LQ_OK) status = check_range(axis, error);
    if (status == LQ_OK) status = allocate_nodes(axis, error);
    if (status) return finish(axis, status);
    for (size_t i = 0; i < size; i++) axis->nodes[i] = node_at(axis, i);
    return finish(axis, check_increasing(axis, error));
}

lq_status lq_axis_make_custom(lq_axis *axis, const char *name, const double *nodes, size_t size,
                              lq_error *error) {
    lq_status status = start(axis, name, size, error);
    if (status == LQ_OK && !nodes) status = lq_fail(error, LQ_BAD_INPUT, "axis '%s' without its nodes", name);
    if (status == LQ_OK) status = allocate_nodes(axis, error);
    if (status) return finish(axis, status);
    memcpy(axis->nodes, nodes, size * sizeof *nodes);
    axis->map = LQ_MAP_CUSTOM;
    axis->min = nodes[0];
    axis->max = nodes[size - 1];
    status = check_range(axis, error);
    if (status == LQ_OK) status = check_increasing(axis, error);
    return finish(axis, status);
}

lq_status lq_axis_copy(lq_axis *to, const lq_axis *from, lq_error *error) {
    *to = *from;
    lq_status status = allocate_nodes(to, error);
    if (status) return finish(to, status);
    memcpy(to->nodes, from->nodes, from->size * sizeof *from->nodes);
    return LQ_OK;
}

void lq_axis_free(lq_axis *axis) {
    if (!axis) return;
    free(axis->nodes);
    memset(axis, 0, sizeof *axis);
}

/* ------------------------------------------------------------------ the command-line form */

static lq_status refuse(const char *name, const char *part, const char *cause, lq_error *error) {
    return lq_fail(error, LQ_BAD_INPUT, "axis '%s': '%.60s' %s; %s", name, part, cause, AXIS_FORMS);
}

static bool parse_number(const char *text, double *value) {
    char *end;
    if (!*text || isspace((unsigned char)*text)) return false;
    *value = lq_strtod(text, &end);
    return !*end;
}

static bool parse_count(const char *text, size_t *count) {
    char *end;
    if (!isdigit((unsigned char)*text)) return false;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    *count = errno ? (size_t)-1 : (size_t)value; /* too large for any axis: refused by its size */
    return !*end;
}

static bool parse_map(const char *text, lq_map *map, double *exponent) {
    *exponent = 0;
    if (strncmp(text, "power", 5) == 0) {
        *map = LQ_MAP_POWER;
        return parse_number(text + 5, exponent);
    }
    return lq_map_find(text, map) && *map != LQ_MAP_CUSTOM;
}

/* MIN:MAX:N[:MAP]; splits `text` in place. */
static lq_status parse_range(lq_axis *axis, const char *name, char *text, size_t most, lq_error *error) {
    char *parts[4] = {text};
    size_t count = 1;
    for (char *c = text; *c; c++) {
        if (*c != ':') continue;
        if (count == 4) return refuse(name, c, "is one part too many", error);
        *c = '\0';
        parts[count++] = c + 1;
    }
    if (count < 3) return refuse(name, text, "is a range without a number of nodes", error);
    double min, max, exponent = 1;
    size_t size;
    lq_map map = LQ_MAP_LINEAR;
    if (!parse_number(parts[0], &min)) return refuse(name, parts[0], "is not a number", error);
    if (!parse_number(parts[1], &max)) return refuse(name, parts[1], "is not a number", error);
    if (!parse_count(parts[2], &size)) return refuse(name, parts[2], "is not a number of nodes", error);
    if (count == 4 && !parse_map(parts[3], &map, &exponent))
        return refuse(name, parts[3], "is not a map", error);
    if (size > most) return refuse_size(name, size, most, error);
    return lq_axis_make(axis, name, min, max, size, map, exponent, error);
}

/* A,B,...; splits `text` in place. */
static lq_status parse_list(lq_axis *axis, const char *name, char *text, lq_error *error) {
    size_t count = 1;
    for (const char *c = text; *c; c++) count += *c == ',';
    lq_status status = check_size(name, count, error);
    if (status) return status;
    double *nodes = malloc(count * sizeof *nodes);
    if (!nodes) return lq_fail(error, LQ_NO_MEMORY, "axis '%s': no memory for %zu nodes", name, count);
    char *part = text;
    for (size_t i = 0; i < count && status == LQ_OK; i++) {
        char *comma = strchr(part, ',');
        if (comma) *comma = '\0';
        if (!parse_number(part, &nodes[i])) status = refuse(name, part, "is not a number", error);
        part = comma ? comma + 1 : part;
    }
    if (status == LQ_OK) status = lq_axis_make_custom(axis, name, nodes, count, error);
    free(nodes);
    return status;
}

lq_status lq_axis_parse(lq_axis *axis, const char *name, const char *text, lq_error *error) {
    return lq_axis_parse_within(axis, name, text, LQ_MAX_AXIS_SIZE, error);
}

lq_status lq_axis_parse_within(lq_axis *axis, const char *name, const char *text, size_t most,
                               lq_error *error) {
    memset(axis, 0, sizeof *axis);
    lq_status status = lq_name_check("axis", name, error);
    if (status) return status;
    if (!text || !*text) return refuse(name, "", "is empty", error);
    char *copy = strdup(text);
    if (!copy) return lq_fail(error, LQ_NO_MEMORY, "axis '%s': no memory", name);
    double value;
    if (strchr(copy, ':')) status = parse_range(axis, name, copy, most, error);
    else if (strchr(copy, ',')) status = parse_list(axis, name, copy, error);
    else if (parse_number(copy, &value))
        status = lq_axis_make(axis, name, value, value, 1, LQ_MAP_LINEAR, 1, error);
    else status = refuse(name, copy, "is not a number", error);
    free(copy);
    return status;
}

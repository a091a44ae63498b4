/* NDFs sampled in a CSV file: theta, and D of one distribution or of several roughnesses.
 *
 *     # comment                                  theta_deg,alpha=0.1,alpha=0.2
 *     theta_deg,D                                0,31.8,7.96
 *     0,31.8                                     ...
 *     0.5,30.1
 *
 * theta_rad is read in radians; plain theta, or no header, in degrees if the last angle is above pi/2.
 */
#include "microfacet/ndf_file.h"

#include "microfacet/ndf_samples.h"
#include "system/number.h"
#include "system/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { COLUMNS_MAX = 64, ROWS_MAX = 1000000 };

typedef struct reader {
    const char *path;
    char *text, *next; /* the line read last; what is after it, NULL at the end */
    size_t line;
    lq_error *error;
    size_t columns; /* of D; 0: not known yet */
    double alpha[COLUMNS_MAX];
    bool has_alphas;
    double unit; /* radians of 1; 0: to be found */
    size_t rows, room;
    double *values; /* [row * (columns + 1)], theta first */
} reader;

static lq_status bad_line(const reader *r, const char *what, const char *value) {
    return lq_fail(r->error, LQ_BAD_INPUT, "%s:%zu: %s%s%s%s", r->path, r->line, what, value ? " '" : "",
                   value ? value : "", value ? "'" : "");
}

static bool read_line(reader *r) {
    while (r->next && *r->next) {
        r->text = strsep(&r->next, "\n");
        r->line++;
        size_t length = strlen(r->text);
        while (length > 0 && strchr(" \t\r\n", r->text[length - 1])) r->text[--length] = '\0';
        const char *start = r->text + strspn(r->text, " \t");
        if (*start && *start != '#') return true;
    }
    return false;
}

/* The next field without blanks around it; NULL beyond the last. */
static char *next_field(char **rest) {
    char *field = strsep(rest, ",");
    if (!field) return NULL;
    field += strspn(field, " \t");
    for (size_t end = strlen(field); end > 0 && strchr(" \t", field[end - 1]);) field[--end] = '\0';
    return field;
}

static bool number(const char *text, double *value) {
    char *end;
    *value = lq_strtod(text, &end);
    return end != text && *end == '\0';
}

/* ---------------------------------------------------------------------------------- header */

static lq_status read_angle_name(reader *r, const char *name) {
    if (strcmp(name, "theta_deg") == 0) r->unit = pi / 180.0;
    else if (strcmp(name, "theta_rad") == 0) r->unit = 1.0;
    else if (strcmp(name, "theta") != 0)
        return bad_line(r, "the first column is theta, theta_deg or theta_rad, not", name);
    return LQ_OK;
}

/* "D", or the roughness of a column: "alpha=0.3" or "0.3". */
static lq_status read_column_name(reader *r, const char *name) {
    static const char prefix[] = "alpha=";
    const char *text = strncmp(name, prefix, sizeof prefix - 1) == 0 ? name + sizeof prefix - 1 : name;
    double alpha = 0.0;
    const bool given = number(text, &alpha);
    if (r->columns == COLUMNS_MAX) return bad_line(r, "more than 64 columns of D", NULL);
    if (r->columns > 0 && given != r->has_alphas) return bad_line(r, "a column without its alpha:", name);
    if (given && !(alpha > 0.0 && alpha <= 1.0))
        return bad_line(r, "alpha of a column is not in (0, 1]:", name);
    if (given && r->columns > 0 && !(alpha > r->alpha[r->columns - 1]))
        return bad_line(r, "the alphas of the columns do not rise at", name);
    r->has_alphas = given;
    r->alpha[r->columns++] = alpha;
    return LQ_OK;
}

static lq_status read_header(reader *r) {
    char *rest = r->text;
    lq_status status = read_angle_name(r, next_field(&rest));
    for (char *field; status == LQ_OK && (field = next_field(&rest));) status = read_column_name(r, field);
    if (status == LQ_OK && r->columns == 0) return bad_line(r, "a column of D is missing", NULL);
    if (status == LQ_OK && r->columns > 1 && !r->has_alphas)
        return bad_line(r, "several columns of D need their alphas: theta_deg,alpha=0.1,alpha=0.2", NULL);
    return status;
}

/* ------------------------------------------------------------------------------------ rows */

static lq_status grow(reader *r) {
    if (r->rows < r->room) return LQ_OK;
    if (r->rows == ROWS_MAX) return bad_line(r, "more than a million rows", NULL);
    const size_t room = r->room ? 2 * r->room : 256;
    double *values = realloc(r->values, room * (r->columns + 1) * sizeof *values);
    if (!values) return lq_fail(r->error, LQ_NO_MEMORY, "no memory for %zu rows of %s", room, r->path);
    r->values = values;
    r->room = room;
    return LQ_OK;
}

static lq_status check_value(const reader *r, size_t column, double value, const char *text) {
    if (column > 0) {
        if (!isfinite(value)) return bad_line(r, "D is not finite:", text);
        return value < 0.0 ? bad_line(r, "D is negative:", text) : LQ_OK;
    }
    if (!(value >= 0.0 && value <= 90.0)) return bad_line(r, "theta is not in [0, 90] degrees:", text);
    if (r->rows > 0 && !(value > r->values[(r->rows - 1) * (r->columns + 1)]))
        return bad_line(r, "theta does not rise:", text);
    return LQ_OK;
}

static lq_status read_row(reader *r) {
    lq_status status = grow(r);
    if (status != LQ_OK) return status;
    double *row = r->values + r->rows * (r->columns + 1);
    char *rest = r->text;
    for (size_t i = 0; i <= r->columns; i++) {
        const char *field = next_field(&rest);
        if (!field || !*field) return bad_line(r, i ? "a value of D is missing" : "theta is missing", NULL);
        if (!number(field, &row[i])) return bad_line(r, "not a number:", field);
        status = check_value(r, i, row[i], field);
        if (status != LQ_OK) return status;
    }
    if (rest) return bad_line(r, "more values than columns:", rest);
    r->rows++;
    return LQ_OK;
}

static lq_status read_all(reader *r) {
    if (!read_line(r))
        return lq_fail(r->error, LQ_BAD_INPUT, "%s: empty; rows of theta,D are expected", r->path);
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    if (r->line == 1 && strncmp(r->text, byte_order_mark, 3) == 0) r->text += 3;
    double first;
    char *end;
    first = lq_strtod(r->text, &end);
    (void)first;
    const bool header = end == r->text && *r->text != ',';
    lq_status status = LQ_OK;
    if (header) {
        status = read_header(r);
    } else {
        for (const char *c = r->text; *c; c++) r->columns += *c == ',';
        if (r->columns > 1)
            return bad_line(r, "several columns of D need a header: theta_deg,alpha=0.1,alpha=0.2", NULL);
        if (r->columns == 0) return bad_line(r, "a value of D is missing", NULL);
        status = read_row(r);
    }
    while (status == LQ_OK && read_line(r)) status = read_row(r);
    if (status == LQ_OK && r->rows < LQ_NDF_SAMPLES_MIN)
        return lq_fail(r->error, LQ_BAD_INPUT, "%s:%zu: %zu angles, at least %d are needed", r->path, r->line,
                       r->rows, LQ_NDF_SAMPLES_MIN);
    return status;
}

/* ---------------------------------------------------------------------------------- the NDF */

static lq_status check_columns(const reader *r, const double *theta, const double *d) {
    if (theta[r->rows - 1] > 0.5 * pi * (1.0 + 1e-9))
        return lq_fail(r->error, LQ_BAD_INPUT, "%s:%zu: theta is above pi/2 radians", r->path, r->line);
    for (size_t c = 0; c < r->columns; c++) {
        double most = 0.0;
        for (size_t i = 0; i < r->rows; i++) most = fmax(most, d[c * r->rows + i]);
        if (!(most > 0.0))
            return lq_fail(r->error, LQ_BAD_INPUT, "%s:%zu: D is 0 in every row of column %zu", r->path,
                           r->line, c + 2);
    }
    return LQ_OK;
}

static lq_status make(reader *r, const lq_ndf **ndf, const char *id) {
    const size_t width = r->columns + 1, rows = r->rows;
    double *theta = malloc(rows * width * sizeof *theta), *d = theta ? theta + rows : NULL;
    if (!theta) return lq_fail(r->error, LQ_NO_MEMORY, "no memory for %zu rows of %s", rows, r->path);
    const double last = r->values[(rows - 1) * width];
    if (r->unit == 0.0) r->unit = last > 0.5 * pi * (1.0 + 1e-6) ? pi / 180.0 : 1.0;
    for (size_t i = 0; i < rows; i++) {
        theta[i] = r->unit * r->values[i * width];
        for (size_t c = 0; c < r->columns; c++) d[c * rows + i] = r->values[i * width + c + 1];
    }
    lq_status status = check_columns(r, theta, d);
    const lq_ndf_samples samples = {rows, r->columns, theta, d, r->columns > 1 ? r->alpha : NULL,
                                    id,   r->path};
    if (status == LQ_OK) status = lq_ndf_samples_make(ndf, &samples, r->error);
    free(theta);
    return status;
}

lq_status lq_ndf_file_open(const lq_ndf **ndf, const char *text, lq_error *error) {
    lq_ndf_path path;
    lq_status status = lq_ndf_path_make(&path, "file", text, error);
    if (status == LQ_OK) {
        reader r = {.path = path.path, .next = path.bytes, .error = error};
        if (strlen(path.bytes) != path.size)
            status = lq_fail(error, LQ_BAD_INPUT, "%s: holds a NUL byte; this is not CSV text", path.path);
        if (status == LQ_OK) status = read_all(&r);
        if (status == LQ_OK) status = make(&r, ndf, path.id);
        free(r.values);
    }
    lq_ndf_path_free(&path);
    return status;
}

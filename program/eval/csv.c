/* csv.c - points as CSV on stdin, computed on all cores in batches, written in their order. */
#include "program/eval/eval.h"

#include "program/matched.h"
#include "program/message.h"
#include "program/verb.h"
#include "system/status.h"

#include <errno.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Enough to keep many cores busy between two reads, little enough that output flows. */
enum { BATCH = 256 };

typedef struct csv_row {
    char *text; /* as read, without the end of line; kept from batch to batch as a buffer */
    size_t capacity;
    size_t line;
    eval_point point;
    eval_result result;
} csv_row;

typedef struct csv_stream {
    const eval_source *source;
    FILE *in;
    size_t line;              /* of the row read last, from 1 */
    int columns[LQ_MAX_AXES]; /* the axis of each column */
    int column_count;
    bool ended;
    bool failed; /* ended by an error; `error` says which */
    lq_error error;
    bool warned;   /* that some points take long */
    size_t missed; /* points whose estimate is above the tolerance */
    csv_row rows[BATCH];
} csv_stream;

/* ======================================================================================
 *                                       Reading
 * ====================================================================================== */

static void stop(csv_stream *stream, const char *text) {
    stream->ended = stream->failed = true;
    lq_fail(&stream->error, LQ_BAD_INPUT, "line %zu: %s", stream->line, text);
}

static void trim_end(char *text, size_t length) {
    while (length > 0 && strchr("\r\n \t", text[length - 1])) text[--length] = '\0';
}

/* The next line that is not blank; false at the end. */
static bool read_line(csv_stream *stream, csv_row *row) {
    ssize_t length;
    errno = 0;
    while ((length = getline(&row->text, &row->capacity, stream->in)) >= 0) {
        row->line = ++stream->line;
        if (strlen(row->text) != (size_t)length) {
            stop(stream, "holds a NUL byte; this is not CSV text");
            return false;
        }
        trim_end(row->text, (size_t)length);
        if (row->text[0]) return true;
    }
    stream->ended = true;
    if (ferror(stream->in) || errno == ENOMEM) {
        stream->failed = true;
        lq_fail(&stream->error, LQ_IO, "cannot read standard input: %s", strerror(errno));
    }
    return false;
}

/* The next field of a line, without blanks and quotes around it; NULL beyond the last. */
static char *next_field(char **rest) {
    char *field = strsep(rest, ",");
    if (!field) return NULL;
    field += strspn(field, " \t");
    trim_end(field, strlen(field));
    size_t length = strlen(field);
    if (length >= 2 && field[0] == '"' && field[length - 1] == '"') {
        field[length - 1] = '\0';
        field++;
    }
    return field;
}

static void read_header_fields(csv_stream *stream, char *rest) {
    static const char byte_order_mark[] = "\xEF\xBB\xBF";
    if (strncmp(rest, byte_order_mark, 3) == 0) rest += 3;
    eval_point seen = {0};
    lq_error error = {""};
    for (char *field; !stream->failed && (field = next_field(&rest));) {
        int axis = eval_find_axis(stream->source, field, &error);
        if (axis < 0) {
            stop(stream, error.text);
        } else if (seen.given[axis]) {
            stop(stream, "a column name stands there twice");
        } else {
            stream->columns[stream->column_count++] = axis;
            seen.given[axis] = true;
        }
    }
    if (!stream->failed && !eval_complete(stream->source, &seen, &error)) stop(stream, error.text);
}

static void read_header(csv_stream *stream, csv_row *row) {
    if (read_line(stream, row)) {
        char *copy = strdup(row->text); /* the fields are cut in place, the text is written out */
        if (copy) read_header_fields(stream, copy);
        else stop(stream, "out of memory");
        free(copy);
    } else if (!stream->failed) {
        stream->line = 1;
        stop(stream, "standard input is empty; a header row of axis names is expected");
    }
}

static void read_coordinates(csv_stream *stream, csv_row *row, char *rest) {
    lq_error error = {""};
    row->point = eval_start(stream->source);
    int count = 0, wanted = stream->column_count;
    for (char *field; (field = next_field(&rest)); count++) {
        if (count < wanted && !stream->failed &&
            !eval_coordinate(stream->source, &row->point, stream->columns[count], field, &error))
            stop(stream, error.text);
    }
    if (count == wanted) return;
    lq_fail(&error, LQ_BAD_INPUT, "%d fields, expected %d", count, wanted);
    stop(stream, error.text);
}

static bool read_row(csv_stream *stream, csv_row *row) {
    if (stream->ended || !read_line(stream, row)) return false;
    char *copy = strdup(row->text);
    if (copy) read_coordinates(stream, row, copy);
    else stop(stream, "out of memory");
    free(copy);
    return !stream->failed;
}

/* ======================================================================================
 *                                  Computing and writing
 * ====================================================================================== */

static void compute_rows(csv_stream *stream, int count) {
    const lq_settings *asked = &stream->source->settings;
    lq_settings settings = *asked;
    settings.threads = 1; /* the cores are shared out by points */
    int threads = asked->threads > 0 ? asked->threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int i = 0; i < count; i++)
        eval_compute(stream->source, &settings, &stream->rows[i].point, &stream->rows[i].result);
}

static void write_rows(csv_stream *stream, int count) {
    for (int i = 0; i < count; i++) {
        const csv_row *row = &stream->rows[i];
        if (row->result.status == LQ_NOT_CONVERGED) {
            stream->missed++;
        } else if (row->result.status != LQ_OK) {
            stream->line = row->line;
            stop(stream, row->result.error.text);
            return;
        }
        fputs(row->text, stdout);
        eval_print_csv_result(stream->source, &row->result);
    }
    if (fflush(stdout) == 0 && !ferror(stdout)) return;
    stream->ended = stream->failed = true;
    lq_fail(&stream->error, LQ_IO, "cannot write to standard output: %s", strerror(errno));
}

static void write_header(const csv_stream *stream, const csv_row *row) {
    fputs(row->text, stdout);
    eval_print_csv_header(stream->source);
}

static int finish(const csv_stream *stream) {
    if (stream->failed) return cli_fail("%s", stream->error.text);
    if (stream->missed == 0) return CLI_DONE;
    cli_message("%zu points are above the tolerance; their errors are in the last column", stream->missed);
    return CLI_EXCEEDED;
}

/* Once, before the first. */
static void warn(csv_stream *stream, const csv_row *row) {
    if (!stream->source->kind || stream->warned) return;
    stream->warned = cli_warn_matched_at(stream->source->kind, row->point.at);
}

int eval_csv(const eval_source *source, FILE *in) {
    csv_stream *stream = calloc(1, sizeof *stream);
    if (!stream) return cli_fail("out of memory");
    stream->source = source;
    stream->in = in;
    read_header(stream, &stream->rows[0]);
    if (!stream->failed) write_header(stream, &stream->rows[0]);
    while (!stream->ended) {
        int count = 0;
        while (count < BATCH && read_row(stream, &stream->rows[count])) warn(stream, &stream->rows[count++]);
        compute_rows(stream, count);
        write_rows(stream, count);
    }
    int code = finish(stream);
    for (int i = 0; i < BATCH; i++) free(stream->rows[i].text);
    free(stream);
    return code;
}

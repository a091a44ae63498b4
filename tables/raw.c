/* raw.c - .npy files and C arrays as bare numbers. */
#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "system/input.h"
#include "system/number.h"
#include "system/status.h"
#include "tables/half.h"
#include "tables/raw.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "numbers are read as they lie in memory, which must be little-endian"
#endif

static lq_status make_room(lq_raw *raw, size_t count, lq_error *error) {
    raw->count = count;
    raw->values = malloc((count + 1) * sizeof *raw->values);
    return raw->values ? LQ_OK : lq_fail(error, LQ_NO_MEMORY, "no memory for %zu values", count);
}

/* ======================================================================================
 *                                         .npy
 * ====================================================================================== */

/* Magic, version, length of the header, header, data. The shape is not believed: the length of the file is.
 */
static lq_status read_npy(lq_raw *raw, const char *path, const char *bytes, size_t size, lq_error *error) {
    static const char *const types[] = {"'<f4'", "'<f8'", "'<f2'"};
    static const size_t widths[] = {4, 8, 2};
    if (size < 12 || memcmp(bytes, "\x93NUMPY", 6) != 0)
        return lq_fail(error, LQ_FORMAT, "%s: not a .npy file", path);
    const size_t start = bytes[6] == 1 ? 10 : 12;
    uint32_t length = 0;
    memcpy(&length, bytes + 8, start - 8);
    if (length > size - start) return lq_fail(error, LQ_FORMAT, "%s: its header is cut short", path);
    char header[1024];
    snprintf(header, sizeof header, "%.*s", (int)(length < 1023 ? length : 1023), bytes + start);
    int type = 0;
    while (type < 3 && !strstr(header, types[type])) type++;
    if (type == 3)
        return lq_fail(error, LQ_FORMAT, "%s: numbers of another type; accepted: <f4, <f8, <f2", path);
    if (strstr(header, "'fortran_order': True"))
        return lq_fail(error, LQ_FORMAT, "%s: Fortran order; accepted: C order (numpy.ascontiguousarray)",
                       path);
    const char *data = bytes + start + length;
    const lq_status status = make_room(raw, (size - start - length) / widths[type], error);
    for (size_t i = 0; status == LQ_OK && i < raw->count; i++) {
        uint16_t half;
        double wide;
        if (type == 0) memcpy(&raw->values[i], data + 4 * i, 4);
        if (type == 1) {
            memcpy(&wide, data + 8 * i, 8);
            raw->values[i] = (float)wide;
        }
        if (type == 2) {
            memcpy(&half, data + 2 * i, 2);
            raw->values[i] = lq_half_to_float(half);
        }
    }
    return status;
}

/* ======================================================================================
 *                                        C array
 * ====================================================================================== */

/* Blanks in place of comments. */
static void strip_comments(char *text) {
    for (char *at = text; *at; at++) {
        const char *end = NULL;
        if (at[0] == '/' && at[1] == '*') end = strstr(at + 2, "*/");
        else if (at[0] == '/' && at[1] == '/') end = strchr(at, '\n');
        else continue;
        const size_t length = end ? (size_t)(end - at) + (at[1] == '*' ? 2 : 0) : strlen(at);
        memset(at, ' ', length);
    }
}

/* The numbers between the first brace and the one that closes it, whatever braces lie between; a file without
 * any brace is a plain list of numbers. */
static lq_status read_array(lq_raw *raw, const char *path, char *text, lq_error *error) {
    strip_comments(text);
    char *at = strchr(text, '{');
    const bool braces = at != NULL;
    int depth = 0;
    lq_status status = make_room(raw, strlen(text) / 2 + 1, error);
    raw->count = 0;
    if (!at) at = text;
    while (status == LQ_OK && *at) {
        if (*at == '{') depth++;
        if (*at == '}' && --depth == 0) break;
        if (isspace((unsigned char)*at) || strchr("{},;", *at)) {
            at++;
            continue;
        }
        char *end;
        raw->values[raw->count] = lq_strtof(at, &end);
        if (end == at) return lq_fail(error, LQ_FORMAT, "%s: '%.12s' is not a number of a C array", path, at);
        raw->count++;
        at = end + strspn(end, "fFlL");
    }
    if (status == LQ_OK && braces && depth != 0)
        status = lq_fail(error, LQ_FORMAT, "%s: its array is not closed: truncated?", path);
    return status;
}

/* ======================================================================================
 *                                        The call
 * ====================================================================================== */

static bool ends_in(const char *path, const char *ending) {
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, ending) == 0;
}

lq_status lq_raw_read(lq_raw *raw, const char *path, const char *const *channels, int channel_count,
                      lq_error *error) {
    *raw = (lq_raw){.values = NULL};
    lq_status status;
    if (ends_in(path, ".exr")) {
        status = lq_raw_read_exr(raw, path, channels, channel_count, error);
    } else {
        char *text;
        size_t size = 0;
        status = lq_input_read(path, &text, &size, error);
        if (status == LQ_OK)
            status = ends_in(path, ".npy") ? read_npy(raw, path, text, size, error)
                                           : read_array(raw, path, text, error);
        free(text);
    }
    if (status != LQ_OK) lq_raw_free(raw);
    return status;
}

void lq_raw_free(lq_raw *raw) {
    free(raw->values);
    *raw = (lq_raw){.values = NULL};
}

/* text.c - UTF-8 and markup, a character at a time. */
#include "picture/text.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The code point that `text` begins with and its length in bytes; length 0 where it is no UTF-8 (RFC 3629):
 * over-long forms, surrogates and what lies beyond U+10FFFF are none. */
static size_t decode(const char *text, uint32_t *point) {
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char first = (unsigned char)*text;
    const size_t length = first < 0x80       ? 1
                          : first >> 5 == 6  ? 2
                          : first >> 4 == 14 ? 3
                          : first >> 3 == 30 ? 4
                                             : 0;
    if (length == 0) return 0;
    *point = length == 1 ? first : first & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; i++) {
        const unsigned char next = (unsigned char)text[i];
        if (next >> 6 != 2) return 0;
        *point = *point << 6 | (next & 0x3fu);
    }
    const bool surrogate = *point >= 0xd800 && *point < 0xe000;
    return *point < least[length] || surrogate || *point > 0x10ffff ? 0 : length;
}

static const char *escape(uint32_t point) {
    switch (point) {
    case '<':
        return "&lt;";
    case '>':
        return "&gt;";
    case '&':
        return "&amp;";
    case '"':
        return "&quot;";
    default:
        return NULL;
    }
}

/* The same without markup. */
static size_t take(const char *text, uint32_t *point, char code[LQ_TEXT_CODE_SIZE]) {
    static const char replaced[] = "\xef\xbf\xbd";
    const size_t length = decode(text, point);
    const bool held = length > 0 && *point >= ' ' && *point != 0x7f && *point != 0xfffe && *point != 0xffff;
    if (held) memcpy(code, text, length);
    else {
        strcpy(code, replaced);
        *point = 0xfffd;
    }
    if (held) code[length] = '\0';
    return length > 0 ? length : 1;
}

size_t lq_text_character(const char *text, char code[LQ_TEXT_CODE_SIZE]) {
    uint32_t point = 0;
    const size_t length = take(text, &point, code);
    const char *escaped = escape(point);
    if (escaped) strcpy(code, escaped);
    return length;
}

char *lq_text_clean(const char *text) {
    char *clean = malloc(3 * strlen(text) + 1), *end = clean, code[LQ_TEXT_CODE_SIZE];
    if (!clean) return NULL;
    *end = '\0';
    for (uint32_t point; *text; end += strlen(end)) {
        point = 0;
        text += take(text, &point, code);
        strcpy(end, code);
    }
    return clean;
}

void lq_text_put(FILE *out, const char *text) {
    char code[LQ_TEXT_CODE_SIZE];
    while (*text) {
        text += lq_text_character(text, code);
        fputs(code, out);
    }
}

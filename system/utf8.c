/* utf8.c - where characters begin and end in UTF-8, and which of them steer a terminal. */
#include "system/utf8.h"

#include <stdbool.h>
#include <string.h>

static bool continues(char byte) {
    return ((unsigned char)byte & 0xC0) == 0x80;
}

/* Bytes that a character with this first byte has; 0: none starts so. */
static size_t announced(unsigned char lead) {
    if (lead < 0x80) return 1;
    if (lead >= 0xC2 && lead < 0xE0) return 2;
    if (lead >= 0xE0 && lead < 0xF0) return 3;
    return lead >= 0xF0 && lead < 0xF5 ? 4 : 0;
}

/* The second byte tells overlong forms, surrogates and what lies beyond U+10FFFF from characters. */
static bool second_fits(unsigned char lead, unsigned char second) {
    if (lead == 0xE0) return second >= 0xA0;
    if (lead == 0xED) return second < 0xA0;
    if (lead == 0xF0) return second >= 0x90;
    return lead != 0xF4 || second < 0x90;
}

size_t lq_utf8_character(const char *text, size_t length) {
    const size_t size = length > 0 ? announced((unsigned char)text[0]) : 0;
    if (size > length) return 0;
    for (size_t i = 1; i < size; i++)
        if (!continues(text[i])) return 0;
    return size < 2 || second_fits((unsigned char)text[0], (unsigned char)text[1]) ? size : 0;
}

size_t lq_utf8_whole(const char *text, size_t length) {
    size_t start = length;
    while (start > 0 && length - start < 3 && continues(text[start - 1])) start--;
    if (start == 0) return length;
    const size_t size = announced((unsigned char)text[start - 1]);
    return size > length - (start - 1) ? start - 1 : length;
}

static bool steers(const char *text, size_t size, const char *kept) {
    const unsigned char c = (unsigned char)text[0];
    if (size == 1) return c == 0x7F || (c < 0x20 && (c == '\0' || !strchr(kept, c)));
    return size == 2 && c == 0xC2 && (unsigned char)text[1] < 0xA0; /* C1, as UTF-8 has it */
}

void lq_utf8_clean(char *text, size_t length, const char *kept) {
    for (size_t i = 0; i < length;) {
        const size_t size = lq_utf8_character(text + i, length - i);
        if (size == 0) text[i] = '?';
        else if (steers(text + i, size, kept)) memset(text + i, ' ', size);
        i += size > 0 ? size : 1;
    }
}

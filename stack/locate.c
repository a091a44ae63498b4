/* locate.c - walks down a JSON text that is known to be valid, skipping what is not on the way. */
#include "stack/locate.h"

#include <string.h>

static const char *skip_space(const char *at) {
    return at + strspn(at, " \t\r\n");
}

/* Behind the string that starts at `at`. */
static const char *skip_string(const char *at) {
    for (at++; *at && *at != '"'; at++)
        if (*at == '\\' && at[1]) at++;
    return *at ? at + 1 : at;
}

/* Behind the value that starts at `at`; brackets are counted, not parsed. */
static const char *skip_value(const char *at) {
    int depth = 0;
    while (*at) {
        if (depth == 0 && strchr(",]}", *at)) return at;
        if (*at == '"') {
            at = skip_string(at);
            continue;
        }
        if (*at == '{' || *at == '[') depth++;
        if (*at == '}' || *at == ']') depth--;
        at++;
    }
    return at;
}

/* The member of the object or array at `at` that `step` names, and its value; NULL: none. */
static const char *descend(const char *at, const lq_json_step *step, const char **value) {
    if (*at != (step->key ? '{' : '[')) return NULL;
    at = skip_space(at + 1);
    for (size_t i = 0; *at && *at != '}' && *at != ']'; i++) {
        const char *member = at;
        size_t length = 0;
        if (step->key) {
            at = skip_string(at);
            length = (size_t)(at - member) - 2;
            at = skip_space(skip_space(at) + 1); /* the colon */
        }
        *value = at;
        if (step->key ? strlen(step->key) == length && strncmp(member + 1, step->key, length) == 0
                      : i == step->index)
            return member;
        at = skip_value(at);
        if (*at == ',') at = skip_space(at + 1);
    }
    return NULL;
}

static int line_of(const char *text, const char *at) {
    int line = 1;
    for (; text < at; text++) line += *text == '\n';
    return line;
}

int lq_json_line(const char *text, const lq_json_step *steps, size_t count) {
    const char *value = skip_space(text), *member = value;
    for (size_t i = 0; i < count; i++) {
        const char *next = descend(value, &steps[i], &value);
        if (!next) break;
        member = next;
    }
    return line_of(text, member);
}

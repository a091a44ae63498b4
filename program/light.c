/* light.c - reads the options that say which light meets a stack. */
#include "program/light.h"

#include <string.h>

#include "program/message.h"
#include "program/options.h"

const char *const cli_interfaces[] = {"all", "single", NULL};
const char *const cli_sides[] = {"above", "below", NULL};

bool cli_read_cosines(void *field, const char *value) {
    cli_light *light = field;
    light->count = 0;
    for (const char *at = value;; at++) {
        char text[64];
        const size_t length = strcspn(at, ",");
        if (length >= sizeof text || light->count == CLI_COSINES_MAX) {
            cli_message("--mu: accepted: up to %d cosines in [0,1] separated by commas", CLI_COSINES_MAX);
            return false;
        }
        memcpy(text, at, length);
        text[length] = '\0';
        if (!cli_parse_number("--mu", text, 0.0, 1.0, &light->mu[light->count++])) return false;
        at += length;
        if (*at == '\0') return true;
    }
}

cli_light cli_light_default(void) {
    return (cli_light){.count = 3, .mu = {1.0, 0.6, 0.15}};
}

lq_stack_query cli_light_query(const cli_light *light) {
    return (lq_stack_query){.mu = light->mu,
                            .mu_count = light->count,
                            .from_below = light->from == 1,
                            .single = light->interfaces == 1};
}

/* light.h - the options that say which light meets a stack, the same for every verb that takes one. */
#ifndef LACQUER_PROGRAM_LIGHT_H
#define LACQUER_PROGRAM_LIGHT_H

#include "lacquer.h"
#include "program/verb.h"

enum { CLI_MU = 544, CLI_INTERFACES, CLI_FROM };
enum { CLI_COSINES_MAX = 256 };
#define CLI_STACK_TOLERANCE_MIN 1e-7
#define CLI_STACK_TOLERANCE_MAX 0.1

/* Rows for the option list of a verb whose request has a cli_light `light`, for these modes of it. */
#define CLI_LIGHT_OPTIONS(REQUEST, mask) CLI_MU_OPTION(REQUEST, mask), CLI_SIDE_OPTIONS(REQUEST, mask)
#define CLI_MU_OPTION(REQUEST, mask)                                                                         \
    {                                                                                                        \
        CLI_MU, "mu", "MU,...",                                                                              \
            "cosines of incidence, in the medium the light comes from (default 1,0.6,0.15)",                 \
            CLI_READ(REQUEST, light, cli_read_cosines), .modes = (mask)                                      \
    }
#define CLI_SIDE_OPTIONS(REQUEST, mask)                                                                      \
    {CLI_INTERFACES,                                                                                         \
     "interfaces",                                                                                           \
     "all|single",                                                                                           \
     "orders of scattering at each interface; single: what is blocked after one is lost (default all)",      \
     CLI_CHOICE(REQUEST, light.interfaces, cli_interfaces),                                                  \
     .modes = (mask)},                                                                                       \
    {                                                                                                        \
        CLI_FROM, "from", "above|below", "where the light comes from (default above)",                       \
            CLI_CHOICE(REQUEST, light.from, cli_sides), .modes = (mask)                                      \
    }

typedef struct cli_light {
    size_t count;
    double mu[CLI_COSINES_MAX];
    int interfaces, from; /* as the choices below have them */
} cli_light;

extern const char *const cli_interfaces[], *const cli_sides[];
/* Cosines separated by commas, into a cli_light. */
bool cli_read_cosines(void *light, const char *value);

cli_light cli_light_default(void);
/* It keeps pointing at `light`. */
lq_stack_query cli_light_query(const cli_light *light);

#endif

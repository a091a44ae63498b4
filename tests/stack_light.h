/* Stacks written in a line, and their light. */
#ifndef LACQUER_TESTS_STACK_LIGHT_H
#define LACQUER_TESTS_STACK_LIGHT_H

#include "lacquer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/expect.h"

#define LAYERS(text)         "{\"layers\": [" text "]}"
#define DIELECTRIC(n, alpha) "{\"dielectric\": {\"n\": " #n ", \"alpha\": " #alpha "}}"
#define COATING(n, alpha, tau)                                                                               \
    "{\"dielectric\": {\"n\": " #n ", \"alpha\": " #alpha "}, \"medium\": {\"tau\": " #tau "}}"
#define CONDUCTOR(n, k, alpha) "{\"conductor\": {\"n\": " #n ", \"kappa\": " #k ", \"alpha\": " #alpha "}}"
#define LAMBERTIAN(rho)        "{\"lambertian\": {\"rho\": " #rho "}}"

static inline lq_stack *parse(const char *text) {
    lq_stack *stack;
    lq_error error = {""};
    if (lq_stack_parse(&stack, text, "a.json", 0, &error) != LQ_OK) fail_msg("%s", error.text);
    return stack;
}

static inline void solve(const char *text, const lq_stack_query *query, lq_stack_light *light) {
    lq_stack *stack = parse(text);
    lq_error error = {""};
    const lq_status status = lq_stack_solve(stack, query, light, NULL, &error);
    if (status != LQ_OK) fail_msg("%s: %s", text, error.text);
    lq_stack_free(stack);
}

static inline lq_stack_light light_at(const char *text, double mu, double tolerance) {
    const lq_stack_query query = {.mu = &mu, .mu_count = 1, .tolerance = tolerance};
    lq_stack_light light;
    solve(text, &query, &light);
    return light;
}

#define FROSTED   LAYERS(DIELECTRIC(1.5, 0.2) "," CONDUCTOR(0.2, 3.9, 0.05))
#define VARNISHED LAYERS(COATING(1.3, 0.1, 0.9) "," COATING(1.8, 0.4, 0.7) "," LAMBERTIAN(0.7))
#define SLAB      LAYERS(COATING(1.5, 0.1, 0.7) "," DIELECTRIC(1, 0.3))
#define WHITE                                                                                                \
    LAYERS(DIELECTRIC(1.3, 0.2) "," DIELECTRIC(1, 0.2) "," DIELECTRIC(1.3, 0.2) "," DIELECTRIC(              \
        1, 0.2) "," DIELECTRIC(1.3, 0.2) "," CONDUCTOR(0, 1, 0))

#endif

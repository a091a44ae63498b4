/* readers_text.c - stacks, budgets, NDF files, points, the texts of arguments, and the arguments themselves.
 */
#define _GNU_SOURCE /* fmemopen, dup2 */
#include "fuzz.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "pca/options_text.h"
#include "program/eval/eval.h"
#include "program/options.h"
#include "validate/certificate_budget.h"

/* What is accepted is written as a text that is accepted. */
void fuzz_stack(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_stack *stack, *again;
    char *text;
    if (lq_stack_read(&stack, fuzz_file("stack.json", bytes, size), LQ_STACK_RANGES, &error) != LQ_OK) return;
    if (lq_stack_text(stack, &text, &error) != LQ_OK) abort();
    if (lq_stack_parse(&again, text, "again", LQ_STACK_RANGES, &error) != LQ_OK) abort();
    lq_stack_free(again);
    lq_stack_free(stack);
    free(text);
}

void fuzz_budget(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    lq_budgets *budgets = malloc(sizeof *budgets);
    lq_budgets_read(budgets, fuzz_file("budget.json", bytes, size), &error);
    free(budgets);
}

void fuzz_ndf(const uint8_t *bytes, size_t size) {
    lq_error error = {""};
    const lq_ndf *ndf;
    char text[256];
    snprintf(text, sizeof text, "file:%s", fuzz_file("samples.csv", bytes, size));
    if (lq_ndf_open(&ndf, text, &error) == LQ_OK) lq_ndf_close(ndf);
}

/* What is printed goes nowhere. */
static void hush(void) {
    static bool done;
    const int nowhere = done ? -1 : open("/dev/null", O_WRONLY);
    done = true;
    if (nowhere < 0) return;
    if (!freopen("/dev/null", "w", stdout)) abort();
    stderr = fdopen(nowhere, "w"); /* the descriptor stays for what the sanitizers say */
}

static lq_table *small_table(void) {
    lq_axis axes[2];
    lq_error error = {""};
    lq_table *table = NULL;
    const char *channel = "albedo";
    if (lq_axis_parse(&axes[0], "mu", "0:1:3", &error) == LQ_OK &&
        lq_axis_parse(&axes[1], "alpha", "0.1,0.2,0.5", &error) == LQ_OK)
        lq_table_create(&table, axes, 2, &channel, 1, &error);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    return table;
}

void fuzz_points(const uint8_t *bytes, size_t size) {
    hush();
    eval_source source = {
        .table = small_table(), .path = "table", .channels = {"albedo"}, .settings.threads = 1};
    source.axis_count = source.table->axis_count;
    source.channel_count = source.table->channel_count;
    for (int a = 0; a < source.axis_count; a++)
        source.axes[a] =
            (eval_axis){source.table->axes[a].name, source.table->axes[a].min, source.table->axes[a].max};
    FILE *in = size > 0 ? fmemopen((void *)(uintptr_t)bytes, size, "r") : NULL;
    if (in) {
        eval_csv(&source, in);
        fclose(in);
    }
    eval_source_free(&source);
}

/* ------------------------------------------------------------------ one argument, by every reader */

static void read_pca(const char *text, const lq_axis *axes, int count) {
    lq_error error = {""};
    lq_pca_options options = lq_pca_options_default();
    lq_pca_read_separations(&options, text, axes, count, &error);
    lq_pca_read_split(&options, text, axes, count, &error);
    lq_pca_read_texels(&options, text, axes, count, &error);
    lq_pca_read_bases(&options, text, &error);
}

static void set_parameter(const char *text) {
    static const char frosted[] =
        "{\"layers\": [{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"x\": 0.2, \"y\": 0.1}}, "
        "\"medium\": {\"tau\": 0.5}}, {\"lambertian\": {\"rho\": 0.5}}]}";
    lq_error error = {""};
    lq_stack *stack;
    double lowest, highest;
    if (lq_stack_parse(&stack, frosted, "frosted", 0, &error) != LQ_OK) abort();
    lq_stack_set(stack, text, 0.5, &error);
    lq_stack_range(stack, text, &lowest, &highest, &error);
    lq_stack_free(stack);
}

void fuzz_text_arguments(const uint8_t *bytes, size_t size) {
    char *text = fuzz_text(bytes, size);
    lq_error error = {""};
    lq_axis axes[2];
    lq_budget budget;
    lq_rule rule = {.table = ""};
    const lq_ndf *ndf;
    if (lq_axis_parse(&axes[0], "mu", text, &error) == LQ_OK) {
        if (lq_axis_copy(&axes[1], &axes[0], &error) != LQ_OK) abort();
        strcpy(axes[1].name, "alpha");
        lq_axis_locate(&axes[0], 0.5 * (axes[0].min + axes[0].max));
        read_pca(text, axes, 2);
        for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    }
    const lq_axis named[] = {{.name = "mu"}, {.name = "alpha"}, {.name = "eta"}};
    read_pca(text, named, 3);
    lq_budget_parse(&budget, text, &error);
    lq_ranges_parse(&rule, text, &error);
    set_parameter(text);
    if (strncmp(text, "file:", 5) != 0 && strncmp(text, "plugin:", 7) != 0 &&
        lq_ndf_open(&ndf, text, &error) == LQ_OK)
        lq_ndf_close(ndf);
    free(text);
}

/* ------------------------------------------------------------------ arguments, one a line */

typedef struct request {
    const char *text;
    bool flag;
    double number;
    size_t count;
    int choice, layout;
    cli_texts list;
} request;

static const char *const choices[] = {"one", "two", NULL};

static const cli_option rows[] = {
    {'t', "text", "T", "a text", CLI_TEXT(request, text)},
    {'f', "flag", NULL, "a flag", CLI_FLAG(request, flag)},
    {'n', "number", "X", "a number", CLI_NUMBER(request, number, 0.0, 1.0), .modes = 1},
    {'c', "count", "N", "a count", CLI_COUNT(request, count, 1, 1000), .modes = 2},
    {300, "choice", "WORD", "a choice", CLI_CHOICE(request, choice, choices)},
    {301, "layout", "WORD", "a layout", CLI_READ(request, layout, cli_read_layout)},
    {302, "list", "T", "a list", CLI_LIST(request, list), .silent = true},
    {0}};

static const cli_verb verb = {"fuzz", "", "", rows, CLI_COUNTED(rows), NULL, "", NULL, false};

static bool take_word(void *of, const char *word) {
    (void)of;
    return *word != 'x';
}

void fuzz_options(const uint8_t *bytes, size_t size) {
    enum { MOST = 64 };
    hush();
    char *text = fuzz_text(bytes, size), *rest = text, *argv[MOST + 1] = {(char *)(uintptr_t) "fuzz"};
    int argc = 1;
    for (char *line; argc < MOST && (line = strsep(&rest, "\n"));) argv[argc++] = line;
    request filled = {.text = ""};
    cli_given given;
    if (cli_parse(&verb, argc, argv, &filled, take_word, &given)) {
        cli_suits(&given, 1, "here");
        char *command = cli_command(&given, &filled, "words");
        free(command);
    }
    free(text);
}

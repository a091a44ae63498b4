/* Descriptions of stacks: what is read, what is refused and in which words, and back to text. */
#include "lacquer.h"

#include <stdlib.h>
#include <string.h>

#include "tests/expect.h"

#define BASE         "{\"lambertian\": {\"rho\": 0.5}}"
#define LAYERS(text) "{\"layers\": [\n" text "]}"

static const char frosted[] =
    "{\"name\": \"frosted-metal\", \"layers\": ["
    "{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.2}, \"medium\": {\"tau\": [0.8, 0.5, 0.3]}},"
    "{\"conductor\": {\"n\": 0.2, \"kappa\": 3.9, \"alpha\": {\"x\": 0.05, \"y\": 0.1}, \"ndf\": "
    "\"beckmann\"}}]}";

static lq_stack *parse(const char *text, unsigned flags) {
    lq_stack *stack;
    lq_error error = {""};
    if (lq_stack_parse(&stack, text, "a.json", flags, &error) != LQ_OK) fail_msg("%s", error.text);
    return stack;
}

static void test_reads(void **state) {
    (void)state;
    lq_stack *s = parse(frosted, 0);
    assert_string_equal(s->name, "frosted-metal");
    assert_int_equal(s->layer_count, 2);
    assert_int_equal(s->layers[0].type, LQ_LAYER_DIELECTRIC);
    assert_near(s->layers[0].medium.tau.value[2], 0.3, 0.0);
    assert_int_equal(s->layers[0].medium.tau.form, LQ_RGB);
    assert_true(s->layers[1].anisotropic);
    assert_near(s->layers[1].alpha_y.value[0], 0.1, 0.0);
    assert_string_equal(s->layers[1].ndf, "beckmann");
    lq_stack_free(s);
    s = parse(LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"min\": 0.1, \"max\": 0.6}}}"),
              LQ_STACK_RANGES);
    assert_int_equal(s->layers[0].alpha_x.form, LQ_RANGE);
    assert_near(s->layers[0].alpha_y.highest, 0.6, 0.0);
    assert_near(s->layers[0].medium.tau.value[0], 1.0, 0.0);
    lq_stack_free(s);
}

static void test_writes(void **state) {
    (void)state;
    static const char *const texts[] = {
        frosted,
        LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0.123456789012345678}, \"medium\": "
               "{\"sigma_s\": 2, \"depth\": [1, 2, 3], \"g\": -0.5}}," BASE),
        LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": {\"min\": 0.1, \"max\": 0.6}}}")};
    for (size_t i = 0; i < 3; i++) {
        char *once, *twice;
        lq_stack *s = parse(texts[i], LQ_STACK_RANGES), *copy;
        assert_int_equal(lq_stack_text(s, &once, NULL), LQ_OK);
        lq_stack *again = parse(once, LQ_STACK_RANGES);
        assert_int_equal(again->layer_count, s->layer_count); /* the rest by the texts: layers have padding */
        assert_int_equal(lq_stack_copy(&copy, again, NULL), LQ_OK);
        assert_int_equal(lq_stack_text(copy, &twice, NULL), LQ_OK);
        assert_string_equal(once, twice);
        lq_stack_free(s);
        lq_stack_free(again);
        lq_stack_free(copy);
        free(once);
        free(twice);
    }
}

static void test_sets(void **state) {
    (void)state;
    lq_stack *s = parse(frosted, 0);
    lq_error error = {""};
    double low, high;
    assert_int_equal(lq_stack_set(s, "top.alpha", 0.4, &error), LQ_OK);
    assert_int_equal(lq_stack_set(s, "1.tau", 0.9, &error), LQ_OK);
    assert_int_equal(lq_stack_set(s, "base.alpha", 0.3, &error), LQ_OK);
    assert_near(s->layers[0].alpha_y.value[1], 0.4, 0.0);
    assert_int_equal(s->layers[0].medium.tau.form, LQ_ONE);
    assert_false(s->layers[1].anisotropic);
    assert_int_equal(lq_stack_range(s, "base.kappa", &low, &high, &error), LQ_OK);
    assert_near(high, 100.0, 0.0);
    static const char *const bad[][2] = {
        {"top.alpha", "top.alpha = 1.5; accepted: 0 <= alpha.x <= 1"},
        {"3.alpha", "'3.alpha' names no layer; accepted: top.NAME, base.NAME or N.NAME, N from 1 to 2"},
        {"alpha", "'alpha' names no layer; accepted: top.NAME, base.NAME or N.NAME, N from 1 to 2"},
        {"base.rho", "'base.rho': a conductor has no such parameter; accepted: n, kappa, alpha, alpha.x, "
                     "alpha.y, alpha.rotate"},
        {"top.sigma_a", "'top.sigma_a': the medium is said by tau"}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(lq_stack_set(s, bad[i][0], 1.5, &error), LQ_BAD_INPUT);
        assert_string_equal(error.text, bad[i][1]);
    }
    assert_int_equal(lq_stack_set(s, "top.alpha", NAN, &error), LQ_BAD_INPUT);
    lq_stack_free(s);
}

#define D(text) LAYERS("{\"dielectric\":\n{" text "}}")
#define M(text) LAYERS("{\"dielectric\": {\"n\": 1.5, \"alpha\": 0},\n\"medium\": " text "}," BASE)

static const char *const refusals[][2] = {
    {"", "a.json:1: not JSON: '[' or '{' expected near end of file"},
    {"{\"layers\":\n[NaN]}", "a.json:2: not JSON: invalid token near 'NaN'"},
    {"{\"name\": \"a\",\n\"name\": \"b\"}", "a.json:2: not JSON: duplicate object key near '\"name\"'"},
    {"[]", "a.json: line 1: no object; accepted: {\"layers\": [...]}"},
    {"{\n\"name\": 3}", "a.json: line 2: name is no text of at most 127 bytes"},
    {"{\n\"layer\": 3}", "a.json: line 2: unknown key 'layer'; accepted: name, layers"},
    {"{}", "a.json: line 1: layers is missing, empty or too long; accepted: a list of 1 to 4096"},
    {"{\n\n\"layers\": []}",
     "a.json: line 3: layers is missing, empty or too long; accepted: a list of 1 to 4096"},
    {LAYERS("3"),
     "a.json: line 2: layer 1: no object; accepted: {\"dielectric\": ...}, {\"conductor\": ...}, "
     "{\"lambertian\": ...}"},
    {LAYERS("{}"),
     "a.json: line 2: layer 1: no interface; accepted: one of dielectric, conductor, lambertian"},
    {LAYERS("{\"lambertian\": {\"rho\": 1}, \"conductor\": {}}"),
     "a.json: line 2: layer 1: two interfaces in one layer; accepted: one of dielectric, conductor, "
     "lambertian"},
    {LAYERS("{\"mirror\": {}}"),
     "a.json: line 2: layer 1: unknown key 'mirror'; accepted: dielectric, conductor, lambertian, medium"},
    {LAYERS(BASE ",\n" BASE),
     "a.json: line 2: layer 1: a lambertian that is not the last layer; accepted: as the last one"},
    {LAYERS("{\"lambertian\": 3}"),
     "a.json: line 2: layer 1: lambertian is no object; accepted: {...} with rho"},
    {LAYERS("{\"lambertian\": {\n\"rho\": 2}}"), "a.json: line 3: layer 1: rho = 2; accepted: 0 <= rho <= 1"},
    {LAYERS("{\"lambertian\": {\"rho\": 1}, \"medium\": {\"tau\": 1}}"),
     "a.json: line 2: layer 1: nothing lies below a lambertian; accepted: a medium below a dielectric"},
    {LAYERS("{\"conductor\": {\"n\": 0, \"kappa\": 0, \"alpha\": 0}}"),
     "a.json: line 2: layer 1: n and kappa are both 0; accepted: a kappa > 0 makes a perfect mirror"},
    {LAYERS("{\"conductor\": {\"n\": 1, \"kappa\": -1, \"alpha\": 0}}"),
     "a.json: line 2: layer 1: kappa = -1; accepted: 0 <= kappa <= 100"},
    {D("\"alpha\": 0"), "a.json: line 2: layer 1: n is missing"},
    {D("\"n\": 1.5"), "a.json: line 2: layer 1: alpha is missing; 0 is a smooth interface"},
    {D("\n\"n\": 0, \"alpha\": 0"), "a.json: line 4: layer 1: n = 0; accepted: 0 < n <= 10"},
    {D("\"n\": \"x\", \"alpha\": 0"),
     "a.json: line 3: layer 1: n is no number; accepted: a number or [r, g, b]"},
    {D("\"n\": [1, 2], \"alpha\": 0"),
     "a.json: line 3: layer 1: n: a list of 2; accepted: a number or [r, g, b]"},
    {D("\"n\": [1, 2, true], \"alpha\": 0"),
     "a.json: line 3: layer 1: n: entry 3 is no number; accepted: a number or [r, g, b]"},
    {D("\"n\": [1, 2, 11], \"alpha\": 0"), "a.json: line 3: layer 1: n = 11; accepted: 0 < n <= 10"},
    {D("\"n\": 1.5, \"alpha\": {\"min\": 0, \"max\": 1}"),
     "a.json: line 3: layer 1: alpha.x: a range, which only scenes take; accepted: a number or [r, g, b]"},
    {D("\"n\": 1.5, \"alpha\": {\"x\": 0, \"z\": 1}"),
     "a.json: line 3: layer 1: alpha: unknown key 'z'; accepted: x, y, rotate"},
    {D("\"n\": 1.5, \"alpha\": {\"x\": 0}"), "a.json: line 2: layer 1: alpha.y is missing"},
    {D("\"n\": 1.5, \"alpha\": 0, \"ndf\": 3"),
     "a.json: line 3: layer 1: ndf is no text; accepted: an NDF of lacquer list"},
    {D("\"n\": 1.5, \"alpha\": 0, \"ndf\": \"plugin:evil.so\""),
     "a.json: line 3: layer 1: NDF 'plugin:evil.so' is named by a description, which is not trusted to open "
     "files"},
    {D("\"n\": 1.5, \"alpha\": 0, \"ndf\": \"file:/etc/shadow\""),
     "a.json: line 3: layer 1: NDF 'file:/etc/shadow' is named by a description, which is not trusted to "
     "open files"},
    {D("\"n\": 1.5, \"alpha\": 0, \"ndf\": \"ggx:a\""),
     "a.json: line 3: layer 1: NDF ggx takes no parameters, not 'a'"},
    {M("{}"),
     "a.json: line 3: layer 1: medium is empty or no object; accepted: {\"tau\": T} or sigma_a, sigma_s, "
     "depth, g"},
    {M("{\"tau\": 2}"), "a.json: line 3: layer 1: tau = 2; accepted: 0 <= tau <= 1"},
    {M("{\"tau\": 1, \"g\": 0}"), "a.json: line 3: layer 1: unknown key 'g'; accepted: tau"},
    {M("{\"sigma_a\": 1}"), "a.json: line 3: layer 1: depth is missing"},
    {M("{\"depth\": 1, \"g\": 1}"), "a.json: line 3: layer 1: g = 1; accepted: -1 < g < 1"},
};

static void test_refuses(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof refusals / sizeof refusals[0]; i++) {
        lq_stack *stack;
        lq_error error = {""};
        assert_true(lq_stack_parse(&stack, refusals[i][0], "a.json", 0, &error) != LQ_OK);
        assert_null(stack);
        assert_string_equal(error.text, refusals[i][1]);
    }
    lq_stack *stack;
    assert_int_equal(lq_stack_read(&stack, "/nowhere.json", 0, NULL), LQ_IO);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reads),
        cmocka_unit_test(test_writes),
        cmocka_unit_test(test_sets),
        cmocka_unit_test(test_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

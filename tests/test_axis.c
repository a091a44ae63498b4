/* test_axis.c - node maps against their inverses, and every refused form of an axis. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lacquer.h"
#include "system/status.h"

static void assert_contains(const char *text, const char *part) {
    if (!strstr(text, part)) fail_msg("'%s' does not contain '%s'", text, part);
}

/* ------------------------------------------------------------------ messages */

static void test_message_is_one_short_line(void **state) {
    (void)state;
    lq_error error;
    assert_int_equal(lq_fail(&error, LQ_IO, "a\nb\tc %d.\n", 7), LQ_IO);
    assert_string_equal(error.text, "a b c 7");
    assert_int_equal(lq_fail(NULL, LQ_FORMAT, "x"), LQ_FORMAT);
    lq_fail(&error, LQ_IO, "<%s>", error.text); /* its own text among the arguments */
    assert_string_equal(error.text, "<a b c 7>");
}

static void test_message_cut_between_characters(void **state) {
    (void)state;
    lq_error error;
    char text[2 * LQ_MESSAGE_SIZE] = "";
    for (size_t i = 0; i < LQ_MESSAGE_SIZE - 2; i++) text[i] = 'a';
    strcat(text, "\xE2\x88\x9E\xE2\x88\x9E"); /* only one byte of the first sign fits */
    lq_fail(&error, LQ_IO, "%s", text);
    assert_int_equal(strlen(error.text), LQ_MESSAGE_SIZE - 2);
    lq_fail(&error, LQ_IO, "%s", text + 2); /* all three bytes fit, the next sign does not */
    assert_int_equal(strlen(error.text), LQ_MESSAGE_SIZE - 1);
    assert_memory_equal(error.text + LQ_MESSAGE_SIZE - 4, "\xE2\x88\x9E", 3);
}

/* ------------------------------------------------------------------ maps */

static void check_round_trip(double min, double max, size_t size, lq_map map, double exponent) {
    lq_axis axis;
    lq_error error;
    if (lq_axis_make(&axis, "x", min, max, size, map, exponent, &error)) fail_msg("%s", error.text);
    assert_true(axis.nodes[0] == min && axis.nodes[size - 1] == max);
    double range = max - min, last = (double)(size - 1);
    for (size_t i = 0; i < size; i++) {
        assert_true(fabs(lq_axis_locate(&axis, axis.nodes[i]) - (double)i) <= 1e-12);
        if (i + 1 == size) break;
        double x = 0.5 * (axis.nodes[i] + axis.nodes[i + 1]), index = lq_axis_locate(&axis, x);
        assert_true(index >= (double)i && index <= (double)(i + 1));
        if (fabs(min) > 1e3) continue; /* nodes are rounded there */
        double u = index / last, p = map == LQ_MAP_LINEAR ? 1 : map == LQ_MAP_SQRT ? 2 : exponent;
        assert_true(fabs(min + range * pow(u, p) - x) <= 1e-14 * (range + fabs(min)));
    }
    assert_true(lq_axis_locate(&axis, min - 1) == 0 && lq_axis_locate(&axis, -INFINITY) == 0);
    assert_true(lq_axis_locate(&axis, max + 1) == last && lq_axis_locate(&axis, INFINITY) == last);
    assert_true(lq_axis_locate(&axis, NAN) == 0);
    lq_axis_free(&axis);
    assert_null(axis.nodes);
}

static void test_maps_and_inverses(void **state) {
    (void)state;
    const size_t sizes[] = {2, 3, 7, 64, 1000};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        check_round_trip(0, 1, sizes[k], LQ_MAP_LINEAR, 0);
        check_round_trip(0, 1, sizes[k], LQ_MAP_SQRT, 0);
        check_round_trip(0, 4, sizes[k], LQ_MAP_POWER, 2.5);
        check_round_trip(0, 1, sizes[k], LQ_MAP_POWER, 0.3);
        check_round_trip(-3, 7.1, sizes[k], LQ_MAP_POWER, 4);
        check_round_trip(0.1, 0.3, sizes[k], LQ_MAP_SQRT, 0);
        check_round_trip(1e9, 1e9 + 1, sizes[k], LQ_MAP_LINEAR, 0);
        check_round_trip(-1e300, 1e300, sizes[k] == 1000 ? 2 : sizes[k], LQ_MAP_LINEAR, 0);
    }
    check_round_trip(0, 1, 1 << 20, LQ_MAP_LINEAR, 0);
    check_round_trip(0, 1, 1 << 20, LQ_MAP_SQRT, 0);
}

static void test_known_nodes(void **state) {
    (void)state;
    lq_axis axis;
    assert_int_equal(lq_axis_make(&axis, "alpha", 0, 1, 5, LQ_MAP_SQRT, 99, NULL), LQ_OK);
    const double squares[] = {0, 0.0625, 0.25, 0.5625, 1};
    assert_memory_equal(axis.nodes, squares, sizeof squares);
    assert_true(axis.exponent == 2);
    assert_true(fabs(lq_axis_locate(&axis, 0.140625) - 1.5) < 1e-15);
    lq_axis_free(&axis);
}

static void test_one_node(void **state) {
    (void)state;
    lq_axis axis;
    assert_int_equal(lq_axis_make(&axis, "eta", 1.5, 1.5, 1, LQ_MAP_LINEAR, 0, NULL), LQ_OK);
    assert_true(axis.nodes[0] == 1.5);
    assert_true(lq_axis_locate(&axis, 1) == 0 && lq_axis_locate(&axis, 1.5) == 0 &&
                lq_axis_locate(&axis, 2) == 0);
    lq_axis_free(&axis);
}

static void test_custom(void **state) {
    (void)state;
    const double nodes[] = {-1, 0, 0.1, 1, 3};
    lq_axis axis, copy;
    assert_int_equal(lq_axis_make_custom(&axis, "x", nodes, 5, NULL), LQ_OK);
    assert_int_equal(lq_axis_copy(&copy, &axis, NULL), LQ_OK);
    lq_axis_free(&axis);
    assert_true(copy.map == LQ_MAP_CUSTOM && copy.exponent == 0 && copy.min == -1 && copy.max == 3);
    for (int i = 0; i < 5; i++) assert_true(lq_axis_locate(&copy, nodes[i]) == i);
    assert_true(lq_axis_locate(&copy, 2) == 3.5);
    assert_true(lq_axis_locate(&copy, -0.75) == 0.25);
    assert_true(lq_axis_locate(&copy, 9) == 4);
    lq_axis_free(&copy);
}

/* ------------------------------------------------------------------ refused */

static void refuse_make(double min, double max, size_t size, lq_map map, double exponent, const char *part) {
    lq_axis axis;
    lq_error error = {""};
    assert_int_equal(lq_axis_make(&axis, "kappa", min, max, size, map, exponent, &error), LQ_BAD_INPUT);
    assert_int_equal(lq_axis_make(&axis, "kappa", min, max, size, map, exponent, NULL), LQ_BAD_INPUT);
    assert_null(axis.nodes);
    assert_contains(error.text, "kappa");
    assert_contains(error.text, part);
    assert_contains(error.text, "accepted");
}

static void test_refused_ranges(void **state) {
    (void)state;
    refuse_make(0, 1, 0, LQ_MAP_LINEAR, 0, "1 to 1048576");
    refuse_make(0, 1, ((size_t)1 << 20) + 1, LQ_MAP_LINEAR, 0, "1 to 1048576");
    refuse_make(0, 1, SIZE_MAX, LQ_MAP_LINEAR, 0, "1 to 1048576");
    refuse_make(1, 0, 4, LQ_MAP_LINEAR, 0, "minimum below");
    refuse_make(1, 1, 4, LQ_MAP_LINEAR, 0, "minimum below");
    refuse_make(0, 1, 1, LQ_MAP_LINEAR, 0, "equal ends");
    refuse_make(0, NAN, 4, LQ_MAP_LINEAR, 0, "finite");
    refuse_make(-INFINITY, 1, 4, LQ_MAP_LINEAR, 0, "finite");
    refuse_make(-1e308, 1e308, 4, LQ_MAP_LINEAR, 0, "finite");
    refuse_make(0, 1, 4, LQ_MAP_POWER, 0, "above 0");
    refuse_make(0, 1, 4, LQ_MAP_POWER, -1, "above 0");
    refuse_make(0, 1, 4, LQ_MAP_POWER, NAN, "above 0");
    refuse_make(0, 1, 4, LQ_MAP_CUSTOM, 1, "linear, sqrt and power");
    refuse_make(1, 2, 64, LQ_MAP_POWER, 50, "strictly increasing"); /* 1 + 63^-50 is 1 */
}

static void test_refused_names(void **state) {
    (void)state;
    const char *names[] = {"", "a b", "a=b", "mu:", "\xCE\xBC", "a-name-of-more-than-thirty-one-characters"};
    lq_axis axis;
    lq_error error;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(lq_axis_make(&axis, names[i], 0, 1, 2, LQ_MAP_LINEAR, 0, &error), LQ_BAD_INPUT);
        assert_contains(error.text, "accepted are");
    }
    assert_int_equal(lq_axis_make(&axis, NULL, 0, 1, 2, LQ_MAP_LINEAR, 0, &error), LQ_BAD_INPUT);
}

static void test_refused_custom(void **state) {
    (void)state;
    const double equal[] = {0, 1, 1, 2}, falling[] = {0, 2, 1, 3}, bad[] = {0, NAN, 1},
                 open[] = {0, INFINITY};
    lq_axis axis;
    lq_error error;
    assert_int_equal(lq_axis_make_custom(&axis, "x", equal, 4, &error), LQ_BAD_INPUT);
    assert_contains(error.text, "node 1 is 1 and the next 1");
    assert_int_equal(lq_axis_make_custom(&axis, "x", falling, 4, &error), LQ_BAD_INPUT);
    assert_contains(error.text, "strictly increasing");
    assert_int_equal(lq_axis_make_custom(&axis, "x", bad, 3, &error), LQ_BAD_INPUT);
    assert_int_equal(lq_axis_make_custom(&axis, "x", open, 2, &error), LQ_BAD_INPUT);
    assert_contains(error.text, "finite");
    assert_int_equal(lq_axis_make_custom(&axis, "x", equal, 0, &error), LQ_BAD_INPUT);
    assert_int_equal(lq_axis_make_custom(&axis, "x", NULL, 2, &error), LQ_BAD_INPUT);
}

/* ------------------------------------------------------------------ command line */

static void check_parse(const char *text, double min, double max, size_t size, lq_map map, double exponent) {
    lq_axis axis;
    lq_error error;
    if (lq_axis_parse(&axis, "alpha", text, &error)) fail_msg("%s", error.text);
    assert_string_equal(axis.name, "alpha");
    assert_true(axis.min == min && axis.max == max && axis.size == size);
    assert_true(axis.map == map && axis.exponent == exponent);
    lq_axis_free(&axis);
}

static void test_parse(void **state) {
    (void)state;
    check_parse("0:1:64", 0, 1, 64, LQ_MAP_LINEAR, 1);
    check_parse("-1.5:4e2:2:linear", -1.5, 400, 2, LQ_MAP_LINEAR, 1);
    check_parse("0:1:64:sqrt", 0, 1, 64, LQ_MAP_SQRT, 2);
    check_parse("0:1:8:power2.5", 0, 1, 8, LQ_MAP_POWER, 2.5);
    check_parse("0:1:8:power2", 0, 1, 8, LQ_MAP_POWER, 2);
    check_parse("0.3", 0.3, 0.3, 1, LQ_MAP_LINEAR, 1);
    check_parse("2:2:1", 2, 2, 1, LQ_MAP_LINEAR, 1);
    check_parse("0,0.1,1,3", 0, 3, 4, LQ_MAP_CUSTOM, 0);
}

static void test_parse_refused(void **state) {
    (void)state;
    const struct {
        const char *text, *part;
    } cases[] = {
        {"", "is empty"},
        {"abc", "'abc' is not a number"},
        {"1x", "'1x' is not a number"},
        {" 1", "' 1' is not a number"},
        {"0:1", "without a number of nodes"},
        {"x:1:4", "'x' is not a number"},
        {"0:y:4", "'y' is not a number"},
        {"0::4", "'' is not a number"},
        {"0:1:4.5", "'4.5' is not a number of nodes"},
        {"0:1:-4", "'-4' is not a number of nodes"},
        {"0:1:", "'' is not a number of nodes"},
        {"0:1:0", "1 to 1048576"},
        {"0:1:99999999999999999999999", "1 to 1048576"},
        {"0:1:1", "equal ends"},
        {"1:0:4", "minimum below"},
        {"nan:1:4", "finite"},
        {"0:inf:4", "finite"},
        {"nan", "finite"},
        {"0:1:4:cubic", "'cubic' is not a map"},
        {"0:1:4:", "'' is not a map"},
        {"0:1:4:power", "'power' is not a map"},
        {"0:1:4:powerful", "'powerful' is not a map"},
        {"0:1:4:power-2", "above 0"},
        {"0:1:4:power0", "above 0"},
        {"0:1:4:custom", "'custom' is not a map"},
        {"0:1:4:sqrt:5", "one part too many"},
        {"0,", "'' is not a number"},
        {",1", "'' is not a number"},
        {"0,x,1", "'x' is not a number"},
        {"0,2,1", "strictly increasing"},
        {"0,1,inf", "finite"},
        {"0,0", "minimum below"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lq_axis axis;
        lq_error error = {""};
        assert_int_equal(lq_axis_parse(&axis, "alpha", cases[i].text, &error), LQ_BAD_INPUT);
        assert_null(axis.nodes);
        assert_contains(error.text, "alpha");
        assert_contains(error.text, cases[i].part);
        assert_contains(error.text, "accepted");
    }
}

static void test_map_names(void **state) {
    (void)state;
    assert_string_equal(lq_map_name(LQ_MAP_LINEAR), "linear");
    assert_string_equal(lq_map_name(LQ_MAP_SQRT), "sqrt");
    assert_string_equal(lq_map_name(LQ_MAP_POWER), "power");
    assert_string_equal(lq_map_name(LQ_MAP_CUSTOM), "custom");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_message_is_one_short_line),
        cmocka_unit_test(test_message_cut_between_characters),
        cmocka_unit_test(test_maps_and_inverses),
        cmocka_unit_test(test_known_nodes),
        cmocka_unit_test(test_one_node),
        cmocka_unit_test(test_custom),
        cmocka_unit_test(test_refused_ranges),
        cmocka_unit_test(test_refused_names),
        cmocka_unit_test(test_refused_custom),
        cmocka_unit_test(test_parse),
        cmocka_unit_test(test_parse_refused),
        cmocka_unit_test(test_map_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

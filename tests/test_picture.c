/* Colour maps, ticks, scales, and what an image and a page hold of a table. */
#include <cairo/cairo.h>
#include <stdlib.h>
#include <string.h>

#include "picture/colour.h"
#include "picture/draw.h"
#include "picture/page.h"
#include "picture/text.h"
#include "picture/ticks.h"
#include "tests/expect.h"
#include "tests/scratch.h"

/* ======================================================================================
 *                                       Colours
 * ====================================================================================== */

/* Machado 2009, severity 1, in linear light. */
static const double protan[3][3] = {
    {0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}};
static const double deutan[3][3] = {
    {0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}};

static double linear(unsigned char v) {
    return v <= 10 ? v / 255.0 / 12.92 : pow((v / 255.0 + 0.055) / 1.055, 2.4);
}

static unsigned char stored(double v) {
    v = fmin(fmax(v, 0.0), 1.0);
    return (unsigned char)lround(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055));
}

static lq_rgb seen(lq_rgb colour, const double eye[3][3]) {
    const double in[3] = {linear(colour.r), linear(colour.g), linear(colour.b)};
    double out[3];
    for (int i = 0; i < 3; i++) out[i] = eye[i][0] * in[0] + eye[i][1] * in[1] + eye[i][2] * in[2];
    return (lq_rgb){stored(out[0]), stored(out[1]), stored(out[2])};
}

static double distance(lq_rgb a, lq_rgb b) {
    double p[3], q[3];
    lq_colour_to_oklab(a, p);
    lq_colour_to_oklab(b, q);
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double lightness(lq_rgb colour) {
    double lab[3];
    lq_colour_to_oklab(colour, lab);
    return lab[0];
}

/* Ottosson's own examples: white is L = 1 without hue, red is as published. */
static void oklab_is_as_published(void **state) {
    (void)state;
    double lab[3];
    lq_colour_to_oklab((lq_rgb){255, 255, 255}, lab);
    assert_true(fabs(lab[0] - 1.0) < 1e-6 && fabs(lab[1]) < 1e-6 && fabs(lab[2]) < 1e-6);
    lq_colour_to_oklab((lq_rgb){255, 0, 0}, lab);
    assert_true(fabs(lab[0] - 0.62796) < 1e-4 && fabs(lab[1] - 0.22486) < 1e-4 &&
                fabs(lab[2] - 0.12585) < 1e-4);
    double back[3];
    lq_colour_from_oklab(lab, back);
    assert_true(fabs(back[0] - 1.0) < 1e-5 && fabs(back[1]) < 1e-5 && fabs(back[2]) < 1e-5);
}

static void lightness_grows_evenly(void **state) {
    (void)state;
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(LQ_COLOURS_VALUE, steps);
    const double dark = lightness(steps[0]), light = lightness(steps[255]);
    assert_true(dark < 0.2 && light > 0.94);
    for (int i = 0; i < LQ_COLOUR_STEPS; i++) {
        assert_true(fabs(lightness(steps[i]) - dark - (light - dark) * i / 255.0) < 0.006);
        if (i > 0) assert_true(lightness(steps[i]) > lightness(steps[i - 1]));
    }
}

/* Sixteenths of the map are about as far apart, for every eye. */
static void steps_are_even(void **state) {
    (void)state;
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(LQ_COLOURS_VALUE, steps);
    double least = INFINITY, most = 0.0;
    for (int i = 0; i + 16 < LQ_COLOUR_STEPS; i++) {
        least = fmin(least, distance(steps[i], steps[i + 16]));
        most = fmax(most, distance(steps[i], steps[i + 16]));
        assert_true(distance(seen(steps[i], protan), seen(steps[i + 16], protan)) > 0.028);
        assert_true(distance(seen(steps[i], deutan), seen(steps[i + 16], deutan)) > 0.04);
        assert_true(lightness(seen(steps[i + 16], protan)) > lightness(seen(steps[i], protan)));
        assert_true(lightness(seen(steps[i + 16], deutan)) > lightness(seen(steps[i], deutan)));
    }
    assert_true(most / least < 1.5);
}

static void signs_differ(void **state) {
    (void)state;
    lq_rgb steps[LQ_COLOUR_STEPS];
    lq_colour_steps(LQ_COLOURS_SIGNED, steps);
    assert_true(lightness(steps[127]) > 0.96 && lightness(steps[128]) > 0.96);
    for (int i = 0; i < 128; i++) {
        assert_true(fabs(lightness(steps[i]) - lightness(steps[255 - i])) < 0.006);
        if (i > 0) assert_true(lightness(steps[i]) > lightness(steps[i - 1]));
        if (i > 60) continue; /* closer to zero than half the scale */
        assert_true(distance(steps[i], steps[255 - i]) > 0.14);
        assert_true(distance(seen(steps[i], protan), seen(steps[255 - i], protan)) > 0.1);
        assert_true(distance(seen(steps[i], deutan), seen(steps[255 - i], deutan)) > 0.1);
    }
}

static void no_number_is_no_step(void **state) {
    (void)state;
    lq_rgb steps[LQ_COLOUR_STEPS];
    assert_int_equal(lq_colour_step(NAN, 0.0, 1.0), -1);
    assert_int_equal(lq_colour_step(INFINITY, 0.0, 1.0), -1);
    assert_int_equal(lq_colour_step(-5.0, 0.0, 1.0), 0);
    assert_int_equal(lq_colour_step(5.0, 0.0, 1.0), 255);
    assert_int_equal(lq_colour_step(0.5, 0.0, 1.0), 128);
    for (int map = 0; map < 2; map++) {
        lq_colour_steps((lq_colours)map, steps);
        for (int i = 0; i < LQ_COLOUR_STEPS; i++) assert_true(distance(steps[i], lq_colour_bad()) > 0.1);
    }
}

/* ======================================================================================
 *                                        Ticks
 * ====================================================================================== */

static void expect_ticks(const lq_axis *axis, double gap, const char *wanted) {
    lq_tick ticks[LQ_TICKS_MAX];
    char text[LQ_TICKS_MAX * (LQ_TICK_TEXT + 1) + 1] = "", *end = text;
    const size_t count = lq_ticks(axis, gap, ticks);
    for (size_t i = 0; i < count; i++) {
        if (i > 0) assert_true(ticks[i].at - ticks[i - 1].at >= gap);
        end += sprintf(end, "%s%.*s", i ? " " : "", LQ_TICK_TEXT - 1, ticks[i].text);
    }
    assert_string_equal(text, wanted);
}

static void ticks_are_round(void **state) {
    (void)state;
    lq_axis axis;
    assert_int_equal(lq_axis_parse(&axis, "mu", "0:1:5", NULL), LQ_OK);
    expect_ticks(&axis, 0.11, "0 0.2 0.4 0.6 0.8 1");
    expect_ticks(&axis, 0.3, "0 0.5 1");
    lq_axis_free(&axis);
    assert_int_equal(lq_axis_parse(&axis, "eta", "1.02:2.5:24", NULL), LQ_OK);
    expect_ticks(&axis, 0.12, "1.2 1.4 1.6 1.8 2 2.2 2.4");
    lq_axis_free(&axis);
    assert_int_equal(lq_axis_parse(&axis, "mu", "0:1:32:sqrt", NULL), LQ_OK);
    expect_ticks(&axis, 0.12, "0 0.02 0.1 0.2 0.5 0.7 1");
    lq_tick ticks[LQ_TICKS_MAX];
    assert_int_equal(lq_ticks(&axis, 0.12, ticks), 7);
    assert_true(fabs(ticks[4].at - sqrt(0.5)) < 1e-12);
    lq_axis_free(&axis);
    assert_int_equal(lq_axis_parse(&axis, "n", "0.2", NULL), LQ_OK);
    expect_ticks(&axis, 0.1, "0.2");
    lq_axis_free(&axis);
}

/* A range no wider than rounding, and one as wide as floats are. */
static void ticks_end(void **state) {
    (void)state;
    lq_tick ticks[LQ_TICKS_MAX];
    assert_true(lq_ticks_linear(1e20, nextafter(1e20, 1e21), 0.1, ticks) <= LQ_TICKS_MAX);
    assert_true(lq_ticks_linear(-3.4e38, 3.4e38, 0.1, ticks) >= 3);
    assert_true(lq_ticks_linear(0.0, 1e-30, 0.1, ticks) >= 3);
    assert_true(lq_ticks_linear(0.0, 1.0, 0.0, ticks) <= LQ_TICKS_MAX);
}

/* ======================================================================================
 *                                     Scales and text
 * ====================================================================================== */

static void scales_can_be_divided_by(void **state) {
    (void)state;
    double range[2];
    bool is_signed = false;
    lq_panel_range(LQ_PANEL_MAP, (const float[]){0.25f, NAN, 0.75f}, 3, range, &is_signed);
    assert_true(range[0] == 0.25 && range[1] == 0.75 && !is_signed);
    lq_panel_range(LQ_PANEL_MAP, (const float[]){-0.25f, INFINITY, 0.75f}, 3, range, &is_signed);
    assert_true(range[0] == -0.75 && range[1] == 0.75 && is_signed);
    lq_panel_range(LQ_PANEL_LINES, (const float[]){-0.25f, 0.75f}, 2, range, &is_signed);
    assert_true(range[0] == -0.25 && range[1] == 0.75 && !is_signed);
    lq_panel_range(LQ_PANEL_MAP, (const float[]){0.5f, 0.5f}, 2, range, &is_signed);
    assert_true(range[0] < 0.5 && range[1] > 0.5);
    lq_panel_range(LQ_PANEL_MAP, (const float[]){NAN, NAN}, 2, range, &is_signed);
    assert_true(range[0] == 0.0 && range[1] == 1.0);
}

static void text_is_valid(void **state) {
    (void)state;
    char code[LQ_TEXT_CODE_SIZE];
    char *clean = lq_text_clean("a<\xc3\xa9\n\xff\xc0\xbc&");
    assert_string_equal(clean, "a<\xc3\xa9\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd&");
    free(clean);
    assert_int_equal(lq_text_character("<", code), 1);
    assert_string_equal(code, "&lt;");
    assert_int_equal(lq_text_character("\xc0\xbc", code), 1); /* an overlong '<' is no '<' */
    assert_string_equal(code, "\xef\xbf\xbd");
}

/* ======================================================================================
 *                                   Images and pages
 * ====================================================================================== */

/* 5 x 4 x 3 nodes, value x + 10 y + 100 z in their numbers, one of them no number. */
static lq_table *make_table(void) {
    static const char *const channel = "v";
    lq_axis axes[3];
    lq_table *table = NULL;
    assert_int_equal(lq_axis_parse(&axes[0], "x", "0:1:5:sqrt", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "y", "0:1:4", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[2], "z", "1:3:3", NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 3, &channel, 1, NULL), LQ_OK);
    for (int i = 0; i < 60; i++) table->channels[0][i] = (float)(i % 5 + 10 * (i / 5 % 4) + 100 * (i / 20));
    table->channels[0][20 + 5 * 2 + 3] = NAN;
    for (int a = 0; a < 3; a++) lq_axis_free(&axes[a]);
    return table;
}

static lq_rgb pixel(cairo_surface_t *image, double x, double y) {
    const unsigned char *row =
        cairo_image_surface_get_data(image) + (size_t)y * (size_t)cairo_image_surface_get_stride(image);
    uint32_t bits;
    memcpy(&bits, row + 4 * (size_t)x, sizeof bits);
    return (lq_rgb){(unsigned char)(bits >> 16), (unsigned char)(bits >> 8), (unsigned char)bits};
}

/* Every node of the slice z = 2 has its colour at its place. */
static void image_shows_every_node(void **state) {
    (void)state;
    lq_table *table = make_table();
    lq_figure *figure = NULL;
    lq_rgb steps[LQ_COLOUR_STEPS];
    const double point[] = {0.0, 0.0, 2.0};
    const lq_slice slice = {.table = table, .x = 0, .y = 1, .at = point};
    assert_int_equal(lq_figure_create(&figure, "t", NULL, NULL), LQ_OK);
    assert_int_equal(lq_figure_add_slice(figure, &slice, NULL), LQ_OK);
    assert_true(figure->panels[0].low == 100.0 && figure->panels[0].high == 134.0);
    assert_int_equal(lq_draw_write(figure, LQ_IMAGE_PNG, at("t.png"), NULL), LQ_OK);
    cairo_surface_t *image = cairo_image_surface_create_from_png(at("t.png"));
    const lq_box box = lq_draw_plot(figure, 0);
    lq_colour_steps(LQ_COLOURS_VALUE, steps);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 5; x++) {
            const double width = box.width * LQ_DRAW_SCALE - 1.0, height = box.height * LQ_DRAW_SCALE - 1.0;
            const lq_rgb shown = pixel(image, box.x * LQ_DRAW_SCALE + width * x / 4.0,
                                       box.y * LQ_DRAW_SCALE + height * (3 - y) / 3.0);
            const lq_rgb wanted =
                x == 3 && y == 2 ? lq_colour_bad() : steps[lround(255.0 * (x + 10 * y) / 34.0)];
            assert_memory_equal(&shown, &wanted, sizeof shown);
        }
    unlink(at("t.png"));
    cairo_surface_destroy(image);
    lq_figure_free(figure);
    lq_table_free(table);
}

static void thinning_keeps_the_ends(void **state) {
    (void)state;
    lq_table table = {.axis_count = 4};
    size_t kept[LQ_MAX_AXES];
    for (int a = 0; a < 4; a++) table.axes[a].size = 64;
    lq_page_thin(&table, 0, 2, 300000, kept);
    assert_true((double)kept[0] * (double)kept[1] * (double)kept[2] * (double)kept[3] <= 300000.0);
    assert_true((double)kept[0] * (double)kept[1] * (double)kept[2] * (double)kept[3] > 250000.0);
    assert_true(kept[0] >= 2 * kept[1] - 2 && kept[2] >= 2 * kept[3] - 2);
    assert_int_equal(lq_page_node(0, kept[0], 64), 0);
    assert_int_equal(lq_page_node(kept[0] - 1, kept[0], 64), 63);
    table.axes[1].size = table.axes[3].size = 1;
    lq_page_thin(&table, 0, 2, 300000, kept);
    assert_true(kept[0] == 64 && kept[1] == 1 && kept[2] == 64 && kept[3] == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oklab_is_as_published),
        cmocka_unit_test(lightness_grows_evenly),
        cmocka_unit_test(steps_are_even),
        cmocka_unit_test(signs_differ),
        cmocka_unit_test(no_number_is_no_step),
        cmocka_unit_test(ticks_are_round),
        cmocka_unit_test(ticks_end),
        cmocka_unit_test(scales_can_be_divided_by),
        cmocka_unit_test(text_is_valid),
        cmocka_unit_test(image_shows_every_node),
        cmocka_unit_test(thinning_keeps_the_ends),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

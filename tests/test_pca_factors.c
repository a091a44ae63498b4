/* test_pca_factors.c - factored tables: halves, look-up by hand, the file, and files that lie. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "pca/factors.h"
#include "tables/half.h"

/* ------------------------------------------------------------------ halves */

static void test_every_half_round_trips(void **state) {
    (void)state;
    for (uint32_t h = 0; h < 0x10000; h++) {
        const float value = lq_half_to_float((uint16_t)h);
        if (isnan(value)) assert_true(isnan(lq_half_round(value)));
        else assert_int_equal(lq_half_from_float(value), h);
    }
}

/* Nearest by search: no half lies nearer, and of two as near the even one is taken. */
static void test_rounding_is_to_nearest_even(void **state) {
    (void)state;
    for (uint32_t h = 0; h < 0x7bff; h++) {
        const float low = lq_half_to_float((uint16_t)h), high = lq_half_to_float((uint16_t)(h + 1));
        const float middle = 0.5f * (low + high); /* exact in binary32 */
        assert_int_equal(lq_half_from_float(middle), h + (h & 1));
        assert_int_equal(lq_half_from_float(nextafterf(middle, 0.0f)), h);
        assert_int_equal(lq_half_from_float(nextafterf(middle, 1e6f)), h + 1);
        assert_int_equal(lq_half_from_float(-nextafterf(middle, 1e6f)), 0x8000 | (h + 1));
    }
    assert_int_equal(lq_half_from_float(65519.9f), 0x7bff);
    assert_true(isinf(lq_half_round(65520.0f)));
}

/* ------------------------------------------------------------------ a table made by hand */

static lq_texture_axis texture_axis(int axis, const char *text) {
    lq_texture_axis made = {.coordinate = LQ_COORDINATE_AXIS, .axis = axis};
    assert_int_equal(lq_axis_parse(&made.texels, "texels", text, NULL), LQ_OK);
    return made;
}

/* Fill with halves in [0.25, 1): every sum of the tests stays in range. */
static void fill(lq_factor *factor, uint64_t *seed) {
    const size_t values = lq_factor_texels(factor) * factor->base_count;
    for (size_t i = 0; i < values; i++) {
        *seed = *seed * 6364136223846793005u + 1442695040888963407u;
        factor->data[i] = lq_half_round(0.25f + 0.75f * (float)(*seed >> 40) * 0x1p-24f);
    }
}

/* Axes mu, eta, tau. Below eta = 1 energy and cosine of a crossing, above it plain. */
static lq_factored *make(void) {
    lq_factored *made = calloc(1, sizeof *made);
    const char *names[] = {"mu", "eta", "tau"};
    const double min[] = {0.0, 0.5, 0.0}, max[] = {1.0, 2.0, 1.0};
    uint64_t seed = 7;
    assert_non_null(made);
    made->axis_count = 3;
    for (int a = 0; a < 3; a++) {
        strcpy(made->axes[a].name, names[a]);
        made->axes[a].min = min[a];
        made->axes[a].max = max[a];
    }
    made->value_max = 1.0;
    made->piece_count = 2;
    for (int p = 0; p < 2; p++) {
        lq_piece *piece = &made->pieces[p];
        memcpy(piece->min, min, sizeof min);
        memcpy(piece->max, max, sizeof max);
        *(p == 0 ? &piece->max[1] : &piece->min[1]) = 1.0;
        lq_texture_axis plane[2] = {texture_axis(0, p == 0 ? "-1:1:5" : "0:1:5:sqrt"),
                                    texture_axis(1, p == 0 ? "0.5:1:3" : "1:2:4")};
        lq_texture_axis line = texture_axis(2, "0:1:6:power3");
        if (p == 0) plane[0].coordinate = LQ_COORDINATE_CRITICAL, plane[0].other = 1;
        assert_int_equal(lq_factor_create(&piece->factors[0], plane, 2, 3, NULL), LQ_OK);
        assert_int_equal(lq_factor_create(&piece->factors[1], &line, 1, 2, NULL), LQ_OK);
        piece->factor_count = 2;
        for (int a = 0; a < 2; a++) lq_axis_free(&plane[a].texels);
        lq_axis_free(&line.texels);
        piece->value = p == 0 ? LQ_VALUE_BEER : LQ_VALUE_SQUARE;
        piece->value_axis = 2;
        for (int f = 0; f < 2; f++) fill(&piece->factors[f], &seed);
        const int both[] = {0, 1};
        for (piece->stream_count = 0; piece->stream_count < 2 - p; piece->stream_count++) {
            lq_term_sum *sum = &piece->streams[piece->stream_count];
            assert_int_equal(lq_term_sum_create(sum, 2, both, 2, NULL), LQ_OK);
            const unsigned short index[2][4] = {{0, 0, 1, 1}, {2, 1, 0, 0}};
            memcpy(sum->index, index[piece->stream_count], sizeof index[0]);
        }
    }
    assert_int_equal(lq_factored_set_fact(made, "table", "by hand", NULL), LQ_OK);
    assert_int_equal(lq_factored_check(made, NULL), LQ_OK);
    return made;
}

/* One texel, or the linear mix of two neighbours along a line. */
static double line(const lq_factor *f, size_t base, double index) {
    const size_t width = f->axes[0].texels.size, i = (size_t)fmin(floor(index), (double)(width - 2));
    const float *data = f->data + base * width;
    return (double)data[i] + (index - (double)i) * (double)(data[i + 1] - data[i]);
}

static double plane(const lq_factor *f, size_t base, double column, double row) {
    const size_t width = f->axes[0].texels.size, height = f->axes[1].texels.size;
    const size_t i = (size_t)fmin(floor(column), (double)(width - 2));
    const size_t j = (size_t)fmin(floor(row), (double)(height - 2));
    const float *data = f->data + base * width * height + j * width + i;
    const double x = column - (double)i, y = row - (double)j;
    return (1 - y) * ((1 - x) * (double)data[0] + x * (double)data[1]) +
           y * ((1 - x) * (double)data[width] + x * (double)data[width + 1]);
}

static void test_lookup_is_the_formula(void **state) {
    (void)state;
    lq_factored *f = make();
    const lq_factor *p = f->pieces[0].factors, *q = f->pieces[1].factors;
    /* Above: mu = 0.3 sits at sqrt(0.3) of 4 cells, eta = 1.7 at 0.7 of 3, tau = 0.2 at cbrt of 5. */
    const double above[] = {0.3, 1.7, 0.2}, column = 4 * sqrt(0.3), row = 2.1, along = 5 * cbrt(0.2);
    const double s =
        plane(q, 0, column, row) * line(q + 1, 0, along) + plane(q, 1, column, row) * line(q + 1, 1, along);
    assert_float_equal(lq_factored_lookup(f, above), fmin(s * s, 1.0), 1e-14);
    /* Below: critical cosine 0.8 at eta = 0.6; mu = 0.85 lies a quarter of the way above it, at column 2 + 2
     * / 2. */
    const double below[] = {0.85, 0.6, 0.2};
    const double energy =
        plane(p, 0, 3, 0.4) * line(p + 1, 0, along) + plane(p, 1, 3, 0.4) * line(p + 1, 1, along);
    const double path =
        plane(p, 2, 3, 0.4) * line(p + 1, 1, along) + plane(p, 0, 3, 0.4) * line(p + 1, 0, along);
    assert_float_equal(lq_factored_lookup(f, below), fmin(energy * pow(0.2, exp2(path)), 1.0), 1e-14);
    /* Below the critical cosine: mu = 0.35 is 9/16 of the way down, at column 2 - 2 * 3/4. */
    const double beyond[] = {0.35, 0.6, 1.0};
    assert_float_equal(
        lq_factored_lookup(f, beyond),
        fmin(plane(p, 0, 0.5, 0.4) * line(p + 1, 0, 5) + plane(p, 1, 0.5, 0.4) * line(p + 1, 1, 5), 1.0),
        1e-14);
    lq_factored_free(f);
}

/* What is outside is the nearest point inside, NaN the lower end; tau = 0 lets nothing through. */
static void test_lookup_clamps(void **state) {
    (void)state;
    lq_factored *f = make();
    const double outside[] = {-3.0, 7.0, 2.0}, edge[] = {0.0, 2.0, 1.0};
    assert_float_equal(lq_factored_lookup(f, outside), lq_factored_lookup(f, edge), 0.0);
    const double odd[] = {NAN, 0.9, 0.0}, dark[] = {0.0, 0.9, 0.0};
    assert_float_equal(lq_factored_lookup(f, odd), lq_factored_lookup(f, dark), 0.0);
    assert_float_equal(lq_factored_lookup(f, dark), 0.0, 0.0);
    lq_factored_free(f);
}

/* The sampler moves a point by at most 1/512 of a texel, and not at texel centres. */
static void test_gpu_is_near(void **state) {
    (void)state;
    lq_factored *f = make();
    double largest = 0.0;
    for (int i = 0; i < 2000; i++) {
        const double x[] = {(i % 17) / 16.0, 0.5 + 1.5 * (i % 101) / 100.0, (i % 13 + 1) / 13.0};
        largest = fmax(largest, fabs(lq_factored_lookup(f, x) - lq_factored_lookup_gpu(f, x)));
    }
    assert_true(largest < 0.03);
    assert_true(largest > 1e-6); /* or the emulation does nothing */
    const double centre[] = {0.0625, 1.0 + 1.0 / 3.0 + 1e-12, 1.0};
    assert_float_equal(lq_factored_lookup_gpu(f, centre), lq_factored_lookup(f, centre), 2e-7);
    assert_int_equal(lq_factored_bytes(f), 2 * (3 * 15 + 2 * 6 + 3 * 20 + 2 * 6));
    lq_factored_free(f);
}

/* ------------------------------------------------------------------ the file */

static char path[64];

static int folder(void **state) {
    (void)state;
    snprintf(path, sizeof path, "/tmp/test_pca_factors_%d.exr", (int)getpid());
    return 0;
}

static int clean(void **state) {
    (void)state;
    unlink(path);
    return 0;
}

static void test_file_round_trip(void **state) {
    (void)state;
    lq_factored *f = make(), *back;
    assert_int_equal(lq_factored_write(f, path, NULL), LQ_OK);
    assert_int_equal(lq_factored_read(&back, path, NULL), LQ_OK);
    assert_string_equal(lq_factored_fact(back, "table"), "by hand");
    assert_null(lq_factored_fact(back, "factors"));
    assert_int_equal(lq_factored_bytes(back), lq_factored_bytes(f));
    for (int i = 0; i < 500; i++) {
        const double x[] = {(i % 19) / 18.0, 0.5 + 1.5 * (i % 29) / 28.0, (i % 31) / 30.0};
        assert_true(lq_factored_lookup(f, x) == lq_factored_lookup(back, x));
        assert_true(lq_factored_lookup_gpu(f, x) == lq_factored_lookup_gpu(back, x));
    }
    lq_factored_free(back);
    lq_factored_free(f);
}

/* A table with `text` for its structure. */
static lq_status read_structure(const char *text, lq_error *error) {
    lq_axis axes[2];
    lq_table *table;
    lq_factored *f;
    const char *channel = "texel";
    assert_int_equal(lq_axis_parse(&axes[0], "column", "0:4:5", NULL), LQ_OK);
    assert_int_equal(lq_axis_parse(&axes[1], "row", "0:3:4", NULL), LQ_OK);
    assert_int_equal(lq_table_create(&table, axes, 2, &channel, 1, NULL), LQ_OK);
    if (text) assert_int_equal(lq_table_set_fact(table, "factors", text, NULL), LQ_OK);
    assert_int_equal(lq_table_write_exr(table, path, NULL), LQ_OK);
    lq_table_free(table);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    const lq_status status = lq_factored_read(&f, path, error);
    lq_factored_free(f);
    return status;
}

#define PIECE(FACTOR_AXES, INDEX)                                                                            \
    "{\"axes\":[{\"name\":\"mu\",\"min\":0.0,\"max\":1.0}],\"value_min\":0.0,\"value_max\":1.0,\"pieces\":[" \
    "{"                                                                                                      \
    "\"min\":[0.0],\"max\":[1.0],\"value\":\"plain\",\"value_axis\":0,\"factors\":[{\"bases\":4,\"axes\":"   \
    "[" FACTOR_AXES "]}],\"streams\":[{\"factors\":[0],\"index\":[" INDEX "]}]}]}"
#define AXIS(WHICH, SIZE)                                                                                    \
    "{\"coordinate\":\"axis\",\"axis\":" WHICH ",\"other\":0,\"texels\":{\"name\":\"mu\",\"size\":" SIZE     \
    ",\"min\":0.0,\"max\":1.0,\"map\":\"linear\",\"exponent\":1.0}}"

static void test_files_that_lie_are_refused(void **state) {
    (void)state;
    static const char *const lies[] = {
        "",
        "[]",
        "{\"axes\":[]}",
        PIECE(AXIS("0", "5"), "4"), /* no such base */
        PIECE(AXIS("0", "5"), "-1"),
        PIECE(AXIS("1", "5"), "0"),                                       /* no such axis */
        PIECE(AXIS("0", "6"), "0"),                                       /* not the image's size */
        PIECE(AXIS("0", "1000000000"), "0"),                              /* absurd */
        PIECE(AXIS("0", "5") "," AXIS("0", "5") "," AXIS("0", "5"), "0"), /* 3D */
    };
    lq_error error = {""};
    assert_int_equal(read_structure(PIECE(AXIS("0", "5"), "0,3"), NULL), LQ_OK);
    assert_int_equal(read_structure(NULL, &error), LQ_FORMAT);
    assert_non_null(strstr(error.text, "lacquer pca"));
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        error.text[0] = '\0';
        assert_int_equal(read_structure(lies[i], &error), LQ_FORMAT);
        assert_non_null(strstr(error.text, path));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_half_round_trips),
        cmocka_unit_test(test_rounding_is_to_nearest_even),
        cmocka_unit_test(test_lookup_is_the_formula),
        cmocka_unit_test(test_lookup_clamps),
        cmocka_unit_test(test_gpu_is_near),
        cmocka_unit_test_setup_teardown(test_file_round_trip, folder, clean),
        cmocka_unit_test_setup_teardown(test_files_that_lie_are_refused, folder, clean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

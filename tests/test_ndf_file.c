/* NDFs from a file: sampled GGX is GGX, a family has what lies between its columns, and bad files are named
 * by their line. */
#include "tests/ndf.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SAMPLES = 256 };
static const double pi = 3.14159265358979323846;

static char path[64], text[80]; /* of the file, and what --ndf takes */

static int make_file(void **state) {
    (void)state;
    strcpy(path, "/tmp/lacquer-ndf-XXXXXX");
    const int file = mkstemp(path);
    if (file < 0) return -1;
    close(file);
    snprintf(text, sizeof text, "file:%s", path);
    return 0;
}

static int remove_file(void **state) {
    (void)state;
    return unlink(path);
}

static void write_file(const char *content) {
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_true(fputs(content, out) >= 0);
    assert_int_equal(fclose(out), 0);
}

static double ggx(double alpha, double degrees) {
    const double c = cos(degrees * pi / 180.0), s = sin(degrees * pi / 180.0), a2 = alpha * alpha;
    const double q = a2 * c * c + s * s;
    return a2 / (pi * q * q);
}

/* SAMPLES even angles; every column in a scale of its own. */
static void write_ggx(const double *alpha, int columns) {
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out, "# sampled GGX\ntheta_deg");
    for (int c = 0; c < columns; c++) fprintf(out, columns > 1 ? ",alpha=%g" : ",D", alpha[c]);
    for (int i = 0; i < SAMPLES; i++) {
        const double degrees = 90.0 * i / (SAMPLES - 1);
        fprintf(out, "\n%.12g", degrees);
        for (int c = 0; c < columns; c++) fprintf(out, ", %.12g", (7.0 + c) * ggx(alpha[c], degrees));
    }
    fprintf(out, "\n");
    assert_int_equal(fclose(out), 0);
}

static const struct {
    const char *kind;
    double point[4];
    int alpha; /* its place */
} cases[] = {{"fgd", {0.3, 0.0, 0.2, 3.9}, 1},
             {"albedo", {0.1, 0.0}, 1},
             {"albedo-average", {0.0}, 0},
             {"dfg", {0.7, 0.0}, 1},
             {"tir-pass", {0.6, 0.0, 0.75}, 1},
             {"tir-loss", {0.6, 0.0, 0.75}, 1},
             {"fgd-dielectric", {0.2, 0.0, 1.5}, 1},
             {"transmission", {0.5, 0.0, 0.7, 0.5}, 1},
             {"diffuse-reflection", {1.5, 0.0, 0.5}, 1},
             {"variance", {1.5, 0.0}, 1}};
enum { CASES = sizeof cases / sizeof cases[0] };

static void expect_ggx(double alpha) {
    for (int k = 0; k < CASES; k++) {
        double point[4], estimate;
        memcpy(point, cases[k].point, sizeof point);
        point[cases[k].alpha] = alpha;
        const double want = value_of(cases[k].kind, "ggx", point, &estimate);
        const double got = value_of(cases[k].kind, text, point, &estimate);
        if (!(fabs(got - want) <= 1e-6))
            fail_msg("%s at alpha %g: %.9f, GGX %.9f", cases[k].kind, alpha, got, want);
    }
}

/* Asked of it: 1e-5. */
static void sampled_ggx_is_ggx(void **state) {
    (void)state;
    static const double alphas[] = {0.1, 0.5, 1.0};
    for (int i = 0; i < 3; i++) {
        double low, high, factor;
        write_ggx(&alphas[i], 1);
        const lq_ndf *ndf = open_ndf(text);
        lq_ndf_range(ndf, &low, &high);
        assert_true(low == alphas[i] && high == alphas[i]);
        const char *note = strstr(lq_ndf_note(ndf), "D scaled by ");
        assert_non_null(note);
        assert_int_equal(sscanf(note, "D scaled by %lf", &factor), 1);
        assert_near(factor, 1.0 / 7.0, 1e-6);
        lq_ndf_close(ndf);
        expect_ggx(alphas[i]);
    }
}

static void a_family_holds_what_lies_between(void **state) {
    (void)state;
    static const double alphas[] = {0.05, 0.1, 0.3, 0.7, 1.0};
    write_ggx(alphas, 5);
    double low, high, estimate, values[2];
    const lq_ndf *ndf = open_ndf(text);
    lq_ndf_range(ndf, &low, &high);
    assert_true(low == 0.05 && high == 1.0);
    lq_ndf_close(ndf);
    expect_ggx(0.1);
    expect_ggx(0.17);
    expect_ggx(0.62);
    lq_settings settings = lq_settings_default();
    lq_error error;
    settings.ndf = text;
    const double below[] = {0.3, 0.04}, smooth[] = {0.3, 0.0};
    assert_int_equal(lq_eval(lq_kind_find("albedo", NULL), &settings, below, values, &estimate, &error),
                     LQ_BAD_INPUT);
    assert_non_null(strstr(error.text, "accepted: 0.05 to 1, and 0"));
    assert_near(value_of("albedo", text, smooth, &estimate), 1.0, 0.0);
}

/* One roughness, one node: tables keep the axis, with nothing to choose. */
static void one_distribution_leaves_no_alpha(void **state) {
    (void)state;
    const double alpha = 0.3;
    write_ggx(&alpha, 1);
    lq_settings settings = lq_settings_default();
    lq_axis axes[LQ_MAX_AXES];
    lq_table *table;
    lq_error error;
    const lq_kind *kind = lq_kind_find("albedo", NULL);
    settings.ndf = text;
    assert_int_equal(lq_settings_axes(kind, &settings, axes, &error), LQ_OK);
    assert_int_equal(axes[1].size, 1);
    assert_true(axes[1].nodes[0] == 0.3);
    assert_int_equal(lq_precompute(kind, &settings, axes, NULL, &table, &error), LQ_OK);
    for (int a = 0; a < 2; a++) lq_axis_free(&axes[a]);
    /* The fact opens the same NDF again, until the file changes. */
    const char *fact = lq_table_fact(table, "ndf");
    assert_non_null(lq_table_fact(table, "ndf-note"));
    lq_ndf_close(open_ndf(fact));
    const double other = 0.4;
    write_ggx(&other, 1);
    expect_refused(fact, LQ_BAD_INPUT, "has changed");
    lq_table_free(table);
}

/* Coarse data, a hole at the top, nothing beyond 50 degrees: kinks cost the quadrature its finest tolerances,
 * and nothing else. */
static void measured_shapes_work(void **state) {
    (void)state;
    double estimate;
    write_file("theta,D\n0,0\n4,0\n8,1.1\n12,3.0\n16,2.9\n20,2.6\n25,1.4\n30,1.0\n40,0.2\n50,0\n60,0\n");
    const lq_ndf *ndf = open_ndf(text);
    double alpha, high;
    lq_ndf_range(ndf, &alpha, &high);
    double sum = 0.0;
    for (int i = 0; i < 20000; i++) {
        const double theta = 0.5 * pi * (i + 0.5) / 20000, c = cos(theta), s = sin(theta), c2 = c * c,
                     s2 = s * s;
        double d;
        ndf->density(ndf, alpha, 1, &c2, &s2, &d);
        assert_true(d >= 0.0);
        sum += pi * pi / 20000 * c * s * d;
    }
    assert_near(sum, 1.0, 1e-6);
    lq_ndf_close(ndf);
    const double white[] = {0.3, alpha, 0.0, 2.0};
    assert_near(value_of("fgd", text, white, &estimate), 1.0, 1e-12);
    expect_walk_agrees("fgd", text, (const double[]){0.4, alpha, 0.2, 3.9}, 3e-4);
    expect_walk_agrees("albedo", text, (const double[]){0.2, alpha}, 3e-4);
    expect_walk_agrees("fgd-dielectric", text, (const double[]){0.3, alpha, 1.5}, 3e-4);
    expect_walk_agrees("tir-pass", text, (const double[]){0.6, alpha, 0.75}, 3e-4);
}

static void bad_files_are_named_by_line(void **state) {
    (void)state;
    static const struct {
        const char *content, *message;
    } bad[] = {
        {"", ": empty; rows of theta,D are expected"},
        {"theta,D\n0,1\n1,-2\n2,1\n3,1\n", ":3: D is negative: '-2'"},
        {"theta,D\n0,1\n2,1\n1,1\n3,1\n", ":4: theta does not rise: '1'"},
        {"theta,D\n0,1\n1,nan\n2,1\n3,1\n", ":3: D is not finite: 'nan'"},
        {"theta,D\n0,1\n1,inf\n2,1\n3,1\n", ":3: D is not finite: 'inf'"},
        {"theta,D\n0,1\n1\n2,1\n3,1\n", ":3: a value of D is missing"},
        {"theta,D\n# note\n\n0,1\n1,\n2,1\n3,1\n", ":5: a value of D is missing"},
        {"theta,D\n0,1\n1,2,3\n", ":3: more values than columns: '3'"},
        {"theta,D\n0,1\n1,x\n", ":3: not a number: 'x'"},
        {"theta,D\n0,1\n,1\n", ":3: theta is missing"},
        {"theta,D\n0,1\n91,1\n", ":3: theta is not in [0, 90] degrees: '91'"},
        {"theta_rad,D\n0,1\n1,1\n2,1\n3,1\n", ":5: theta is above pi/2"},
        {"theta,D\n0,1\n1,1\n", ":3: 2 angles, at least 4 are needed"},
        {"theta,D\n0,0\n1,0\n2,0\n3,0\n", ":5: D is 0 in every row of column 2"},
        {"angle,D\n", ":1: the first column is theta, theta_deg or theta_rad, not 'angle'"},
        {"theta\n0\n", ":1: a column of D is missing"},
        {"theta,a,b\n", ":1: several columns of D need their alphas"},
        {"theta,alpha=0.2,alpha=0.1\n", ":1: the alphas of the columns do not rise at 'alpha=0.1'"},
        {"theta,alpha=0.2,alpha=2\n", ":1: alpha of a column is not in (0, 1]: 'alpha=2'"},
        {"theta,alpha=0.2,D\n", ":1: a column without its alpha: 'D'"},
        {"0,1,2\n", ":1: several columns of D need a header"},
        {"\x7f\x45LF\n", ":1: the first column is theta"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char message[256];
        snprintf(message, sizeof message, "%s%s", path, bad[i].message);
        write_file(bad[i].content);
        expect_refused(text, LQ_BAD_INPUT, message);
    }
    expect_refused("file:/no/such/file.csv", LQ_IO, "cannot read /no/such/file.csv: No such file");
    expect_refused("file", LQ_BAD_INPUT, "write file:PATH");
    expect_refused("file:/", LQ_IO, "cannot read /");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampled_ggx_is_ggx),
        cmocka_unit_test(a_family_holds_what_lies_between),
        cmocka_unit_test(one_distribution_leaves_no_alpha),
        cmocka_unit_test(measured_shapes_work),
        cmocka_unit_test(bad_files_are_named_by_line),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}

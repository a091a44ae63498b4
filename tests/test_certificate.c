/* test_certificate.c - certificates: binomial limits, where the points lie, planted errors that must be
 * found. */
#include "tests/expect.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "microfacet/fresnel.h"
#include "tests/uniform.h"
#include "validate/certificate_checks.h"
#include "validate/certificate_confidence.h"
#include "validate/certificate_pack.h"

/* ------------------------------------------------------------------------------- confidence */

/* Chance of at most `hits` of `count` at a share p, added up. */
static double binomial(int hits, int count, double p) {
    double sum = 0.0, term = pow(1.0 - p, count);
    for (int k = 0; k <= hits; k++) {
        sum += term;
        term *= (double)(count - k) / (k + 1) * p / (1.0 - p);
    }
    return sum;
}

static void test_limits_are_the_binomial_ones(void **state) {
    (void)state;
    assert_near(lq_share_limit(0, 100, 0.95), 1.0 - pow(0.05, 0.01), 1e-12);
    const int cases[][2] = {{3, 100}, {10, 2000}, {0, 5}, {40, 50}};
    for (size_t i = 0; i < 4; i++) {
        const double limit = lq_share_limit(cases[i][0], cases[i][1], 0.95);
        assert_near(binomial(cases[i][0], cases[i][1], limit), 0.05, 1e-9);
    }
    assert_near(lq_share_limit(7, 7, 0.95), 1.0, 0.0);
    /* 0.99^n <= 0.05 from n = 299 on: fewer points settle no p99 */
    assert_near(lq_quantile_rank(298, 0.99, 0.95), 298, 0.0);
    assert_true(lq_quantile_rank(299, 0.99, 0.95) < 299);
    assert_true(lq_quantile_rank(10000, 0.99, 0.95) > 9900 && lq_quantile_rank(10000, 0.99, 0.95) < 9930);
}

/* 400 blocks of 50: hits that know nothing of blocks, hits that come block by block. */
static void test_effective_points_know_blocks(void **state) {
    (void)state;
    size_t apart[400], together[400];
    for (size_t b = 0; b < 400; b++) {
        apart[b] = 0;
        for (size_t i = 0; i < 50; i++) apart[b] += uniform(50 * b + i) < 0.1;
        together[b] = uniform(1000000 + b) < 0.1 ? 50 : 0;
    }
    assert_near(lq_effective_points(apart, 400, 50), 20000, 4000);
    assert_near(lq_effective_points(together, 400, 50), 400, 10);
}

/* ------------------------------------------------------------------------------- the points */

static lq_domain whole(const lq_kind *kind, double least) {
    lq_domain domain = {.min = {0.0}};
    for (int a = 0; a < kind->axis_count; a++) {
        domain.min[a] = fmax(kind->axes[a].min, least);
        domain.max[a] = kind->axes[a].max;
    }
    return domain;
}

/* Uniform along every axis: the largest gap to the straight line of the distribution function. */
static void test_points_are_uniform(void **state) {
    (void)state;
    const lq_kind *kind = lq_kind_find("transmission", NULL);
    const lq_domain domain = whole(kind, 0.02);
    lq_block_plan plan;
    assert_int_equal(lq_block_plan_make(&plan, kind, &domain, 20000, 5, NULL), LQ_OK);
    assert_true(plan.count * plan.per_block >= 20000);
    size_t below[LQ_MAX_AXES][20] = {{0}};
    lq_block *block = malloc(sizeof *block);
    for (size_t b = 0; b < plan.count; b++) {
        lq_block_draw(&plan, b, block);
        assert_int_equal(block->size[1], 1);
        assert_int_equal(block->size[2], 1);
        for (size_t i = 0; i < plan.per_block; i++) {
            double point[LQ_MAX_AXES];
            lq_block_point(block, 4, i, point);
            for (int a = 0; a < 4; a++) {
                const double u = (point[a] - domain.min[a]) / (domain.max[a] - domain.min[a]);
                assert_true(u >= 0.0 && u <= 1.0);
                for (int k = 0; k < 20; k++) below[a][k] += u < (k + 1) / 20.0;
            }
        }
    }
    for (int a = 0; a < 4; a++)
        for (int k = 0; k < 20; k++)
            assert_near((double)below[a][k] / (double)(plan.count * plan.per_block), (k + 1) / 20.0, 0.02);
    free(block);
    lq_block_plan_free(&plan);
}

/* ------------------------------------------------------------------------- planted decoders */

/* A smooth dielectric, exact in closed form, plus a pyramid of height 0.01 over mu and eta. */
static const double bump_at[2] = {0.37, 1.61};

static double bump(const double *x) {
    const double r = fmax(fabs(x[0] - bump_at[0]), fabs(x[2] - bump_at[1])) / 0.25;
    return r < 1.0 ? 0.01 * (1.0 - r) : 0.0;
}

static double bumped(const void *subject, int channel, const double *point) {
    (void)subject;
    (void)channel;
    return lq_fresnel_dielectric(point[0], point[2], NULL) + bump(point);
}

static lq_sample_request bumped_request(void) {
    lq_sample_request request = {.kind = lq_kind_find("fgd-dielectric", NULL), .points = 100000, .starts = 4};
    request.settings = lq_settings_default();
    request.domain = (lq_domain){{0.05, 0.0, 1.05}, {1.0, 0.0, 2.0}};
    request.stages[0] = (lq_stage){"bumped", "bump", bumped, NULL};
    request.stage_count = 1;
    request.seed = 3;
    return request;
}

/* Its base is 0.5^2 of a domain of 0.95^2; a share s of that is off by more than (1 - sqrt(s)) 0.01. */
static void test_planted_error_is_measured(void **state) {
    (void)state;
    lq_sampled c;
    const lq_sample_request request = bumped_request();
    assert_int_equal(lq_sample(&request, NULL, &c, NULL), LQ_OK);
    const double base = 0.5 * 0.5 / (0.95 * 0.95);
    assert_near(c.total.mean, 0.01 / 3.0 * base, 0.1 * 0.01 / 3.0 * base);
    assert_near(c.total.rms, 0.01 * sqrt(base / 6.0), 0.1 * 0.01 * sqrt(base / 6.0));
    const double p99 = 0.01 * (1.0 - sqrt(0.01 / base));
    assert_near(c.total.p99, p99, 3e-4);
    assert_true(c.total.p99_limit > p99 && c.total.p99_limit < 0.0095);
    /* the tip: by the search, not by the sample */
    assert_true(c.total.max < 0.01 - 5e-5);
    assert_near(c.found.error, 0.01, 5e-5);
    assert_near(c.found.at[0], bump_at[0], 1.3e-3);
    assert_near(c.found.at[2], bump_at[1], 1.3e-3);
    assert_near(c.max, c.found.error, 0.0);
    assert_near(c.unseen, 1.0 - pow(0.05, 1.0 / (double)c.plan.count), 1e-12);
    lq_sampled_free(&c);
}

static void test_threads_change_no_bit(void **state) {
    (void)state;
    lq_sampled one, three;
    lq_sample_request request = bumped_request();
    request.threads = 1;
    assert_int_equal(lq_sample(&request, NULL, &one, NULL), LQ_OK);
    request.threads = 3;
    assert_int_equal(lq_sample(&request, NULL, &three, NULL), LQ_OK);
    assert_memory_equal(one.exact, three.exact, one.points * sizeof *one.exact);
    assert_memory_equal(&one.total, &three.total, sizeof one.total);
    assert_memory_equal(one.found.at, three.found.at, sizeof one.found.at);
    assert_near(one.found.error, three.found.error, 0.0);
    lq_sampled_free(&one);
    lq_sampled_free(&three);
}

/* ------------------------------------------------------------------------------------ folders */

static const lq_check *check_named(const lq_certified *certified, const char *name) {
    for (int i = 0; i < certified->check_count; i++)
        if (strcmp(certified->checks[i].name, name) == 0) return &certified->checks[i];
    static const lq_check none;
    fail_msg("no check '%s'", name);
    return &none;
}

/* A smooth coating: R = F(mu, eta), T = 1 - F, and below it by reciprocity; `bad` times the transmission. */
typedef struct fake {
    int which;       /* R01, T01, T10, R10 */
    double bad, out; /* out: T10 at eta = 1.5 */
} fake;

static double mean_reflectance(double eta) {
    double sum = 0.0;
    for (int i = 0; i < 2000; i++) {
        const double mu = (i + 0.5) / 2000.0;
        sum += 2.0 * mu * lq_fresnel_dielectric(mu, eta, NULL) / 2000.0;
    }
    return sum;
}

static double fake_decode(const void *subject, int channel, const double *point) {
    const fake *f = subject;
    (void)channel;
    if (f->which < 2) {
        const double reflected = lq_fresnel_dielectric(point[0], point[2], NULL);
        return f->which == 0 ? reflected : f->bad * (1.0 - reflected);
    }
    return f->which == 2 ? f->bad * f->out : 1.0 - f->out;
}

static void pack_of_fakes(lq_certified *list, const fake *fakes) {
    const char *const kinds[] = {"fgd-dielectric", "transmission", "diffuse-transmission",
                                 "diffuse-reflection"};
    memset(list, 0, 4 * sizeof *list);
    for (int i = 0; i < 4; i++) {
        lq_sample_request *r = &list[i].certificate.request;
        r->kind = lq_kind_find(kinds[i], NULL);
        r->settings = lq_settings_default();
        r->stages[0] = (lq_stage){"fake", "fake", fake_decode, &fakes[i]};
        r->stage_count = 1;
        list[i].budget.bound[LQ_NORM_MAX] = 1e-3;
        for (int a = 0; a < r->kind->axis_count; a++) {
            const bool eta = strcmp(r->kind->axes[a].name, "eta") == 0;
            r->domain.min[a] = eta ? 1.5 : 0.0;
            r->domain.max[a] = eta ? 1.5 : 1.0;
        }
    }
    lq_check_pack(list, 4);
}

/* Exact identities hold; 3 % more transmission breaks all that have it in them. */
static void test_tables_of_a_folder_agree(void **state) {
    (void)state;
    lq_certified *list = malloc(4 * sizeof *list);
    const double out = (1.0 - mean_reflectance(1.5)) / (1.5 * 1.5);
    fake fakes[4] = {{0, 1.0, out}, {1, 1.0, out}, {2, 1.0, out}, {3, 1.0, out}};
    pack_of_fakes(list, fakes);
    for (int i = 0; i < 4; i++) assert_null(lq_certified_failure(&list[i]));
    assert_true(check_named(&list[1], "R + T")->value <= 1e-15);
    assert_true(check_named(&list[3], "furnace")->value < 1e-6);
    assert_true(check_named(&list[2], "reciprocity")->value < 1e-4);
    assert_true(check_named(&list[3], "reciprocity")->value < 1e-4);
    fakes[1].bad = 1.03;
    for (int i = 0; i < 4; i++) lq_certified_free(&list[i]);
    pack_of_fakes(list, fakes);
    assert_near(check_named(&list[1], "R + T")->value, 0.03 * 0.96, 1e-4);
    assert_int_equal(check_named(&list[1], "R + T")->outcome, LQ_FAILED);
    assert_int_equal(check_named(&list[3], "furnace")->outcome, LQ_FAILED);
    assert_int_equal(check_named(&list[2], "reciprocity")->outcome, LQ_FAILED);
    assert_int_equal(check_named(&list[3], "reciprocity")->outcome, LQ_PASSED);
    for (int i = 0; i < 4; i++) lq_certified_free(&list[i]);
    free(list);
}

/* ---------------------------------------------------------------------------------- budgets */

static void test_budgets_are_read(void **state) {
    (void)state;
    lq_budget budget;
    lq_error error;
    assert_int_equal(lq_budget_parse(&budget, "p99=2e-3,max=1e-2", NULL), LQ_OK);
    assert_near(budget.bound[LQ_NORM_MAX], 1e-2, 0.0);
    assert_near(budget.bound[LQ_NORM_P99], 2e-3, 0.0);
    assert_near(budget.bound[LQ_NORM_RMS], 0.0, 0.0);
    assert_int_equal(lq_budget_parse(&budget, "5e-3", NULL), LQ_OK);
    assert_near(budget.bound[LQ_NORM_MAX], 5e-3, 0.0);
    const char *const bad[] = {"",      "max",      "max=",      "max=0",
                               "max=2", "p98=1e-2", "max=1e-2,", "max=1e-2;p99=1"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(lq_budget_parse(&budget, bad[i], &error), LQ_BAD_INPUT);
        assert_non_null(strstr(error.text, "max=1e-2,p99=2e-3"));
    }
    lq_rule rule = {.table = ""};
    assert_int_equal(lq_ranges_parse(&rule, "mu=0.02:1,tau=0.1:0.9", NULL), LQ_OK);
    assert_int_equal(rule.range_count, 2);
    assert_string_equal(rule.ranges[1].axis, "tau");
    assert_near(rule.ranges[1].max, 0.9, 0.0);
    assert_int_equal(lq_ranges_parse(&rule, "mu=1:0.02", NULL), LQ_BAD_INPUT);
    assert_int_equal(lq_ranges_parse(&rule, "mu", NULL), LQ_BAD_INPUT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_limits_are_the_binomial_ones),
        cmocka_unit_test(test_effective_points_know_blocks),
        cmocka_unit_test(test_points_are_uniform),
        cmocka_unit_test(test_planted_error_is_measured),
        cmocka_unit_test(test_threads_change_no_bit),
        cmocka_unit_test(test_tables_of_a_folder_agree),
        cmocka_unit_test(test_budgets_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

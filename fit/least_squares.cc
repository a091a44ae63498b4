// Ceres behind fit/least_squares.h: bounds, automatic derivatives, robust loss, covariance; silent.
#include "fit/least_squares.h"

#include <ceres/ceres.h>
#include <ceres/covariance.h>
#include <glog/logging.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

namespace {

using std::exp;
using std::expm1;
using std::log;

#define FAMILY_FUNCTION template <typename REAL>
#include "fit/family_formula.h"

struct Residual {
    const lq_fit_problem *problem;
    size_t point;
    double weight;
    template <typename T> bool operator()(const T *p, T *residual) const {
        const double *x = problem->x + point * LQ_FAMILY_COORDINATES;
        residual[0] = weight * (log(family_of<T>(problem->family, p, x)) - log(problem->y[point]));
        using std::isfinite;
        return isfinite(residual[0]);
    }
};

// Every family is differentiated for the largest number of parameters; those it lacks are held at 0.
ceres::CostFunction *cost(const lq_fit_problem *problem, size_t point, double weight) {
    return new ceres::AutoDiffCostFunction<Residual, 1, LQ_FAMILY_PARAMETERS>(
        new Residual{problem, point, weight});
}

void build(ceres::Problem &built, const lq_fit_problem *problem, const std::vector<double> &weight,
           double *p) {
    const lq_family *family = lq_family_at(problem->family);
    for (size_t i = 0; i < problem->count; i++)
        built.AddResidualBlock(cost(problem, i, weight[i]),
                               problem->loss > 0.0 ? new ceres::CauchyLoss(problem->loss) : nullptr, p);
    std::vector<int> held;
    for (int k = family->parameters; k < LQ_FAMILY_PARAMETERS; k++) held.push_back(k);
    if (!held.empty()) built.SetManifold(p, new ceres::SubsetManifold(LQ_FAMILY_PARAMETERS, held));
    for (int k = 0; k < family->parameters; k++) {
        built.SetParameterLowerBound(p, k, family->low[k]);
        built.SetParameterUpperBound(p, k, family->high[k]);
    }
}

bool minimise(const lq_fit_problem *problem, const std::vector<double> &weight, lq_fit_answer *answer) {
    ceres::Problem built;
    build(built, problem, weight, answer->p);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 200;
    options.function_tolerance = options.parameter_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &built, &summary);
    answer->iterations += summary.num_successful_steps + summary.num_unsuccessful_steps;
    return summary.IsSolutionUsable();
}

std::vector<double> residuals(const lq_fit_problem *problem, const double *p, double *largest) {
    std::vector<double> r(problem->count);
    *largest = 0.0;
    for (size_t i = 0; i < problem->count; i++) {
        const double value = lq_family_value(problem->family, p, problem->x + i * LQ_FAMILY_COORDINATES);
        r[i] = std::fabs(value / problem->y[i] - 1.0);
        *largest = std::fmax(*largest, r[i]);
    }
    return r;
}

// Lawson: weights grow where the residual is large; the best of all rounds stands.
void even_out(const lq_fit_problem *problem, lq_fit_answer *answer) {
    std::vector<double> weight(problem->count, 1.0);
    double best;
    std::vector<double> r = residuals(problem, answer->p, &best);
    lq_fit_answer tried = *answer;
    for (int round = 0; round < problem->rounds; round++) {
        double largest, sum = 0.0;
        r = residuals(problem, tried.p, &largest);
        if (!(largest > 0.0)) break;
        for (size_t i = 0; i < problem->count; i++) sum += weight[i] *= std::sqrt(r[i] / largest) + 1e-3;
        for (double &w : weight) w *= static_cast<double>(problem->count) / sum;
        if (!minimise(problem, weight, &tried)) break;
        residuals(problem, tried.p, &largest);
        answer->iterations = tried.iterations;
        if (!(largest < best)) continue;
        best = largest;
        *answer = tried;
    }
}

void covariance(const lq_fit_problem *problem, lq_fit_answer *answer) {
    constexpr int N = LQ_FAMILY_PARAMETERS;
    const int used = lq_family_at(problem->family)->parameters;
    for (double &c : answer->covariance) c = NAN;
    std::vector<double> one(problem->count, 1.0);
    ceres::Problem built;
    lq_fit_problem squares = *problem;
    squares.loss = 0.0;
    build(built, &squares, one, answer->p);
    double total = 0.0, block[N * N];
    built.Evaluate(ceres::Problem::EvaluateOptions(), &total, nullptr, nullptr, nullptr);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.null_space_rank = -1;
    ceres::Covariance made(options);
    const std::vector<std::pair<const double *, const double *>> pairs{{answer->p, answer->p}};
    if (problem->count <= static_cast<size_t>(used) || !made.Compute(pairs, &built)) return;
    made.GetCovarianceBlock(answer->p, answer->p, block);
    const double scale = 2.0 * total / (static_cast<double>(problem->count) - used);
    for (int k = 0; k < N * N; k++) answer->covariance[k] = block[k] * scale;
}

} // namespace

extern "C" int lq_fit_solve(const lq_fit_problem *problem, lq_fit_answer *answer, char *message,
                            size_t size) {
    static bool quiet = false;
    if (!quiet) google::InitGoogleLogging("lacquer-fit");
    quiet = true;
    FLAGS_minloglevel = 3;
    const lq_family *family = lq_family_at(problem->family);
    *answer = lq_fit_answer{};
    for (int k = 0; k < family->parameters; k++) answer->p[k] = family->start[k];
    for (size_t i = 0; i < problem->count; i++) {
        const double start =
            lq_family_value(problem->family, answer->p, problem->x + i * LQ_FAMILY_COORDINATES);
        if (std::isfinite(std::log(start)) && std::isfinite(std::log(problem->y[i]))) continue;
        snprintf(message, size,
                 "the residual of point %zu is not finite: value %g, family %s at its start %g", i,
                 problem->y[i], family->name, start);
        return -1;
    }
    if (problem->count < static_cast<size_t>(family->parameters)) {
        snprintf(message, size, "%zu points cannot determine %d coefficients", problem->count,
                 family->parameters);
        return -1;
    }
    if (!minimise(problem, std::vector<double>(problem->count, 1.0), answer)) {
        snprintf(message, size, "no fit of family %s was found", family->name);
        return -1;
    }
    if (problem->rounds > 0) even_out(problem, answer);
    covariance(problem, answer);
    return 0;
}

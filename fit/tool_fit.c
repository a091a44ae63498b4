/* lacquer-fit: the least-squares engine of `lacquer fit`, a program of its own because Debian's Ceres brings
 * GPL code along. One problem on stdin, one answer on stdout, in numbers:
 *
 *     FAMILY COUNT LOSS ROUNDS   then x0 x1 x2 x3 y a point
 *     ok ITERATIONS  p...  covariance...      or      error: one line
 */
#include "fit/least_squares.h"

#include <stdio.h>
#include <stdlib.h>

static int refuse(const char *why) {
    printf("error: %s\n", why);
    return 1;
}

static int solve(const lq_fit_problem *problem) {
    lq_fit_answer answer;
    char message[256];
    if (lq_fit_solve(problem, &answer, message, sizeof message) != 0) return refuse(message);
    printf("ok %d", answer.iterations);
    for (int k = 0; k < LQ_FAMILY_PARAMETERS; k++) printf(" %.17g", answer.p[k]);
    for (int k = 0; k < LQ_FAMILY_PARAMETERS * LQ_FAMILY_PARAMETERS; k++)
        printf(" %.9g", answer.covariance[k]);
    printf("\n");
    return fflush(stdout) != 0;
}

int main(void) {
    lq_fit_problem problem = {.count = 0};
    if (scanf("%d %zu %lf %d", &problem.family, &problem.count, &problem.loss, &problem.rounds) != 4 ||
        !lq_family_at(problem.family) || problem.count < 1 || problem.count > 1000000)
        return refuse("this is the engine of `lacquer fit`; it reads a problem on stdin");
    double *x = malloc(problem.count * LQ_FAMILY_COORDINATES * sizeof *x);
    double *y = malloc(problem.count * sizeof *y);
    int code = x && y ? 0 : refuse("no memory");
    for (size_t i = 0; code == 0 && i < problem.count; i++) {
        for (int k = 0; k < LQ_FAMILY_COORDINATES && code == 0; k++)
            if (scanf("%lf", &x[i * LQ_FAMILY_COORDINATES + (size_t)k]) != 1)
                code = refuse("a point is missing");
        if (code == 0 && scanf("%lf", &y[i]) != 1) code = refuse("a value is missing");
    }
    problem.x = x;
    problem.y = y;
    if (code == 0) code = solve(&problem);
    free(x);
    free(y);
    return code;
}

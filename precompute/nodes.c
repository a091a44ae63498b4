/* Node axes: maps, Chebyshev points and interpolation. */
#define _POSIX_C_SOURCE 200809L
#include "precompute/nodes.h"

#include "microfacet/gauss.h"
#include "microfacet/ndf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

double *lq_zeros(size_t count) {
    void *p = NULL;
    if (posix_memalign(&p, sizeof(lq_v8), (count ? count : 1) * sizeof(double))) return NULL;
    memset(p, 0, count * sizeof(double));
    return p;
}

double lq_inverse_area(double area) {
    return area > 1e-250 ? 1.0 / area : 0.0;
}

static double map_forward(const lq_cosine_map *map, double mu) {
    if (map->root) return map->scale * sqrt(fmax(map->root * (mu - map->from), 0.0)) + map->shift;
    const double t = map->half_angle ? 2.0 * mu / (1.0 + lq_sine(mu)) : mu;
    const double x = asinh(t * map->inverse_alpha);
    return map->scale * (map->rooted ? sqrt(x) : x) + map->shift;
}

static double map_inverse(const lq_cosine_map *map, double x) {
    const double root = (x - map->shift) / map->scale;
    if (map->root) return fmin(map->from + map->root * root * root, 1.0);
    const double t = sinh(map->rooted ? root * root : root) / map->inverse_alpha;
    return fmin(map->half_angle ? t / (1.0 + 0.25 * t * t) : t, 1.0);
}

/* The map of one element: the whole axis, stretched so that the element is [-1, 1]. */
static lq_cosine_map map_of(double alpha, lq_sense sense, double from, double to) {
    lq_cosine_map map = {.inverse_alpha = 1.0 / alpha,
                         .scale = 1.0,
                         .half_angle = sense != LQ_FALLING,
                         .rooted = sense == LQ_FALLING_ROOTED && from == 0.0};
    const double x0 = map_forward(&map, from), x1 = map_forward(&map, to);
    map.scale = 2.0 / (x1 - x0);
    map.shift = -(x0 + x1) / (x1 - x0);
    return map;
}

static double chebyshev_angle(int nodes, int i) {
    return pi * (nodes - 1 - i + 0.5) / nodes;
}

/* The elements have their maps: Chebyshev points of each, and their basis. */
static bool place_nodes(lq_node_axis *axis) {
    const int n = axis->nodes;
    axis->basis = lq_zeros((size_t)n * (size_t)n);
    if (!axis->basis) return false;
    for (int m = 0; m < n; m++)
        for (int i = 0; i < n; i++)
            axis->basis[m * n + i] = (m ? 2.0 : 1.0) / n * cos(m * chebyshev_angle(n, i));
    for (int e = 0; e < axis->elements; e++)
        for (int i = 0; i < n; i++)
            axis->mu[e * n + i] = map_inverse(&axis->map[e], cos(chebyshev_angle(n, i)));
    return true;
}

bool lq_node_axis_make(lq_node_axis *axis, double alpha, lq_sense sense, int count, double split) {
    const bool divided = split > 0.0 && split < 1.0;
    return lq_node_axis_make_divided(axis, alpha, sense, &split, divided, divided ? count / 2 : count);
}

static void start_axis(lq_node_axis *axis, const double *splits, int split_count, int nodes) {
    *axis = (lq_node_axis){.count = (split_count + 1) * nodes, .elements = split_count + 1, .nodes = nodes};
    for (int e = 0; e < split_count; e++) axis->bound[e + 1] = splits[e];
    axis->bound[axis->elements] = 1.0;
}

bool lq_node_axis_make_divided(lq_node_axis *axis, double alpha, lq_sense sense, const double *splits,
                               int split_count, int nodes) {
    start_axis(axis, splits, split_count, nodes);
    for (int e = 0; e < axis->elements; e++)
        axis->map[e] = map_of(alpha, sense, axis->bound[e], axis->bound[e + 1]);
    return place_nodes(axis);
}

bool lq_node_axis_make_roots(lq_node_axis *axis, const lq_root_element *elements, int count, int nodes) {
    double bounds[LQ_ELEMENTS_MAX] = {0.0};
    for (int e = 0; e < count; e++) bounds[e] = elements[e].to;
    start_axis(axis, bounds, count - 1, nodes);
    for (int e = 0; e < count; e++) {
        const double from = axis->bound[e], to = axis->bound[e + 1], scale = 2.0 / sqrt(to - from);
        axis->map[e] = elements[e].from_above
                           ? (lq_cosine_map){.root = -1, .from = to, .scale = -scale, .shift = 1.0}
                           : (lq_cosine_map){.root = 1, .from = from, .scale = scale, .shift = -1.0};
    }
    return place_nodes(axis);
}

void lq_node_axis_free(lq_node_axis *axis) {
    free(axis->basis);
    axis->basis = NULL;
}

static int element_of(const lq_node_axis *axis, double mu) {
    int e = 0;
    while (e + 1 < axis->elements && mu > axis->bound[e + 1]) e++;
    return e;
}

/* The end of the cosines from `from` on that lie in its element *e: neighbours, since they run monotonically.
 */
static size_t end_of_run(const lq_node_axis *axis, size_t count, const double *cosine, size_t from, int *e) {
    *e = element_of(axis, cosine[from]);
    size_t to = axis->elements == 1 ? count : from + 1;
    while (to < count && element_of(axis, cosine[to]) == *e) to++;
    return to;
}

double lq_node_axis_moments(const lq_node_axis *axis, const lq_solver_kernels *kernels, size_t count,
                            const double *cosine, const double *weight, double *moments) {
    double total = 0.0;
    for (size_t from = 0, to; from < count; from = to) {
        int e;
        to = end_of_run(axis, count, cosine, from, &e);
        double *of_element = moments + e * axis->nodes;
        const double before = of_element[0];
        kernels->moments(&axis->map[e], to - from, cosine + from, weight + from, axis->nodes, of_element);
        total += of_element[0] - before;
    }
    return total;
}

void lq_node_axis_moments3(const lq_node_axis *axis, const lq_solver_kernels *kernels, size_t count,
                           const double *cosine, const double *const weight[3], double *const moments[3]) {
    for (size_t from = 0, to; from < count; from = to) {
        int e;
        to = end_of_run(axis, count, cosine, from, &e);
        const double *w[3] = {weight[0] + from, weight[1] + from, weight[2] + from};
        double *of_element[3];
        for (int k = 0; k < 3; k++) of_element[k] = moments[k] + e * axis->nodes;
        kernels->moments3(&axis->map[e], to - from, cosine + from, w, axis->nodes, of_element);
    }
}

void lq_node_axis_project(const lq_node_axis *axis, const double *moments, double *weights) {
    const int n = axis->nodes;
    memset(weights, 0, (size_t)axis->count * sizeof *weights);
    for (int e = 0; e < axis->elements; e++, weights += n)
        for (int m = 0; m < n; m++) {
            const double moment = moments[e * n + m];
            for (int i = 0; i < n; i++) weights[i] += moment * axis->basis[m * n + i];
        }
}

void lq_node_axis_weights(const lq_node_axis *axis, double mu, double *weights) {
    double moments[LQ_NODES_MAX] = {0.0};
    const int e = element_of(axis, mu);
    const double angle = acos(fmax(fmin(map_forward(&axis->map[e], mu), 1.0), -1.0));
    for (int m = 0; m < axis->nodes; m++) moments[e * axis->nodes + m] = cos(m * angle);
    lq_node_axis_project(axis, moments, weights);
}

void lq_node_axis_weights_from_zero(const lq_node_axis *axis, double mu, double *weights) {
    lq_node_axis_weights(axis, mu, weights);
    if (element_of(axis, mu) > 0) return;
    const double above = fmax(1.0 + map_forward(&axis->map[0], mu), 0.0);
    for (int i = 0; i < axis->nodes; i++) weights[i] *= above / (1.0 + cos(chebyshev_angle(axis->nodes, i)));
}

void lq_node_axis_cosine_mean(const lq_node_axis *axis, double *weights) {
    double moments[LQ_NODES_MAX] = {0.0}, total = 0.0;
    lq_gauss rule;
    lq_gauss_make(&rule, LQ_GAUSS_MAX);
    for (int e = 0; e < axis->elements; e++) {
        const double from = axis->bound[e], width = axis->bound[e + 1] - from;
        double mu[LQ_GAUSS_MAX], weight[LQ_GAUSS_MAX];
        for (int i = 0; i < rule.count; i++) {
            const double x = rule.node[i]; /* the root of the distance to its dense end */
            mu[i] = axis->map[e].root > 0 ? from + width * x * x : from + width - width * x * x;
            weight[i] = 4.0 * mu[i] * width * x * rule.weight[i];
        }
        total += lq_node_axis_moments(axis, lq_solver_kernels_get(), (size_t)rule.count, mu, weight, moments);
    }
    lq_node_axis_project(axis, moments, weights);
    for (int i = 0; i < axis->count; i++) weights[i] /= total;
}

/* Student-t slopes, Ribardière et al. 2017: GGX at gamma = 2, Beckmann as gamma grows. */
#ifndef LACQUER_MICROFACET_STUDENT_T_H
#define LACQUER_MICROFACET_STUDENT_T_H

#include "microfacet/ndf.h"

/* The range of gamma. Below 2 D grows without bound towards the horizon, like cos^(2 gamma - 4), and the
 * facet quadrature loses its tolerances (at 1.9 an albedo is off by 5e-5). At 3/2 the mean slope is infinite.
 */
#define LQ_STUDENT_T_GAMMA_MIN 2.0
#define LQ_STUDENT_T_GAMMA_MAX 100.0

lq_status lq_student_t_open(const lq_ndf **ndf, double gamma, lq_error *error);

#endif

/* Generalised Trowbridge-Reitz, Burley 2012, sec. 5.4 and app. B: D ~ 1/(a^2 cos^2 + sin^2)^gamma. */
#ifndef LACQUER_MICROFACET_GTR_H
#define LACQUER_MICROFACET_GTR_H

#include "microfacet/ndf.h"

/* The range of gamma. Below 1 the limit alpha = 0 would not be the smooth surface. */
#define LQ_GTR_GAMMA_MIN 1.0
#define LQ_GTR_GAMMA_MAX 10.0

lq_status lq_gtr_open(const lq_ndf **ndf, double gamma, lq_error *error);

#endif

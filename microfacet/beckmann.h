/* The Beckmann distribution: normally distributed slopes, Walter et al. 2007, eq. 25-26. */
#ifndef LACQUER_MICROFACET_BECKMANN_H
#define LACQUER_MICROFACET_BECKMANN_H

#include "microfacet/ndf.h"

extern const lq_ndf lq_beckmann;

#endif

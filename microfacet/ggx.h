/* The GGX (Trowbridge-Reitz) distribution: Walter et al. 2007, eq. 33-34. */
#ifndef LACQUER_MICROFACET_GGX_H
#define LACQUER_MICROFACET_GGX_H

#include "microfacet/ndf.h"

extern const lq_ndf lq_ggx;

#endif

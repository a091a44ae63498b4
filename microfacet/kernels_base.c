/* The kernels for any processor. */
#define LQ_KERNELS lq_microfacet_kernels_base
#include "microfacet/kernels_body.h"

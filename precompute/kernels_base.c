/* The solver's kernels for any processor. */
#define LQ_KERNELS lq_precompute_kernels_base
#include "precompute/kernels_body.h"

/* The solver's kernels for processors with AVX2 (see cmake/kernels.cmake for the flags). */
#ifdef __AVX2__
#define LQ_KERNELS lq_precompute_kernels_avx2
#include "precompute/kernels_body.h"
#else
#include "precompute/kernels.h"
const lq_solver_kernels *lq_precompute_kernels_avx2(void) {
    return NULL;
}
#endif

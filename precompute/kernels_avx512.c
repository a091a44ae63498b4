/* The solver's kernels for processors with AVX512F (see cmake/kernels.cmake for the flags). */
#ifdef __AVX512F__
#define LQ_KERNELS lq_precompute_kernels_avx512
#include "precompute/kernels_body.h"
#else
#include "precompute/kernels.h"
const lq_solver_kernels *lq_precompute_kernels_avx512(void) {
    return NULL;
}
#endif

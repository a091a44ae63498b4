/* The kernels for processors with AVX512F (see cmake/kernels.cmake for the flags). */
#ifdef __AVX512F__
#define LQ_KERNELS lq_microfacet_kernels_avx512
#include "microfacet/kernels_body.h"
#else
#include "microfacet/kernels.h"
const lq_microfacet_kernels *lq_microfacet_kernels_avx512(void) {
    return NULL;
}
#endif

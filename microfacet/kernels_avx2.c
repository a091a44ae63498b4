/* The kernels for processors with AVX2 (see cmake/kernels.cmake for the flags). */
#ifdef __AVX2__
#define LQ_KERNELS lq_microfacet_kernels_avx2
#include "microfacet/kernels_body.h"
#else
#include "microfacet/kernels.h"
const lq_microfacet_kernels *lq_microfacet_kernels_avx2(void) {
    return NULL;
}
#endif

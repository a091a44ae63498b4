/* Chooses the copy of the kernels for this processor. */
#include "microfacet/kernels.h"

#include "microfacet/cpu.h"

const lq_microfacet_kernels *lq_microfacet_kernels_get(void) {
    if (lq_cpu_has_avx512() && lq_microfacet_kernels_avx512()) return lq_microfacet_kernels_avx512();
    if (lq_cpu_has_avx2() && lq_microfacet_kernels_avx2()) return lq_microfacet_kernels_avx2();
    return lq_microfacet_kernels_base();
}

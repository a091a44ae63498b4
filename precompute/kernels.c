/* Chooses the copy of the solver's kernels for this processor. */
#include "precompute/kernels.h"

#include "microfacet/cpu.h"

const lq_solver_kernels *lq_solver_kernels_get(void) {
    if (lq_cpu_has_avx512() && lq_precompute_kernels_avx512()) return lq_precompute_kernels_avx512();
    if (lq_cpu_has_avx2() && lq_precompute_kernels_avx2()) return lq_precompute_kernels_avx2();
    return lq_precompute_kernels_base();
}

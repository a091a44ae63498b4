/* blas.c - BLAS on the calling thread only, and the process as it was afterwards. */
#include "system/blas.h"

#include <cblas.h>

#ifdef OPENBLAS_VERSION

/* As global as the number they guard: OpenBLAS has one for the process. */
static int users, threads_before;

void lq_blas_begin(void) {
#pragma omp critical(lq_blas)
    if (users++ == 0) {
        threads_before = openblas_get_num_threads();
        openblas_set_num_threads(1);
    }
}

void lq_blas_end(void) {
#pragma omp critical(lq_blas)
    if (--users == 0) openblas_set_num_threads(threads_before);
}

bool lq_blas_reentrant(void) {
    return openblas_get_parallel() != 0;
}

#else

void lq_blas_begin(void) {}

void lq_blas_end(void) {}

bool lq_blas_reentrant(void) {
    return true;
}

#endif

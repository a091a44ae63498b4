/* blas.h - BLAS on the calling thread only, and the process as it was afterwards. */
#ifndef LACQUER_SYSTEM_BLAS_H
#define LACQUER_SYSTEM_BLAS_H

#include <stdbool.h>

/* Between the two, which may nest and run on several threads at once, a BLAS call uses the thread it is made
 * on: the callers are parallel themselves, and sums keep their order. OpenBLAS 0.3.21 has this number for
 * the whole process only: it is 1 until the last of those under way has ended, and then what it was. */
void lq_blas_begin(void);
void lq_blas_end(void);

/* Whether several threads may call BLAS at once: OpenBLAS built without threads shares its buffers unlocked,
 * and gives garbage then. */
bool lq_blas_reentrant(void);

#endif

/* What the processor can run, asked where a kernel is chosen. */
#ifndef LACQUER_MICROFACET_CPU_H
#define LACQUER_MICROFACET_CPU_H

#include <stdbool.h>

static inline bool lq_cpu_has_avx2(void) {
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
    return false;
#endif
}

static inline bool lq_cpu_has_avx512(void) {
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && lq_cpu_has_avx2();
#else
    return false;
#endif
}

#endif

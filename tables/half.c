/* half.c - binary16 from and to binary32, in integers: the same on every machine. */
#include "tables/half.h"

#include <string.h>

/* Drop the `shift` low bits, to nearest, ties to even. */
static uint32_t round_shift(uint32_t bits, unsigned shift) {
    const uint32_t kept = bits >> shift, rest = bits & ((1u << shift) - 1), tie = 1u << (shift - 1);
    return kept + (rest > tie || (rest == tie && (kept & 1)));
}

uint16_t lq_half_from_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    const uint32_t size = bits & 0x7fffffff;
    if (size > 0x7f800000) return (uint16_t)(sign | 0x7e00);
    if (size >= 0x477ff000) return (uint16_t)(sign | 0x7c00); /* 65520 */
    if (size >= 0x38800000) return (uint16_t)(sign | round_shift(size - 0x38000000, 13));
    const uint32_t exponent = size >> 23; /* subnormal in half: units of 2^-24 */
    if (exponent < 102) return sign;      /* below 2^-25 */
    return (uint16_t)(sign | round_shift((size & 0x7fffff) | 0x800000, 126 - exponent));
}

float lq_half_to_float(uint16_t half) {
    const uint32_t sign = (uint32_t)(half & 0x8000) << 16, exponent = half >> 10 & 31, mantissa = half & 1023;
    uint32_t bits = sign;
    float value;
    if (exponent == 0) {
        value = (float)mantissa * 0x1p-24f;
        return sign ? -value : value;
    }
    bits |= (exponent == 31 ? 255 : exponent + 112) << 23 | mantissa << 13;
    memcpy(&value, &bits, sizeof value);
    return value;
}

float lq_half_round(float value) {
    return lq_half_to_float(lq_half_from_float(value));
}

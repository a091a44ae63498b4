/* The random points of the tests. */
#ifndef LACQUER_TESTS_UNIFORM_H
#define LACQUER_TESTS_UNIFORM_H

/* A counter-based stream that needs no state: splitmix64 (Steele et al. 2014). */
static inline double uniform(unsigned long long index) {
    unsigned long long z = index * 0x9e3779b97f4a7c15u + 0x243f6a8885a308d3u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

#endif

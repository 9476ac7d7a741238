/* random.h: repeatable random numbers for tests: splitmix64 (Steele, Lea, Flood 2014) */
#ifndef COTREE_TESTS_RANDOM_H
#define COTREE_TESTS_RANDOM_H

#include <math.h>
#include <stdint.h>

__attribute__((unused)) static uint64_t test_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9E3779B97F4A7C15U);

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

__attribute__((unused)) static double test_uniform(uint64_t *state, double low, double high)
{
    return low + (high - low) * (double)(test_random(state) >> 11) * 0x1p-53;
}

/* between low and high, both positive, alike in every decade */
__attribute__((unused)) static double test_decades(uint64_t *state, double low, double high)
{
    return low * pow(high / low, test_uniform(state, 0, 1));
}

#endif

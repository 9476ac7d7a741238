/* random.h: repeatable random numbers: splitmix64 (Steele, Lea, Flood 2014) */
#ifndef COTREE_BASE_RANDOM_H
#define COTREE_BASE_RANDOM_H

#include <stdint.h>

/* between -1 and 1; *state is the seed, moved on */
static inline double random_unit(uint64_t *state)
{
    uint64_t z = (*state += 0x9E3779B97F4A7C15U);

    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return 2 * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53) - 1;
}

#endif

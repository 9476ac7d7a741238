/* random_stream.h: random numbers by counters: each is a function of seed, run and column alone, so
 * that a run has the same numbers in any order and on any thread
 *
 * Philox4x32 with ten rounds (Salmon, Moraes, Dror, Shaw 2011). */
#ifndef COTREE_SIMULATE_SWEEP_RANDOM_STREAM_H
#define COTREE_SIMULATE_SWEEP_RANDOM_STREAM_H

#include <stdint.h>

/* the block of a counter and a key */
void random_block(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);
/* Uniform in (0, 1), with 53 bits; never 0 or 1. `use` separates streams of one purpose. */
double random_uniform(uint64_t seed, uint64_t run, uint32_t column, uint32_t use);

#endif

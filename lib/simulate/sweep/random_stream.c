/* random_stream.c: Philox4x32-10 */
#include "simulate/sweep/random_stream.h"

enum { ROUNDS = 10 };

static const uint32_t multipliers[2] = {0xD2511F53U, 0xCD9E8D57U};
static const uint32_t increments[2] = {0x9E3779B9U, 0xBB67AE85U}; /* of the key, each round */

void random_block(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4])
{
    uint32_t x[4] = {counter[0], counter[1], counter[2], counter[3]};
    uint32_t k[2] = {key[0], key[1]};

    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t a = (uint64_t)multipliers[0] * x[0];
        const uint64_t b = (uint64_t)multipliers[1] * x[2];
        const uint32_t next[4] = {(uint32_t)(b >> 32) ^ x[1] ^ k[0], (uint32_t)b,
                                  (uint32_t)(a >> 32) ^ x[3] ^ k[1], (uint32_t)a};

        for (int i = 0; i < 4; i++)
            x[i] = next[i];
        k[0] += increments[0];
        k[1] += increments[1];
    }
    for (int i = 0; i < 4; i++)
        out[i] = x[i];
}

double random_uniform(uint64_t seed, uint64_t run, uint32_t column, uint32_t use)
{
    const uint32_t counter[4] = {(uint32_t)run, (uint32_t)(run >> 32), column, use};
    const uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    uint32_t block[4];

    random_block(counter, key, block);
    return ((double)(((uint64_t)block[0] << 32 | block[1]) >> 11) + 0.5) * 0x1p-53;
}

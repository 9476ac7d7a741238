/* bench.h: what benchmarks share
 *
 * A benchmark prints lines `name value unit`, smaller is better; `make bench` puts the
 * record beside them. The name holds no blank and begins with the module: expr.diff_1e5. */
#ifndef COTREE_TESTS_BENCH_H
#define COTREE_TESTS_BENCH_H

#include "base/clock.h"

#include <malloc.h>
#include <stdio.h>

/* What a round frees serves the next one, as in a session that goes on: it is not for each to give
 * memory back to the system and ask for it again. */
__attribute__((constructor)) static void bench_keep_memory(void)
{
    (void)mallopt(M_TOP_PAD, 1 << 26);
}

__attribute__((unused)) static void bench_line(const char *name, double value, const char *unit)
{
    printf("%s %.4g %s\n", name, value, unit);
}

/* the least time of some tries, in seconds: what the machine needs when nobody disturbs it */
#define BENCH_LEAST(tries, seconds, ...)                                                           \
    do {                                                                                           \
        (seconds) = 1e300;                                                                         \
        for (int try_ = 0; try_ < (tries); try_++) {                                               \
            double begin_ = clock_now();                                                           \
            __VA_ARGS__;                                                                           \
            double took_ = clock_now() - begin_;                                                   \
            (seconds) = took_ < (seconds) ? took_ : (seconds);                                     \
        }                                                                                          \
    } while (0)

#endif

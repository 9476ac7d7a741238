/* clock.h: the monotonic clock, independent of the time of day */
#ifndef COTREE_BASE_CLOCK_H
#define COTREE_BASE_CLOCK_H

#include <time.h>

/* s; since when doesn't matter */
static inline double clock_now(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif

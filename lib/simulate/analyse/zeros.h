/* zeros.h: zeros of a transfer function, with what they are known to */
#ifndef COTREE_SIMULATE_ANALYSE_ZEROS_H
#define COTREE_SIMULATE_ANALYSE_ZEROS_H

#include "algebra/spectrum.h"
#include "simulate/analyse/single.h"

/* From the poles (n), write the zeros of d + c (s - A)^-1 b (room for n), and the gain of it in
 * poles and zeros; 0 where it can't be told from 0. False where they can't be found. O(n^3). */
MUST_USE bool zeros_find(const Single *single, const Root *pole, Root *zero, int *count,
                         double *gain);

#endif

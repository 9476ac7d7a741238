/* independence.h: whether many sparse rows are independent beyond doubt */
#ifndef COTREE_ALGEBRA_INDEPENDENCE_H
#define COTREE_ALGEBRA_INDEPENDENCE_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

/* True only where the least singular value of the m x nu matrix, rows brought to unit size, is more
 * than `threshold`, itself less than 1e-2. False says nothing: the rows may be close to each other,
 * or the watch says stop. O(m nu) and what the factors of rows times rows take, which is little
 * where rows share few columns. */
bool rows_are_independent(const double *matrix, int m, int nu, double threshold,
                          const CallMonitor *watch);
/* The same of rows that stand as columns of a pattern, without the O(m nu). */
bool columns_are_independent(const Pattern *pattern, const double *values, double threshold,
                             const CallMonitor *watch);

#endif

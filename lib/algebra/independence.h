/* independence.h: whether many sparse rows are independent beyond doubt */
#ifndef COTREE_ALGEBRA_INDEPENDENCE_H
#define COTREE_ALGEBRA_INDEPENDENCE_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

/* True only if the least singular value of the m x nu matrix, with rows scaled to unit size,
 * exceeds `threshold` (less than 1e-2). False proves nothing: the rows may be nearly dependent, or
 * the watch requested a stop. O(m nu) plus the cost of factoring J J^T, which is low when rows
 * share few columns. */
bool rows_are_independent(const double *matrix, int m, int nu, double threshold,
                          const CallMonitor *watch);
/* The same for rows that are stored as columns of a pattern, without the O(m nu). */
bool columns_are_independent(const Pattern *pattern, const double *values, double threshold,
                             const CallMonitor *watch);

#endif

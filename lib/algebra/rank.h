/* rank.h: which constraint rows are independent */
#ifndef COTREE_ALGEBRA_RANK_H
#define COTREE_ALGEBRA_RANK_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

/* Rank of the m x nu matrix by QR with pivoting of its transpose, rows brought to unit size first;
 * a remainder below `threshold` times the largest counts as 0. order[0..rank-1] are independent
 * rows, rising; the rest, rising too, depend on them. E_STOPPED when the watch requests a stop.
 * O(nu m^2), less for entries that are 0. Golub and Van Loan (2013), 5.4.2. */
MUST_USE Status rank_rows(const double *matrix, int m, int nu, double threshold,
                          const CallMonitor *watch, int *rank, int *order);

/* The same for rows that are stored as columns of a pattern. When they are certainly independent,
 * the full matrix isn't formed. */
MUST_USE Status rank_columns(const Pattern *pattern, const double *values, double threshold,
                             const CallMonitor *watch, int *rank, int *order);

/* The `count` rows that are the least dependent on each other, rising; returns their rank_ratio().
 * O(nu m count). */
double rank_choose(const double *matrix, int m, int nu, int count, int *rows);
/* Least over largest pivot of some rows, brought to unit size first: how independent they are.
 * O(nu count^2). */
double rank_ratio(const double *matrix, int nu, const int *rows, int count);

/* The least multipliers of those that give the same forces: lambda's part in the range of
 * phi_u. In place. O(nu m^2). */
void rank_least_multipliers(const double *phi_u, int m, int nu, double *lambda);

#endif

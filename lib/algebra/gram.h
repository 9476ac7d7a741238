/* gram.h: J J^T of many sparse rows, and its sparse factors */
#ifndef COTREE_ALGEBRA_GRAM_H
#define COTREE_ALGEBRA_GRAM_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

typedef struct Gram Gram;

/* Of an m x nu matrix, each row divided by its norm (NULL: by 1). New; gram_free(). O(m nu) plus
 * the products of rows that share a column. */
Gram *gram_new(const double *matrix, int m, int nu, const double *norm);
/* The same for rows that are stored as columns of a pattern. O(entries) plus those products. */
Gram *gram_of_columns(const Pattern *pattern, const double *values, const double *norm);
void gram_free(Gram *gram);
double gram_largest(const Gram *gram); /* on the diagonal */
/* Where no diagonal entry is more than 1: an upper bound of the change of the factored matrix'
 * eigenvalues by rounding. */
double gram_rounding(const Gram *gram);
/* Factor J J^T + added 1, without exchanges. False when a pivot isn't more than `least` times its
 * diagonal entry, or the watch requests a stop. */
bool gram_factor(Gram *gram, double added, double least, const CallMonitor *watch);
void gram_solve(const Gram *gram, double *b); /* b becomes the solution */

#endif

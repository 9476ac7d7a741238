/* ldl.h: P A P^T = L D L^T of a sparse symmetric matrix, pivots taken in an order chosen once
 *
 * The order depends on the pattern alone; several sets of factors may share it. It suits matrices
 * whose pivots need no exchange: positive definite ones, and those bordered by rows with a zero
 * corner block, where all unknowns of an earlier class precede those of a later one.
 *
 * A pivot is d = a_kk - p + n, where p is the sum that the rows before subtract and n the sum that
 * they add. If d is small against p, the row is nearly a combination of those before. */
#ifndef COTREE_ALGEBRA_LDL_H
#define COTREE_ALGEBRA_LDL_H

#include "base/call_monitor.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct LdlOrder LdlOrder;
typedef struct Ldl Ldl;

/* New; free with ldl_order_free(). Entry k is at row[k], column[k] and at its transposed position;
 * the caller passes each pair once. The diagonal is always stored. class[i] = 0, 1 ... is the class
 * of unknown i: pivots are ordered by rising class, and within a class for little fill-in. Sets
 * place[k] to the index of entry k in ldl_entries(), place_of[i] to that of the i-th diagonal entry
 * and of component i of a vector. Camd (Amestoy, Davis, Duff 2004). */
LdlOrder *ldl_order_new(int n, const int *class, int entries, const int *row, const int *column,
                        int *place, int *place_of);
void ldl_order_free(LdlOrder *order);       /* NULL is fine */
int ldl_order_width(const LdlOrder *order); /* in a row of L + L^T, at most */
/* pairs of entries in columns of L, an entry with itself too: number of products of ldl_factor() */
int64_t ldl_order_products(const LdlOrder *order);

Ldl *ldl_new(const LdlOrder *order); /* new, borrows the order; ldl_free() */
void ldl_free(Ldl *ldl);             /* NULL is fine */
double *ldl_entries(Ldl *ldl);       /* by place; all 0 at first. Factors leave them as they are */
/* If a pivot is smaller in size than LDL_SMALL times its `reference` (by place; NULL: none),
 * LDL_HOLD times that is subtracted from it, which regularises its unknown. A pivot of 0 is
 * skipped. False when the watch requests a stop. O(products of pairs in columns of L). */
#define LDL_SMALL 1e-5
#define LDL_HOLD  1e-8
bool ldl_factor(Ldl *ldl, const double *reference, const CallMonitor *watch);
/* By place, of the last ldl_factor(): pivots (regularised ones before the subtraction), and p. */
const double *ldl_pivots(const Ldl *ldl);
const double *ldl_taken(const Ldl *ldl);
/* x, by place, becomes the solution; */
void ldl_solve(const Ldl *ldl, double *x);
/* out = b - A x for the entries as they are. */
void ldl_residual(const Ldl *ldl, const double *b, const double *x, double *out);

#endif

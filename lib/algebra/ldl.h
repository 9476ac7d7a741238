/* ldl.h: P A P^T = L D L^T of a sparse symmetric matrix, pivots taken in an order chosen once
 *
 * The order knows the pattern alone; factors are numbers, of which one order may have several. It
 * serves matrices whose pivots need no exchange: positive definite ones, and those bordered by rows
 * with 0 in their corner, where unknowns of a later class follow all of an earlier one.
 *
 * A pivot is a sum d = a_kk - p + n of what rows before take off and add: where it is small
 * against p, the row is nearly a combination of those before. */
#ifndef COTREE_ALGEBRA_LDL_H
#define COTREE_ALGEBRA_LDL_H

#include "base/call_monitor.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct LdlOrder LdlOrder;
typedef struct Ldl Ldl;

/* New; ldl_order_free(). Entry k stands at row[k], column[k] and across, each pair given once; the
 * diagonal is there in any case. class[i] 0, 1 ... of unknown i: pivots by rising class, in a class
 * so that little fills in. place[k] becomes where the entry is written, place_of[i] where that
 * of the i-th diagonal entry and of a vector is. Camd (Amestoy, Davis, Duff 2004). */
LdlOrder *ldl_order_new(int n, const int *class, int entries, const int *row, const int *column,
                        int *place, int *place_of);
void ldl_order_free(LdlOrder *order);       /* NULL is fine */
int ldl_order_width(const LdlOrder *order); /* in a row of L + L^T, at most */
/* pairs of entries in columns of L, an entry with itself too: products that ldl_factor() takes */
int64_t ldl_order_products(const LdlOrder *order);

Ldl *ldl_new(const LdlOrder *order); /* new, borrows the order; ldl_free() */
void ldl_free(Ldl *ldl);             /* NULL is fine */
double *ldl_entries(Ldl *ldl);       /* by place; all 0 at first. Factors leave them as they are */
/* Where a pivot is less in size than LDL_SMALL of its `reference` (by place; NULL: none), LDL_HOLD
 * of that is taken off it, which holds its unknown back; a pivot of 0 is passed over. False when
 * the watch says stop. O(products of pairs in columns of L). */
#define LDL_SMALL 1e-5
#define LDL_HOLD  1e-8
bool ldl_factor(Ldl *ldl, const double *reference, const CallMonitor *watch);
/* By place, of the last ldl_factor(): pivots, those that are held as they would be, and p. */
const double *ldl_pivots(const Ldl *ldl);
const double *ldl_taken(const Ldl *ldl);
/* x, by place, becomes the solution; */
void ldl_solve(const Ldl *ldl, double *x);
/* out = b - A x for the entries as they are. */
void ldl_residual(const Ldl *ldl, const double *b, const double *x, double *out);

#endif

/* kkt.h: the matrix [M G^T; G 0] of accelerations and multipliers
 *
 * M is nu x nu, symmetric, possibly singular; G holds the m constraint rows in use. Of both the
 * entries that may not be 0 are stored. Near a singular configuration a small -epsilon in the
 * corner of the rows that become dependent keeps the solution bounded, and sweeps of refinement
 * against the true matrix take its effect back where the equations determine the answer
 * (quasi-definite regularisation, Vanderbei 1995).
 *
 * Where few speeds are those of many rows, as of a platform on many legs, the others are eliminated
 * with their rows first (kkt_border.h), and the work is linear in the legs.
 *
 * A configuration is singular by its geometry, whatever the masses: what counts are the pivots of
 * G G^T, columns and rows of G brought to like size. */
#ifndef COTREE_ALGEBRA_KKT_H
#define COTREE_ALGEBRA_KKT_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

typedef struct Kkt Kkt;

/* New; free with kkt_free(). Borrows the patterns: of M, both halves, and of all constraint rows, a
 * column each. m of them will be in use, these at first. */
Kkt *kkt_new(const Pattern *mass, const Pattern *constraints, const int *rows, int m);
/* who may stop kkt_factor(), borrowed; NULL: nobody */
void kkt_set_watch(Kkt *kkt, const CallMonitor *watch);
void kkt_free(Kkt *kkt); /* NULL is fine */
/* Factor, from the values of the patterns' places; borrowed during the call. Where `rows` are
 * others than before, their order of elimination is found first. False when no solution can be had
 * at all: M singular where nothing holds it, or NaN; or it was stopped. */
bool kkt_factor(Kkt *kkt, const double *mass, const double *phi_u, const int *rows);
/* whether kkt_solve() may be called: kkt_independence() may have found another order, or a call
 * that did have been taken back */
bool kkt_is_factored(const Kkt *kkt);
/* products that a kkt_factor() takes in the order as it is, by its pattern, but for those that only
 * some positions need */
double kkt_products(const Kkt *kkt);
/* of the last kkt_factor(): whether a singular configuration is so near that epsilon is there */
bool kkt_is_regularised(const Kkt *kkt);
/* relative size of what rounding may leave of speeds and accelerations there; 0: as elsewhere */
double kkt_rounding_error(const Kkt *kkt);
/* How independent the rows are, without M: the root of the least of those pivots, 1 at most. It
 * falls to 0 as the distance to a singular configuration does. */
double kkt_independence(Kkt *kkt, const double *phi_u, const int *rows);
double
kkt_rounding_error_at(double independence); /* kkt_rounding_error() where rows are as independent */
/* How independent they are by the rows of each group of a block triangular form alone
 * (triangular.h), which is less work: the rows are independent as long as it isn't small. 0: they
 * have no such form. */
double kkt_independence_of_groups(Kkt *kkt, const double *phi_u, const int *rows);
/* What is next to nothing is told by how large it has been. Sizes as they are now are kept, and
 * come back where a step that was tried and given up has seen what the motion never does. */
void kkt_store_sizes(Kkt *kkt);
void kkt_return_sizes(Kkt *kkt);
/* of the last kkt_factor(): whether it needs neither epsilon, refinement nor rows exchanged */
bool kkt_is_plain(const Kkt *kkt);
/* Whether a factorisation that somebody else has made, speeds before multipliers, is as plain: by
 * pivots d of these rows, signs reversed, and p; and of speeds behind them by what is left of their
 * pivots, 1 at most. Less of d will do where all rows are known to be independent, or groups tell
 * so, by G here and sizes as they were measured last. What pivots show of sizes counts from now on.
 */
bool kkt_is_sound(Kkt *kkt, const double *pivot, const double *taken, const double *phi_u,
                  const int *rows, const double *left, int left_count, bool is_known);
/* M du + G^T lambda = top, G du = bottom. `top` may be NULL for 0; du may be `top`. */
void kkt_solve(Kkt *kkt, const double *top, const double *bottom, double *du, double *lambda);
/* du of the same with top 0, where it corrects something much larger, or is corrected itself: not
 * refined for what rounding leaves in its last digits. */
void kkt_correct(Kkt *kkt, const double *bottom, double *du);

#endif

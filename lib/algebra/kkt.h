/* kkt.h: the matrix [M G^T; G 0] of accelerations and multipliers
 *
 * M is nu x nu, symmetric, possibly singular; G (m x nu) consists of the constraint rows in use.
 * Only entries that may differ from 0 are stored. Near a singular configuration, -epsilon on the
 * diagonal of the rows that become dependent bounds the solution. Iterative refinement with the
 * true matrix removes its effect where the equations determine the answer (quasi-definite
 * regularisation, Vanderbei 1995).
 *
 * Where many rows share a few speeds, as those of a platform on many legs, the other speeds are
 * eliminated with their rows first (kkt_border.h). The work is then linear in the number of legs.
 *
 * A configuration is singular by its geometry, whatever the masses. The measure is the pivots of G
 * G^T, with columns and rows of G scaled to equal size. */
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
/* Factor, from values by place of the patterns; borrowed during the call. If `rows` differ from
 * those of the last call, an order of elimination is found first. False when there is no solution
 * (M singular in a direction that no constraint fixes, or NaN) or the call was stopped. */
bool kkt_factor(Kkt *kkt, const double *mass, const double *phi_u, const int *rows);
/* whether kkt_solve() may be called: not after kkt_independence() found another order, or after a
 * call that did was undone */
bool kkt_is_factored(const Kkt *kkt);
/* number of products of a kkt_factor() in the present order, by its pattern; without those that
 * only some positions need */
double kkt_products(const Kkt *kkt);
/* of the last kkt_factor(): whether a singular configuration is so near that epsilon is there */
bool kkt_is_regularised(const Kkt *kkt);
/* relative size of the rounding errors of speeds and accelerations there; 0: as elsewhere */
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
/* Smallness is measured against the largest size so far. These functions save the present sizes and
 * restore them after a rejected step, whose trial positions the motion never reaches. */
void kkt_store_sizes(Kkt *kkt);
void kkt_return_sizes(Kkt *kkt);
/* of the last kkt_factor(): whether it needs neither epsilon, refinement nor rows exchanged */
bool kkt_is_plain(const Kkt *kkt);
/* Whether a factorisation made elsewhere, speeds before multipliers, is regular as well. Tested are
 * the pivots d of these rows (signs reversed) against p, and the relative remainders of the pivots
 * of speeds that follow them, 1 at most. A smaller d suffices where all rows are known to be
 * independent, or groups show that by G here and the last measured sizes. The sizes that pivots
 * show are used from now on. */
bool kkt_is_sound(Kkt *kkt, const double *pivot, const double *taken, const double *phi_u,
                  const int *rows, const double *left, int left_count, bool is_known);
/* M du + G^T lambda = top, G du = bottom. `top` may be NULL for 0; du may be `top`. */
void kkt_solve(Kkt *kkt, const double *top, const double *bottom, double *du, double *lambda);
/* du of the same with top 0, where it corrects something much larger, or is corrected itself: not
 * refined for rounding errors in its last digits. */
void kkt_correct(Kkt *kkt, const double *bottom, double *du);

#endif

/* circuits.h: constraint rows of positions and orientations, from the circuits of their chords
 *
 *     DATUM, TAIL   n . d = 0       d: vector from the tail of a chord to its head, the sum of the
 *                                   vectors along its circuit; n: in axes of ground, of the tail
 *     DOT           a_t . b_h = 0   directions fixed in tail and head */
#ifndef COTREE_FORMULATE_KINEMATICS_CIRCUITS_H
#define COTREE_FORMULATE_KINEMATICS_CIRCUITS_H

#include "formulate/system/constraints.h"

/* the node where the paths from the datum to two nodes separate */
int circuit_parting(const System *system, int a, int b);
Expr circuit_shown(const System *system, const Row *row);
/* Lists the speeds that the row's derivative can contain, in order: few in a long mechanism.
 * `speeds` has room for all. Returns their number. */
int circuit_speeds(const System *system, const Row *row, int *speeds);
/* adds row k to the recursive form: Phi, Phi_u of those speeds, gamma */
void circuit_run(const System *system, const Row *row, int k, const int *speeds, int count);

#endif

/* circuits.h: rows of constraints that say where frames are, DATUM, TAIL and DOT, from
 * the circuits of their chords */
#ifndef COTREE_FORMULATE_KINEMATICS_CIRCUITS_H
#define COTREE_FORMULATE_KINEMATICS_CIRCUITS_H

#include "formulate/system/constraints.h"

/* where the ways from the datum to two nodes part */
int circuit_parting(const System *system, int a, int b);
Expr circuit_shown(const System *system, const Row *row);
/* Speeds that the row's derivative can hold, in order: of a long mechanism few. Room for all; how
 * many there are. */
int circuit_speeds(const System *system, const Row *row, int *speeds);
/* puts row k into what is run: Phi, Phi_u of those speeds, gamma */
void circuit_run(const System *system, const Row *row, int k, const int *speeds, int count);

#endif

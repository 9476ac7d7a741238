/* multi_turn.h: turns of chords that only sine and cosine determine, or that count full turns */
#ifndef COTREE_FORMULATE_KINEMATICS_MULTI_TURN_H
#define COTREE_FORMULATE_KINEMATICS_MULTI_TURN_H

#include "formulate/system/constraints.h"

/* finds the turns of chords that only sine and cosine determine */
void multi_turn_build(System *system);
/* the angle of such a turn; NULL: it is no such turn */
Expr multi_turn_angle(const System *system, int instance, int coordinate);
/* the full turns of a chord's angle, to be added to the sum that determines it; 0: it has none */
Expr multi_turn_whole(const System *system, int instance, int coordinate);
/* adds full turns to rows of angles with sum 0, in the recursive form */
void multi_turn_add_rows(System *system);
/* a driver prescribes the angle */
void multi_turn_drive(System *system, int instance, int coordinate, Expr prescribed);

#endif

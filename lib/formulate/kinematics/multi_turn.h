/* multi_turn.h: turns of chords that only their sine and cosine tell, or that count whole turns */
#ifndef COTREE_FORMULATE_KINEMATICS_MULTI_TURN_H
#define COTREE_FORMULATE_KINEMATICS_MULTI_TURN_H

#include "formulate/system/constraints.h"

/* which turns of chords are told by sine and cosine alone */
void multi_turn_build(System *system);
/* the angle of such a turn; NULL: it is none of them */
Expr multi_turn_angle(const System *system, int instance, int coordinate);
/* the whole turns that the angle of a chord has beside the sum that tells it; 0: it has none */
Expr multi_turn_whole(const System *system, int instance, int coordinate);
/* to rows of angles that sum up to 0, in the recursive form */
void multi_turn_add_rows(System *system);
/* a driver makes it so */
void multi_turn_drive(System *system, int instance, int coordinate, Expr prescribed);

#endif

/* constraint_rows.h: circuits of chords made into constraint rows */
#ifndef COTREE_FORMULATE_KINEMATICS_CONSTRAINT_ROWS_H
#define COTREE_FORMULATE_KINEMATICS_CONSTRAINT_ROWS_H

#include "formulate/system/constraints.h"

MUST_USE Status constraints_build(System *system, Diag *diag);

#endif

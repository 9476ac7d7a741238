/* mass_matrix.h: the numeric M where no entry of it is symbolic
 * (formulate/dynamics/composite_mass.h) */
#ifndef COTREE_SIMULATE_EQUATIONS_MASS_MATRIX_H
#define COTREE_SIMULATE_EQUATIONS_MASS_MATRIX_H

#include "algebra/pattern.h"
#include "formulate/dynamics/composite_mass.h"

typedef struct MassMatrix MassMatrix;

/* New; borrows from the system. NULL: the system's M is symbolic and is compiled as it is. */
MassMatrix *mass_matrix_new(const System *system);
void mass_matrix_free(MassMatrix *matrix); /* NULL is fine */
/* the expressions that it is made from */
const Expr *mass_matrix_needs(const MassMatrix *matrix, int *count);
/* Compute M for these values of the needs. O(speeds x places on their paths) */
void mass_matrix_set(MassMatrix *matrix, const double *numbers);
/* M as computed last: the entries that may not be 0, and their positions; borrowed */
const double *mass_matrix_at(const MassMatrix *matrix);
const Pattern *mass_matrix_places(const MassMatrix *matrix);

#endif

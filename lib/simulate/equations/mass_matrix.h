/* mass_matrix.h: M in numbers where nothing of it is written out
 * (formulate/dynamics/composite_mass.h) */
#ifndef COTREE_SIMULATE_EQUATIONS_MASS_MATRIX_H
#define COTREE_SIMULATE_EQUATIONS_MASS_MATRIX_H

#include "algebra/pattern.h"
#include "formulate/dynamics/composite_mass.h"

typedef struct MassMatrix MassMatrix;

/* New; borrows from the system. NULL: its M is run as it is written. */
MassMatrix *mass_matrix_new(const System *system);
void mass_matrix_free(MassMatrix *matrix); /* NULL is fine */
/* the expressions that it is made from */
const Expr *mass_matrix_needs(const MassMatrix *matrix, int *count);
/* M for the numbers of these. O(speeds x places on their ways) */
void mass_matrix_set(MassMatrix *matrix, const double *numbers);
/* as it was put last, the entries that may not be 0, and where they stand; borrowed */
const double *mass_matrix_at(const MassMatrix *matrix);
const Pattern *mass_matrix_places(const MassMatrix *matrix);

#endif

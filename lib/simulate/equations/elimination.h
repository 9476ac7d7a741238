/* elimination.h: whether a run's program eliminates u' itself, and how */
#ifndef COTREE_SIMULATE_EQUATIONS_ELIMINATION_H
#define COTREE_SIMULATE_EQUATIONS_ELIMINATION_H

#include "formulate/reduced/accelerations.h"
#include "formulate/reduced/constrained.h"
#include "formulate/reduced/prescribed.h"
#include "simulate/equations/variable_index.h"

/* u' on the layout's surfaces, then what tells its rounding, or where all is prescribed the
 * multipliers (2 nu): new, also where it is not told. */
MUST_USE Status elimination_choose(const VariableIndex *layout, EliminatedBy *by, Expr **out,
                                   Diag *diag);

/* Where these constraint rows hold the speeds: new, constrained_free(). NULL: it is left to
 * numbers, as where it takes more than `most` products. */
Constrained *elimination_of_rows(const VariableIndex *layout, const int *rows, int row_count,
                                 double most);

#endif

/* elimination.h: whether a run's program eliminates u' itself, and how */
#ifndef COTREE_SIMULATE_EQUATIONS_ELIMINATION_H
#define COTREE_SIMULATE_EQUATIONS_ELIMINATION_H

#include "formulate/reduced/accelerations.h"
#include "formulate/reduced/constrained.h"
#include "formulate/reduced/prescribed.h"
#include "simulate/equations/variable_index.h"

/* u' on the layout's surfaces, followed by its rounding indicators or, where all speeds are
 * prescribed, by the multipliers (2 nu). New, also where there is no such form. */
MUST_USE Status elimination_choose(const VariableIndex *layout, EliminatedBy *by, Expr **out,
                                   Diag *diag);

/* Where these rows constrain the speeds. New, free with constrained_free(). NULL: numeric
 * factorisation does it, as where elimination takes more than `most` products. */
Constrained *elimination_of_rows(const VariableIndex *layout, const int *rows, int row_count,
                                 double most);

#endif

/* substituted.h: M u' + G^T lambda = F, G u' = gamma in symbols, speeds substituted by their rows
 *
 * A row in which a speed has an entry of 1 or -1 tells that speed by the others, whatever the
 * position. Where each row tells one so, one after the other, no rows have to be independent. */
#ifndef COTREE_FORMULATE_REDUCED_SUBSTITUTED_H
#define COTREE_FORMULATE_REDUCED_SUBSTITUTED_H

#include "formulate/dynamics/composite_mass.h"
#include "formulate/reduced/constrained.h"

typedef struct Substitution Substitution;

/* New; substitution_free(). With these entries of one half of M, borrowed; NULL: not each of the
 * rows tells a speed. */
Substitution *substitution_new(System *system, const MassEntries *mass, const int *rows,
                               int row_count);
void substitution_free(Substitution *substitution); /* NULL is fine */
/* products that elimination takes */
int64_t substitution_products(const Substitution *substitution);
/* accelerations, multipliers, excess and steps; false: there is no pivot */
bool substitution_solve(Substitution *substitution, const Expr *force, const Expr *gamma,
                        const Constrained *out);

#endif

/* substituted.h: M u' + G^T lambda = F, G u' = gamma in symbols, speeds substituted by their rows
 *
 * A row with an entry of 1 or -1 for a speed determines that speed by the others, in every
 * position. Where each row determines one this way, in sequence, the rows needn't be tested for
 * independence. */
#ifndef COTREE_FORMULATE_REDUCED_SUBSTITUTED_H
#define COTREE_FORMULATE_REDUCED_SUBSTITUTED_H

#include "formulate/dynamics/composite_mass.h"
#include "formulate/reduced/constrained.h"

typedef struct Substitution Substitution;

/* New; substitution_free(). `mass`: entries of one half of M, borrowed; NULL: some row determines
 * no speed. */
Substitution *substitution_new(System *system, const MassEntries *mass, const int *rows,
                               int row_count);
void substitution_free(Substitution *substitution); /* NULL is fine */
/* products that the elimination needs */
int64_t substitution_products(const Substitution *substitution);
/* accelerations, multipliers, excess and steps; false: there is no pivot */
bool substitution_solve(Substitution *substitution, const Expr *force, const Expr *gamma,
                        const Constrained *out);

#endif

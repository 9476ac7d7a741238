/* expanded.h: entries of the equations in expanded form */
#ifndef COTREE_FORMULATE_EXPANDED_EXPANDED_H
#define COTREE_FORMULATE_EXPANDED_EXPANDED_H

#include "formulate/system/system.h"

typedef Status EntryFunction(System *system, int row, int column, Expr *out, Diag *diag);

/* false: by an estimate, entries of M and F would be too long to be expanded */
bool expanded_fits(const System *system);
int embedded_rows(const System *system); /* they exclude drivers */
/* The expression without named subexpressions, multiplied out, folded and collected, whatever is
 * shortest. */
Expr expanded_tidy(System *system, Expr e);
/* an entry as shown, of a block that isn't embedded, with symbols for full turns */
MUST_USE Status expanded_entry(System *system, Block block, int row, int column, Expr *out,
                               Diag *diag);
/* An entry that was formed before, or that `form` forms now. */
MUST_USE Status entry_formed(System *system, Block block, EntryFunction *form, int row, int column,
                             Expr *out, Diag *diag);

#endif

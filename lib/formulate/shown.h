/* shown.h: what a view forms of a finished System when somebody asks: entries written out,
 * reactions, switches */
#ifndef COTREE_FORMULATE_SHOWN_H
#define COTREE_FORMULATE_SHOWN_H

#include "base/memory.h"
#include "formulate/system.h"
#include "formulate/vector.h"

typedef struct Recovery Recovery;
typedef struct Sums Sums;

typedef struct Shown {
    Expr *entries[BLOCK_COUNT]; /* arrays; NULL, as their entries are, until formed */
    Vec *positions;             /* of nodes, ground axes; likewise */
    Recovery *recovery;         /* NULL: not looked for yet, or no row vanished */
    Sums *actual;               /* with u', lambda: for reactions */
    Vec *actual_a;              /* accelerations of nodes */
    Vec *actual_alpha;          /* of chains */
    Expr *turn_rates;           /* of angles that count turns; as entries */
    Expr power;                 /* that sources give and losses take */
    LIST(Switch) switches;
    LIST(Expr) surfaces; /* where they jump, in the state */
    int switches_of_time;
    bool switches_known;
    int depth; /* of variables being resolved */
} Shown;

void shown_free(Shown *shown); /* NULL is fine */

/* false: entries of M and F would be too long to be written out: a guess */
bool expanded_fits(const System *system);
/* an entry of what is shown, whole turns with it (expanded.c) */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif

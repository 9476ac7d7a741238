/* shown.h: what a view forms of a finished System when somebody asks: entries written out,
 * reactions, switches */
#ifndef COTREE_FORMULATE_SYSTEM_SHOWN_H
#define COTREE_FORMULATE_SYSTEM_SHOWN_H

#include "base/memory.h"
#include "formulate/system/system.h"
#include "formulate/system/vector.h"

typedef struct Recovery Recovery;
typedef struct Sums Sums;

typedef struct Shown {
    Expr *entries[BLOCK_COUNT]; /* arrays; NULL, as their entries are, until formed */
    Vec *positions;             /* of nodes, ground axes; likewise */
    Vec *datum_axes;            /* ground's x of chains, in their axes, then y, z; or NULL */
    Recovery *recovery;         /* NULL: not looked for yet, or no row vanished */
    Sums *actual;               /* with u', lambda: for reactions */
    Vec *actual_a;              /* accelerations of nodes */
    Vec *actual_alpha;          /* of chains */
    Expr *turn_rates;           /* of angles that count turns; as entries */
    int *full_turns;            /* of sums of angles, an entry one; NULL: none has any */
    Expr power;                 /* that sources give and losses take */
    Expr *eliminated;           /* u' in symbols, the last told (accelerations.c); NULL: none yet */
    int eliminated_how;         /* how it was */
    LIST(Switch) switches;
    LIST(Expr) surfaces; /* where they jump, in the state */
    int switches_of_time;
    bool switches_known;
    int depth; /* of variables being resolved */
} Shown;

#endif

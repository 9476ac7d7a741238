/* shown.h: what a view derives from a finished System on request: expanded entries, reactions,
 * switches */
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
    /* the datum's x in the axes of every orientation class, then y, then z; or NULL */
    Vec *datum_axes;
    Recovery *recovery; /* NULL: not searched for yet, or no row is redundant */
    Sums *actual;       /* with u' and lambda: for reactions */
    Vec *actual_a;      /* accelerations of nodes */
    Vec *actual_alpha;  /* of orientation classes */
    Expr *turn_rates;   /* of angles with full turns; as entries */
    int *full_turns;    /* of sums of angles, one for each; NULL: none has any */
    Expr power;         /* of sources and losses */
    Expr *eliminated;   /* u' in symbols, the last result (accelerations.c); NULL: none yet */
    int eliminated_how; /* method of that elimination */
    LIST(Switch) switches;
    LIST(SystemSurface) surfaces; /* where the equations jump, in the state */
    int switches_of_time;
    bool switches_known;
    int depth; /* number of variables being resolved */
} Shown;

#endif

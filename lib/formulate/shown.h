/* shown.h: what is formed of a finished System when somebody asks: entries written out, reactions,
 * switches */
#ifndef COTREE_FORMULATE_SHOWN_H
#define COTREE_FORMULATE_SHOWN_H

#include "base/memory.h"
#include "formulate/system.h"
#include "formulate/vector.h"

typedef struct Recovery Recovery;
typedef struct Sums Sums;

typedef struct Shown {
    Expr *entries[BLOCK_COUNT]; /* NULL pointers until formed */
    Recovery *recovery;         /* NULL: not looked for yet, or no row vanished */
    Sums *actual;               /* with u', lambda: for reactions */
    Vec *actual_a;              /* accelerations of nodes */
    Vec *actual_alpha;          /* of chains */
    LIST(Switch) switches;
    LIST(Expr) surfaces; /* where they jump, in the state */
    int switches_of_time;
    bool switches_known;
    int64_t terms_guessed; /* of M written out; 0: not guessed yet */
    int depth;             /* of variables being resolved */
} Shown;

void shown_free(Shown *shown); /* NULL is fine */

/* false: entries of M and F are too long for that, and stand over their definitions */
bool system_writes_out(System *system);
/* an entry of what is shown, whole turns with it (expanded.c) */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

#endif

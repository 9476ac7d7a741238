/* shown.h: what is formed of a finished System when somebody asks: entries written out, reactions,
 * switches */
#ifndef COTREE_FORMULATE_SHOWN_H
#define COTREE_FORMULATE_SHOWN_H

#include "base/memory.h"
#include "formulate/constraints.h"
#include "formulate/dynamics.h"
#include "formulate/sample.h"

/* multipliers of rows that vanished, from virtual branches that carry nothing (redundancy.c) */
typedef struct Recovery {
    Expr *multipliers; /* mu, one a vanished row; 0 where it is open */
    Sums **sums;       /* what a unit of each puts beyond every node */
    int open_count;    /* combinations of mu that nothing determines */
    double *open;      /* vanished rows x open_count, at `sample` */
    Sample *sample;    /* the position */
} Recovery;

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

/* vectors as sums over chains, for the expanded form (framesum.c) */
typedef struct Part {
    int chain;
    Vec v; /* zero-position axes of the chain */
} Part;

typedef struct FrameSum {
    Part *parts; /* in the system's pool, by chain */
    int count;
} FrameSum;

FrameSum framesum_add(System *system, FrameSum a, Expr scale, FrameSum b);
FrameSum framesum_of(System *system, int chain, Vec v);
/* k of chain `turn` crossed with each part */
FrameSum framesum_cross(System *system, Vec axis, int chain, FrameSum b);
Expr framesum_dot(System *system, FrameSum a, FrameSum b);
/* the way from one node to another along the translation tree */
FrameSum framesum_way(System *system, int from, int to);

/* false: entries of M and F are too long for that, and stand over their definitions */
bool system_writes_out(System *system);
/* an entry of what is shown, whole turns with it (expanded.c) */
MUST_USE Status show_entry(System *system, Block block, int row, int column, Expr *out, Diag *diag);

/* --- the embedded form (embedded.c) --- */

MUST_USE Status embedded_mass(System *system, int row, int column, Expr *out, Diag *diag);
MUST_USE Status embedded_force(System *system, int row, int column, Expr *out, Diag *diag);
int embedded_rows(const System *system); /* drivers don't count as constraints in it */
/* the effort of the only driver of a system with one freedom, in q, u and u' */
MUST_USE Status embedded_effort(System *system, const Row *driver, Expr *out, Diag *diag);

/* --- reactions (reactions.c, redundancy.c) --- */

/* accelerations with u', sums inward with lambda */
MUST_USE Status actual_build(System *system, Diag *diag);
/* what a constraint row puts on its two ends: -lambda along its direction */
void loads_add_row(System *system, Loads *loads, const Row *row, Expr lambda);
/* multipliers of the rows that vanished, from the loads without them */
void recovery_build(System *system, const Loads *loads);

typedef struct ReactionPart { /* a component of a force or a moment */
    bool moment;
    bool own; /* in the axes of the tail, not of the datum */
    int axis; /* 0, 1, 2 */
} ReactionPart;
MUST_USE Status joint_reaction(System *system, const Instance *joint, ReactionPart part, Expr *out,
                               Diag *diag);

#endif

/* reactions.h: what joints and constraint rows exert */
#ifndef COTREE_FORMULATE_DYNAMICS_REACTIONS_H
#define COTREE_FORMULATE_DYNAMICS_REACTIONS_H

#include "formulate/dynamics/loads.h"
#include "formulate/system/constraints.h"
#include "formulate/system/sample.h"

/* multipliers of rows that vanished, from virtual branches that carry nothing (redundancy.c) */
typedef struct Recovery {
    Expr *multipliers; /* mu, one a vanished row; 0 where it is open */
    Sums **sums;       /* what a unit of each puts beyond every node */
    int open_count;    /* combinations of mu that nothing determines */
    double *open;      /* vanished rows x open_count, at `sample` */
    Sample *sample;    /* the position */
} Recovery;

/* accelerations with u', sums inward with lambda */
MUST_USE Status actual_build(System *system, Diag *diag);
/* multipliers of the rows that vanished, from the loads without them */
void recovery_build(System *system, const Loads *loads);

/* the force or torque that a branch carries from its tail to its head, in the axes of `chain` */
Vec branch_reaction(const System *system, const Instance *instance, const Sums *sums, bool rotation,
                    int *chain);
/* what a figure of a part, `wanted`, changes by per unit of the multiplier of a row that vanished
 */
typedef Expr RowShare(System *system, const Instance *part, const void *wanted, int redundant);
/* A row that vanished and on which the figure depends, though nothing determines its multiplier.
 * NULL: there is none. */
const Row *reaction_open_row(System *system, const Instance *part, RowShare *share,
                             const void *wanted);

typedef struct ReactionPart { /* a component of a force or a moment */
    bool moment;
    bool own; /* in the axes of the tail, not of the datum */
    int axis; /* 0, 1, 2 */
} ReactionPart;
MUST_USE Status joint_reaction(System *system, const Instance *joint, ReactionPart part, Expr *out,
                               Diag *diag);

#endif

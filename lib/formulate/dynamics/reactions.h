/* reactions.h: reaction forces and moments of joints and constraint rows */
#ifndef COTREE_FORMULATE_DYNAMICS_REACTIONS_H
#define COTREE_FORMULATE_DYNAMICS_REACTIONS_H

#include "formulate/dynamics/loads.h"
#include "formulate/system/constraints.h"
#include "formulate/system/sample.h"

/* multipliers of redundant rows, from virtual branches that carry no load (redundancy.c) */
typedef struct Recovery {
    Expr *multipliers; /* mu, one for each redundant row; 0 where it is undetermined */
    Sums **sums;       /* loads of a unit of each beyond every node */
    int open_count;    /* combinations of mu that nothing determines */
    double *open;      /* null space of W: redundant rows x open_count, at `sample` */
    Sample *sample;    /* the position */
} Recovery;

/* d'Alembert's load of a part's rotor on its joint; nothing without a rotor */
MUST_USE Status rotor_add(System *system, const Instance *instance, Loads *loads, Diag *diag);
/* the effort of a drive on the coordinate that supplies its motion, if that is another one */
void drive_add(System *system, const Drive *drive, Loads *loads);
/* accelerations with u', sums inward with lambda */
MUST_USE Status actual_build(System *system, Diag *diag);
/* multipliers of the redundant rows, from the loads without them */
void recovery_build(System *system, const Loads *loads);

/* the force or torque that a branch carries from its tail to its head, in the axes of `chain` */
Vec branch_reaction(const System *system, const Instance *instance, const Sums *sums, bool rotation,
                    int *chain);
/* The same of a joint or an arm, branch or chord, after actual_build(): its force on the head, or
 * with `rotation` its moment about the head's origin. Multipliers that nothing determines are 0. */
Vec rigid_reaction(System *system, const Instance *joint, bool rotation, int *chain);
/* derivative of a part's quantity `wanted` by the multiplier of a redundant row */
typedef Expr RowShare(System *system, const Instance *part, const void *wanted, int redundant);
/* A redundant row whose multiplier nothing determines, though the quantity depends on it. NULL:
 * there is none. */
const Row *reaction_open_row(System *system, const Instance *part, RowShare *share,
                             const void *wanted);

typedef struct ReactionPart { /* a component of a force or a moment */
    bool moment;
    bool own; /* in the axes of the tail, not of the datum */
    int axis; /* 0, 1, 2 */
} ReactionPart;
MUST_USE Status joint_reaction(System *system, const Instance *joint, ReactionPart part, Expr *out,
                               Diag *diag);
/* The norm of what presses the joint of a part by its load, N: the reaction force, of a shift
 * across its axis, or with `moment` the reaction moment, N*m. It is without the efforts on the
 * joint's own coordinate, which act along that axis. */
MUST_USE Status joint_load(System *system, const Instance *part, bool moment, Expr *out,
                           Diag *diag);

/* fx fy fz, x y z, fn or ft of a contact: the sum of its rows' forces, and its point. E_MISSING
 * where it shares its load with others. */
MUST_USE Status contact_variable(System *system, const Instance *part, const char *member,
                                 Expr *out, Diag *diag);

#endif

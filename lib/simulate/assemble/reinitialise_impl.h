/* reinitialise_impl.h: what the files of new values share */
#ifndef COTREE_SIMULATE_ASSEMBLE_REINITIALISE_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_REINITIALISE_IMPL_H

#include "base/memory.h"
#include "formulate/kinematics/edges.h"
#include "formulate/system_build/held_coordinates.h"
#include "simulate/assemble/kinematic_tree.h"
#include "simulate/assemble/level_rows.h"
#include "simulate/assemble/reinitialise.h"

typedef struct Target {
    Expr expr;
    StateLevel level;
    int place;                 /* unknown that it is, alone; -1 */
    int column;                /* unknown that is held with it; -1: it is an equation */
    int multi_turn;            /* angle of turns that it is; -1 */
    int row;                   /* among the expressions of its level */
    VariableReferent referent; /* what it says of frames, or what its first integral does */
    int node;                  /* of a position: the frame whose it is; -1 */
    int rate;                  /* the target that is its rate; -1 */
    int attitude;              /* of what is given: that it is an Euler parameter of; -1 */
    int turning;               /* then a component of its angular velocity; -1 */
    int held_index;            /* of those that may stay, or their rates; -1 */
} Target;

/* what the event under way decides of positions (reinitialise_stay.c) */
typedef struct Decision {
    bool *is_near;       /* unknowns that may move */
    bool *keeps;         /* by target: it is given and tells something, or stays */
    double *size;        /* by target: how much those unknowns move it */
    int rank;            /* of all that is held, in those unknowns */
    int open;            /* rows that would have to be given, too: */
    Text names;          /* "h2 and h3" */
    const char *example; /* one of them that has a name; borrowed; NULL */
} Decision;

struct Reinit {
    ReinitPlan plan;
    LIST(Target) targets;
    int given; /* of them, the first; the others stay, or are rates of what is given */
    HeldCoordinate *stays;
    int held_count;
    LIST(const char *) named; /* positions that are given; borrowed until all is compiled */
    Storage *storages;        /* whose charge or flux stays */
    int storage_count;
    KinematicTree *kinematic_tree; /* NULL: nothing is mechanical, or no positions were set yet */
    LevelRows *levels[LEVEL_COUNT];
    LevelRows *kept; /* charges and fluxes */
    Probe *probe;    /* these, kinetic and potential energy, targets */
    /* of the call under way */
    double t;
    double *values; /* of the targets */
    double *y;
};

/* whether it has a value on that level */
bool reinit_is_chosen(const Reinit *reinit, int target, StateLevel level);
/* What is chosen of a level, here; `direct`: with what is set by itself. */
Rows reinit_rows(const Reinit *reinit, StateLevel level, bool direct);

/* the unknown of its level that a target is, and the angle of turns */
void reinit_locate(const Reinit *reinit, Target *target);
/* Where positions may be set: what stays, and rates; before reinit_compile() compiles. */
void reinit_add_stays(Reinit *reinit);
/* By the motions that constraints allow here, of the given values chosen: what stays and what is
 * open. decision_free(). O(unknowns^2 rows) of those that are tied to what is given. */
void reinit_decide(Reinit *reinit, Decision *out);
/* Chooses rates as they were (`before`, one a target) of what was given and has stayed, as far as
 * they don't follow from each other at the new position. False: there they don't tell all. */
bool reinit_choose_rates(Reinit *reinit, const Decision *decision, const double *values,
                         const double *before);
void decision_free(Decision *decision);

#endif

/* initial_impl.h: what the files of assembly share: problems of least squares */
#ifndef COTREE_SIMULATE_ASSEMBLE_INITIAL_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_INITIAL_IMPL_H

#include "base/memory.h"
#include "formulate/kinematics/edges.h"
#include "simulate/assemble/initial.h"
#include "simulate/assemble/kinematic_tree.h"
#include "simulate/assemble/level_rows.h"

/* one initial value or guess */
typedef struct GivenValue {
    const StartValue *value;
    Expr expr; /* NULL: it has none, and is met by placing frames alone */
    StateLevel level;
    int place;   /* coordinate, speed or state that it is, alone; -1 */
    int column;  /* unknown that holding it holds: the place, or a coordinate's speed; -1 */
    bool is_own; /* the system's: the user said nothing of it */
    VariableReferent referent; /* what it says of frames, if it does */
    double target; /* the value; Euler parameters are of unit length, and of the sign that the
                      system's own expression has */
    int group;     /* of Euler parameters of one attitude, given or guessed; -1 */
    VariableReferent
        rate_of; /* coordinate or parameter whose first derivative it is, if it is one */
} GivenValue;

typedef struct Assembly {
    const VariableIndex *l;
    Parameters *parameters;
    CompiledEquations *numbers;
    const Equations *eq;
    const SimulationInput *setting;
    KinematicTree *kinematic_tree; /* NULL: nothing is mechanical */
    Assembled *out;
    double t;       /* s: 0, but in the middle of a run */
    bool has_modes; /* sides of switches are found behind the states */
    double *y;
    GivenValue *given;
    int given_count;
    int group_count;
    StartValue *own; /* of angles that are not to be half a turn off */
} Assembly;

/* equations of one problem: rows of the system, then picked values as expressions; of LEVEL_STATES
 * values are picked that states tell by themselves of what LEVEL_NETWORK holds */
typedef struct Problem {
    Assembly *a;
    const GivenValue **picked;
    int count, system_rows;
    LevelRows *rows;
} Problem;

MUST_USE Status initial_read_given(Assembly *assembly, Diag *diag);
/* what a given value is, and on which level */
MUST_USE Status initial_classify(Assembly *assembly, GivenValue *given, Diag *diag);
/* whether states alone tell it, of all that the network solves for */
bool initial_is_of_states(const GivenValue *given);
/* The equations of a level: those of the system, then what was given, guesses too where asked for.
 * Fails as probe_new() does. */
MUST_USE Status initial_open_problem(Problem *problem, Assembly *assembly, StateLevel level,
                                     bool guesses, Diag *diag);
void initial_close_problem(Problem *problem); /* what it holds */
Rows initial_rows(Problem *problem);
/* whether a position misses an equation by more than rounding leaves */
bool initial_misses(double residual);
/* Solve the equations of a position by Levenberg-Marquardt, columns held likewise; false: missed. A
 * row that its unknowns hardly move may be weighed above what rounding leaves of it: it is met
 * there. `residual` gets what is left, if not NULL. */
bool initial_meet(const Rows *rows, const bool *held, double *v, double *residual);
/* E_ASSEMBLE: "h9 (x) is missed by 0.03; ..." with the values that were given */
MUST_USE Status initial_conflict(const Problem *problem, const double *residual, const char *what,
                                 Diag *diag);

/* Four Euler parameters of unit length; nothing where they are all 0. */
void initial_unit(double p[4]);
/* Euler parameters that were given or guessed of one attitude: groups of them, of unit length where
 * that is all that rounding left undone (initial_given.c). */
void initial_group(Assembly *assembly);
/* Either sign is the same attitude: targets of the sign that their expressions have at y. */
void initial_align(Problem *problem);
/* (q, q') and (-q, -q') are the same motion: where the attitude at y has -q for the q that was
 * given, or else guessed, the targets of its rates q' change their sign, too. O(rates x positions)
 * of Euler parameters. Fails as probe_new() does. */
MUST_USE Status initial_align_rates(Assembly *assembly, Diag *diag);

/* Where a driver has a coordinate. */
MUST_USE Status initial_driven(const Assembly *assembly, Expr prescribed, double *out, Diag *diag);
/* Whole turns of what is a sum of angles: of chords' angles so that they are `angles`, one an entry
 * of system_whole_turns(); of constraints so that they hold. At y. */
MUST_USE Status initial_whole_turns(Assembly *assembly, const double *angles, Diag *diag);
/* Place the frames along the joints and put coordinates and references of angles that count turns
 * into y (initial_place.c). *closed: loops and all that says where frames stand hold. */
MUST_USE Status initial_place(Assembly *assembly, bool *closed, Diag *diag);

/* Speeds into y that constraints and given values leave open, before those are met: the least rates
 * of the joints along which frames are placed (initial_speed.c). */
MUST_USE Status initial_speeds(Assembly *assembly, Diag *diag);

/* States of the network, into y, and x' and z to begin a search with (initial_network.c). */
MUST_USE Status initial_find_network(Assembly *assembly, Diag *diag);

#endif

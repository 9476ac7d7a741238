/* initial_impl.h: declarations shared by the files of assembly: problems of least squares */
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
    Expr expr; /* NULL: none; it only places frames */
    StateLevel level;
    int place;   /* index of the coordinate, speed or state that it equals; -1: none */
    int column;  /* unknown that is fixed with it: the index, or that of a coordinate's speed; -1 */
    bool is_own; /* of the system: the user gave no value */
    VariableReferent referent; /* what it determines of frames, if anything */
    double target; /* the value; Euler parameters have unit length, and the sign of the system's own
                      expression */
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
    KinematicTree *kinematic_tree; /* NULL: no mechanics */
    Assembled *out;
    double t;       /* s: 0, except in the middle of a run */
    bool has_modes; /* switch states are determined after the states */
    double *y;
    GivenValue *given;
    int given_count;
    int group_count;
    StartValue *own; /* of angles that must not be off by half a turn */
} Assembly;

/* Equations of one problem: rows of the system, then given values as expressions. LEVEL_STATES has
 * those given values of LEVEL_NETWORK that depend on states alone. */
typedef struct Problem {
    Assembly *a;
    const GivenValue **picked;
    int count, system_rows;
    LevelRows *rows;
} Problem;

MUST_USE Status initial_read_given(Assembly *assembly, Diag *diag);
/* which variable a given value belongs to, and on which level */
MUST_USE Status initial_classify(Assembly *assembly, GivenValue *given, Diag *diag);
/* whether it depends on states alone, of all unknowns of the network */
bool initial_is_of_states(const GivenValue *given);
/* The equations of a level: those of the system, then given values, with guesses on request. Fails
 * as probe_new() does. */
MUST_USE Status initial_open_problem(Problem *problem, Assembly *assembly, StateLevel level,
                                     bool guesses, Diag *diag);
void initial_close_problem(Problem *problem); /* frees its contents */
Rows initial_rows(Problem *problem);
/* whether the residual of an equation of positions exceeds rounding error */
bool initial_misses(double residual);
/* Solve the equations of a position by Levenberg-Marquardt, columns held likewise; false: no
 * solution was found. The scaling of a row on which its unknowns have little effect may raise its
 * rounding error above the tolerance: such a row counts as satisfied. `residual` gets the
 * residuals, unless NULL. */
bool initial_meet(const Rows *rows, const bool *held, double *v, double *residual);
/* E_ASSEMBLE: "h9 (x) is missed by 0.03; ..." with the values that were given */
MUST_USE Status initial_conflict(const Problem *problem, const double *residual, const char *what,
                                 Diag *diag);

/* Scale four Euler parameters to unit length; unchanged where they are all 0. */
void initial_unit(double p[4]);
/* Group given or guessed Euler parameters by attitude, and scale a group to unit length where it
 * misses that by rounding alone (initial_given.c). */
void initial_group(Assembly *assembly);
/* Both signs are the same attitude: give the targets the sign that their expressions have at y. */
void initial_align(Problem *problem);
/* (q, q') and (-q, -q') are the same motion: where the attitude at y is -q for the q that was
 * given, or else guessed, the signs of the targets of its rates q' change too. O(rates x positions)
 * of Euler parameters. Fails as probe_new() does. */
MUST_USE Status initial_align_rates(Assembly *assembly, Diag *diag);

/* The value at which a driver prescribes a coordinate. */
MUST_USE Status initial_driven(const Assembly *assembly, Expr prescribed, double *out, Diag *diag);
/* Whole turns of sums of angles: for chords such that the sums are `angles`, one per entry of
 * system_whole_turns(); for constraints such that they hold. At y. */
MUST_USE Status initial_whole_turns(Assembly *assembly, const double *angles, Diag *diag);
/* Place the frames along the joints, and store coordinates and references of multi-turn angles in y
 * (initial_place.c). *closed: loops and all given values of frames hold. */
MUST_USE Status initial_place(Assembly *assembly, bool *closed, Diag *diag);

/* Initial guess of speeds in y that constraints and given values leave undetermined: the least
 * rates of the joints along which frames are placed (initial_speed.c). Constraints and given values
 * are solved afterwards. */
MUST_USE Status initial_speeds(Assembly *assembly, Diag *diag);

/* States of the network, into y, and the initial guess of x' and z (initial_network.c). */
MUST_USE Status initial_find_network(Assembly *assembly, Diag *diag);

#endif

/* start_impl.h: what the files of assembly share: problems of least squares */
#ifndef COTREE_SIMULATE_ASSEMBLE_START_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_START_IMPL_H

#include "algebra/levenberg_marquardt.h"
#include "base/memory.h"
#include "formulate/edges.h"
#include "simulate/assemble/skeleton.h"
#include "simulate/assemble/start.h"

/* LEVEL_STATES: of a problem only, states by themselves of what LEVEL_NETWORK holds */
typedef enum Level { LEVEL_POSITION, LEVEL_VELOCITY, LEVEL_NETWORK, LEVEL_STATES } Level;

/* one initial value or guess */
typedef struct Given {
    const StartValue *value;
    Expr expr; /* NULL: it has none, and is met by placing frames alone */
    Level level;
    int place;     /* coordinate, speed or state that it is, alone; -1 */
    int column;    /* unknown that holding it holds: the place, or a coordinate's speed; -1 */
    bool is_own;   /* the system's: the user said nothing of it */
    Stand stand;   /* what it says of frames, if it does */
    double target; /* the value; Euler parameters are of unit length, and of the sign that the
                      system's own expression has */
    int group;     /* of Euler parameters of one attitude, given or guessed; -1 */
} Given;

typedef struct Assembly {
    const Layout *l;
    Parameters *parameters;
    Numbers *numbers;
    const Equations *eq;
    const Setting *setting;
    Skeleton *skeleton; /* NULL: nothing is mechanical */
    Assembled *out;
    bool has_modes; /* sides of switches are found behind the states */
    double *y;
    Given *given;
    int given_count;
    int group_count;
    StartValue *own; /* of angles that are not to be half a turn off */
} Assembly;

/* equations of one problem: rows of the system, then picked values as expressions */
typedef struct Problem {
    Assembly *a;
    Level level;
    const Given **picked;
    int count, system_rows, columns;
    Probe *probe; /* values, then gradients, value by value, over the level's own symbols */
    int symbols;
    double *row; /* y-like, and x', z behind */
} Problem;

MUST_USE Status start_read_given(Assembly *assembly, Diag *diag);
/* what a given value is, and on which level */
MUST_USE Status start_classify(Assembly *assembly, Given *given, Diag *diag);
/* whether states alone tell it, of all that the network solves for */
bool start_is_of_states(const Given *given);
/* The equations of a level: those of the system, then what was given, guesses too where asked for.
 * Fails as probe_new() does. */
MUST_USE Status start_open_problem(Problem *problem, Assembly *assembly, Level level, bool guesses,
                                   Diag *diag);
void start_close_problem(Problem *problem); /* what it holds */
Rows start_rows(Problem *problem);
/* E_ASSEMBLE: "h9 (x) is missed by 0.03; ..." with the values that were given */
MUST_USE Status start_conflict(const Problem *problem, const double *residual, const char *what,
                               Diag *diag);

/* Four Euler parameters of unit length; nothing where they are all 0. */
void start_unit(double p[4]);
/* Euler parameters that were given or guessed of one attitude: groups of them, of unit length where
 * that is all that rounding left undone (start_given.c). */
void start_group(Assembly *assembly);
/* Either sign is the same attitude: targets of the sign that their expressions have at y. */
void start_align(Problem *problem);

/* Where a driver has a coordinate at t = 0. */
MUST_USE Status start_driven(const Layout *layout, Parameters *parameters, Expr prescribed,
                             double *out, Diag *diag);
/* Whole turns of what is a sum of angles: of chords' angles so that they are `angles`, one an entry
 * of system_whole_turns(); of constraints so that they hold. At y. */
MUST_USE Status start_whole_turns(Assembly *assembly, const double *angles, Diag *diag);
/* Place the frames along the joints and put coordinates and references of angles that count turns
 * into y (start_place.c). *closed: loops and all that says where frames stand hold. */
MUST_USE Status start_place(Assembly *assembly, WarmValue warm, void *context, bool *closed,
                            Diag *diag);

/* Speeds into y that constraints and given values leave open, before those are met: the least rates
 * of the joints along which frames are placed (start_speed.c). */
MUST_USE Status start_speeds(Assembly *assembly, Diag *diag);

/* States of the network, into y, and x' and z to begin a search with (start_network.c). `from`
 * tells the value of a variable in an earlier result; NULL: there is none. */
MUST_USE Status start_find_network(Assembly *assembly, WarmValue from, void *context, Diag *diag);

#endif

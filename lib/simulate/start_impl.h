/* start_impl.h: what the files of assembly share: problems of least squares */
#ifndef COTREE_SIMULATE_START_IMPL_H
#define COTREE_SIMULATE_START_IMPL_H

#include "base/memory.h"
#include "simulate/least.h"
#include "simulate/start.h"

/* LEVEL_STATES: of a problem only, states by themselves of what LEVEL_NETWORK holds */
typedef enum Level { LEVEL_POSITION, LEVEL_VELOCITY, LEVEL_NETWORK, LEVEL_STATES } Level;

/* one initial value or guess */
typedef struct Given {
    const StartValue *value;
    Expr expr;
    Level level;
    int place;   /* coordinate, speed or state that it is, alone; -1 */
    int column;  /* unknown that holding it holds: the place, or a coordinate's speed; -1 */
    bool is_own; /* the system's: the user said nothing of it */
} Given;

typedef struct Assembly {
    const Layout *l;
    Parameters *parameters;
    const Numbers *numbers;
    const Equations *eq;
    const Setting *setting;
    Assembled *out;
    bool has_modes; /* sides of switches are found behind the states */
    double *y;
    Given *given;
    int given_count;
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
Status start_conflict(const Problem *problem, const double *residual, const char *what, Diag *diag);

/* States of the network, into y, and x' and z to begin a search with (start_network.c). `from`
 * tells the value of a variable in an earlier result; NULL: there is none. */
MUST_USE Status start_find_network(Assembly *assembly, WarmValue from, void *context, Diag *diag);

#endif

/* level_rows.h: the equations of one level of a state, for least squares
 *
 *     position   Phi(q) = 0            (m, without velocity rows) in q (n), which moves along
 *                                      speeds: dq = N ds
 *     velocity   Phi_u u - nu = 0      (m)  in u (nu)
 *     states                           in x (nx)
 *     network                          in (x, x', z)
 *
 * and on each level expressions with given values. Earlier levels are known. */
#ifndef COTREE_SIMULATE_ASSEMBLE_LEVEL_ROWS_H
#define COTREE_SIMULATE_ASSEMBLE_LEVEL_ROWS_H

#include "algebra/levenberg_marquardt.h"
#include "simulate/equations/probe.h"

typedef enum StateLevel {
    LEVEL_POSITION,
    LEVEL_VELOCITY,
    LEVEL_NETWORK,
    LEVEL_STATES,
    LEVEL_COUNT
} StateLevel;

/* of its unknowns: index of the first in (q, u, x), and number */
int level_first(const VariableIndex *layout, StateLevel level);
int level_count(const VariableIndex *layout, StateLevel level);

typedef struct LevelRows {
    const VariableIndex *l;
    const Equations *eq;
    StateLevel level;
    int system_rows; /* rows of the system of that level, which come first */
    int count;       /* expressions */
    double *target;  /* of each; write here. NAN: any value, and no row */
    double t;
    const double *y; /* values of earlier levels, followed by references; set before use */
    Probe *probe;
    /* derivatives of expressions as entries: those by a coordinate count for each speed in its
     * rate, by N */
    int entries;
    int *slope, *by, *speed; /* of an entry: its derivative; coordinate, or -1; column */
    Pattern pattern;         /* of the Jacobian with the targets at the time; */
    bool *is_row;            /* expressions that were rows then; */
    int *at;                 /* of an entry: its index, -1: in no row */
    double *place;           /* (q, u, x, x', z) of the last evaluation */
} LevelRows;

/* New; level_rows_free(). Borrows all but the expressions; `equations` may be used elsewhere
 * between calls. Fails as probe_new() does. */
MUST_USE Status level_rows_new(StateLevel level, const VariableIndex *layout,
                               const Equations *equations, Parameters *parameters,
                               const Expr *wanted, int count, LevelRows **out, Diag *diag);
void level_rows_free(LevelRows *rows); /* NULL is fine */
/* With the current targets. On the velocity level the equations are at the position. */
Rows level_rows(LevelRows *rows, const CallMonitor *watch);

#endif

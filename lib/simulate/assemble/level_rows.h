/* level_rows.h: what one level of a state has to satisfy, for least squares
 *
 *     position   Phi(q) = 0            in q, which moves along speeds: dq = N ds
 *     velocity   Phi_u u - nu = 0      in u
 *     states                           in x
 *     network                          in (x, x', z)
 *
 * and on each of them expressions that are to have values. What a level builds on is known. */
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

/* of its unknowns: the place of the first in (q, u, x), and how many */
int level_first(const VariableIndex *layout, StateLevel level);
int level_count(const VariableIndex *layout, StateLevel level);

typedef struct LevelRows {
    const VariableIndex *l;
    const Equations *eq;
    StateLevel level;
    int system_rows; /* of the system, first: m, or none */
    int count;       /* expressions */
    double *target;  /* of each; write here. NAN: it may have any value, and is no row */
    double t;
    const double *y; /* what the level builds on, with references behind; set before use */
    Probe *probe;
    /* slopes of expressions as entries: a coordinate's by each speed that its rate reads, by N */
    int entries;
    int *slope, *by, *speed; /* of an entry: its slope; coordinate, or -1; column */
    Pattern pattern;         /* of the Jacobian with the targets as they were then; */
    bool *is_row;            /* expressions that were rows; */
    int *at;                 /* of an entry: its place, -1: of no row */
    double *place;           /* (q, u, x, x', z) of the last evaluation */
} LevelRows;

/* New; level_rows_free(). Borrows all but the expressions; `equations` may be used by others
 * between calls. Fails as probe_new() does. */
MUST_USE Status level_rows_new(StateLevel level, const VariableIndex *layout,
                               const Equations *equations, Parameters *parameters,
                               const Expr *wanted, int count, LevelRows **out, Diag *diag);
void level_rows_free(LevelRows *rows); /* NULL is fine */
/* With the targets as they are now. On velocity the equations are at the position. */
Rows level_rows(LevelRows *rows, const CallMonitor *watch);

#endif

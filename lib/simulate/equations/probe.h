/* probe.h: expressions over a layout in numbers: a Residual and a workspace of it
 *
 * What is computed is put on the layout's sides of its surfaces. A probe is used by one thread. */
#ifndef COTREE_SIMULATE_EQUATIONS_PROBE_H
#define COTREE_SIMULATE_EQUATIONS_PROBE_H

#include "base/memory.h"
#include "compile/residual.h"
#include "compile/tangents.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/parameters.h"
#include "simulate/equations/variable_index.h"

#include <string.h>

/* what a row knows; arrays may be NULL for 0 */
typedef struct RowValues {
    double t;
    const double *references, *q, *u, *x, *signs, *rates, *z, *acceleration, *multipliers, *efforts,
        *jerk;
} RowValues;

/* t, and what y holds */
RowValues row_of_state(const VariableIndex *layout, double t, const double *y);
/* and what was solved for there */
RowValues row_of_solved(const VariableIndex *layout, double t, const double *y,
                        const Solved *solved);
/* the same, solved now, and borrowed until the next call on the motion; false: there is no
 * solution, and the row is without */
bool row_solve(const VariableIndex *layout, Motion *motion, double t, const double *y,
               RowValues *out);

/* an input that is a side of a switch */
typedef struct SideInput {
    int input, side;
} SideInput;

/* Told here for the equations of a run, which are evaluated so often that calls count. */
typedef struct Probe {
    const VariableIndex *layout;
    Residual *residual;
    Workspace *workspace;
    double *inputs; /* the workspace's */
    LIST(SideInput) sides;
    uint64_t seen; /* sides, as they were then */
} Probe;

/* What is computed: roots, and the derivatives of the first of them (compile/residual.h). */
typedef struct ProbeOrder {
    const Expr *roots;
    int root_count, row_count;
    const Expr *unknowns; /* by these symbols */
    int unknown_count;
    bool is_apart; /* blocks are computed at the same time, by the parameters' threads */
    bool is_put;   /* the roots are on their surfaces already, or shall stay as they are */
    const CallMonitor *watch; /* may be NULL */
} ProbeOrder;

/* Compile; the layout outlives the probe. Parameters have the values of `parameters`, and what
 * depends on them alone is computed. Fails as residual_new() does. */
MUST_USE Status probe_make(const VariableIndex *layout, Parameters *parameters,
                           const ProbeOrder *order, Probe **out, Diag *diag);
/* the same of roots alone */
MUST_USE Status probe_new(const VariableIndex *layout, Parameters *parameters, const Expr *roots,
                          int count, Probe **out, Diag *diag);
void probe_free(Probe *probe); /* NULL is fine */
/* one value, once */
MUST_USE Status probe_at(const VariableIndex *layout, Parameters *parameters, Expr e,
                         const RowValues *row, double *out, Diag *diag);
const Residual *probe_residual(const Probe *probe);
/* whether t, coordinates, speeds and states are all that its values need: nothing has to be solved
 */
bool probe_reads_state(const Probe *probe);

/* Another value of a parameter, for this probe alone. False: no root holds it. */
bool probe_turn(Probe *probe, Expr parameter, double value);
/* The number of a symbol that somebody has put behind those of the layout, `place` among its
 * symbols: write here. */
double *probe_input(Probe *probe, int place);

/* the values of the roots, then of the slopes; borrowed, until the next call */
const double *probe_values(Probe *probe, const RowValues *row);
/* Of a probe that reads the state alone, at `count` instants with a y of `length` each, one behind
 * the other: its first `roots` values, count x roots. Many are computed several at once, by what
 * the evaluator names. */
void probe_values_of_states(Probe *probe, Evaluator evaluator, const double *times, const double *y,
                            int length, int count, int roots, double *out);
/* How far these values may be off where the row is off by `errors`; t and parameters are as
 * number_error() has them. */
void probe_errors(const Probe *probe, const RowValues *errors, double *out);

/* Take these numbers as inputs, for who computes with the program by other means. */
void probe_set(Probe *probe, const RowValues *row);
/* The same values, with their errors unless `errors` is NULL, in tangents of its program. */
void probe_tangents(Probe *probe, const RowValues *row, const RowValues *errors,
                    Tangents *tangents);
/* The same, without errors, where every number is moved by up to four units in its last place, at
 * random: alike for the same seed. What rounding leaves is another then, what is true is as it was.
 */
void probe_tangents_beside(Probe *probe, const RowValues *row, uint64_t seed, Tangents *tangents);
/* which input of its program a symbol is; -1: no root holds it */
int probe_place(const Probe *probe, Expr symbol);

/* --- stage by stage, by workspace_run() --- */

/* Take sides of switches as the layout has them now, with what follows from them. */
void probe_set_sides(Probe *probe);
/* Its inputs by the layout, write here; sides are as the layout has them. */
static inline double *probe_inputs(Probe *probe)
{
    if (probe->seen != probe->layout->sides)
        probe_set_sides(probe);
    return probe->inputs;
}
/* NULL: 0 */
static inline void inputs_set(double *inputs, int first, const double *values, int count)
{
    if (values != NULL)
        memcpy(inputs + first, values, (size_t)count * sizeof(double));
    else
        memset(inputs + first, 0, (size_t)count * sizeof(double));
}
#endif

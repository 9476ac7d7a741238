/* probe.h: expressions over a layout in numbers: a Residual and a workspace of it
 *
 * Expressions are evaluated on the layout's sides of its surfaces. A probe is used by one
 * thread. */
#ifndef COTREE_SIMULATE_EQUATIONS_PROBE_H
#define COTREE_SIMULATE_EQUATIONS_PROBE_H

#include "base/memory.h"
#include "compile/residual.h"
#include "compile/tangents.h"
#include "simulate/equations/motion.h"
#include "simulate/equations/parameters.h"
#include "simulate/equations/variable_index.h"

#include <string.h>

/* Known values at an instant; NULL arrays are 0, but `signs` those of the layout. */
typedef struct RowValues {
    double t;
    const double *references, *q, *u, *x, *signs, *rates, *z, *acceleration, *multipliers, *efforts,
        *jerk;
} RowValues;

/* from t and y */
RowValues row_of_state(const VariableIndex *layout, double t, const double *y);
/* the same with the solution there: u', lambda, x', z */
RowValues row_of_solved(const VariableIndex *layout, double t, const double *y,
                        const Solved *solved);
/* The same with the solution computed now, borrowed until the next call on the motion. False: there
 * is no solution, and the row is without. */
bool row_solve(const VariableIndex *layout, Motion *motion, double t, const double *y,
               RowValues *out);

/* an input that is a side of a switch */
typedef struct SideInput {
    int input, side;
} SideInput;

/* Defined here because the equations of a run are evaluated so often that calls cost time. */
typedef struct Probe {
    const VariableIndex *layout;
    Residual *residual;
    Workspace *workspace;
    double *inputs; /* the workspace's */
    LIST(SideInput) sides;
    uint64_t seen; /* counter of switch changes when the sides were set */
} Probe;

/* What is computed: roots, and the derivatives of the first of them (compile/residual.h). */
typedef struct ProbeOrder {
    const Expr *roots;
    int root_count, row_count;
    const Expr *unknowns; /* derivatives are by these symbols */
    int unknown_count;
    bool is_apart; /* independent blocks are computed in parallel, by the parameters' threads */
    bool is_put;   /* the roots are on their surfaces already, or are used unchanged */
    const CallMonitor *watch; /* may be NULL */
} ProbeOrder;

/* Compile; the layout outlives the probe. Parameters get the values of `parameters`, and
 * expressions of parameters alone are evaluated. Fails as residual_new() does. */
MUST_USE Status probe_make(const VariableIndex *layout, Parameters *parameters,
                           const ProbeOrder *order, Probe **out, Diag *diag);
/* the same, for roots alone */
MUST_USE Status probe_new(const VariableIndex *layout, Parameters *parameters, const Expr *roots,
                          int count, Probe **out, Diag *diag);
void probe_free(Probe *probe); /* NULL is fine */
/* evaluate one expression once */
MUST_USE Status probe_at(const VariableIndex *layout, Parameters *parameters, Expr e,
                         const RowValues *row, double *out, Diag *diag);
const Residual *probe_residual(const Probe *probe);
/* whether its values depend on t, coordinates, speeds and states alone: nothing has to be solved */
bool probe_reads_state(const Probe *probe);

/* Set a parameter, for this probe alone. False: no root contains it. */
bool probe_turn(Probe *probe, Expr parameter, double value);
/* The value of a symbol that a caller has appended to those of the layout, `place` among its
 * symbols: write here. */
double *probe_input(Probe *probe, int place);

/* the values of the roots, then of the derivatives; borrowed, until the next call */
const double *probe_values(Probe *probe, const RowValues *row);
/* For a probe that reads the state alone: its first `roots` values at `count` instants, count x
 * roots. y has `length` entries per instant, instant by instant. Many instants are computed in SIMD
 * batches, by the evaluator. */
void probe_values_of_states(Probe *probe, Evaluator evaluator, const double *times, const double *y,
                            int length, int count, int roots, double *out);
/* Bound the error of these values where the row has the errors `errors`; t and parameters have
 * those of number_error(). */
void probe_errors(const Probe *probe, const RowValues *errors, double *out);

/* Set these values as inputs, for callers that run the program by other means. */
void probe_set(Probe *probe, const RowValues *row);
/* The same values as tangents of its program, with errors unless `errors` is NULL. */
void probe_tangents(Probe *probe, const RowValues *row, const RowValues *errors,
                    Tangents *tangents);
/* The same, without errors, with every number perturbed at random by up to four units in its last
 * place; equal seeds give equal perturbations. Results that are rounding error change, others
 * don't. */
void probe_tangents_perturbed(Probe *probe, const RowValues *row, uint64_t seed,
                              Tangents *tangents);
/* index of a symbol among the inputs of its program; -1: no root contains it */
int probe_place(const Probe *probe, Expr symbol);

/* --- stage by stage, by workspace_run() --- */

/* Set sides of switches to the layout's, with what depends on them. */
void probe_set_sides(Probe *probe);
/* Its inputs in the order of the layout, write here; sides of switches are brought up to date. */
static inline double *probe_inputs(Probe *probe)
{
    if (probe->seen != probe->layout->sides)
        probe_set_sides(probe);
    return probe->inputs;
}
/* values NULL: all 0 */
static inline void inputs_set(double *inputs, int first, const double *values, int count)
{
    if (values != NULL)
        memcpy(inputs + first, values, (size_t)count * sizeof(double));
    else
        memset(inputs + first, 0, (size_t)count * sizeof(double));
}
#endif

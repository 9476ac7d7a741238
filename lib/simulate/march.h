/* march.h: from start to end of a forward run: steps, rows of the output grid, switches, events
 *
 * Rows lie at multiples of the output step and at the end; they are read from the steps'
 * interpolants and projected, and never force a step. Switches do: a condition in t alone is found
 * beforehand, and the step ends on the last number before it and starts again on the first behind
 * it; a condition in the state is located on the interpolant, and the step is taken again up to it.
 * Conditions of events are located likewise. The instant at which an event happens is a row, or two
 * of equal time where it gives new values: before and behind.
 */
#ifndef COTREE_SIMULATE_MARCH_H
#define COTREE_SIMULATE_MARCH_H

#include "base/text.h"
#include "base/watch.h"
#include "simulate/events.h"
#include "simulate/samples.h"

typedef struct MarchPlan {
    const Equations *equations;
    Motion *motion;
    Events *events;       /* NULL: none */
    Samples *samples;     /* NULL: none */
    const Method *method; /* NULL: dop853 until it finds the problem stiff, then `stiff` */
    const Method *stiff;
    bool stiff_decays; /* `stiff` is no help where what limits the steps swings */
    Control control;
    double from, to; /* s */
    double every;    /* output step, s */
    bool skip_first; /* the row at `from` is there already */
    const Watch *watch;
} MarchPlan;

/* Rows of (t, y), y as the motion has it, in one growing block. */
typedef struct Grid {
    int length; /* of y */
    int count, room;
    double *times;
    double *states; /* count x length */
} Grid;
void grid_add(Grid *grid, double t, const double *y);
void grid_free(Grid *grid); /* what it holds; it is empty again */

typedef struct MarchReport {
    Counts counts;
    const Method *method; /* in use at the end */
    double reached;
    double position_residual, velocity_residual; /* largest over the rows */
    Text remarks;                                /* lines */
} MarchReport;

/* Rows are appended to `grid` and the report filled also when it fails: E_SOLVER, E_STOPPED. */
MUST_USE Status march(const MarchPlan *plan, const double *start, Grid *grid, MarchReport *out,
                      Diag *diag);

/* Number of grid rows behind `from` up to `to`; grid_time(k) for k = 1.. is the k-th of them. Times
 * are products, so that they don't gather rounding. */
int grid_rows(double from, double to, double every);
double grid_time(double from, double to, double every, int k);

#endif

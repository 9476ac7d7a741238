/* phase.h: the equations of a part of a run, and all that computes them
 *
 * A model without switches and jumps has one. With switches there is one of the whole, in which
 * each switch is on both sides and which no row is of, and one for each mode that a run comes to;
 * with jumps one for each set of sides of their surfaces. Modes in which the ideal switches are on
 * the same sides share their equations, in which other switches and the signs on surfaces are
 * numbers: phase_enter() sets these before anything but phase_row() and phase_probe_at() reads
 * them. */
#ifndef COTREE_SIMULATE_RUN_PHASE_H
#define COTREE_SIMULATE_RUN_PHASE_H

#include "simulate/assemble/initial.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/implicit_jacobian.h"
#include "simulate/equations/netdae.h"
#include "simulate/equations/rate_jacobian.h"
#include "simulate/run/events.h"
#include "simulate/run/onset.h"
#include "simulate/run/samples.h"

typedef struct Phase Phase;
struct Phase {
    System *system; /* borrowed */
    int number;     /* among the phases of its run, as rows bear it */
    bool *closed;   /* sides of its switches; NULL: it is in no mode */
    Phase *like;    /* that it shares all below with, and which owns it; itself */
    OnSurface *on;  /* sides of surfaces; 0: it slides along them */
    int on_count;
    VariableIndex *layout;
    CompiledEquations *numbers;
    Motion *motion;         /* NULL, with all that follows, until phase_open() */
    int length;             /* of y */
    NetDae *network;        /* NULL where there is mechanics */
    RateJacobian *jacobian; /* NULL where there is none */
    ImplicitSlopes *implicit;
    Events *events; /* of `like`; NULL: none, or not made yet */
    Samples *samples;
    StiffElements
        *stiff_elements; /* what can act for a short time, and the search for it; NULL: nothing */
    Onset *onset;
    Probe *seen;      /* what a host is told at rows; NULL: nothing, or not yet */
    Probe *states;    /* the network states of the whole, where it is a mode, */
    int *among_whole; /* and which of those its own are */
};

/* New: programs compiled; phase_free(). Borrows the system and the parameters; `closed` is copied,
 * `count` sides; NULL: in no mode. */
MUST_USE Status phase_new(System *system, Parameters *parameters, const bool *closed, int count,
                          Phase **out, Diag *diag);
/* The same where the signs of surfaces that its equations jump on are inputs; on these sides. */
MUST_USE Status phase_new_on(System *system, Parameters *parameters, const bool *closed, int count,
                             const OnSurface *on, int on_count, Phase **out, Diag *diag);
/* New: the mode of `closed` (NULL: none) and `on`, on the surfaces of another phase, with the
 * equations of that one, which outlives it. */
Phase *phase_new_like(Phase *other, const bool *closed, int count, const OnSurface *on);
/* Set its mode in the equations that it may share with others. O(switches + surfaces). */
void phase_enter(const Phase *phase);
/* What solves its equations; once. The options are copied. Fails as samples_new() does. */
MUST_USE Status phase_open(Phase *phase, Parameters *parameters, const MotionOptions *options,
                           Host *host, Diag *diag);
void phase_free(Phase *phase); /* NULL is fine */

/* the method that continues a run whose equations turn out to be stiff */
const Method *phase_stiff_method(const Phase *phase);
/* The method that solves the unknowns of a network together with its states, for a run that the
 * former can't continue; NULL: the network has no such unknowns. The current of a coil determines
 * the voltage of a blocking diode of 1e12 ohm: no tolerance of the current is fine enough for that
 * voltage. */
const Method *phase_coupled_method(const Phase *phase);
/* The first method at (t, y); *method is the requested one (NULL: none). Without a request it is
 * the coupled one where tolerances of the states don't determine whether a stiff element conducts;
 * the pulse detector is informed. E_SOLVER where the method would fail since they determine so
 * little. The span of the run is that of `control`. O(stiff_elements_answers()). */
MUST_USE Status phase_choose_method(const Phase *phase, double t, const double *y,
                                    const Control *control, const Method **method, Diag *diag);
/* Everything at (t, y). False: no solution. */
bool phase_row(Phase *phase, double t, const double *y, RowValues *out);
/* The values of a probe there, `count` of them: NAN where the equations have no solution. */
void phase_probe_at(Phase *phase, Probe *probe, double t, const double *y, const double *driven,
                    int count, double *out);
/* And the first `count` states of the whole, of a mode. False: no solution. */
bool phase_states(Phase *phase, double t, const double *y, int count, RowValues *row, double *out);
/* E_MODEL where equations need the potential of a terminal on which nothing stands */
MUST_USE Status phase_refuse_open(const Phase *phase, Diag *diag);
/* E_MODEL where a driver's motion is supplied by another effort (by=): for inverse runs alone */
MUST_USE Status phase_refuse_by(const Phase *phase, Diag *diag);

#endif

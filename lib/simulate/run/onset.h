/* onset.h: steps that don't pass over what acts for a short time
 *
 * A step looks at the equations in a few places. A diode that conducts between two of them, or a
 * pulse of a source, leaves no trace: the error estimate is small and the answer wrong. So before
 * each step the way ahead is searched for the first place where a steep element begins to act, or a
 * source leaves what the step's places show of it, and the step ends there: no event, no restart,
 * the solution is smooth. Behind it the steps are bounded as long as the pulse lasts. After each
 * step the same search with the way that it really went finds what was not foreseen.
 *
 * To act is to change a state by a tenth of the tolerance in a step. */
#ifndef COTREE_SIMULATE_RUN_ONSET_H
#define COTREE_SIMULATE_RUN_ONSET_H

#include "simulate/equations/stiff_elements.h"
#include "simulate/integrate/ode.h"

typedef struct Onset Onset;

/* New; onset_free(). Borrows; `steep` NULL: nothing can act for a short time, and NULL comes out.
 */
Onset *onset_new(StiffElements *stiff_elements, const Ode *ode);
void onset_free(Onset *onset); /* NULL is fine, here and below */
/* Whether a condition of the equations has another sign at (t, y) than where the run stands: a
 * source that makes it so acts, whatever it does to rates. `turns` NULL: nobody knows. */
typedef bool (*Turns)(void *context, double t, const double *y);
void onset_watch(Onset *onset, Turns turns, void *context);
/* Whether tolerances of the states leave open what elements do: the search leaves these to a method
 * that solves for their arguments, and so sees them. */
void onset_leave_open(Onset *onset, bool is_open);
/* A step from the stepper's time, at most to `end`: where it has to end instead. Bounds the
 * stepper's steps. */
double onset_before_step(Onset *onset, Stepper *stepper, double end);
/* Whether the last step has passed over something: then the place in it where it should have
 * ended. */
bool onset_after_step(Onset *onset, Stepper *stepper, double *when);
/* Whether no source goes far between two times. */
bool onset_is_calm(Onset *onset, double from, double to);
/* Into how many pieces from..to has to be cut that all sources are as good as straight in each, at
 * most `most`. */
int onset_pieces(Onset *onset, double from, double to, int most);
/* Forget pulses that last: equations or states have changed. */
void onset_forget(Onset *onset);

#endif

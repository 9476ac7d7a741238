/* charge_sharing.h: what is stored, where ideal switches join capacitors or put coils in series
 *
 * Impulses of current leave the charge of each cutset of capacitors as it was, and impulses of
 * voltage the flux of each circuit of coils: of all that the network behind the instant may store,
 * it is the nearest to what was stored, as energy measures it. */
#ifndef COTREE_SIMULATE_RUN_CHARGE_SHARING_H
#define COTREE_SIMULATE_RUN_CHARGE_SHARING_H

#include "simulate/run/active_run.h"

/* more than errors can explain, of a state of the whole */
bool share_is_jump(const ActiveRun *run, int state, double from, double to);

/* Share what is stored in a phase that begins at (t, y): y, and x, the states of the whole, from
 * the sides `before`; the present ones were just found at this instant. The energy that is lost
 * counts as work, and is told with `sides`, what switches. False, and nothing is changed, where a
 * source alone would have to move a state, or where what one stored would go nowhere. */
bool share_stored(ActiveRun *run, Phase *phase, double t, const bool *before, const char *sides,
                  double *y, double *x);
/* what is said of all that were shared, after a run */
void charge_sharing_report(ActiveRun *run);
void shares_free(Shares *shares); /* NULL is fine */

#endif

/* events.h: the model's events in a run: conditions in numbers, what happens, and a record of it
 *
 * A condition is a formula of comparisons a < b; what each decides is the sign of a - b, a "side":
 * -1 where it holds, +1 where not, 0 not known. Whoever drives the run follows the sides
 * (events_conditions) and locates their changes; the formula then says which events become true. */
#ifndef COTREE_SIMULATE_RUN_EVENTS_H
#define COTREE_SIMULATE_RUN_EVENTS_H

#include "simulate/equations/compiled_equations.h"
#include "simulate/run/result.h"

typedef struct Events Events;

/* New; events_free(). Borrows the layout, parameters, equations and motion; copies what it keeps of
 * the events. `rows` are the constraint rows in use. Fails with E_MODEL where such a run can't have
 * an event, E_VALUE for a variable that can't be set, the errors of system_resolve(). */
typedef struct EventsPlan {
    const VariableIndex *layout;
    Parameters *parameters;
    const Equations *equations;
    Motion *motion;
    const int *rows;
    int row_count;
    RunKind kind;
    System *whole; /* one of whose modes the layout's system is: there ideal switches may hold what
                      an event gives a value to, which is an error only then. NULL: it is none */
    const Event *const *events;
    int event_count;
} EventsPlan;
MUST_USE Status events_new(const EventsPlan *plan, Events **out, Diag *diag);
void events_free(Events *events); /* NULL is fine */

int events_count(const Events *events);                 /* 0 for NULL, here and below */
EventRecord events_record(const Events *events, int i); /* borrowed, until something happens */
/* The records of an earlier run that this one goes on with. */
void events_go_on(Events *events, const EventRecord *earlier, int count);
/* What happened, from the same events in another phase of a run; `from` is as it began then. */
void events_hand_over(Events *events, Events *from);
/* what is said of what happened */
void events_remark(const Events *events, Remarks *out);

/* --- conditions and sides --- */

/* which side a difference is on; 0 for NAN too */
static inline int sign_of(double v)
{
    return (v > 0) - (v < 0);
}

int events_condition_count(const Events *events);
/* The first of them, which hold t alone; in a mode those that do so in the whole. */
int events_time_only(const Events *events);
Expr events_difference(const Events *events, int condition); /* that it compares with 0 */
/* whether any other changes with t alone, while no state does */
bool events_follow_time(const Events *events);
/* values a - b of all conditions at (t, y); NAN where the equations have no solution */
void events_conditions(Events *events, double t, const double *y, double *out);
/* of the time-only ones */
void events_time_conditions(Events *events, double t, double *out);
/* Sides of those in the state, at (t, y) and just behind it: where a difference is zero as far
 * as instants of a run of `span` can be told apart, it is the way it changes that counts. `root`:
 * one that is known to be at its zero; -1: none. */
void events_settle(Events *events, double t, double span, const double *y, int root, int *sides);

/* --- what happens --- */

/* Begin at (t, y): conditions that hold there are noted, and don't happen until they have been
 * false. True where one of them ends the run at once. */
bool events_begin(Events *events, double t, const double *y);
/* whether events_begin() has seen where the run starts, here or in a segment before this one */
bool events_have_begun(const Events *events);
/* The sides are these now: notes which events no longer hold. True where others become true. */
bool events_follow(Events *events, const int *sides);
/* whether they would, were the sides these */
bool events_would_happen(const Events *events, const int *sides);
/* Let those happen at (t, y), in order of their making, and put their new values into y, the
 * constraints met; `sides` are those behind it then, and further events may come of that. *changed:
 * y has new values. *stop: an event ends the run. Fails with E_SOLVER where new values contradict
 * the constraints, or events happen without end. */
MUST_USE Status events_happen(Events *events, double t, double span, double *y, int *sides,
                              bool *changed, bool *stop, Diag *diag);

/* Whether an event has come to the limit of a series, and the surface that holds its guard is met.
 * Unless that was held until now, its last new values are left out. */
bool events_settle_on(const Events *events, int surface);
/* The surfaces that are slid along from t on are those of these equations: events whose guards
 * they hold don't happen, and none settles any more. */
void events_hold(Events *events, const Equations *eq, double t);
/* whether that condition belongs to events whose guards are held alone */
bool events_condition_is_held(const Events *events, int condition);

/* The event of that condition comes true again and again: E_SOLVER, unless its series has an end.
 */
MUST_USE Status events_are_stuck(Events *events, int condition, double t, Diag *diag);

/* In driven runs, where y is known at any t: whether a condition that did not hold does at (t, y);
 * and the same with its consequences. */
bool events_are_due(Events *events, double t, const double *y);
MUST_USE Status events_read(Events *events, double t, double span, const double *y, bool *happened,
                            bool *stop, Diag *diag);

#endif

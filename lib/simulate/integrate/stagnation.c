/* stagnation.c: whether steps make progress, or are as short as rounding error makes them */
#include "simulate/integrate/stagnation.h"

#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <math.h>

/* steps whose total length is compared with that of those before */

/* Whether the method evaluates rates as a function of y alone. One that solves for a network's
 * unknowns together with its states isn't affected by the rounding error of a coil's current in a
 * diode's voltage. */
static bool goes_by_rates(const Stepper *s)
{
    return !s->method->solves_dae || s->ode->dae.has_rate == NULL;
}

/* Largest rounding error of an entry's rate times h, in tolerances: the roughness of rates at
 * points ahead, by their fourth differences. (Last bits of y may leave rates unchanged where a sum
 * that loses most of its terms, as of masses decades apart, changes in steps.) */
static double rounding(Stepper *s, double h)
{
    const int all = stepper_length(s), length = STAGNATION_POINTS * all;
    double *rates = NEW_ARRAY(double, length), *ahead = NEW_ARRAY(double, all), largest = 0;
    bool sound = goes_by_rates(s);

    for (int k = 0; sound && k < STAGNATION_POINTS; k++) {
        const double part = h * STAGNATION_AHEAD * k / STAGNATION_POINTS;

        for (int i = 0; i < all; i++)
            ahead[i] = s->y[i] + part * rates[i];
        sound = stepper_rate(s, s->t + part, ahead, rates + (ptrdiff_t)k * all);
    }
    for (int end = length - all; sound && end >= length - STAGNATION_ORDER * all; end -= all)
        for (int e = 0; e < end; e++)
            rates[e] -= rates[e + all];
    for (int e = 0; sound && e < length - STAGNATION_ORDER * all; e++)
        if (e % all < s->ode->n) {
            const double rough = h * fabs(rates[e]) / STAGNATION_AMPLIFIED;

            largest = fmax(largest, rough / stepper_tolerance(s, e % all, fabs(s->y[e % all])));
        }
    MEM_FREE(rates, ahead);
    return largest;
}

/* a method whose steps rounding may limit less: one for stiff equations damps rounding errors of
 * rates */
static const Method *other_method(const Stepper *s)
{
    const bool stiff = s->method->suits_stiff;

    return method_for((MethodNeed){.stiff = true, .history = stiff && !s->method->has_history});
}

static Status give_up(const Stepper *s, double h, Diag *diag)
{
    const double rtol = s->control.rtol;
    const double coarser =
        pow(10, ceil(log10(rtol * s->control.span / (h * STAGNATION_ENOUGH_STEPS))));
    const char *other = other_method(s)->name;
    const char *less = s->ode->is_network ? "a resistor across a steep part" : "another tree";

    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: the tolerance is below what rounding leaves of %s: steps have "
                   "become too short to get anywhere",
                   s->t, ode_rates(s->ode));
    if (coarser <= STAGNATION_COARSEST)
        diag_hint(diag, "%s may leave less rounding; or try rtol=%.0e, or method=%s", less, coarser,
                  other);
    else
        diag_hint(diag,
                  "%s may leave less rounding, and method=%s may need less; %s many decades apart "
                  "leave much",
                  less, other,
                  s->ode->is_network ? "resistances, capacitances or inductances"
                                     : "lengths, masses or stiffnesses");
    return E_SOLVER;
}

static Status report_too_small(const Stepper *s, Diag *diag)
{
    (void)solver_failure(diag, s->t, "the step became too small");
    if (s->control.rtol < STAGNATION_FINE)
        diag_hint(diag, "method=%s may get further; so may a coarser rtol=", other_method(s)->name);
    return E_SOLVER;
}

/* Towards a singularity of the solution steps become ever shorter, down to the rounding error of
 * the rates: thousands of them. A tolerance below rounding error is another case. */
static bool wanes(Stepper *s)
{
    StepShrinkage *w = &s->step_shrinkage;
    const double way = s->t - w->t;

    if (s->counts.steps - w->steps < STAGNATION_WINDOW)
        return false;
    w->times = way < STAGNATION_DECREASE * w->way && way < STAGNATION_SHORT * s->control.span
                   ? w->times + 1
                   : 0;
    w->way = way;
    w->steps = s->counts.steps;
    w->t = s->t;
    return w->times >= STAGNATION_DECREASES &&
           2 * way / STAGNATION_WINDOW < control_asked(&s->control) &&
           !(rounding(s, way / STAGNATION_WINDOW) > STAGNATION_ROUNDING);
}

Status stagnation_check(StagnationMonitor *stagnation, Stepper *s, int64_t steps, bool *is_rounding,
                        Diag *diag)
{
    const int64_t count = steps - stagnation->steps;
    const double way = s->t - stagnation->t;
    double h;

    *is_rounding = false;
    if (wanes(s))
        return report_too_small(s, diag);
    if (count < STAGNATION_STEPS)
        return OK;
    h = way / (double)count;
    stagnation->steps = steps;
    stagnation->t = s->t;
    /* the user requested short steps */
    if (!(way < STAGNATION_PROGRESS * s->control.span) || 2 * h > control_asked(&s->control))
        return OK;
    if (way < STAGNATION_SHORTEST * s->control.span)
        return report_too_small(s, diag);
    *is_rounding = rounding(s, h) > STAGNATION_ROUNDING;
    return *is_rounding ? give_up(s, h, diag) : OK;
}

bool stagnation_is_rounding(Stepper *s, double h, Diag *diag)
{
    if (!(h < STAGNATION_SHORTEST * s->control.span) || !(rounding(s, h) > STAGNATION_ROUNDING))
        return false;
    (void)give_up(s, h, diag);
    return true;
}

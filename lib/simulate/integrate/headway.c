/* headway.c: whether steps get anywhere, or are as short as rounding makes them */
#include "simulate/integrate/headway.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>

#define STEPS        5000 /* so many ought to go */
#define PART         5e-3 /* this part of the run; else it would take a million and more */
#define NOTICED      0.01 /* of the tolerance: stable steps make less of the last bit of y */
#define HOPELESS     1e-9 /* less of the run: time itself has hardly more digits */
#define NEIGHBOURS   4
#define ENOUGH_STEPS 1e4  /* of a run whose tolerance is attainable */
#define COARSEST     1e-7 /* a tolerance that is worth trying */

#define DWINDLING                                                                                  \
    200             /* steps: what they get over together is compared with that of those before    \
                     */
#define WANING 3    /* times on end that it has become less; a transient's steps grow */
#define SHORT  1e-6 /* of the run, each time */

/* numbers without a pattern (Knuth's multiplicative hashing) */
static int scattered(int i, int pass)
{
    return (int)((uint32_t)(NEIGHBOURS * i + pass + 1) * 2654435769U >> 16);
}

/* Largest part of its tolerance that an entry's rate, times h, changes by where y changes in its
 * last bit. */
static double rounding(Stepper *s, double h)
{
    const Ode *ode = s->ode;
    const int all = stepper_length(s);
    double *beside = NEW_ARRAY(double, all);
    double *rate = NEW_ARRAY(double, all);
    double *other = NEW_ARRAY(double, all);
    double largest = 0;
    bool sound = stepper_rate(s, s->t, s->y, rate);

    for (int pass = 0; sound && pass < NEIGHBOURS; pass++) {
        for (int i = 0; i < all; i++) {
            const int bits = scattered(i, pass) % 3 - 1;

            beside[i] = s->y[i] * (1 + bits * DBL_EPSILON);
        }
        sound = stepper_rate(s, s->t, beside, other);
        for (int i = 0; sound && i < ode->n; i++) {
            const double moved = h * fabs(other[i] - rate[i]);

            largest = fmax(largest, moved / stepper_tolerance(s, i, fabs(s->y[i])));
        }
    }
    MEM_FREE(beside, rate, other);
    return largest;
}

/* one whose steps rounding may limit less: one for stiff equations damps what it leaves of rates */
static const Method *other_method(const Stepper *s)
{
    const bool stiff = s->method->is_stiff;

    return method_for((MethodNeed){.stiff = true, .history = stiff && !s->method->has_history});
}

static Status give_up(const Stepper *s, double h, Diag *diag)
{
    const double rtol = s->control.rtol;
    const double coarser = pow(10, ceil(log10(rtol * s->control.span / (h * ENOUGH_STEPS))));
    const char *other = other_method(s)->name;

    (void)solver_failure(diag, s->t,
                         "the tolerance is below what rounding leaves of the accelerations: steps "
                         "have become too short to get anywhere");
    if (coarser <= COARSEST)
        diag_hint(diag, "another tree may leave less rounding; or try rtol=%.0e, or method=%s",
                  coarser, other);
    else
        diag_hint(diag,
                  "another tree may leave less rounding, and method=%s may need less; lengths, "
                  "masses or stiffnesses many decades apart leave much",
                  other);
    return E_SOLVER;
}

/* Towards a place where the solution ends steps become ever shorter, by as much as rounding leaves
 * of the rates there: thousands of them. A tolerance below that is another matter. */
static bool wanes(Stepper *s)
{
    Waning *w = &s->waning;
    const double way = s->t - w->t;

    if (s->counts.steps - w->steps < DWINDLING)
        return false;
    w->times = way < w->way && way < SHORT * s->control.span ? w->times + 1 : 0;
    w->way = way;
    w->steps = s->counts.steps;
    w->t = s->t;
    return w->times >= WANING && 2 * way / DWINDLING < control_asked(&s->control) &&
           !(rounding(s, way / DWINDLING) > NOTICED);
}

Status headway_check(Headway *headway, Stepper *s, int64_t steps, bool *is_rounding, Diag *diag)
{
    const int64_t count = steps - headway->steps;
    const double way = s->t - headway->t;
    double h;

    *is_rounding = false;
    if (wanes(s))
        return solver_failure(diag, s->t, "the step became too small");
    if (count < STEPS)
        return OK;
    h = way / (double)count;
    headway->steps = steps;
    headway->t = s->t;
    /* short steps that were asked for are as they should be */
    if (!(way < PART * s->control.span) || 2 * h > control_asked(&s->control))
        return OK;
    if (way < HOPELESS * s->control.span)
        return solver_failure(diag, s->t, "the step became too small");
    *is_rounding = rounding(s, h) > NOTICED;
    return *is_rounding ? give_up(s, h, diag) : OK;
}

bool headway_is_rounding(Stepper *s, double h, Diag *diag)
{
    if (!(h < HOPELESS * s->control.span) || !(rounding(s, h) > NOTICED))
        return false;
    (void)give_up(s, h, diag);
    return true;
}

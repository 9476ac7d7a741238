/* ode.h: what an integrator needs to know of a problem, and what it offers
 *
 *     y' = f(t, y),   y on a manifold that project() restores
 *
 * A Stepper is one integration under way: it takes accepted steps, each not beyond a given
 * time, and tells y anywhere in the last one. Methods are rows of methods.def; whoever drives a
 * stepper owns output, switches and stopping. */
#ifndef COTREE_SIMULATE_INTEGRATE_ODE_H
#define COTREE_SIMULATE_INTEGRATE_ODE_H

#include "algebra/hessenberg_form.h"
#include "base/diag.h"
#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* The same motion for solvers of implicit equations F(t, w, w') = 0; w holds y and multipliers, or
 * what else is algebraic. */
typedef struct Dae {
    int n;
    void *context;
    bool (*residual)(void *context, double t, const double *w, const double *rate, double *out);
    /* consistent w and w' at (t, y) */
    bool (*start)(void *context, double t, const double *y, double *w, double *rate);
    const double *weight; /* n: absolute tolerance of w_i is atol * weight */
    /* n: whether a rate of w_i stands in F; NULL: take all for such */
    const bool *has_rate;
    /* n: whether an error of w_i counts; NULL: all do. Multipliers as rates of unknowns jump where
     * a step becomes longer, and say nothing of y. */
    const bool *is_tested;
    /* Places of dF/dw + c dF/dw' that may not be 0, each place at most once; known from the first
     * start() on. NULL, or -1 of them: not offered. */
    int (*pattern)(void *context, const int **row, const int **column);
    bool (*jacobian)(void *context, double t, double c, const double *w, const double *rate,
                     double *values);
    /* The same, where any place may not be 0, column by column; false: it can't be determined there
     * but by differences. NULL: not offered. */
    bool (*full)(void *context, double t, double c, const double *w, const double *rate,
                 double *values);
    /* Whether dF/dy' and dF by the rest of w have an inverse: index 1, without multipliers. */
    bool is_index_one;
    /* Whether dF/dw and dF/dw' stay as they are until a restart. NULL: not known. */
    bool (*is_linear)(void *context);
    /* Then, whether w' = J w + ... is known in a form for many shifts from an earlier time at which
     * the same equations held; NULL: it isn't. What is kept is the callee's from then on. */
    const HessenbergForm *(*known)(void *context);
    const HessenbergForm *(*keep)(void *context, HessenbergForm *given);
} Dae;

/* Derivatives of y' in closed form. */
typedef struct OdeJacobian {
    void *context;
    /* Of all entries of y' by the n that count, row by row, at (t, y). False: they can't be
     * determined there but by differences. NULL: nowhere. */
    bool (*at)(void *context, double t, const double *y, double *out);
} OdeJacobian;

typedef struct Ode {
    int n;           /* unknowns that count in the error test */
    int quadratures; /* further entries of y that f doesn't read, behind them */
    void *context;
    /* y' at (t, y); false: undefined there, try a shorter step */
    bool (*rate)(void *context, double t, const double *y, double *rate);
    /* A step of h from y at t is tried next (0: nobody knows how long a one): what rates mean off
     * the manifold is decided for all of it. NULL: nothing is. */
    void (*begin)(void *context, double t, const double *y, double h);
    /* move y back onto its manifold; false: can't. NULL: there is none */
    bool (*project)(void *context, double t, double *y);
    /* n: |y_i| counts up to here in a relative tolerance (an angle of many turns isn't known less
     * well than one of a few); NULL: all of it */
    const double *magnitude_bound;
    /* n: how much of y_i counts as 1 in the absolute tolerance (a shape is as far off as what it
     * moves); NULL: 1 */
    const double *unit;
    /* n: errors of y_i up to here don't count, projected as it is after each step; NULL: all do.
     * Methods that don't project leave it aside. */
    const double *error_floor;
    /* Largest relative error that rounding may have left of rates since the last call; NULL: as
     * anywhere. No step is shortened for the sake of less. */
    double (*rounding_error)(void *context);
    OdeJacobian jacobian;
    Dae dae;         /* entries 0..n+quadratures-1 of w are y; n 0: not offered */
    bool is_network; /* nothing moves in it: messages speak of a network */
} Ode;

/* what y' is called in messages */
static inline const char *ode_rates(const Ode *ode)
{
    return ode->is_network ? "the network's rates" : "the accelerations";
}

static inline double ode_nominal(const Ode *ode, int i)
{
    return ode->unit != NULL && i < ode->n ? ode->unit[i] : 1;
}

/* by how much to move an unknown to tell a derivative from a difference */
static inline double ode_increment(double y)
{
    return sqrt(DBL_EPSILON * fmax(1e-5, fabs(y)));
}

typedef struct Control {
    double rtol, atol;
    double step; /* fixed or largest step, s; 0: free */
    double most; /* largest step, s, also of methods whose steps are fixed; 0: free */
    double span; /* of the whole run, s; 0: not known */
} Control;

/* largest step that was asked for */
static inline double control_asked(const Control *control)
{
    double step = control->step > 0 ? control->step : HUGE_VAL;

    return control->most > 0 ? fmin(step, control->most) : step;
}

/* Largest step of methods that look at one to three places of a step: where nothing goes on they
 * would step over a pulse and never know. */
static inline double control_largest(const Control *control)
{
    double asked = control_asked(control);

    return asked < HUGE_VAL ? asked : control->span > 0 ? control->span / 50 : HUGE_VAL;
}

typedef struct Counts {
    int64_t steps, rejected, evaluations, jacobians;
    int64_t visits; /* ranges of expressions in the look-ahead (onset.h) */
} Counts;

typedef struct Stepper Stepper;
typedef struct Method {
    const char *name;
    const char *brief;
    /* new stepper at (t, y); `ode` and what it points to outlive it */
    Stepper *(*create)(const Ode *ode, const Control *control);
    void (*destroy)(Stepper *stepper);
    /* (Re)start at (t, y), as after a jump. E_SOLVER when f is undefined there. */
    Status (*start)(Stepper *stepper, double t, const double *y, Diag *diag);
    /* One accepted step, at most to `end` (which it meets exactly when it can). E_SOLVER. */
    Status (*step)(Stepper *stepper, double end, Diag *diag);
    /* y at t in the last step; not projected */
    void (*at)(Stepper *stepper, double t, double *y);
    /* Take the last step again so that it ends at t, inside it; then start anew from there. Where
     * that fails, at() and y still tell of the last step as it was. */
    Status (*shorten)(Stepper *stepper, double t, Diag *diag);
    /* y' at the stepper's time, without an evaluation; false: not known. NULL: never */
    bool (*slope)(Stepper *stepper, double *rate);
    /* what a step sees of the equations: places in it, as parts of its length, */
    const double *nodes;
    int node_count;
    bool has_history;   /* the steps before, too: it starts anew after shorten(); */
    bool sees_little;   /* too little to find what happens in between */
    double pulse_steps; /* that a pulse of the equations takes, to come out right */
    double short_part;  /* of the tolerance, for each of many short steps whose errors add up */
    /* what it can */
    bool is_stiff;    /* its steps are not limited by stability, where what limits them decays; */
    bool is_a_stable; /* nor where it swings */
    bool has_fixed_step; /* and so controls no error */
    bool solves_dae;     /* takes ode->dae where it is offered: multipliers are unknowns, too */
} Method;

/* how steps since the last start become shorter */
typedef struct StepShrinkage {
    int64_t steps; /* and t: when it was looked at last */
    double t, way; /* s; way: what the steps before that had got over together */
    int times;     /* on end that it has become less */
} StepShrinkage;

struct Stepper {
    const Method *method;
    const Ode *ode;
    Control control;
    Counts counts;
    double before;       /* start of the last step */
    double t;            /* its end */
    double *y;           /* y at t, projected where the method projects */
    LIST(double *) room; /* where it and its method keep numbers */
    double next; /* step it would take next, s; 0: to be chosen, as after a start, when its driver
                  * may say it */
    int stuck;   /* steps on end that end where they began: numbers hold no shorter ones */
    StepShrinkage step_shrinkage; /* stagnation.h */
    double bound;                 /* by whoever drives it: no longer step now, s; 0: free */
    bool may_bend;                /* likewise: something steep acts that may end within the step */
    bool is_read;     /* likewise: between its ends each step is read for conditions of the state */
    bool has_pulses;  /* likewise: it takes many short steps, for what acts for a short time or
                       * behind jumps */
    double missed;    /* fixed steps: largest estimated error of one, in tolerances, */
    double missed_at; /* and when that was, s */
    bool is_stiff;    /* explicit methods: steps are cut by stability, not by accuracy */
    bool is_oscillatory; /* ... and what cuts them swings rather than decays */
};

static inline int stepper_length(const Stepper *stepper) /* of y */
{
    return stepper->ode->n + stepper->ode->quadratures;
}

/* y' at (t, y), counted; false: undefined there */
static inline bool stepper_rate(Stepper *stepper, double t, const double *y, double *rate)
{
    stepper->counts.evaluations++;
    return stepper->ode->rate(stepper->ode->context, t, y, rate);
}

/* the error of y_i that counts as one, of an entry of that size */
static inline double stepper_tolerance(const Stepper *stepper, int i, double size)
{
    const double *magnitude_bound = stepper->ode->magnitude_bound;

    return stepper->control.atol * ode_nominal(stepper->ode, i) +
           stepper->control.rtol *
               (magnitude_bound != NULL ? fmin(size, magnitude_bound[i]) : size);
}

/* h, or what is allowed of it */
static inline double stepper_allowed(const Stepper *stepper, double h)
{
    return stepper->bound > 0 ? fmin(h, stepper->bound) : h;
}

/* Where a method that grows its steps by itself has to stop for the bound, or at `end`. A stop just
 * behind its next step would leave a sliver for the one after it. */
static inline double stepper_stop(const Stepper *stepper, double end)
{
    double bound = stepper->bound;

    if (!(bound > 0) || (stepper->next > 0 && stepper->next <= bound))
        return end;
    return fmin(end, stepper->t + bound);
}

#define LEAST_TOLERANCE 1e-13 /* that numbers allow */

/* The part of the tolerance that one step may take up. Errors of a method with a history are much
 * alike from step to step, and add up over the many short steps of pulses and behind restarts. */
static inline double stepper_part(const Stepper *stepper)
{
    return stepper->method->has_history && stepper->has_pulses
               ? fmax(stepper->method->short_part, fmin(1, LEAST_TOLERANCE / stepper->control.rtol))
               : 1;
}

/* y' at the stepper's time */
static inline bool stepper_slope(Stepper *stepper, double *rate)
{
    if (stepper->method->slope != NULL && stepper->method->slope(stepper, rate))
        return true;
    return stepper_rate(stepper, stepper->t, stepper->y, rate);
}

static inline void stepper_begin(const Stepper *s, double t, const double *y, double h)
{
    if (s->ode->begin != NULL)
        s->ode->begin(s->ode->context, t, y, h);
}

/* Largest relative error that rounding may have left of rates since it was last asked for. */
static inline double stepper_rounding(const Stepper *s)
{
    return s->ode->rounding_error != NULL ? s->ode->rounding_error(s->ode->context) : 0;
}

/* How many times the tolerance an error may be, since rounding leaves no less. Asked once a step.
 */
static inline double stepper_rounding_error(const Stepper *s)
{
    return fmax(1, stepper_rounding(s) / s->control.rtol);
}

/* The row of that name, or NULL; row i, or NULL at the end. */
const Method *method_find(const char *name);
const Method *method_row(int i);

/* What is wanted of a method that nobody named. */
typedef struct MethodNeed {
    bool stiff;   /* is for stiff equations, */
    bool history; /* goes by many steps rather than anew from each */
    bool dae;     /* has multipliers among its unknowns */
    bool fixed;   /* and controls no error */
} MethodNeed;
/* the first row that is so */
const Method *method_for(MethodNeed need);

/* An error of the solver at time t, in words: "at t = 0.3 s: ...". */
Status solver_failure(Diag *diag, double t, const char *reason);
/* what is said where y' has no value */
Status ode_undefined(const Ode *ode, double t, Diag *diag);

/* what a method's create() begins with; `stepper` is the first member of the method's own struct */
void stepper_init(Stepper *stepper, const Method *method, const Ode *ode, const Control *control);
/* room for so many numbers, 0, freed with it */
double *stepper_numbers(Stepper *stepper, int count);
/* what destroy() ends with, or all of it; NULL is fine */
void stepper_free(Stepper *stepper);
/* It goes on from (t, y) as a new one does: what a start() begins with. */
void stepper_place(Stepper *stepper, double t, const double *y);
/* the same, with the rate there, of methods that begin with one. E_SOLVER. */
MUST_USE Status stepper_start(Stepper *stepper, double t, const double *y, double *rate,
                              Diag *diag);

/* The last step took `h`, to time `reached`, and `next` follows it. Where steps go on to end where
 * they began, and don't grow, E_SOLVER: such an integration would walk through any singularity
 * while its clock stands still. */
MUST_USE Status stepper_arrive(Stepper *stepper, double reached, double h, double next, Diag *diag);

/* What methods with a history do where their last step has to end at t, inside it: y there,
 * projected. `last` is y at the end of the step, to which it comes back where that fails. */
MUST_USE Status stepper_reject(Stepper *stepper, double t, const double *last, Diag *diag);

#define MAX_REJECTIONS 10   /* in a row, by NaN or a projection that fails, end a run, */
#define RETREAT        0.25 /* each so much shorter: the last, by a million */

#define METHOD(row) extern const Method row;
#include "simulate/integrate/methods.def"
#undef METHOD

#endif

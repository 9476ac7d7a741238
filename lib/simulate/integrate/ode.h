/* ode.h: the problem as an integrator needs it, and the interface of a stepper
 *
 *     y' = f(t, y),   y on a manifold that project() restores
 *
 * A Stepper is one integration under way: it takes accepted steps, each not beyond a given time,
 * and interpolates y in the last one. Methods are rows of methods.def. The caller that drives a
 * stepper is responsible for output, switches and stopping. */
#ifndef COTREE_SIMULATE_INTEGRATE_ODE_H
#define COTREE_SIMULATE_INTEGRATE_ODE_H

#include "algebra/hessenberg_form.h"
#include "base/diag.h"
#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* The same motion for solvers of implicit equations F(t, w, w') = 0; w is y and multipliers, or y
 * and other algebraic unknowns. */
typedef struct Dae {
    int n;
    void *context;
    bool (*residual)(void *context, double t, const double *w, const double *rate, double *out);
    /* consistent w and w' at (t, y) */
    bool (*start)(void *context, double t, const double *y, double *w, double *rate);
    const double *weight; /* n: absolute tolerance of w_i is atol * weight */
    /* n: whether F contains a rate of w_i; NULL: all are assumed to */
    const bool *has_rate;
    /* n: whether w_i is in the error test; NULL: all are. Multipliers, which are rates of unknowns,
     * jump where a step becomes longer, without an effect on y. */
    const bool *is_tested;
    /* Positions of the entries of dF/dw + c dF/dw' that may not be 0, each at most once; known from
     * the first start() on. NULL, or a count of -1: not available. */
    int (*pattern)(void *context, const int **row, const int **column);
    bool (*jacobian)(void *context, double t, double c, const double *w, const double *rate,
                     double *values);
    /* The same as a full matrix, column by column; false: available by differences only. NULL: not
     * available. */
    bool (*full)(void *context, double t, double c, const double *w, const double *rate,
                 double *values);
    /* Whether dF/dy' and dF by the rest of w have an inverse: index 1, without multipliers. */
    bool is_index_one;
    /* Whether dF/dw and dF/dw' are constant until a restart. NULL: not known. */
    bool (*is_linear)(void *context);
    /* Then, whether w' = J w + ... is known in a form for many shifts from an earlier time with the
     * same equations; NULL: not known. A form passed in belongs to the callee afterwards. */
    const HessenbergForm *(*known)(void *context);
    const HessenbergForm *(*keep)(void *context, HessenbergForm *given);
} Dae;

/* Derivatives of y' in closed form. */
typedef struct OdeJacobian {
    void *context;
    /* Derivatives of all entries of y' by the first n of y, row by row, at (t, y). False: available
     * there by differences only. NULL: never available. */
    bool (*at)(void *context, double t, const double *y, double *out);
} OdeJacobian;

typedef struct Ode {
    int n;           /* unknowns in the error test */
    int quadratures; /* further entries of y, after those, that f doesn't read */
    void *context;
    /* y' at (t, y); false: undefined there, try a shorter step */
    bool (*rate)(void *context, double t, const double *y, double *rate);
    /* A step h from y at t is tried next (0: of unknown length). How rates are defined off the
     * manifold is decided for the whole step. NULL: no such decision. */
    void (*begin)(void *context, double t, const double *y, double h);
    /* move y back onto its manifold; false: can't. NULL: there is none */
    bool (*project)(void *context, double t, double *y);
    /* n: largest |y_i| in a relative tolerance (an angle of many turns is as accurate as one of a
     * few); NULL: unbounded */
    const double *magnitude_bound;
    /* n: nominal value: the change of y_i that counts as 1 in the absolute tolerance (a shape's
     * error is that of the displacement it causes); NULL: 1 */
    const double *unit;
    /* n: errors of y_i up to here don't count, since y is projected after each step; NULL: all do.
     * Methods that don't project ignore it. */
    const double *error_floor;
    /* Largest relative rounding error of rates since the last call; NULL: machine precision. No
     * step is shortened to reduce it. */
    double (*rounding_error)(void *context);
    OdeJacobian jacobian;
    Dae dae;         /* entries 0..n+quadratures-1 of w are y; n 0: not available */
    bool is_network; /* without mechanics: messages mention a network */
    /* Stiffness may fall by decades from step to step: with a matrix of earlier steps Newton's
     * method would seem to have converged. */
    bool stiffness_falls;
} Ode;

/* name of y' in messages */
static inline const char *ode_rates(const Ode *ode)
{
    return ode->is_network ? "the network's rates" : "the accelerations";
}

static inline double ode_nominal(const Ode *ode, int i)
{
    return ode->unit != NULL && i < ode->n ? ode->unit[i] : 1;
}

/* perturbation of an unknown for a difference quotient */
static inline double ode_increment(double y)
{
    return sqrt(DBL_EPSILON * fmax(1e-5, fabs(y)));
}

typedef struct Control {
    double rtol, atol;
    double step; /* fixed or largest step, s; 0: free */
    double most; /* largest step, s, also for methods with fixed steps; 0: free */
    double span; /* of the whole run, s; 0: not known */
} Control;

/* largest step that the user requested */
static inline double control_asked(const Control *control)
{
    double step = control->step > 0 ? control->step : HUGE_VAL;

    return control->most > 0 ? fmin(step, control->most) : step;
}

/* Largest step of methods that evaluate one to three points of a step: while nothing changes they
 * would step over a pulse without noticing. */
static inline double control_largest(const Control *control)
{
    double asked = control_asked(control);

    return asked < HUGE_VAL ? asked : control->span > 0 ? control->span / 50 : HUGE_VAL;
}

typedef struct Counts {
    int64_t steps, rejected, evaluations, jacobians;
    int64_t visits; /* ranges of expressions computed in the look-ahead (onset.h) */
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
    /* Repeat the last step so that it ends at t, inside it; then start anew from there. Where that
     * fails, at() and y still represent the original step. */
    Status (*shorten)(Stepper *stepper, double t, Diag *diag);
    /* y' at the stepper's time, without an evaluation; false: not available. NULL: never */
    bool (*slope)(Stepper *stepper, double *rate);
    /* positions in a step where the equations are evaluated, as fractions of its length, */
    const double *nodes;
    int node_count;
    bool has_history;   /* it also uses the steps before: it starts anew after shorten(); */
    bool sees_little;   /* too few positions to detect what happens in between */
    double pulse_steps; /* number of steps over a pulse that make it accurate */
    double short_part;  /* of the tolerance, for each of many short steps whose errors add up */
    /* properties */
    bool suits_stiff; /* stability doesn't limit its steps, where the limiting component decays; */
    bool is_a_stable; /* nor where it oscillates */
    bool has_fixed_step; /* and no error control */
    bool solves_dae;     /* uses ode->dae where it is available: multipliers are unknowns, too */
} Method;

/* how steps since the last start decrease */
typedef struct StepShrinkage {
    int64_t steps; /* with t: at the last check */
    double t, way; /* s; way: total length of the steps before that */
    int times;     /* checks in succession at which it had decreased */
} StepShrinkage;

struct Stepper {
    const Method *method;
    const Ode *ode;
    Control control;
    Counts counts;
    double before;       /* start of the last step */
    double t;            /* its end, s */
    double *y;           /* y at t, projected where the method projects */
    LIST(double *) room; /* memory of it and its method, freed with it */
    double next; /* s: step it would take next; 0: not chosen yet, as after a start, when its driver
                    may set it */
    int stuck;   /* steps in succession that end where they began: below resolution */
    StepShrinkage step_shrinkage; /* stagnation.h */
    double bound;                 /* set by its driver: largest step now, s; 0: free */
    bool may_bend;                /* likewise: a stiff element may become inactive in the step */
    bool is_read;                 /* likewise: steps are interpolated to evaluate conditions */
    bool has_pulses;  /* likewise: it takes many short steps, for brief pulses or after jumps */
    double missed;    /* fixed steps: largest estimated error of one, in tolerances, */
    double missed_at; /* and its time, s */
    /* explicit methods: a fast component limits the steps, by stability or by accuracy (set by
     * stiffness detection, dop853_stiff.c), */
    bool found_stiff;
    bool is_oscillatory; /* ... and that component oscillates rather than decays */
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

/* the error tolerance of y_i, for an entry of that size */
static inline double stepper_tolerance(const Stepper *stepper, int i, double size)
{
    const double *magnitude_bound = stepper->ode->magnitude_bound;

    return stepper->control.atol * ode_nominal(stepper->ode, i) +
           stepper->control.rtol *
               (magnitude_bound != NULL ? fmin(size, magnitude_bound[i]) : size);
}

/* h, limited to the allowed step */
static inline double stepper_allowed(const Stepper *stepper, double h)
{
    return stepper->bound > 0 ? fmin(h, stepper->bound) : h;
}

/* Where a method that grows its steps by itself has to stop for the bound, or at `end`. A stop just
 * after its next step would leave a tiny step for the one after it. */
static inline double stepper_stop(const Stepper *stepper, double end)
{
    double bound = stepper->bound;

    if (!(bound > 0) || (stepper->next > 0 && stepper->next <= bound))
        return end;
    return fmin(end, stepper->t + bound);
}

/* `part` of the tolerance, or what makes it `least` */
static inline double tolerance_part(const Stepper *stepper, double part, double least)
{
    return fmax(part, fmin(1, least / stepper->control.rtol));
}

/* The fraction of the tolerance that one step may use. Errors of a method with a history are
 * similar from step to step: they add up where motion hardly damps them, and over the many short
 * steps of pulses and after restarts. */
static inline double stepper_part(const Stepper *stepper)
{
    const Method *method = stepper->method;
    double part = 1;

    if (method->has_history && !stepper->ode->is_network)
        part = tolerance_part(stepper, MOTION_PART, MOTION_LEAST);
    if (method->has_history && stepper->has_pulses)
        part = fmin(part, tolerance_part(stepper, method->short_part, LEAST_TOLERANCE));
    return part;
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

/* Largest relative rounding error of rates since the last call. */
static inline double stepper_rounding(const Stepper *s)
{
    return s->ode->rounding_error != NULL ? s->ode->rounding_error(s->ode->context) : 0;
}

/* Factor by which rounding error raises the tolerance. Call once a step. */
static inline double stepper_rounding_error(const Stepper *s)
{
    return fmax(1, stepper_rounding(s) / s->control.rtol);
}

/* The row of that name, or NULL; row i, or NULL at the end. */
const Method *method_find(const char *name);
const Method *method_row(int i);

/* Requirements for a method that the user didn't choose. */
typedef struct MethodNeed {
    bool stiff;   /* suitable for stiff equations, */
    bool history; /* multistep rather than one-step */
    bool dae;     /* has multipliers among its unknowns */
    bool fixed;   /* without error control */
} MethodNeed;
/* the first row that satisfies these */
const Method *method_for(MethodNeed need);

/* Reports an error of the solver at time t: "at t = 0.3 s: ...". */
Status solver_failure(Diag *diag, double t, const char *reason);
/* reports that y' is undefined there */
Status ode_undefined(const Ode *ode, double t, Diag *diag);

/* called first by a method's create(); `stepper` is the first member of the method's own struct */
void stepper_init(Stepper *stepper, const Method *method, const Ode *ode, const Control *control);
/* memory for so many numbers, set to 0, freed with the stepper */
double *stepper_numbers(Stepper *stepper, int count);
/* the last call of destroy(), or all of it; NULL is fine */
void stepper_free(Stepper *stepper);
/* Restart the stepper from (t, y); called first by start(). */
void stepper_place(Stepper *stepper, double t, const double *y);
/* the same, with the rate there, for methods that need one. E_SOLVER. */
MUST_USE Status stepper_start(Stepper *stepper, double t, const double *y, double *rate,
                              Diag *diag);

/* Record that the last step took `h`, to time `reached`, and that `next` follows it. E_SOLVER where
 * several steps end where they began and don't grow: such an integration would pass any singularity
 * while its time stands still. */
MUST_USE Status stepper_arrive(Stepper *stepper, double reached, double h, double next, Diag *diag);

/* For methods with a history whose last step has to end at t, inside it: set y there, projected.
 * `last` is y at the end of the step, which is restored where that fails. */
MUST_USE Status stepper_reject(Stepper *stepper, double t, const double *last, Diag *diag);

#define METHOD(row) extern const Method row;
#include "simulate/integrate/methods.def"
#undef METHOD

#endif

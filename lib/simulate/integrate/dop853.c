/* dop853.c: explicit Runge-Kutta of order 8 with error control and dense output of order 7
 *
 * Dormand and Prince's pair as given by Hairer, Norsett and Wanner (1993), II.5 and II.10. Stage i
 * is k_i = f(t + c_i h, y + h sum_j a_ij k_j). Each accepted step is projected before the first
 * stage of the next, so that this costs no evaluation; the dense output ends at the projected
 * point. */
#include "simulate/integrate/dop853_impl.h"

#include "base/memory.h"
#include "simulate/integrate/integrate_limits.h"

#include <math.h>
#include <string.h>

#define FIRST_SEEN 5 /* first stage after stage 0 with a weight in the result */

enum {
    LEAPS = 4,        /* in succession, before steps become shorter */
    LEAP_CHOICES = 50 /* lengths that are compared */
};

/* by square roots, which unlike powers are the same on every machine */
static double eighth_root(double x)
{
    return sqrt(sqrt(sqrt(x)));
}

/* Initial step: its explicit Euler result, compared with f there, has an estimated error of a
 * hundredth (Hairer, Norsett, Wanner 1993, II.4). */
static double first_step(Dop853 *d, double t, double span)
{
    double size, slope, bend, h, h2;

    dop853_choose_scale(d, d->base.y, d->base.y);
    size = dop853_norm(d, d->base.y);
    slope = dop853_norm(d, d->k[0]);
    /* an almost zero y may change at once: it is within the tolerance */
    h = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * fmax(size, 1) / slope;
    h = fmin(h, span);
    for (int i = 0; i < d->all; i++)
        d->stage_point[i] = d->base.y[i] + h * d->k[0][i];
    if (!stepper_rate(&d->base, t + h, d->stage_point, d->k[1]))
        return 1e-3 * h;
    for (int i = 0; i < d->n; i++)
        d->k[2][i] = d->k[1][i] - d->k[0][i];
    bend = dop853_norm(d, d->k[2]) / h;
    h2 = fmax(slope, bend) <= 1e-15 ? fmax(1e-6, h * 1e-3) : eighth_root(0.01 / fmax(slope, bend));
    return fmin(fmin(100 * h, h2), span);
}

/* Error of the step just tried, in units of the tolerance (their equation II.10.17). The estimate
 * of order 5 may vanish by chance where a pulse is between the stages. Where steps resolve the
 * solution, the estimate of order 3 is proportional to the root of the tolerance. */
static double step_error(Dop853 *d, double h)
{
    const double *eighth = d->sums[1]; /* of try_step() */
    const double *fifth = dop853_weigh(d, ROW_ERROR_FIVE, d->sums[0]);
    const double *of_third = dop853_weigh(d, ROW_THIRD, d->sums[2]);
    double sum5 = 0, sum3 = 0, under, third_order;

    dop853_choose_scale(d, d->old, d->new);
    for (int i = 0; i < d->n; i++) {
        double e5 = fifth[i] / d->scale[i];
        double e3 = (eighth[i] - of_third[i]) / d->scale[i];

        sum5 += e5 * e5;
        sum3 += e3 * e3;
    }
    under = sum5 + 0.01 * sum3;
    if (!(under > 0))
        return under;
    h = fabs(h);
    third_order = h * sqrt(sum3 / d->n * d->base.control.rtol) /
                  (d->base.may_bend ? DOP853_THIRD_ORDER_STIFF : DOP853_THIRD_ORDER);
    d->rounding_error = fmax(1, d->rounded / d->base.control.rtol);
    d->rounded = 0;
    return fmax(h * sum5 / sqrt(under * d->n) / d->rounding_error, third_order * third_order);
}

/* The new point of a step h from d->old at base.before; `sums[1]` is the weighted sum of its
 * stages. */
static bool try_step(Dop853 *d, double h)
{
    stepper_begin(&d->base, d->base.before, d->old, h);
    if (!dop853_set_stages(d, h))
        return false;
    dop853_move(d->old, h, dop853_weigh(d, ROW_END, d->sums[1]), d->all, d->new);
    return true;
}

/* project the new point at t and evaluate its rate into k[ROW_END] */
static bool settle(Dop853 *d, double t, double h)
{
    const Ode *ode = d->base.ode;

    if (ode->project != NULL && !ode->project(ode->context, t, d->new))
        return false;
    if (!stepper_rate(&d->base, t, d->new, d->k[ROW_END]))
        return false;
    d->base.t = t;
    d->step = h;
    d->parts = 0;
    memcpy(d->base.y, d->new, (size_t)d->all * sizeof(double));
    return true;
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Dop853 *d = NEW(Dop853);

    stepper_init(&d->base, &method_dop853, ode, control);
    d->n = ode->n;
    d->all = stepper_length(&d->base);
    d->room = (d->all + TOGETHER - 1) / TOGETHER * TOGETHER;
    for (int i = 0; i < STAGES; i++)
        d->k[i] = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(d->sums); i++)
        d->sums[i] = stepper_numbers(&d->base, d->room);
    for (int i = 0; i < COUNT(d->spare); i++)
        d->spare[i] = stepper_numbers(&d->base, d->room);
    dop853_reserve_room(d, &d->dense[0]);
    d->rounding_error = 1;
    d->old = stepper_numbers(&d->base, d->room);
    d->new = stepper_numbers(&d->base, d->all);
    d->stage_point = stepper_numbers(&d->base, d->all);
    d->scale = stepper_numbers(&d->base, d->all);
    d->peak = stepper_numbers(&d->base, d->n);
    return &d->base;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;

    d->was_rejected = false;
    d->parts = 0;
    d->step = 0;
    return stepper_start(stepper, t, y, d->k[ROW_END], diag);
}

/* the step to try next, limited so that `end` is met and no tiny step is left before it */
static double trim(const Dop853 *d, double h, double end)
{
    double left = end - d->base.before;

    h = stepper_allowed(&d->base, fmin(h, control_asked(&d->base.control)));
    if (h >= left || left - h < 1e-10 * h)
        return left;
    return h > 0.5 * left ? 0.5 * left : h;
}

/* return to the start of the last step */
static void take_back(Dop853 *d)
{
    d->base.t = d->base.before;
    memcpy(d->base.y, d->old, (size_t)d->all * sizeof(double));
    memcpy(d->k[ROW_END], d->k[0], (size_t)d->all * sizeof(double));
    d->step = 0;
}

/* Whether the step just taken ends where its parts end; checked where output between its ends is
 * read. When a step passes over a corner, as a wall that is met and left within it, its error
 * estimate is meaningless and may be small by chance, but its parts end elsewhere. */
static bool parts_agree(Dop853 *d, double error)
{
    const Stiffness before = d->stiffness;
    const bool found_stiff = d->base.found_stiff;

    dop853_watch_stiffness(d, d->step, error);
    if (!d->base.is_read)
        return true;
    dop853_make_dense(d);
    if (!(d->parted > DOP853_PARTS_AGREE * d->rounding_error))
        return true;
    d->stiffness = before;
    d->base.found_stiff = found_stiff;
    take_back(d);
    return false;
}

/* Position of a singular position in the step h just tried, by the rounding errors of the stages
 * near it: s after the start; 0: none. */
static double singular_place(const Dop853 *d, double h)
{
    double sum = 0, moment = 0;

    for (int stage = 1; stage < ROW_END; stage++) {
        sum += d->rounding[stage];
        moment += d->rounding[stage] * dop853_nodes[stage];
    }
    return sum > 0 ? h * moment / sum : 0;
}

/* distance, s, from there to the nearest stage of a step h, including those of its dense output */
static double nearest_stage(double place, double h)
{
    double nearest = HUGE_VAL;

    for (int stage = 0; stage < STAGES; stage++)
        nearest = fmin(nearest, fabs(dop853_nodes[stage] * h - place));
    return nearest;
}

/* The step up to `most` long that passes a singular position `place` after its start with its
 * stages furthest from it; 0: none does. Near that position y' off the constraints is inaccurate,
 * so that errors grow the nearer a stage comes. Shorter steps would end before it, each nearer than
 * the last. */
static double leap_over(double place, double most)
{
    const double least = place / DOP853_LEAP_PAST;
    double best = 0, furthest = 0;

    for (int i = 0; i <= LEAP_CHOICES && least > 0 && least < most; i++) {
        const double h = most + (least - most) * i / LEAP_CHOICES;
        const double nearest = nearest_stage(place, h);

        if (nearest > furthest) {
            furthest = nearest;
            best = h;
        }
    }
    return best;
}

/* Whether the stages of another step would be at least twice as far from the position at which this
 * one has rounding errors. */
static bool can_see_better(const Dop853 *d, double h)
{
    const double place = singular_place(d, h), leap = leap_over(place, DOP853_LEAP * h);

    return leap > 0 && nearest_stage(place, leap) > 2 * nearest_stage(place, h);
}

/* Whether a step h, to t, is accepted. `error` is in units of the tolerance: HUGE_VAL where its
 * parts end elsewhere, NAN where it is undefined. With `is_choosy`, a step with an error of at most
 * 1 is also rejected where another step would have less rounding error. */
static bool take_step(Dop853 *d, double h, double t, bool is_choosy, double *error)
{
    double estimate;

    *error = NAN;
    if (!try_step(d, h))
        return false;
    estimate = step_error(d, h);
    if (!isfinite(estimate))
        return false;
    if (estimate <= 1 && is_choosy && d->rounding_error > 1 && can_see_better(d, h)) {
        *error = estimate;
        return false;
    }
    if (estimate <= 1 && !settle(d, t, h))
        return false;
    *error = estimate <= 1 && !parts_agree(d, estimate) ? HUGE_VAL : estimate;
    return *error <= 1;
}

/* length of the next step after one of `taken` with such an error, where h was intended */
static double next_step(const Dop853 *d, double taken, double h, double error)
{
    const double most = d->was_rejected ? 1 : DOP853_GROW;
    const double factor = error > 0 ? DOP853_SAFETY / eighth_root(error) : DOP853_GROW;
    /* a step that was cut to meet an end doesn't reduce the intended one */
    const double longer = taken < h ? fmin(h, taken * DOP853_GROW) : 0;

    return fmax(taken * fmin(most, fmax(DOP853_SHRINK, factor)), longer);
}

/* what was tried in one step */
typedef struct Tries {
    int failures, leaps;
    bool has_looked; /* for a step with less rounding error than an acceptable one: */
    double sure;     /* the acceptable one, s, until it is tried again; 0: none */
} Tries;

/* the length to try after a rejected h */
static double try_next(const Dop853 *d, double h, double error, Tries *tries)
{
    const double sure = tries->sure;
    double leap;

    tries->sure = 0;
    if (sure > 0)
        return sure;
    /* where its parts end elsewhere, the stages are those of the last part */
    leap = isinf(error) ? 0 : leap_over(singular_place(d, h), DOP853_LEAP * h);
    if (error <= 1) {
        tries->has_looked = true;
        tries->sure = h;
        return leap;
    }
    if (leap > 0 && tries->leaps++ < LEAPS)
        return leap;
    return h * (isnan(error) ? RETREAT : fmax(DOP853_SHRINK, DOP853_SAFETY / eighth_root(error)));
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;
    Tries tries = {0};
    double h;

    memcpy(d->old, d->base.y, (size_t)d->all * sizeof(double));
    memcpy(d->k[0], d->k[ROW_END], (size_t)d->all * sizeof(double));
    d->base.before = d->base.t;
    h = d->base.next > 0 ? d->base.next : first_step(d, d->base.t, end - d->base.t);
    for (;;) {
        const double tried = trim(d, h, end);
        const double t = tried == end - d->base.before ? end : d->base.before + tried;
        double error;

        if (!(tried > 4e-16 * fabs(t)))
            return solver_failure(diag, d->base.before, "the step became too small");
        if (take_step(d, tried, t, !tries.has_looked, &error)) {
            d->base.next = next_step(d, tried, h, error);
            d->was_rejected = false;
            d->base.counts.steps++;
            return OK;
        }
        d->base.counts.rejected++;
        d->was_rejected = true;
        if (isnan(error) && ++tries.failures >= MAX_REJECTIONS)
            return solver_failure(diag, d->base.before,
                                  "the equations have no solution just behind this instant (ten "
                                  "ever shorter steps failed)");
        h = try_next(d, tried, error, &tries);
    }
}

static void at(Stepper *stepper, double t, double *y)
{
    Dop853 *d = (Dop853 *)stepper;

    if (d->step == 0 || t == d->base.t) {
        memcpy(y, d->base.y, (size_t)d->all * sizeof(double));
        return;
    }
    if (d->parts == 0)
        dop853_make_dense(d);
    dop853_interpolate(d, t, y);
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    Dop853 *d = (Dop853 *)stepper;
    double h = t - d->base.before;

    if (h <= 0) {
        take_back(d);
        return OK;
    }
    if (d->step != 0 && d->parts == 0)
        dop853_make_dense(d); /* while its stages are available */
    if (!try_step(d, h) || !settle(d, t, h))
        return solver_failure(diag, t, "the equations have no solution at a switch");
    d->base.next = h;
    return OK;
}

static bool slope(Stepper *stepper, double *rate)
{
    const Dop853 *d = (const Dop853 *)stepper;

    memcpy(rate, d->k[ROW_END], (size_t)d->all * sizeof(double));
    return true;
}

const Method method_dop853 = {
    .name = "dop853",
    .brief = "explicit Runge-Kutta 8(5,3), Dormand and Prince; projects after each step",
    .create = create,
    .destroy = stepper_free,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = dop853_nodes + FIRST_SEEN,
    .node_count = ROW_END - FIRST_SEEN,
    .pulse_steps = 3,
};

/* rk4.c: the classical Runge-Kutta method with fixed steps and projection
 *
 * No error control: its use is a run in known time, and a comparison. What it estimates of its
 * error is told. A step is cut where its driver asks for it, at switches and where something begins
 * to act for a short time. Between the ends of a step the cubic through both points and slopes is
 * read (error of order 4, as the method's). */
#include "simulate/integrate/ode.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef struct Rk4 {
    Stepper base;
    int all;
    double *old, *old_rate, *rate, *point, *k[4];
    double last;            /* length of the step before, s; 0: there is none */
    double *earlier, *half; /* rates at its start, and half way */
} Rk4;

static Stepper *create(const Ode *ode, const Control *control)
{
    Rk4 *r = NEW(Rk4);

    stepper_init(&r->base, &method_rk4, ode, control);
    r->all = stepper_length(&r->base);
    r->old = stepper_numbers(&r->base, r->all);
    r->old_rate = stepper_numbers(&r->base, r->all);
    r->rate = stepper_numbers(&r->base, r->all);
    r->point = stepper_numbers(&r->base, r->all);
    r->earlier = stepper_numbers(&r->base, r->all);
    r->half = stepper_numbers(&r->base, r->all);
    for (int i = 0; i < 4; i++)
        r->k[i] = stepper_numbers(&r->base, r->all);
    return &r->base;
}

static Status start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    Rk4 *r = (Rk4 *)stepper;

    r->last = 0;
    return stepper_start(stepper, t, y, r->rate, diag);
}

/* from old at base.before over h; leaves the new point projected and its rate */
static bool advance(Rk4 *r, double h, double end)
{
    static const double node[4] = {0, 0.5, 0.5, 1};
    const Ode *ode = r->base.ode;

    memcpy(r->k[0], r->old_rate, (size_t)r->all * sizeof(double));
    stepper_begin(&r->base, r->base.before, r->old, h);
    for (int s = 1; s < 4; s++) {
        for (int i = 0; i < r->all; i++)
            r->point[i] = r->old[i] + h * node[s] * r->k[s - 1][i];
        if (!stepper_rate(&r->base, r->base.before + node[s] * h, r->point, r->k[s]))
            return false;
    }
    for (int i = 0; i < r->all; i++)
        r->base.y[i] =
            r->old[i] + h / 6 * (r->k[0][i] + 2 * r->k[1][i] + 2 * r->k[2][i] + r->k[3][i]);
    if (ode->project != NULL && !ode->project(ode->context, end, r->base.y))
        return false;
    r->base.t = end;
    return stepper_rate(&r->base, end, r->base.y, r->rate);
}

/* The error of the last step: by how much the slope of what is read between its ends misses the
 * equations half way, which is of order 4, one less than the error itself; and what Simpson's rule
 * leaves of rates that follow the time, by their fourth difference over this step and the one
 * before.
 */
static double error_of(const Rk4 *r, double h, int i)
{
    double slope = 1.5 * (r->base.y[i] - r->old[i]) / h - 0.25 * (r->old_rate[i] + r->rate[i]);
    double missed = fabs(slope - r->k[2][i]) / 6;
    double bend = r->earlier[i] - 4 * r->half[i] + 6 * r->old_rate[i] - 4 * r->k[2][i] + r->rate[i];

    if (fabs(h - r->last) <= 1e-9 * h)
        missed = fmax(missed, fabs(bend) / 180);
    return h * missed;
}

static void estimate(Rk4 *r, double h)
{
    const Ode *ode = r->base.ode;

    for (int i = 0; i < ode->n; i++) {
        double size = fmax(fabs(r->base.y[i]), fabs(r->old[i]));
        double error = error_of(r, h, i);

        if (ode->slack != NULL && error <= ode->slack[i])
            continue;
        error /= stepper_tolerance(&r->base, i, size);
        if (error > r->base.missed) {
            r->base.missed = error;
            r->base.missed_at = r->base.before;
        }
    }
    memcpy(r->earlier, r->old_rate, (size_t)r->all * sizeof(double));
    memcpy(r->half, r->k[2], (size_t)r->all * sizeof(double));
    r->last = h;
}

/* where the last step ended, as it was there */
static Status give_up(Rk4 *r, Diag *diag)
{
    r->base.t = r->base.before;
    memcpy(r->base.y, r->old, (size_t)r->all * sizeof(double));
    memcpy(r->rate, r->old_rate, (size_t)r->all * sizeof(double));
    return solver_failure(diag, r->base.t, "the equations have no solution one step on");
}

static Status step(Stepper *stepper, double end, Diag *diag)
{
    Rk4 *r = (Rk4 *)stepper;
    double left = end - r->base.t;
    double h = stepper_allowed(&r->base, control_asked(&r->base.control));
    bool last = h <= 0 || h >= left * (1 - 1e-9);

    memcpy(r->old, r->base.y, (size_t)r->all * sizeof(double));
    memcpy(r->old_rate, r->rate, (size_t)r->all * sizeof(double));
    r->base.before = r->base.t;
    h = last ? left : h;
    /* where a motion ends, shorter steps lead up to that: what ends it shows there */
    for (int i = 0; !advance(r, h, last ? end : r->base.before + h); i++) {
        if (i == MAX_REJECTIONS)
            return give_up(r, diag);
        r->base.counts.rejected++;
        last = false;
        h *= RETREAT;
    }
    estimate(r, r->base.t - r->base.before);
    r->base.counts.steps++;
    return OK;
}

static void at(Stepper *stepper, double t, double *y)
{
    const Rk4 *r = (const Rk4 *)stepper;
    double h = r->base.t - r->base.before;
    double s = h > 0 ? (t - r->base.before) / h : 1;

    for (int i = 0; i < r->all; i++) {
        double dy = r->base.y[i] - r->old[i];

        y[i] = h > 0
                   ? r->old[i] + s * dy +
                         s * (s - 1) *
                             ((1 - 2 * s) * dy + (s - 1) * h * r->old_rate[i] + s * h * r->rate[i])
                   : r->base.y[i];
    }
}

static Status shorten(Stepper *stepper, double t, Diag *diag)
{
    Rk4 *r = (Rk4 *)stepper;
    size_t bytes = (size_t)r->all * sizeof(double);
    double end = r->base.t;
    double *y = NEW_ARRAY(double, r->all), *rate = NEW_ARRAY(double, r->all);
    Status status = OK;

    memcpy(y, r->base.y, bytes);
    memcpy(rate, r->rate, bytes);
    if (!advance(r, t - r->base.before, t)) {
        status = solver_failure(diag, t, "the equations have no solution at a switch");
        r->base.t = end;
        memcpy(r->base.y, y, bytes);
        memcpy(r->rate, rate, bytes);
    }
    mem_free(y);
    mem_free(rate);
    return status;
}

static bool slope(Stepper *stepper, double *rate)
{
    const Rk4 *r = (const Rk4 *)stepper;

    memcpy(rate, r->rate, (size_t)r->all * sizeof(double));
    return true;
}

static const double nodes[] = {0.5, 1};

const Method method_rk4 = {
    .name = "rk4",
    .brief =
        "classical Runge-Kutta, fixed steps (step=, else one a row), shorter where something steep "
        "begins to act; controls no error, and tells of it; projects after each step",
    .create = create,
    .destroy = stepper_free,
    .start = start,
    .step = step,
    .at = at,
    .shorten = shorten,
    .slope = slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .sees_little = true,
    .pulse_steps = 24,
    .has_fixed_step = true,
};

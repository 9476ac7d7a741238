/* rk4.c: the classical Runge-Kutta method with fixed steps and projection
 *
 * For runs of known cost, and for comparison. Between its ends a step is interpolated by the cubic
 * through both points and slopes (error of order 4, as the method's). */
#include "simulate/integrate/fixed.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef struct Rk4 {
    FixedStepper fixed;
    double *point, *k[4];
    double *earlier, *half; /* rates at the start of the step before, and half way */
} Rk4;

/* computes the new point, projected, and its rate */
static bool advance(FixedStepper *f, double h, double end)
{
    static const double node[4] = {0, 0.5, 0.5, 1};
    const Rk4 *r = (const Rk4 *)f;
    const Ode *ode = f->base.ode;

    memcpy(r->k[0], f->old_rate, (size_t)f->all * sizeof(double));
    stepper_begin(&f->base, f->base.before, f->old, h);
    for (int s = 1; s < 4; s++) {
        for (int i = 0; i < f->all; i++)
            r->point[i] = f->old[i] + h * node[s] * r->k[s - 1][i];
        if (!stepper_rate(&f->base, f->base.before + node[s] * h, r->point, r->k[s]))
            return false;
    }
    for (int i = 0; i < f->all; i++)
        f->base.y[i] =
            f->old[i] + h / 6 * (r->k[0][i] + 2 * r->k[1][i] + 2 * r->k[2][i] + r->k[3][i]);
    if (ode->project != NULL && !ode->project(ode->context, end, f->base.y))
        return false;
    f->base.t = end;
    return stepper_rate(&f->base, end, f->base.y, f->rate);
}

/* Error estimate of order 4, one less than the error itself: the defect of the interpolated slope
 * half way; and the error of Simpson's rule for rates that depend on time, by their fourth
 * difference over this step and the one before. */
static double error_of(const FixedStepper *f, double h, int i)
{
    const Rk4 *r = (const Rk4 *)f;
    double slope = 1.5 * (f->base.y[i] - f->old[i]) / h - 0.25 * (f->old_rate[i] + f->rate[i]);
    double missed = fabs(slope - r->k[2][i]) / 6;
    double bend = r->earlier[i] - 4 * r->half[i] + 6 * f->old_rate[i] - 4 * r->k[2][i] + f->rate[i];

    if (fabs(h - f->step_before) <= 1e-9 * h)
        missed = fmax(missed, fabs(bend) / 180);
    return h * missed;
}

static void keep(FixedStepper *f)
{
    const Rk4 *r = (const Rk4 *)f;

    memcpy(r->earlier, f->old_rate, (size_t)f->all * sizeof(double));
    memcpy(r->half, r->k[2], (size_t)f->all * sizeof(double));
}

static Stepper *create(const Ode *ode, const Control *control)
{
    Rk4 *r = NEW(Rk4);
    Stepper *base = &r->fixed.base;

    fixed_init(&r->fixed, &method_rk4, ode, control);
    r->fixed.advance = advance;
    r->fixed.error = error_of;
    r->fixed.keep = keep;
    r->point = stepper_numbers(base, r->fixed.all);
    r->earlier = stepper_numbers(base, r->fixed.all);
    r->half = stepper_numbers(base, r->fixed.all);
    for (int i = 0; i < 4; i++)
        r->k[i] = stepper_numbers(base, r->fixed.all);
    return base;
}

static void at(Stepper *stepper, double t, double *y)
{
    const FixedStepper *f = (const FixedStepper *)stepper;
    double h = f->base.t - f->base.before;
    double s = h > 0 ? (t - f->base.before) / h : 1;

    for (int i = 0; i < f->all; i++) {
        double dy = f->base.y[i] - f->old[i];

        y[i] = h > 0
                   ? f->old[i] + s * dy +
                         s * (s - 1) *
                             ((1 - 2 * s) * dy + (s - 1) * h * f->old_rate[i] + s * h * f->rate[i])
                   : f->base.y[i];
    }
}

static const double nodes[] = {0.5, 1};

const Method method_rk4 = {
    .name = "rk4",
    .brief = "classical Runge-Kutta, fixed steps (step=, else one per row), shorter steps where a "
             "stiff term sets in; controls no error, and reports that; projects after each step",
    .create = create,
    .destroy = stepper_free,
    .start = fixed_start,
    .step = fixed_step,
    .at = at,
    .shorten = fixed_shorten,
    .slope = fixed_slope,
    .nodes = nodes,
    .node_count = COUNT(nodes),
    .sees_little = true,
    .pulse_steps = 24,
    .has_fixed_step = true,
};

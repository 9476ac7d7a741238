/* fixed.c: steps of a fixed length, one after the other */
#include "simulate/integrate/fixed.h"

#include <math.h>
#include <string.h>

enum { MOST_CUTS = 40 }; /* of steps in succession */

void fixed_init(FixedStepper *f, const Method *method, const Ode *ode, const Control *control)
{
    stepper_init(&f->base, method, ode, control);
    f->all = stepper_length(&f->base);
    f->old = stepper_numbers(&f->base, f->all);
    f->old_rate = stepper_numbers(&f->base, f->all);
    f->rate = stepper_numbers(&f->base, f->all);
}

Status fixed_start(Stepper *stepper, double t, const double *y, Diag *diag)
{
    FixedStepper *f = (FixedStepper *)stepper;

    f->step_before = 0;
    return stepper_start(stepper, t, y, f->rate, diag);
}

static void estimate(FixedStepper *f, double h)
{
    const Ode *ode = f->base.ode;

    for (int i = 0; i < ode->n; i++) {
        double size = fmax(fabs(f->base.y[i]), fabs(f->old[i]));
        double error = f->error(f, h, i);

        if (ode->error_floor != NULL && error <= ode->error_floor[i])
            continue;
        error /= stepper_tolerance(&f->base, i, size);
        if (error > f->base.missed) {
            f->base.missed = error;
            f->base.missed_at = f->base.before;
        }
    }
    if (f->keep != NULL)
        f->keep(f);
    f->step_before = h;
}

/* restore the start of the last step */
static Status give_up(FixedStepper *f, Diag *diag)
{
    const double h = control_asked(&f->base.control);

    f->base.t = f->base.before;
    memcpy(f->base.y, f->old, (size_t)f->all * sizeof(double));
    memcpy(f->rate, f->old_rate, (size_t)f->all * sizeof(double));
    if (f->reason == NULL)
        return solver_failure(diag, f->base.t, "the equations have no solution one step on");
    (void)solver_failure(diag, f->base.t, f->reason);
    diag_hint(diag, "step=%.1g or less; or method=%s, whose steps that doesn't limit", h / 4,
              method_radau.name);
    return E_SOLVER;
}

Status fixed_step(Stepper *stepper, double end, Diag *diag)
{
    FixedStepper *f = (FixedStepper *)stepper;
    double left = end - f->base.t;
    double h = stepper_allowed(&f->base, control_asked(&f->base.control));
    bool is_last = h <= 0 || h >= left * (1 - 1e-9);

    memcpy(f->old, f->base.y, (size_t)f->all * sizeof(double));
    memcpy(f->old_rate, f->rate, (size_t)f->all * sizeof(double));
    f->base.before = f->base.t;
    f->reason = NULL;
    h = is_last ? left : h;
    /* where a motion ends, shorter steps lead up to its end and show the cause */
    for (int i = 0; !f->advance(f, h, is_last ? end : f->base.before + h); i++) {
        if (i == MAX_REJECTIONS || (i == 0 && ++f->cuts == MOST_CUTS))
            return give_up(f, diag);
        f->base.counts.rejected++;
        is_last = false;
        h *= RETREAT;
    }
    if (f->reason == NULL)
        f->cuts = 0;
    estimate(f, f->base.t - f->base.before);
    f->base.counts.steps++;
    return OK;
}

Status fixed_shorten(Stepper *stepper, double t, Diag *diag)
{
    FixedStepper *f = (FixedStepper *)stepper;
    size_t bytes = (size_t)f->all * sizeof(double);
    double end = f->base.t;
    double *y = NEW_ARRAY(double, f->all), *rate = NEW_ARRAY(double, f->all);
    Status status = OK;

    memcpy(y, f->base.y, bytes);
    memcpy(rate, f->rate, bytes);
    if (!f->advance(f, t - f->base.before, t)) {
        status = solver_failure(diag, t, "the equations have no solution at a switch");
        f->base.t = end;
        memcpy(f->base.y, y, bytes);
        memcpy(f->rate, rate, bytes);
    } else {
        f->step_before = 0;
    }
    mem_free(y);
    mem_free(rate);
    return status;
}

bool fixed_slope(Stepper *stepper, double *rate)
{
    const FixedStepper *f = (const FixedStepper *)stepper;

    memcpy(rate, f->rate, (size_t)f->all * sizeof(double));
    return true;
}

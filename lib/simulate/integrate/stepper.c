/* stepper.c: functions that steppers of all methods share */
#include "simulate/integrate/ode.h"

#include "simulate/integrate/integrate_limits.h"

#include <string.h>

void stepper_init(Stepper *s, const Method *method, const Ode *ode, const Control *control)
{
    *s = (Stepper){.method = method, .ode = ode, .control = *control};
    s->y = stepper_numbers(s, stepper_length(s));
}

double *stepper_numbers(Stepper *s, int count)
{
    double *numbers = NEW_ARRAY(double, count);

    LIST_PUSH(s->room, numbers);
    return numbers;
}

void stepper_free(Stepper *s)
{
    if (s == NULL)
        return;
    for (int i = 0; i < s->room.count; i++)
        mem_free(s->room.at[i]);
    LIST_FREE(s->room);
    mem_free(s);
}

void stepper_place(Stepper *s, double t, const double *y)
{
    memmove(s->y, y, (size_t)stepper_length(s) * sizeof(double));
    s->t = s->before = t;
    s->next = 0;
    s->stuck = 0;
    s->step_shrinkage = (StepShrinkage){.steps = s->counts.steps, .t = t};
}

Status stepper_start(Stepper *s, double t, const double *y, double *rate, Diag *diag)
{
    stepper_place(s, t, y);
    if (!stepper_rate(s, t, s->y, rate))
        return ode_undefined(s->ode, t, diag);
    return OK;
}

Status stepper_arrive(Stepper *s, double reached, double h, double next, Diag *diag)
{
    const double before = s->t;

    s->before = before;
    if (reached > before)
        s->stuck = 0;
    else if (next <= h) /* the short first steps after a start grow */
        s->stuck++;
    if (s->stuck >= STEPPER_STUCK)
        return solver_failure(diag, before, "the step became too small");
    s->t = reached;
    s->next = next;
    return OK;
}

Status stepper_reject(Stepper *s, double t, const double *last, Diag *diag)
{
    const Ode *ode = s->ode;

    s->method->at(s, t, s->y);
    if (ode->project != NULL && !ode->project(ode->context, t, s->y)) {
        memcpy(s->y, last, (size_t)stepper_length(s) * sizeof(double));
        return solver_failure(diag, t, "the equations have no solution at a switch");
    }
    s->t = t;
    return OK;
}

Status solver_failure(Diag *diag, double t, const char *reason)
{
    return diag_set(diag, E_SOLVER, "at t = %.9g s: %s", t, reason);
}

Status ode_undefined(const Ode *ode, double t, Diag *diag)
{
    return diag_set(diag, E_SOLVER, "at t = %.9g s: %s are undefined", t, ode_rates(ode));
}

/* method.c: the table of integrators */
#include "simulate/integrate/ode.h"

#include "base/memory.h"

#include <string.h>

#define STUCK 10 /* steps on end that end where they began */

static const Method *const rows[] = {
#define METHOD(row) &row,
#include "simulate/integrate/methods.def"
#undef METHOD
};

const Method *method_row(int i)
{
    return i >= 0 && i < COUNT(rows) ? rows[i] : NULL;
}

const Method *method_find(const char *name)
{
    for (int i = 0; i < COUNT(rows); i++)
        if (strcmp(rows[i]->name, name) == 0)
            return rows[i];
    return NULL;
}

const Method *method_for(MethodNeed need)
{
    for (int i = 0; i < COUNT(rows); i++)
        if (rows[i]->is_stiff == need.stiff && rows[i]->has_history == need.history &&
            rows[i]->solves_dae == need.dae && !rows[i]->has_fixed_step)
            return rows[i];
    return NULL;
}

Status solver_failure(Diag *diag, double t, const char *reason)
{
    return diag_set(diag, E_SOLVER, "at t = %.9g s: %s", t, reason);
}

Status stepper_arrive(Stepper *s, double reached, double h, double next, Diag *diag)
{
    const double before = s->t;

    s->before = before;
    if (reached > before)
        s->stuck = 0;
    else if (next <= h) /* the short first steps of a start grow out of it */
        s->stuck++;
    if (s->stuck >= STUCK)
        return solver_failure(diag, before, "the step became too small");
    s->t = reached;
    s->next = next;
    return OK;
}

Status stepper_take_back(Stepper *s, double t, const double *last, Diag *diag)
{
    const Ode *ode = s->ode;

    s->method->at(s, t, s->y);
    if (ode->project != NULL && !ode->project(ode->context, t, s->y)) {
        memcpy(s->y, last, (size_t)(ode->n + ode->quadratures) * sizeof(double));
        return solver_failure(diag, t, "the equations have no solution at a switch");
    }
    s->t = t;
    return OK;
}

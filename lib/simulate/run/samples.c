/* samples.c: sampled states in a run */
#include "simulate/run/samples.h"

#include "base/memory.h"

#include <math.h>

#define SAME 1e-9 /* of a period: instants nearer than that are one */

typedef struct SampledState {
    int state; /* in x */
    double period;
} SampledState;

struct Samples {
    const Layout *layout;
    Motion *motion;
    Probe *next;
    SampledState *at;
    int count;
};

static Status add_sample(Samples *s, const OwnSample *own, Parameters *parameters, Diag *diag)
{
    SampledState *sample = &s->at[s->count];

    sample->state = own->state;
    sample->period = parameters_evaluate(parameters, own->period);
    if (!(sample->period > 0) || !isfinite(sample->period)) {
        (void)diag_set(diag, E_VALUE, "the sampling period of %s is %g s",
                       system_x(s->layout->system, own->state)->name, sample->period);
        diag_hint(diag, "period= is a positive time");
        return E_VALUE;
    }
    s->count++;
    return OK;
}

Status samples_new(const Layout *layout, Parameters *parameters, Motion *motion, Samples **out,
                   Diag *diag)
{
    Samples *s = NEW(Samples);
    Expr *next = NEW_ARRAY(Expr, layout->nx);
    const OwnSample *own;
    Status status = OK;

    *out = NULL;
    s->layout = layout;
    s->motion = motion;
    s->at = NEW_ARRAY(SampledState, layout->nx);
    for (int i = 0; (own = system_sample(layout->system, i)) != NULL; i++) {
        if (own->period == NULL)
            continue;
        CHECK(system_resolve(layout->system, own->next, &next[s->count], diag));
        CHECK(add_sample(s, own, parameters, diag));
    }
    if (s->count == 0)
        goto done;
    CHECK(probe_new(layout, parameters, next, s->count, &s->next, diag));
    *out = s;
    s = NULL;
done:
    mem_free(next);
    samples_free(s);
    return status;
}

void samples_free(Samples *s)
{
    if (s == NULL)
        return;
    probe_free(s->next);
    MEM_FREE(s->at, s);
}

double samples_next(const Samples *s, double t)
{
    double first = INFINITY;

    for (int i = 0; s != NULL && i < s->count; i++)
        first = fmin(first, s->at[i].period * (floor(t / s->at[i].period + SAME) + 1));
    return first;
}

static bool is_due(const SampledState *sample, double t)
{
    double count = t / sample->period;

    return fabs(count - round(count)) <= SAME;
}

Status samples_take(Samples *s, double t, double *y, bool *due, Diag *diag)
{
    const Layout *l;
    RowValues row;
    const double *values;

    *due = false;
    for (int i = 0; s != NULL && i < s->count; i++)
        *due = *due || is_due(&s->at[i], t);
    if (!*due)
        return OK;
    l = s->layout;
    if (!row_solve(l, s->motion, t, y, &row))
        return solver_failure(diag, t, "the equations have no solution at a sampling instant");
    values = probe_values(s->next, &row);
    for (int i = 0; i < s->count; i++)
        if (is_due(&s->at[i], t))
            y[l->n + l->nu + s->at[i].state] = values[i];
    return OK;
}

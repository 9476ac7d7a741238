/* samples.c: sampled states in a run */
#include "simulate/run/samples.h"

#include "base/memory.h"
#include "simulate/run/run_limits.h"

#include <math.h>

typedef struct SampledState {
    int state; /* index in x */
    double period;
    int instance; /* of an input; -1: not an input */
} SampledState;

struct Samples {
    const VariableIndex *layout;
    Motion *motion;
    Probe *next;
    SampledState *at;
    int count;
    Host *host; /* NULL: none, or there is no input */
};

static Status add_sample(Samples *s, const OwnSample *own, Parameters *parameters, Diag *diag)
{
    SampledState *sample = &s->at[s->count];

    sample->state = own->state;
    sample->period = parameters_evaluate(parameters, own->period);
    sample->instance = own->is_input ? system_x(s->layout->system, own->state)->instance : -1;
    if (!(sample->period > 0) || !isfinite(sample->period)) {
        (void)diag_set(diag, E_VALUE, "the sampling period of %s is %g s",
                       system_x(s->layout->system, own->state)->name, sample->period);
        diag_hint(diag, "period= is a positive time");
        return E_VALUE;
    }
    s->count++;
    return OK;
}

Status samples_new(const VariableIndex *layout, Parameters *parameters, Motion *motion, Host *host,
                   Samples **out, Diag *diag)
{
    const int items = host != NULL ? host->item_count : 0;
    Samples *s = NEW(Samples);
    Expr *next = NEW_ARRAY(Expr, layout->nx + items);
    const OwnSample *own;
    int roots;
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
        s->host = own->is_input ? host : s->host;
    }
    if (s->count == 0)
        goto done;
    roots = s->count;
    for (int i = 0; s->host != NULL && i < items; i++)
        CHECK(system_resolve(layout->system, host->items[i], &next[roots++], diag));
    CHECK(probe_new(layout, parameters, next, roots, &s->next, diag));
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

Status samples_check(const Samples *s, double duration, Diag *diag)
{
    for (int i = 0; s != NULL && i < s->count; i++) {
        const SampledState *sample = &s->at[i];

        if (duration / sample->period <= SAMPLES_MOST)
            continue;
        (void)diag_set(diag, E_VALUE, "%s would be sampled %.3g times in %g s",
                       system_x(s->layout->system, sample->state)->name, duration / sample->period,
                       duration);
        diag_hint(diag, "period= is far too short for that run");
        return E_VALUE;
    }
    return OK;
}

double samples_next(const Samples *s, double t)
{
    double first = INFINITY;

    for (int i = 0; s != NULL && i < s->count; i++)
        first = fmin(first, s->at[i].period * (floor(t / s->at[i].period + SAME_SAMPLE) + 1));
    return first;
}

static bool is_due(const SampledState *sample, double t)
{
    double count = t / sample->period;

    return fabs(count - round(count)) <= SAME_SAMPLE;
}

/* the value that the host set for an input at that instant; NULL: none yet */
static const HostValue *find_value(const Host *host, int instance, double t, double near)
{
    int low = 0, high = host->values.count;

    while (low < high) {
        const int middle = (low + high) / 2;

        if (host->values.at[middle].t < t - near)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < host->values.count && host->values.at[low].t <= t + near; low++)
        if (host->values.at[low].instance == instance)
            return &host->values.at[low];
    return NULL;
}

/* the value of an input from t on; `items`: what the host receives */
static Status set_input(Host *host, const SampledState *sample, const char *name, double t,
                        const double *items, double *value, Diag *diag)
{
    const HostValue *before = find_value(host, sample->instance, t, SAME_SAMPLE * sample->period);

    if (before != NULL)
        *value = before->value;
    if (before != NULL || host->input == NULL)
        return OK;
    if (host->input(host->context, name, t, items, value))
        return diag_set(diag, E_STOPPED, "stopped at t = %.6g s", t);
    if (!isfinite(*value))
        return diag_set(diag, E_SOLVER, "%s was set to no number at t = %.6g s", name, t);
    LIST_PUSH(host->values, ((HostValue){t, sample->instance, *value}));
    return OK;
}

Status samples_read(Samples *s, double t, double *y, bool *due, Diag *diag)
{
    const VariableIndex *l;
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
    for (int i = 0; i < s->count; i++) {
        const SampledState *sample = &s->at[i];
        double value = values[i];

        if (!is_due(sample, t))
            continue;
        if (sample->instance >= 0 && s->host != NULL)
            TRY(set_input(s->host, sample, system_instance_name(l->system, sample->instance), t,
                          values + s->count, &value, diag));
        y[l->n + l->nu + sample->state] = value;
    }
    return OK;
}

/* onset.c: before and behind each step, where something begins to act within it */
#include "simulate/run/onset_impl.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

Onset *onset_new(StiffElements *stiff_elements, const Ode *ode)
{
    Onset *o;
    int k, j;

    if (stiff_elements == NULL)
        return NULL;
    o = NEW(Onset);
    o->stiff_elements = stiff_elements;
    o->visits = stiff_elements_visits(stiff_elements);
    o->ode = ode;
    o->elements = k = stiff_elements_element_count(stiff_elements);
    o->sources = j = stiff_elements_source_count(stiff_elements);
    o->length = ode->n + ode->quadratures;
    o->has_pulses = k > 0;
    o->at = (Affine){NEW_ARRAY(double, k), NEW_ARRAY(double, k), NEW_ARRAY(double, k),
                     NEW_ARRAY(double, k *j)};
    o->source_at = NEW_ARRAY(double, j);
    o->threshold = NEW_ARRAY(double, k);
    o->effect = NEW_ARRAY(double, k);
    o->conducts = NEW_ARRAY(bool, k);
    o->leaks = NEW_ARRAY(double, k);
    o->slope = NEW_ARRAY(double, o->length);
    o->scale = NEW_ARRAY(double, o->length);
    o->seen = NEW_ARRAY(double, j);
    o->seen_at = NEW_ARRAY(double, j);
    o->onset = NEW_ARRAY(double, j);
    o->acting = NEW_ARRAY(double, j);
    o->rates = NEW_ARRAY(double, 2 * o->length);
    o->element_pulses = NEW_ARRAY(Pulse, k);
    o->source_pulses = NEW_ARRAY(Pulse, j);
    onset_forget(o);
    return o;
}

void onset_free(Onset *o)
{
    if (o == NULL)
        return;
    MEM_FREE(o->at.a, o->at.rate, o->at.bend, o->at.by_source, o->source_at, o->threshold,
             o->effect, o->conducts, o->slope, o->scale, o->leaks, o->seen, o->seen_at, o->onset,
             o->acting, o->rates, o->element_pulses, o->source_pulses, o);
}

void onset_watch(Onset *o, Turns turns, void *context)
{
    if (o == NULL)
        return;
    o->turns = turns;
    o->context = context;
}

void onset_leave_open(Onset *o, bool is_open)
{
    if (o != NULL)
        o->is_open = is_open;
}

void onset_forget(Onset *o)
{
    if (o == NULL)
        return;
    memset(o->element_pulses, 0, (size_t)o->elements * sizeof(Pulse));
    memset(o->source_pulses, 0, (size_t)o->sources * sizeof(Pulse));
    for (int j = 0; j < o->sources; j++)
        o->onset[j] = NAN;
    o->t = NAN;
    o->clear = -INFINITY;
    o->age = 0;
    o->is_first = true;
}

static void choose_scale(Onset *o, const Stepper *stepper)
{
    const Control *control = &stepper->control;
    const double part = stepper_part(stepper);

    for (int i = 0; i < o->length; i++) {
        double size = fabs(stepper->y[i]);

        if (o->ode->magnitude_bound != NULL && i < o->ode->n)
            size = fmin(size, o->ode->magnitude_bound[i]);
        o->scale[i] = part * (control->atol * ode_nominal(o->ode, i) + control->rtol * size);
    }
}

static void count_visits(Onset *o, Stepper *stepper)
{
    const int64_t visits = stiff_elements_visits(o->stiff_elements);

    stepper->counts.visits += visits - o->visits;
    o->visits = visits;
}

double onset_before_step(Onset *o, Stepper *stepper, double end)
{
    double bound = INFINITY, first = end;

    if (o == NULL)
        return end;
    o->t_before = o->t;
    o->t = stepper->t;
    o->h = fmin(stepper->next > 0 ? stepper->next : end - o->t, end - o->t);
    o->h = fmin(o->h, stepper->method->sees_little ? control_largest(&stepper->control)
                                                   : control_asked(&stepper->control));
    choose_scale(o, stepper);
    if (o->is_first && o->sources > 0)
        stiff_elements_span(o->stiff_elements, o->t, end);
    if (o->elements > 0) {
        onset_take_sources(o, o->t);
        if (stepper->method->sees_little)
            bound = onset_bend_bound(o, end);
        o->h = fmin(o->h, bound);
        o->is_affine = false;
        if (!(o->is_open && stepper->method->solves_dae))
            first = onset_next_conduction(o, stepper, end, &bound);
    }
    if (o->sources > 0)
        first = fmin(first, onset_next_unseen(o, stepper, first));
    bound = fmin(bound, onset_pulse_bound(o->source_pulses, o->sources, o->t));
    stepper->has_pulses = stepper->has_pulses || o->has_pulses;
    stepper->bound = bound < end - o->t ? bound : 0;
    stepper->may_bend = false;
    for (int k = 0; k < o->elements; k++)
        stepper->may_bend = stepper->may_bend || o->conducts[k];
    o->is_first = false;
    count_visits(o, stepper);
    o->planned = fmin(first, o->t + o->h * (1 - 1e-9));
    return first;
}

bool onset_after_step(Onset *o, Stepper *stepper, double *when)
{
    double first;

    if (o == NULL || (o->elements > 0 && o->is_affine && onset_has_conducted(o, stepper, when)))
        return o != NULL;
    /* a step that was tried again, shorter, has looked in other places than foreseen */
    if (o->sources == 0 || !(stepper->t < o->planned))
        return false;
    o->h = stepper->t - o->t;
    first = onset_next_unseen(o, stepper, stepper->t);
    count_visits(o, stepper);
    *when = first;
    return first < stepper->t;
}

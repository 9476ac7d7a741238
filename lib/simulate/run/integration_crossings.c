/* integration_crossings.c: a record of the instants at which equations or states jump */
#include "simulate/run/integration_impl.h"

void crossings_append(Crossings *crossings, const Crossings *more)
{
    for (int i = 0; i < more->list.count; i++)
        LIST_PUSH(crossings->list, more->list.at[i]);
    grid_append(&crossings->states, &more->states);
}

void crossings_free(Crossings *crossings)
{
    LIST_FREE(crossings->list);
    grid_free(&crossings->states);
}

static void add_state(const Integration *m, double t, const double *y)
{
    grid_add(&m->plan->crossings->states, t, m->segment.phase, y, m->length);
}

void integration_open_crossing(Integration *m, CrossingKind kind, int condition, double t,
                               const double *y)
{
    Crossing crossing = {.kind = kind, .before = t, .condition = -1};

    if (m->plan->crossings == NULL || m->is_crossing)
        return;
    if (kind == CROSSING_EVENT)
        crossing.difference = events_difference(m->ev, condition - m->eq->switch_count);
    else if (kind == CROSSING_CONDITION)
        crossing.condition = condition;
    LIST_PUSH(m->plan->crossings->list, crossing);
    add_state(m, t, y);
    m->is_crossing = true;
}

Crossing *integration_crossing(const Integration *m)
{
    return m->is_crossing ? &m->plan->crossings->list.at[m->plan->crossings->list.count - 1] : NULL;
}

void integration_close_crossing(Integration *m)
{
    if (!m->is_crossing)
        return;
    integration_crossing(m)->after = fmax(m->stepper->t, m->low);
    add_state(m, m->stepper->t, m->stepper->y);
    m->is_crossing = false;
}

/* integration_events.c: events of the model in a forward run */
#include "simulate/run/integration_impl.h"

#include <math.h>
#include <string.h>

#define EVENT_NOISE 1e-13 /* of a condition's largest value: values below have no reliable sign */

/* a row at an event's instant, unless there is one */
static Status add_instant(Integration *m, double t, bool again, Diag *diag)
{
    if (!again && integration_has_row(m, t))
        return OK;
    if (again && m->eq->slide_count > 0) { /* a new speed may leave what is slid along */
        integration_add_new_row(m, t);
        return OK;
    }
    if (!integration_add_row(m, t))
        return solver_failure(diag, t, "the constraints can't be met");
    return OK;
}

Status integration_take_events(Integration *m, double t, int *sides, bool *changed, Diag *diag)
{
    double span = m->plan->to - m->plan->from;
    int first = m->eq->switch_count;

    *changed = false;
    if (events_follow(m->ev, sides)) {
        TRY(add_instant(m, t, false, diag));
        TRY(events_happen(m->ev, t, span, m->y, sides, changed, &m->is_over, diag));
        if (*changed)
            TRY(add_instant(m, t, true, diag));
        if (*changed && integration_crossing(m) != NULL)
            integration_crossing(m)->has_new_values = true;
    }
    m->depths_at = NAN;
    for (int i = first; i < m->count; i++)
        m->mode[i] = sides[i - first];
    integration_evaluate(m, t, m->y);
    for (int i = first; i < m->count; i++)
        if (fabs(m->conditions[i]) <= EVENT_NOISE * m->largest[i])
            m->band[i] = fmax(10 * fabs(m->conditions[i]), EVENT_NOISE * m->largest[i]);
    m->stepper->t = t;
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    return OK;
}

bool integration_matters(Integration *m, int i)
{
    const int *sides = m->mode + m->eq->switch_count;

    m->mode[i] = -m->mode[i];
    if (!events_would_happen(m->ev, sides)) {
        (void)events_follow(m->ev, sides);
        return false;
    }
    m->mode[i] = -m->mode[i];
    return true;
}

Status integration_meet_time(Integration *m, Jump jump, Diag *diag)
{
    int first = m->eq->switch_count;
    int timed = events_time_only(m->ev);
    int *sides = NEW_ARRAY(int, m->count - first);
    double *values = NEW_ARRAY(double, timed);
    bool moved = false;
    bool changed;
    Status status = OK;

    memcpy(sides, m->mode + first, (size_t)(m->count - first) * sizeof(int));
    if (timed > 0)
        events_time_conditions(m->ev, jump.behind, values);
    for (int i = 0; i < timed; i++)
        if (sign_of(values[i]) != 0 && sign_of(values[i]) != sides[i]) {
            sides[i] = sign_of(values[i]);
            moved = true;
        }
    if (moved) {
        memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
        CHECK(integration_take_events(
            m, fmax(m->stepper->t, jump.before + (jump.behind - jump.before) / 2), sides, &changed,
            diag));
    }
done:
    MEM_FREE(values, sides);
    return status;
}

/* sides of all conditions at the current point, (t, m->y), or just after it */
static void find_sides(Integration *m, double t, int *sides)
{
    int timed = events_time_only(m->ev);
    double *values = NEW_ARRAY(double, timed);
    double now = fmax(t, m->low);

    events_time_conditions(m->ev, now, values);
    for (int i = 0; i < timed; i++)
        sides[i] = sign_of(values[i]);
    events_time_conditions(m->ev, nextafter(now, INFINITY), values);
    for (int i = 0; i < timed; i++)
        sides[i] = sides[i] != 0 ? sides[i] : sign_of(values[i]);
    events_settle(m->ev, t, m->plan->to - m->plan->from, m->y, -1, sides);
    integration_evaluate(m, t, m->y);
    for (int i = m->eq->switch_count; i < m->count; i++)
        m->largest[i] = fabs(m->conditions[i]);
    mem_free(values);
}

Status integration_begin_events(Integration *m, Diag *diag)
{
    int *sides = NEW_ARRAY(int, m->count - m->eq->switch_count);
    bool changed;
    Status status = OK;

    m->is_over = events_begin(m->ev, m->plan->from, m->y);
    if (m->is_over)
        goto done;
    find_sides(m, m->plan->from, sides);
    CHECK(integration_take_events(m, m->plan->from, sides, &changed, diag));
done:
    mem_free(sides);
    return status;
}

Status integration_resume_events(Integration *m, bool *changed, Diag *diag)
{
    int *sides = NEW_ARRAY(int, m->count - m->eq->switch_count);
    Status status = OK;

    find_sides(m, m->stepper->t, sides);
    CHECK(integration_take_events(m, m->stepper->t, sides, changed, diag));
done:
    mem_free(sides);
    return status;
}

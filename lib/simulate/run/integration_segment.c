/* integration_segment.c: from one segment of a forward run to the next: the data that belong to its
 * equations, and the change of equations at ideal switches or surfaces */
#include "simulate/run/integration_impl.h"

#include "algebra/linear.h"

#include <math.h>
#include <string.h>

#define REST_RATIO 4  /* norms that count as 0 */
#define ROUNDS     20 /* events and ideal switches that trigger each other at one instant */

/* --- steps --- */

void integration_discard_stepper(Integration *m)
{
    if (m->stepper == NULL)
        return;
    m->earlier.steps += m->stepper->counts.steps;
    m->earlier.rejected += m->stepper->counts.rejected;
    m->earlier.evaluations += m->stepper->counts.evaluations;
    m->earlier.jacobians += m->stepper->counts.jacobians;
    m->earlier.visits += m->stepper->counts.visits;
    if (m->stepper->missed > m->missed) {
        m->missed = m->stepper->missed;
        m->missed_at = m->stepper->missed_at;
    }
    m->stepper->method->destroy(m->stepper);
    m->stepper = NULL;
}

Stepper *integration_new_stepper(Integration *m, const Method *method)
{
    motion_set_drifting(m->segment.motion, method->has_history);
    return method->create(motion_ode(m->segment.motion), &m->control);
}

/* --- segments --- */

/* open the surfaces of the segment, with what is known of them from segments of the same system */
static void open_surfaces(Integration *m)
{
    m->surfaces = 0;
    for (int i = 0; i < m->eq->switch_count; i++)
        if (equations_guard(m->eq, i).surface >= m->surfaces)
            m->surfaces = equations_guard(m->eq, i).surface + 1;
    if (m->reach != NULL)
        return;
    m->reach = NEW_ARRAY(double, m->surfaces);
    m->chatters = NEW_ARRAY(Chatter, m->surfaces);
}

/* open the data that belong to the equations of the segment */
void integration_open_segment(Integration *m, const Segment *segment, double t)
{
    const Equations *in_time = m->plan->in_time;
    int conditions, length;

    m->segment = *segment;
    m->eq = segment->equations;
    m->ev = segment->events;
    m->count = m->eq->switch_count + events_condition_count(m->ev);
    m->length = motion_length(segment->motion);
    conditions = m->count;
    length = m->length;
    /* integration_find_jumps() evaluates the equations of the whole model, which may have more of
     * both */
    if (in_time != NULL && in_time->switch_count + events_condition_count(m->ev) > conditions)
        conditions = in_time->switch_count + events_condition_count(m->ev);
    if (in_time != NULL && in_time->n + in_time->nu + in_time->nx > length)
        length = in_time->n + in_time->nu + in_time->nx;
    m->y = NEW_ARRAY(double, length);
    m->slope = NEW_ARRAY(double, length);
    m->conditions = NEW_ARRAY(double, conditions);
    m->largest = NEW_ARRAY(double, conditions);
    m->band = NEW_ARRAY(double, conditions);
    m->noise = NEW_ARRAY(double, conditions);
    m->rest = NEW_ARRAY(double, conditions);
    m->band_ends = NEW_ARRAY(double, conditions);
    m->depth = NEW_ARRAY(double, conditions);
    m->depth_low = NEW_ARRAY(double, conditions);
    m->depth_high = NEW_ARRAY(double, conditions);
    m->depths_at = NAN;
    m->mode = NEW_ARRAY(int, conditions);
    m->looked_at = NEW_ARRAY(int, conditions);
    for (int i = 0; i < conditions; i++)
        m->band_ends[i] = INFINITY;
    events_hold(m->ev, m->eq, t);
    integration_choose_conditions(m);
    open_surfaces(m);
    if (m->count > 0)
        onset_watch(m->segment.onset, integration_turns, m);
    m->stepper = integration_new_stepper(m, m->out->method);
}

void integration_close_segment(Integration *m)
{
    integration_discard_stepper(m);
    onset_watch(m->segment.onset, NULL, NULL);
    motion_window(m->segment.motion, -INFINITY, INFINITY);
    MEM_FREE(m->y, m->slope, m->conditions, m->largest, m->band, m->noise, m->rest, m->band_ends,
             m->depth, m->depth_low, m->depth_high, m->mode, m->looked_at);
}

static void add_corner(Integration *m, double t, const double *y)
{
    if (m->plan->corners != NULL)
        grid_add(m->plan->corners, t, m->segment.phase, y, m->length);
}

/* Other equations hold from here on, with state y; *changed: events gave it new values. */
static Status enter(Integration *m, const Segment *segment, double t, const double *y,
                    bool *changed, Diag *diag)
{
    const Method *method =
        m->plan->method == NULL && m->out->method->suits_stiff ? segment->stiff : NULL;

    const Method *first = m->plan->method;

    if (method != NULL && m->out->method == m->segment.coupled && segment->coupled != NULL)
        method = segment->coupled;
    if (m->plan->first != NULL)
        TRY(m->plan->first(m->plan->context, segment, t, y, &first, diag));
    if (first != NULL)
        method = first;
    integration_close_segment(m);
    if (method != NULL)
        m->out->method = method;
    integration_open_segment(m, segment, t);
    motion_window(m->segment.motion, m->low, m->high);
    add_corner(m, t, y);
    motion_partition(segment->motion, t, y);
    memcpy(m->y, y, (size_t)m->length * sizeof(double));
    memcpy(m->stepper->y, y, (size_t)m->length * sizeof(double));
    m->stepper->t = t;
    *changed = false;
    /* the mode at the start is found before events are started */
    if (events_have_begun(m->ev))
        TRY(integration_resume_events(m, changed, diag));
    return OK;
}

/* The norm below which a vector counts as at rest where another is: where one stops another may
 * stop with it, and their norms differ by errors. */
static double rest_of_all(const Integration *m)
{
    double most = 0;

    for (int i = 0; i < m->eq->switch_count; i++)
        if (equations_guard(m->eq, i).is_norm)
            most = fmax(most, integration_rest(m, i));
    return REST_RATIO * most;
}

/* How far condition i is from where its surface counts as met; 0 or less: it is met, as beyond a
 * surface that has no other side. */
static double distance_from(const Integration *m, int i)
{
    const Guard guard = equations_guard(m->eq, i);
    const double h = m->conditions[i];

    if (guard.is_norm)
        return h + m->rest[i] - rest_of_all(m);
    return (guard.is_unilateral ? -h : fabs(h)) - integration_on_surface(m, i);
}

/* what is known of the surface that condition i belongs to */
static void meet_surface(Integration *m, int i, Meeting *out)
{
    const Guard guard = equations_guard(m->eq, i);
    const bool settles = guard.is_of_event && events_settle_on(m->ev, guard.surface);
    bool near;

    m->largest[i] = fmax(m->largest[i], fabs(m->conditions[i]));
    near = guard.is_of_event
               ? settles
               : i == m->root || guard.solved || guard.held || distance_from(m, i) <= 0;
    *out = (Meeting){guard.surface, .far = !near, .load = guard.load,
                     .settles = settles || (i == m->root && m->chatters[guard.surface].settles),
                     .rest = guard.is_norm ? integration_rest(m, i) : 0};
    if (!near)
        out->side = guard.is_norm || (m->conditions[i] > 0 && !guard.is_of_event) ? 1 : -1;
}

/* What has a load takes part with the surface of that, whatever its own rate is, which an impact
 * changes: its side follows from that rate. Without a load either side is the same. */
static void join_loads(Meeting *at, int count)
{
    for (int i = 0; i < count; i++) {
        bool is_loaded = false;

        if (at[i].load == 0)
            continue;
        for (int k = 0; k < count; k++)
            is_loaded = is_loaded || (at[k].surface == at[i].load - 1 && !at[k].far);
        if (at[i].far || !is_loaded)
            at[i].side = !is_loaded;
        at[i].far = !is_loaded;
    }
}

/* The surfaces that the run is on, and all others, so that no step evaluates the other side of one.
 * `on`: whether the segment is on a side of any. */
static int find_meetings(Integration *m, Meeting *at, bool *on)
{
    int count = 0;

    *on = false;
    integration_evaluate(m, m->stepper->t, m->stepper->y);
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.waits)
            at[count++] = (Meeting){guard.surface, 1, .far = true, .load = guard.load,
                                    .rest = guard.is_norm ? integration_rest(m, i) : 0};
        if (guard.surface < 0 || guard.is_idle)
            continue;
        *on = *on || guard.side != 0 || guard.end != 0;
        if (guard.end < 0) { /* with the other end, just before it */
            if (i == m->root)
                at[count - 1] = (Meeting){guard.surface, .side = -1, .ends = true};
        } else if (guard.end > 0) {
            at[count++] = (Meeting){guard.surface, i == m->root ? 1 : 0, .ends = i == m->root,
                                    .rest = guard.is_norm ? integration_rest(m, i) : 0};
        } else {
            meet_surface(m, i, &at[count++]);
        }
    }
    join_loads(at, count);
    return count;
}

/* what is near a unilateral surface after an impact is measured by the motion from there on */
static void forget_reach(Integration *m)
{
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (!guard.is_unilateral || guard.is_idle)
            continue;
        m->largest[i] = fabs(m->conditions[i]);
        m->reach[guard.surface] = 0;
    }
}

/* y after an impact, with a row before it and one after it */
static void take_impact(Integration *m, double t, const double *y)
{
    const size_t bytes = (size_t)m->length * sizeof(double);

    if (!integration_has_row(m, t)) {
        memcpy(m->y, m->stepper->y, bytes);
        integration_add_new_row(m, t);
    }
    memcpy(m->stepper->y, y, bytes);
    memcpy(m->y, y, bytes);
    integration_add_new_row(m, t);
}

static Status slide(Integration *m, bool *entered, bool *changed, Diag *diag)
{
    Meeting *at = NEW_ARRAY(Meeting, m->eq->switch_count);
    double *y = NEW_ARRAY(double, m->length);
    double t = m->stepper->t;
    Segment next = m->segment;
    bool on = false;
    int count = m->root != ROOT_NONE ? find_meetings(m, at, &on) : 0;
    SurfaceChoice chosen = {0};
    Status status = OK;

    *entered = *changed = false;
    if (m->plan->choose == NULL || m->root == ROOT_NONE || (count == 0 && !on))
        goto done;
    memcpy(y, m->stepper->y, (size_t)m->length * sizeof(double));
    integration_reach(m); /* the guards are those of the segment until another one is chosen */
    CHECK(
        m->plan->choose(m->plan->context, t, m->low, m->high, y, at, count, &next, &chosen, diag));
    *entered = chosen.entered;
    if (chosen.jumps && integration_crossing(m) != NULL)
        integration_crossing(m)->has_impact = true;
    if (chosen.jumps) {
        forget_reach(m);
        take_impact(m, t, y);
    }
    if (*entered)
        CHECK(enter(m, &next, t, y, changed, diag));
    else
        events_hold(m->ev, m->eq, t); /* where it settled, it is led away from there */
    if (!*entered && chosen.moved)
        memcpy(m->stepper->y, y, (size_t)m->length * sizeof(double));
    integration_enter_row(m);
    motion_window(m->segment.motion, m->low, m->high);
    if (*entered)
        (void)motion_project(m->segment.motion, t, m->stepper->y);
done:
    MEM_FREE(at, y);
    return status;
}

/* choose the segment that continues from the stepper's state: another one where that is on
 * surfaces */
Status integration_settle_surfaces(Integration *m, bool *entered, Diag *diag)
{
    bool changed = m->surfaces > 0;

    for (int round = 0; changed && !m->is_over; round++) {
        bool slides;

        if (round == ROUNDS)
            TRY(solver_failure(diag, m->stepper->t,
                               "events and discontinuities set each other off"));
        TRY(slide(m, &slides, &changed, diag));
        *entered = *entered || slides;
        m->root = ROOT_ANY;
    }
    return OK;
}

Status integration_go_on(Integration *m, double t, const double *y, bool *entered, Diag *diag)
{
    const IntegrationPlan *plan = m->plan;
    bool changed = plan->mode_switch != NULL;
    const Nearness near = {
        .last = m->stepper->t > m->stepper->before ? m->stepper->t - m->stepper->before : 0,
        .ahead = m->ahead};
    Status status = OK;

    *entered = false;
    memmove(m->y, y, (size_t)m->length * sizeof(double));
    for (int round = 0; changed && !m->is_over; round++) {
        const double *behind = NULL;
        Segment next = m->segment;

        if (round == ROUNDS)
            CHECK(solver_failure(diag, t, "events and ideal switches set each other off"));
        CHECK(
            plan->mode_switch(plan->context, t, fmax(t, m->low), near, m->y, &next, &behind, diag));
        if (behind == NULL)
            break;
        add_corner(m, t, m->y);
        *entered = true;
        MEM_FREE(m->reach, m->chatters);
        m->reach = NULL;
        m->chatters = NULL;
        CHECK(enter(m, &next, t, behind, &changed, diag));
        m->root = ROOT_ANY; /* what stuck on the last mode's surfaces is on its own */
        memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    }
    motion_window(m->segment.motion, m->low, m->high);
    m->stepper->t = t;
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    CHECK(integration_settle_surfaces(m, entered, diag));
    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    m->stepper->has_pulses = m->stepper->has_pulses || m->has_restarted;
    m->has_restarted = true;
    CHECK(m->stepper->method->start(m->stepper, t, m->y, diag));
    m->after_event = *entered && !m->stepper->method->has_history;
    if (m->after_event)
        m->stepper->next = m->initial_step;
    m->needs_restart = false;
    onset_forget(m->segment.onset);
    if (*entered)
        integration_begin_modes(m);
done:
    m->root = ROOT_ANY;
    m->ahead = 0;
    return status;
}

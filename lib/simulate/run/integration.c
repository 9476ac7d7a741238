/* integration.c: the loop of a forward run: rows, steps, segments */
#include "simulate/run/integration_impl.h"

#include <math.h>
#include <string.h>

#define MANY         100 /* tolerances: a larger error of fixed steps is reported */
#define MOST_RESCANS 10  /* times that a step is searched again for the first event in it */
#define CAREFUL      0.5 /* of the step that the last switch allowed: the first step */

/* Change the method: the current one has found that stability or rounding limits its steps, or
 * can't continue. */
static Status hand_over(Integration *m, const Method *method, RemarkKind why, Diag *diag)
{
    const double t = m->stepper->t, next = m->stepper->next;

    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    remarks_add(&m->out->remarks, (Remark){.kind = why, .t = t, .what = method->name});
    integration_discard_stepper(m);
    m->stepper = integration_new_stepper(m, method);
    m->out->method = method;
    TRY(method->start(m->stepper, t, m->y, diag));
    if (why == REMARK_STIFF)
        m->stepper->next = next; /* until the next jump this is the best estimate */
    return OK;
}

/* number of steps to the end of the run if all were as long as the next one; 0: not known */
static double steps_ahead(const Integration *m)
{
    return m->stepper->next > 0 ? (m->plan->to - m->stepper->t) / m->stepper->next : 0;
}

/* Choose rows and independent speeds anew. Accelerations don't change, so a stepper needs no
 * restart, except where multipliers of rows are among its unknowns. */
static Status renew(Integration *m, Diag *diag)
{
    Stepper *s = m->stepper;
    const Renewed renewed = motion_renew(m->segment.motion, s->t, s->y);

    if (renewed.independent)
        remarks_add(&m->out->remarks, (Remark){.kind = REMARK_INDEPENDENT_ANEW, .t = s->t});
    TRY(motion_try_coordinate_partitioning(m->segment.motion, steps_ahead(m), diag));
    if (!renewed.rows || !s->method->solves_dae)
        return OK;
    memcpy(m->y, s->y, (size_t)m->length * sizeof(double));
    return s->method->start(s, s->t, m->y, diag);
}

/* When the stepper can't continue, the run ends with the cause. Exceptions apply if the user named
 * no method. Where large terms of stiff equations cancel, rates have large rounding errors, which
 * an explicit method takes for its own; a method for stiff equations damps them. Unknowns of a
 * network that its states hardly determine need to be solved for together with them. */
static Status end_or_hand_over(Integration *m, bool is_rounding, Diag *diag)
{
    const Method *coupled = m->segment.coupled;

    if (m->plan->method == NULL && coupled != NULL && m->out->method != coupled)
        return hand_over(m, coupled, REMARK_COUPLED, diag);
    if (m->plan->explain != NULL)
        m->plan->explain(m->plan->context, &m->segment, m->stepper, &is_rounding, diag);
    return is_rounding && m->plan->method == NULL && !m->out->method->suits_stiff
               ? hand_over(m, m->segment.stiff, REMARK_ROUNDING, diag)
               : E_SOLVER;
}

static Status take_step(Integration *m, double end, Diag *diag)
{
    end = onset_before_step(m->segment.onset, m->stepper, integration_end_of_step(m, end));
    m->stepper->is_read = integration_state_conditions(m) > 0;
    return m->stepper->method->step(m->stepper, end, diag);
}

/* a step that passes over no short pulse */
static Status seeing_step(Integration *m, double end, Diag *diag)
{
    double when = 0, last = m->stepper->t;
    Diag ignored = {0};
    Status status = OK;

    if (m->needs_restart) { /* after rows and conditions have been interpolated from its history */
        m->needs_restart = false;
        memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
        CHECK(m->stepper->method->start(m->stepper, last, m->y, diag));
    }
    while ((status = take_step(m, end, diag)) == E_SOLVER)
        CHECK(end_or_hand_over(m, false, diag));
    CHECK(status);
    if (!(m->stepper->t > last) || !onset_after_step(m->segment.onset, m->stepper, &when))
        return OK;
    /* where it can't be shortened it is accepted: its end is after the pulse */
    if (m->stepper->method->shorten(m->stepper, when, &ignored) != OK)
        return OK;
    m->needs_restart = m->stepper->method->has_history;
done:
    return status;
}

/* The motion after a switch is similar each time: the step that was possible after one determines
 * the first step after the next. */
static void learn_beginning(Integration *m)
{
    if (m->after_event && m->plan->mode_switch != NULL)
        m->initial_step = CAREFUL * m->stepper->next;
    m->after_event = false;
}

static Status check_stagnation(Integration *m, Diag *diag)
{
    const int64_t steps = m->earlier.steps + m->stepper->counts.steps;
    bool is_rounding;
    Status status = stagnation_check(&m->stagnation, m->stepper, steps, &is_rounding, diag);

    return status == E_SOLVER ? end_or_hand_over(m, is_rounding, diag) : status;
}

static Status one_step(Integration *m, double end, Diag *diag)
{
    double when = 0;
    int rescan_count = 0;

    TRY(seeing_step(m, end, diag));
    learn_beginning(m);
    m->scanned = m->stepper->before;
    while (integration_state_conditions(m) > 0) {
        int i = integration_find_switch(m, &when);

        if (i < 0)
            break;
        if (integration_is_of_event(m, i) && !integration_matters(m, i)) {
            m->scanned = when;
            m->band[i] = m->noise[i];
            continue;
        }
        bool again = rescan_count++ < MOST_RESCANS;

        TRY(integration_is_of_event(m, i) ? integration_meet_event(m, i, when, &again, diag)
                                          : integration_meet_switch(m, i, when, &again, diag));
        if (!again)
            return OK;
    }
    TRY(integration_add_rows(m, diag));
    TRY(check_stagnation(m, diag));
    TRY(renew(m, diag));
    if (m->plan->method == NULL && m->stepper->found_stiff &&
        (m->segment.stiff->is_a_stable || !m->stepper->is_oscillatory))
        TRY(hand_over(m, m->segment.stiff, REMARK_STIFF, diag));
    return OK;
}

/* --- intervals between jumps --- */

/* from the stepper's time to `end`, with the current signs of conditions in time */
static Status integrate_interval(Integration *m, double end, Diag *diag)
{
    const IntegrationPlan *plan = m->plan;
    double least =
        NEAREST_TIME * fabs(end); /* what an event may leave of the way, too short for a step */
    Status status = OK;

    transaction_stop_asking(); /* there are rows to be stored */
    integration_begin_modes(m);
    while (end - m->stepper->t > least && !m->is_over) {
        monitor_report(plan->watch, "simulate",
                       (m->stepper->t - plan->from) / (plan->to - plan->from));
        status =
            monitor_poll(plan->watch) == OK && !m->is_stopped ? one_step(m, end, diag) : E_STOPPED;
        /* a step that is stopped fails with errors of its own */
        if (status != OK && (monitor_poll(plan->watch) != OK || m->is_stopped))
            return diag_set(diag, E_STOPPED, "stopped at t = %.6g s",
                            m->is_stopped ? m->out->reached : m->stepper->t);
        CHECK(status);
        if (plan->pace != NULL)
            pace_wait(plan->pace, m->stepper->t, plan->watch);
    }
    if (!m->is_over)
        m->stepper->t = end;
done:
    return status;
}

/* Take samples of held states at an instant, at the stepper's time: once, whatever else jumps
 * there. A row at that instant has the values before. */
static Status take_samples(Integration *m, double t, Diag *diag)
{
    bool due;

    m->stepper->t = fmax(m->stepper->t, t);
    TRY(integration_add_rows_before(m, diag));
    if (integration_crossing(m) != NULL)
        integration_crossing(m)->has_samples = true;
    return samples_read(m->segment.samples, t, m->stepper->y, &due, diag);
}

static Status all_intervals(Integration *m, Diag *diag)
{
    const IntegrationPlan *plan = m->plan;
    bool entered;

    for (int i = 0; i <= m->jumps.count && !m->is_over; i++) {
        bool last = i == m->jumps.count;
        double end = last ? plan->to : m->jumps.at[i].before;

        m->high = last ? INFINITY : end;
        /* jumps within rounding of each other are one */
        if (end - m->stepper->t > 1e-13 * (plan->to - plan->from)) {
            TRY(integration_go_on(m, m->stepper->t, m->stepper->y, &entered, diag));
            integration_close_crossing(m);
            TRY(integrate_interval(m, fmin(end, plan->to), diag));
        }
        if (!last && !m->is_over) {
            integration_open_crossing(m, CROSSING_TIME, -1, m->stepper->t, m->stepper->y);
            m->low = fmax(m->low, m->jumps.at[i].behind);
            TRY(integration_meet_time(m, m->jumps.at[i], diag));
            if (m->jumps.at[i].samples)
                TRY(take_samples(m, m->jumps.at[i].before, diag));
        }
    }
    return OK;
}

static Status run(Integration *m, const double *start, Diag *diag)
{
    const IntegrationPlan *plan = m->plan;
    bool due = false;

    memcpy(m->y, start, (size_t)m->length * sizeof(double));
    if (!plan->is_sampled)
        TRY(samples_read(m->segment.samples, plan->from, m->y, &due, diag));
    motion_partition(m->segment.motion, plan->from, m->y);
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    m->stepper->t = plan->from;
    TRY(integration_settle_surfaces(m, &due, diag));
    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    if (!plan->skip_first && !integration_add_row(m, plan->from))
        return solver_failure(diag, plan->from, "the start does not meet the constraints");
    if (events_count(m->ev) > 0)
        TRY(integration_begin_events(m, diag));
    TRY(integration_find_jumps(m, diag));
    TRY(all_intervals(m, diag));
    /* a row at the very end, which rounding, or a switch there, has left out */
    if (!m->is_over) {
        if (plan->to - m->stepper->t <= 1e-12 * (plan->to - plan->from))
            m->stepper->t = plan->to;
        TRY(integration_add_rows(m, diag));
    }
    return OK;
}

/* A run that ends before its first output row after the start stores its last state as a row. */
static void keep_reached(Integration *m, int rows_before)
{
    const Stepper *s = m->stepper;
    const int rows = m->grid->count - rows_before;

    if (rows > (m->plan->skip_first ? 0 : 1) || m->plan->times != NULL || m->is_stopped ||
        !(s->t > m->plan->from) || integration_has_row(m, s->t))
        return;
    memcpy(m->y, s->y, (size_t)m->length * sizeof(double));
    (void)integration_add_row(m, s->t);
}

Status integrate(const IntegrationPlan *plan, const double *start, Grid *grid,
                 IntegrationReport *out, Diag *diag)
{
    const Method *method = plan->method;
    Integration m = {.plan = plan,
                     .grid = grid,
                     .out = out,
                     .control = plan->control,
                     .stagnation = {.t = plan->from},
                     .low = -INFINITY,
                     .high = INFINITY,
                     .next_row = 1,
                     .rows = plan->times != NULL ? plan->time_count
                                                 : grid_rows(plan->from, plan->to, plan->every),
                     .root = ROOT_ANY,
                     .switched_since = -INFINITY,
                     .slow_since = -INFINITY};
    const int rows_before = grid->count;
    Status status = OK;

    if (plan->first != NULL)
        status = plan->first(plan->context, &plan->segment, plan->from, start, &method, diag);
    if (method == NULL)
        method = method_for((MethodNeed){0});
    *out = (IntegrationReport){
        .method = method, .reached = plan->from, .events = plan->segment.events};
    TRY(status);
    if (method->has_fixed_step && !(m.control.step > 0))
        m.control.step = plan->every;
    m.control.span = plan->span > 0 ? plan->span : plan->to - plan->from;
    integration_open_segment(&m, &plan->segment, plan->from);
    status = run(&m, start, diag);
    integration_close_crossing(&m);
    if (status == E_STOPPED || status == E_SOLVER)
        keep_reached(&m, rows_before);
    integration_close_segment(&m);
    if (m.missed > (plan->asks ? 1 : MANY))
        remarks_add(&out->remarks, (Remark){.kind = REMARK_STEP_TOO_LONG,
                                            .what = method->name,
                                            .t = m.missed_at,
                                            .size = m.missed});
    out->counts = m.earlier;
    out->events = m.ev;
    out->jumps = m.jumps;
    MEM_FREE(m.reach, m.chatters);
    return status;
}

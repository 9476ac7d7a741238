/* march.c: the loop of a forward run: rows, steps, legs */
#include "simulate/run/march_impl.h"

#include "algebra/linear.h"

#include <math.h>
#include <string.h>

#define MANY   100 /* tolerances that an estimated error has to miss to be told */
#define ROUNDS 20  /* events and ideal switches that set each other off at one instant */

/* --- rows --- */

bool march_add_row(March *m, double t)
{
    double position = 0, velocity = 0;

    if (!motion_project(m->leg.motion, t, m->y))
        return false;
    motion_residuals(m->leg.motion, t, m->y, &position, &velocity);
    m->out->position_residual = fmax(m->out->position_residual, position);
    m->out->velocity_residual = fmax(m->out->velocity_residual, velocity);
    grid_add(m->grid, t, m->leg.phase, m->y, m->length);
    m->out->reached = t;
    return true;
}

bool march_has_row(const March *m, double t)
{
    const Grid *grid = m->grid;

    return grid->count > 0 && t - grid->times[grid->count - 1] <= 1e-12 * m->plan->every;
}

static Status add_rows_to(March *m, double end, Diag *diag)
{
    const MarchPlan *plan = m->plan;

    for (; m->next_row <= m->rows; m->next_row++) {
        double t = plan->times != NULL ? plan->times[m->next_row - 1]
                                       : grid_time(plan->from, plan->to, plan->every, m->next_row);

        if (t > end)
            break;
        if (march_has_row(m, t))
            continue; /* an event's instant */
        m->stepper->method->at(m->stepper, t, m->y);
        if (!march_add_row(m, t))
            return solver_failure(diag, t, "the constraints can't be met");
    }
    return OK;
}

Status march_add_rows(March *m, Diag *diag)
{
    return add_rows_to(m, m->stepper->t, diag);
}

Status march_cut(March *m, double t, Diag *diag)
{
    Status status = OK;

    CHECK(add_rows_to(m, t, diag)); /* while the interpolant has its end */
    m->stepper->method->at(m->stepper, t, m->y);
    if (!motion_project(m->leg.motion, t, m->y))
        CHECK(solver_failure(diag, t, "the constraints can't be met"));
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    m->stepper->t = t;
done:
    return status;
}

/* --- steps --- */

static void give_up_stepper(March *m)
{
    if (m->stepper == NULL)
        return;
    m->earlier.steps += m->stepper->counts.steps;
    m->earlier.rejected += m->stepper->counts.rejected;
    m->earlier.evaluations += m->stepper->counts.evaluations;
    m->earlier.jacobians += m->stepper->counts.jacobians;
    if (m->stepper->missed > m->missed) {
        m->missed = m->stepper->missed;
        m->missed_at = m->stepper->missed_at;
    }
    m->stepper->method->destroy(m->stepper);
    m->stepper = NULL;
}

static Stepper *new_stepper(March *m, const Method *method)
{
    return method->create(motion_ode(m->leg.motion), &m->control);
}

/* The explicit method has found that stability limits its steps. */
static Status hand_over(March *m, Diag *diag)
{
    const Method *stiff = m->leg.stiff;
    double t = m->stepper->t;

    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    m->control.first = m->stepper->next;
    text_addf(&m->out->remarks, "stiff from t = %.6g s: went on with %s\n", t, stiff->name);
    give_up_stepper(m);
    m->stepper = new_stepper(m, stiff);
    m->out->method = stiff;
    return stiff->start(m->stepper, t, m->y, diag);
}

/* The accelerations stay the same, so that a stepper needn't know, except where multipliers of rows
 * are among its unknowns. */
static Status renew(March *m, Diag *diag)
{
    Stepper *s = m->stepper;
    const Renewed renewed = motion_renew(m->leg.motion, s->t, s->y);

    if (renewed.independent)
        text_addf(&m->out->remarks, "independent coordinates chosen anew at t = %.6g s\n", s->t);
    if (!renewed.rows || !s->method->solves_dae)
        return OK;
    memcpy(m->y, s->y, (size_t)m->length * sizeof(double));
    return s->method->start(s, s->t, m->y, diag);
}

/* with the cause, where the stepper gets no further */
static Status explained(March *m, Status status, Diag *diag)
{
    if (status == E_SOLVER && m->plan->explain != NULL)
        m->plan->explain(m->plan->context, &m->leg, m->stepper, diag);
    return status;
}

/* a step that passes over nothing that acts for a short time */
static Status seeing_step(March *m, double end, Diag *diag)
{
    const Method *method = m->stepper->method;
    double when = 0, last = m->stepper->t;
    Diag ignored = {0};
    Status status = OK;

    if (m->is_taken_back) { /* once rows and conditions have been read from its history */
        m->is_taken_back = false;
        memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
        CHECK(method->start(m->stepper, last, m->y, diag));
    }
    CHECK(explained(
        m, method->step(m->stepper, onset_before_step(m->leg.onset, m->stepper, end), diag), diag));
    if (!(m->stepper->t > last) || !onset_after_step(m->leg.onset, m->stepper, &when))
        return OK;
    /* where it can't be taken back it stays: what it passed over it has seen the end of */
    if (method->shorten(m->stepper, when, &ignored) != OK)
        return OK;
    m->is_taken_back = method->has_history;
done:
    return status;
}

static Status one_step(March *m, double end, Diag *diag)
{
    Status status = OK;
    double when = 0;

    CHECK(seeing_step(m, end, diag));
    m->scanned = m->stepper->before;
    while (march_state_conditions(m) > 0) {
        int i = march_find_switch(m, &when);

        if (i < 0)
            break;
        if (!march_is_of_event(m, i))
            return march_meet_switch(m, i, when, diag);
        if (march_matters(m, i))
            return march_meet_event(m, i, when, diag);
        m->scanned = when;
        m->band[i] = m->noise[i];
    }
    CHECK(march_add_rows(m, diag));
    status =
        headway_check(&m->headway, m->stepper, m->earlier.steps + m->stepper->counts.steps, diag);
    CHECK(explained(m, status, diag));
    CHECK(renew(m, diag));
    if (m->plan->method == NULL && m->stepper->is_stiff &&
        (m->leg.stiff->is_a_stable || !m->stepper->swings))
        CHECK(hand_over(m, diag));
done:
    return status;
}

/* --- legs --- */

/* the surfaces of the leg, with what is known of them from legs of the same system */
static void open_surfaces(March *m)
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

/* what goes with the equations of the leg */
static void open_leg(March *m, const Leg *leg)
{
    const Equations *in_time = m->plan->in_time;
    int conditions, length;

    m->leg = *leg;
    m->eq = leg->equations;
    m->ev = leg->events;
    m->count = m->eq->switch_count + events_condition_count(m->ev);
    m->length = motion_length(leg->motion);
    conditions = m->count;
    length = m->length;
    /* march_find_jumps() asks the equations of the whole, which may have more of both */
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
    m->depth = NEW_ARRAY(double, conditions);
    m->depth_low = NEW_ARRAY(double, conditions);
    m->depth_high = NEW_ARRAY(double, conditions);
    m->mode = NEW_ARRAY(int, conditions);
    open_surfaces(m);
    if (m->count > 0)
        onset_watch(m->leg.onset, march_turns, m);
    m->stepper = new_stepper(m, m->out->method);
}

static void close_leg(March *m)
{
    give_up_stepper(m);
    onset_watch(m->leg.onset, NULL, NULL);
    motion_window(m->leg.motion, -INFINITY, INFINITY);
    mem_free(m->y);
    mem_free(m->slope);
    mem_free(m->conditions);
    mem_free(m->largest);
    mem_free(m->band);
    mem_free(m->noise);
    mem_free(m->depth);
    mem_free(m->depth_low);
    mem_free(m->depth_high);
    mem_free(m->mode);
}

static void add_corner(March *m, double t, const double *y)
{
    if (m->plan->corners != NULL)
        grid_add(m->plan->corners, t, m->leg.phase, y, m->length);
}

Status march_enter(March *m, const Leg *leg, double t, const double *y, bool *changed, Diag *diag)
{
    bool is_stiff = m->plan->method == NULL && m->out->method->is_stiff;
    Status status = OK;

    close_leg(m);
    if (is_stiff)
        m->out->method = leg->stiff;
    open_leg(m, leg);
    motion_window(m->leg.motion, m->low, m->high);
    add_corner(m, t, y);
    motion_partition(leg->motion, t, y);
    memcpy(m->y, y, (size_t)m->length * sizeof(double));
    memcpy(m->stepper->y, y, (size_t)m->length * sizeof(double));
    m->stepper->t = t;
    *changed = false;
    if (events_count(m->ev) > 0)
        CHECK(march_resume_events(m, changed, diag));
done:
    return status;
}

/* the leg that goes on where the stepper stands: not the last one where that is on surfaces */
static Status settle_surfaces(March *m, bool *entered, Diag *diag)
{
    bool changed = m->surfaces > 0;
    Status status = OK;

    for (int round = 0; changed && !m->is_over; round++) {
        bool slides;

        if (round == ROUNDS)
            CHECK(solver_failure(diag, m->stepper->t,
                                 "events and discontinuities set each other off"));
        CHECK(march_slide(m, &slides, &changed, diag));
        *entered = *entered || slides;
        m->root = ROOT_ANY;
    }
done:
    return status;
}

Status march_go_on(March *m, double t, const double *y, bool *entered, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    bool changed = plan->commute != NULL;
    double last = m->stepper->t > m->stepper->before ? m->stepper->t - m->stepper->before : 0;
    Status status = OK;

    *entered = false;
    memmove(m->y, y, (size_t)m->length * sizeof(double));
    for (int round = 0; changed && !m->is_over; round++) {
        const double *behind = NULL;
        Leg next = m->leg;

        if (round == ROUNDS)
            CHECK(solver_failure(diag, t, "events and ideal switches set each other off"));
        CHECK(plan->commute(plan->context, t, fmax(t, m->low), last, m->y, &next, &behind, diag));
        if (behind == NULL)
            break;
        add_corner(m, t, m->y);
        *entered = true;
        mem_free(m->reach);
        mem_free(m->chatters);
        m->reach = NULL;
        CHECK(march_enter(m, &next, t, behind, &changed, diag));
        memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    }
    motion_window(m->leg.motion, m->low, m->high);
    m->stepper->t = t;
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    CHECK(settle_surfaces(m, entered, diag));
    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    CHECK(m->stepper->method->start(m->stepper, t, m->y, diag));
    m->is_taken_back = false;
    onset_forget(m->leg.onset);
    if (*entered)
        march_begin_modes(m);
done:
    m->root = ROOT_ANY;
    return status;
}

/* --- stretches, between jumps --- */

/* from the stepper's time to `end`, conditions in time as they are now */
static Status stretch(March *m, double end, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    double least = 4e-16 * fabs(end); /* what an event may leave of the way, too short for a step */
    Status status = OK;

    march_begin_modes(m);
    while (end - m->stepper->t > least && !m->is_over) {
        report(plan->watch, "simulate", (m->stepper->t - plan->from) / (plan->to - plan->from));
        status = poll(plan->watch) == OK ? one_step(m, end, diag) : E_STOPPED;
        /* a step that is stopped within fails in its own words */
        if (status != OK && poll(plan->watch) != OK)
            return diag_set(diag, E_STOPPED, "stopped at t = %.6g s", m->stepper->t);
        CHECK(status);
    }
    if (!m->is_over)
        m->stepper->t = end;
done:
    return status;
}

/* held states at a sampling instant, where the stepper stands */
static Status take_samples(March *m, double t, Diag *diag)
{
    bool due;

    return samples_take(m->leg.samples, t, m->stepper->y, &due, diag);
}

static Status all_stretches(March *m, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    bool entered;
    Status status = OK;

    for (int i = 0; i <= m->jumps.count && !m->is_over; i++) {
        bool last = i == m->jumps.count;
        double end = last ? plan->to : m->jumps.at[i].before;

        m->high = last ? INFINITY : end;
        /* jumps that rounding alone tells apart are one */
        if (end - m->stepper->t > 1e-13 * (plan->to - plan->from)) {
            CHECK(march_go_on(m, m->stepper->t, m->stepper->y, &entered, diag));
            CHECK(stretch(m, fmin(end, plan->to), diag));
        }
        if (!last && !m->is_over) {
            m->low = fmax(m->low, m->jumps.at[i].behind);
            CHECK(march_meet_time(m, m->jumps.at[i], diag));
            CHECK(take_samples(m, m->jumps.at[i].before, diag));
        }
    }
done:
    return status;
}

static Status run(March *m, const double *start, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    bool due;
    Status status = OK;

    memcpy(m->y, start, (size_t)m->length * sizeof(double));
    if (!plan->is_sampled)
        CHECK(samples_take(m->leg.samples, plan->from, m->y, &due, diag));
    motion_partition(m->leg.motion, plan->from, m->y);
    memcpy(m->stepper->y, m->y, (size_t)m->length * sizeof(double));
    m->stepper->t = plan->from;
    CHECK(settle_surfaces(m, &due, diag));
    memcpy(m->y, m->stepper->y, (size_t)m->length * sizeof(double));
    if (!plan->skip_first && !march_add_row(m, plan->from))
        return solver_failure(diag, plan->from, "the start does not meet the constraints");
    if (events_count(m->ev) > 0)
        CHECK(march_begin_events(m, diag));
    CHECK(march_find_jumps(m, diag));
    CHECK(all_stretches(m, diag));
    /* a row on the very end that rounding, or a switch on it, left out */
    if (!m->is_over) {
        if (plan->to - m->stepper->t <= 1e-12 * (plan->to - plan->from))
            m->stepper->t = plan->to;
        CHECK(march_add_rows(m, diag));
    }
done:
    return status;
}

Status march(const MarchPlan *plan, const double *start, Grid *grid, MarchReport *out, Diag *diag)
{
    const Method *method = plan->method != NULL ? plan->method : method_for((MethodNeed){0});
    March m = {.plan = plan,
               .grid = grid,
               .out = out,
               .control = plan->control,
               .headway = {.t = plan->from},
               .low = -INFINITY,
               .high = INFINITY,
               .next_row = 1,
               .rows = plan->times != NULL ? plan->time_count
                                           : grid_rows(plan->from, plan->to, plan->every),
               .root = ROOT_ANY,
               .switched_since = -INFINITY};
    Status status;

    if (method->has_fixed_step && !(m.control.step > 0))
        m.control.step = plan->every;
    m.control.span = plan->span > 0 ? plan->span : plan->to - plan->from;
    *out = (MarchReport){.method = method, .reached = plan->from};
    open_leg(&m, &plan->leg);
    status = run(&m, start, diag);
    close_leg(&m);
    if (m.missed > (plan->asks ? 1 : MANY))
        text_addf(&out->remarks,
                  "%s controls no error: a step at t = %.6g s may be off by %.2g times the "
                  "tolerance; take a smaller step=, or another method\n",
                  method->name, m.missed_at, m.missed);
    out->counts = m.earlier;
    out->events = m.ev;
    out->jumps = m.jumps;
    mem_free(m.reach);
    mem_free(m.chatters);
    return status;
}

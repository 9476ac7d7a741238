/* march.c: the loop of a forward run */
#include "simulate/march.h"

#include "base/memory.h"
#include "simulate/linear.h"

#include <math.h>
#include <string.h>

#define SAMPLES     20000 /* of the run, at least, where time conditions are looked at */
#define MOST        2000000
#define POINTS      5 /* of a step, where state conditions are looked at */
#define ZENO_EVENTS 100
#define ZENO_SPAN   1e-9  /* of the run */
#define EVENT_NOISE 1e-13 /* of a condition's largest size: too small to tell a side from */

/* between two numbers one behind another (or around one on which the condition is 0) */
typedef struct Jump {
    double before, behind;
} Jump;

typedef struct March {
    const MarchPlan *plan;
    const Equations *eq;
    Events *ev;
    int count; /* conditions: those of the equations, then those of events */
    Grid *grid;
    MarchReport *out;
    Stepper *stepper;
    Control control;
    Counts earlier; /* of steppers given up */
    LIST(Jump) jumps;
    double *y, *slope;            /* one y, one y' */
    double *conditions, *largest; /* values and largest sizes of conditions */
    int *mode;                    /* sign of each condition on this side of its next switch */
    double *band;                 /* sizes too small to tell a sign from, behind a switch */
    int next_row, rows;
    double scanned;        /* of the last step, up to here conditions are followed */
    int switches;          /* close together */
    double switched_since; /* the first of them */
    bool is_over;          /* an event has ended the run */
} March;

void grid_add(Grid *grid, double t, const double *y)
{
    if (grid->count == grid->room) {
        grid->room = grid->room < 256 ? 512 : 2 * grid->room;
        grid->times = mem_grow(grid->times, (size_t)grid->room, sizeof(double));
        grid->states =
            mem_grow(grid->states, (size_t)grid->room, (size_t)grid->length * sizeof(double));
    }
    grid->times[grid->count] = t;
    memcpy(grid->states + (size_t)grid->count * (size_t)grid->length, y,
           (size_t)grid->length * sizeof(double));
    grid->count++;
}

void grid_free(Grid *grid)
{
    mem_free(grid->times);
    mem_free(grid->states);
    *grid = (Grid){.length = grid->length};
}

int grid_rows(double from, double to, double every)
{
    double whole = floor((to - from) / every * (1 + 1e-12) + 1e-9);

    if (from + whole * every >= to - 1e-9 * every)
        return (int)whole;
    return (int)whole + 1; /* the end lies between two multiples */
}

double grid_time(double from, double to, double every, int k)
{
    double t = from + k * every;

    return k >= grid_rows(from, to, every) || t > to ? to : t;
}

/* --- rows --- */

static bool add_row(March *m, double t)
{
    double position = 0, velocity = 0;

    if (!motion_project(m->plan->motion, t, m->y))
        return false;
    motion_residuals(m->plan->motion, t, m->y, &position, &velocity);
    m->out->position_residual = fmax(m->out->position_residual, position);
    m->out->velocity_residual = fmax(m->out->velocity_residual, velocity);
    grid_add(m->grid, t, m->y);
    m->out->reached = t;
    return true;
}

/* whether the last row is at t, as far as rounding lets one tell */
static bool has_row(const March *m, double t)
{
    const Grid *grid = m->grid;

    return grid->count > 0 && t - grid->times[grid->count - 1] <= 1e-12 * m->plan->every;
}

static Status add_rows(March *m, Diag *diag)
{
    const MarchPlan *plan = m->plan;

    for (; m->next_row <= m->rows; m->next_row++) {
        double t = grid_time(plan->from, plan->to, plan->every, m->next_row);

        if (t > m->stepper->t)
            break;
        if (has_row(m, t))
            continue; /* an event's instant */
        m->stepper->method->at(m->stepper, t, m->y);
        if (!add_row(m, t))
            return solver_failure(diag, t, "the constraints can't be met");
    }
    return OK;
}

/* --- conditions --- */

static int sign_of(double v)
{
    return (v > 0) - (v < 0);
}

/* the values of all of them */
static void evaluate(March *m, double t, const double *y)
{
    const Equations *eq = m->eq;

    if (eq->switch_count > 0)
        motion_switches(m->plan->motion, t, y, m->conditions);
    if (m->count > eq->switch_count)
        events_conditions(m->ev, t, y, m->conditions + eq->switch_count);
}

static bool is_of_event(const March *m, int i)
{
    return i >= m->eq->switch_count;
}

static bool is_of_time(const March *m, int i)
{
    return is_of_event(m, i) ? i - m->eq->switch_count < events_time_only(m->ev)
                             : i < m->eq->time_only;
}

static int state_conditions(const March *m)
{
    return m->count - m->eq->time_only - events_time_only(m->ev);
}

/* --- conditions in time alone --- */

static double time_condition(March *m, int i, double t)
{
    if (is_of_event(m, i))
        events_time_conditions(m->ev, t, m->conditions + m->eq->switch_count);
    else
        m->eq->switches(m->eq->context, t, m->y, m->y + m->eq->n, m->y + m->eq->n + m->eq->nu,
                        m->conditions);
    return m->conditions[i];
}

/* the first number in (low, high] at which the sign isn't `sign` any more, as a jump */
static Jump narrow(March *m, int i, int sign, double low, double high)
{
    Jump jump;

    for (;;) {
        double middle = low + (high - low) / 2;

        if (middle <= low || middle >= high)
            break;
        if (sign_of(time_condition(m, i, middle)) == sign)
            low = middle;
        else
            high = middle;
    }
    jump = (Jump){low, high};
    /* a comparison may hold or fail on the zero itself: step over it */
    if (time_condition(m, i, high) == 0 && time_condition(m, i, nextafter(high, INFINITY)) != 0)
        jump.behind = nextafter(high, INFINITY);
    return jump;
}

static void add_jump(March *m, Jump jump)
{
    int at = m->jumps.count;

    LIST_PUSH(m->jumps, jump);
    while (at > 0 && m->jumps.at[at - 1].before > jump.before) {
        m->jumps.at[at] = m->jumps.at[at - 1];
        at--;
    }
    m->jumps.at[at] = jump;
}

static void find_jumps_of(March *m, int i)
{
    double from = m->plan->from, to = m->plan->to;
    int samples = (int)fmin(MOST, fmax(SAMPLES, 16 * (to - from) / m->plan->every));
    int sign = sign_of(time_condition(m, i, from));
    double last = from;

    if (sign == 0) { /* a switch at the start lies behind us */
        double behind = nextafter(from, INFINITY);

        sign = sign_of(time_condition(m, i, behind));
        if (sign != 0)
            add_jump(m, (Jump){from, behind});
    }
    for (int k = 1; k <= samples; k++) {
        double t = k == samples ? to : from + (to - from) * k / samples;
        int now = sign_of(time_condition(m, i, t));

        if (now != sign) {
            Jump jump = narrow(m, i, sign, last, t);

            add_jump(m, jump);
            sign = sign_of(time_condition(m, i, jump.behind));
            last = jump.behind;
            if (now != sign && last < t)
                k--; /* there was more than one between the samples */
            continue;
        }
        last = t;
    }
}

static void find_jumps(March *m)
{
    double t = samples_next(m->plan->samples, m->plan->from);

    while (t < m->plan->to) {
        add_jump(m, (Jump){t, t});
        t = samples_next(m->plan->samples, t);
    }
    for (int i = 0; i < m->count; i++)
        if (is_of_time(m, i))
            find_jumps_of(m, i);
}

/* --- conditions in the state --- */

static void conditions_at(March *m, double t)
{
    m->stepper->method->at(m->stepper, t, m->y);
    evaluate(m, t, m->y);
}

/* those of events go on as they are */
static void begin_modes(March *m)
{
    if (m->eq->switch_count == m->eq->time_only)
        return;
    conditions_at(m, m->stepper->t);
    for (int i = m->eq->time_only; i < m->eq->switch_count; i++) {
        m->mode[i] = sign_of(m->conditions[i]);
        m->largest[i] = fabs(m->conditions[i]);
        m->band[i] = 0;
    }
}

/* whether condition i, as evaluated last, has left its mode; learns a mode not known yet */
static bool has_switched(March *m, int i)
{
    double value = m->conditions[i];

    m->largest[i] = fmax(m->largest[i], fabs(value));
    if (!(fabs(value) > m->band[i]))
        return false;
    m->band[i] = 0;
    if (m->mode[i] == 0) /* what had no value till now becomes what it is */
        m->mode[i] = is_of_event(m, i) ? -sign_of(value) : sign_of(value);
    return sign_of(value) != m->mode[i] && value != 0;
}

/* The first switch in the last step that isn't followed yet: its condition, and a time just behind
 * it; -1: none. */
static int find_switch(March *m, double *when)
{
    double low = m->scanned, high = m->stepper->t;
    int found = -1;

    for (int k = 1; k <= POINTS && found < 0; k++) {
        double t = k == POINTS
                       ? m->stepper->t
                       : m->stepper->before + (m->stepper->t - m->stepper->before) * k / POINTS;

        if (t < m->scanned)
            continue;
        conditions_at(m, t);
        for (int i = 0; i < m->count; i++)
            if (!is_of_time(m, i) && has_switched(m, i) && found < 0)
                found = i;
        if (found < 0)
            low = t;
        else
            high = t;
    }
    if (found < 0)
        return -1;
    for (int i = 0; i < 100 && high - low > 4e-16 * fmax(fabs(high), 1e-300); i++) {
        double middle = low + (high - low) / 2;
        bool switched = false;

        conditions_at(m, middle);
        for (int k = 0; k < m->count; k++)
            if (!is_of_time(m, k) && m->conditions[k] != 0 && m->mode[k] != 0 &&
                sign_of(m->conditions[k]) != m->mode[k] && fabs(m->conditions[k]) > m->band[k]) {
                switched = true;
                found = k;
            }
        if (switched)
            high = middle;
        else
            low = middle;
    }
    *when = high;
    return found;
}

/* g of condition i at the stepper's end, and how fast it changes along the motion */
static double condition_rate(March *m, int i, double *value)
{
    const Ode *ode = motion_ode(m->plan->motion);
    const Stepper *s = m->stepper;
    double h = 1e-7 * fmax(1e-3, s->t - s->before);

    conditions_at(m, s->t);
    *value = m->conditions[i];
    if (!ode->rate(ode->context, s->t, s->y, m->slope))
        return 0;
    for (int k = 0; k < m->grid->length; k++)
        m->y[k] = s->y[k] + h * m->slope[k];
    evaluate(m, s->t + h, m->y);
    return (m->conditions[i] - *value) / h;
}

/* Take the last step again until it ends just before the switch, so that none of its stages has
 * seen what is behind: Newton's method on the length of the step. */
static Status approach(March *m, int i, double when, double *value, double *slope, Diag *diag)
{
    double aim = 1e-13 * m->largest[i] * m->mode[i];
    double before = m->stepper->before, end = m->stepper->t;
    Status status = OK;

    for (int k = 0; k < 12; k++) {
        CHECK(m->stepper->method->shorten(m->stepper, when, diag));
        *slope = condition_rate(m, i, value);
        if (*value * m->mode[i] > 0 && fabs(*value) <= 1e-11 * m->largest[i])
            break;
        if (*slope * m->mode[i] >= 0)
            break; /* a grazing contact: no clean root */
        when = fmin(end, fmax(before + 1e-3 * (when - before), when - (*value - aim) / *slope));
    }
done:
    return status;
}

/* From just before a switch to just behind it: so short a way that Euler's rule is exact. */
static bool cross(March *m, int i, double value, double slope)
{
    Stepper *s = m->stepper;
    double h = fmax(4e-16 * fabs(s->t), 2 * fabs(value / slope));

    for (int k = 0; k < 20; k++, h *= 2) {
        for (int j = 0; j < m->grid->length; j++)
            m->y[j] = s->y[j] + h * m->slope[j];
        evaluate(m, s->t + h, m->y);
        if (sign_of(m->conditions[i]) == -m->mode[i]) {
            memcpy(s->y, m->y, (size_t)m->grid->length * sizeof(double));
            s->t += h;
            return true;
        }
    }
    return false;
}

/* Switches that come without a pause end the run; i is the condition that did. */
static Status check_pace(March *m, int i, Diag *diag)
{
    double span = m->plan->to - m->plan->from;

    if (m->stepper->t - m->switched_since > ZENO_SPAN * span) {
        m->switched_since = m->stepper->t;
        m->switches = 0;
    }
    if (++m->switches <= ZENO_EVENTS)
        return OK;
    if (is_of_event(m, i))
        return events_are_stuck(m->ev, i - m->eq->switch_count, m->stepper->t, diag);
    return solver_failure(diag, m->stepper->t,
                          "a condition in the equations switches to and fro without end");
}

/* End the last step at the switch, cross it, and start anew behind it. */
static Status meet_switch(March *m, int i, double when, Diag *diag)
{
    double value = 0, slope = 0;
    Status status = OK;

    /* a switch on the very start of the step can't be told from the one just met */
    if (when > m->stepper->before) {
        CHECK(approach(m, i, when, &value, &slope, diag));
        CHECK(add_rows(m, diag));
        if (slope * m->mode[i] < 0 && value * m->mode[i] > 0)
            (void)cross(m, i, value, slope);
    }
    conditions_at(m, m->stepper->t);
    m->band[i] = fmax(10 * fabs(m->conditions[i]), 1e-10 * m->largest[i]);
    m->mode[i] = -m->mode[i];
    CHECK(check_pace(m, i, diag));
    CHECK(m->stepper->method->start(m->stepper, m->stepper->t, m->stepper->y, diag));
done:
    return status;
}

/* --- events --- */

/* a row at an event's instant, unless there is one */
static Status add_instant(March *m, double t, bool again, Diag *diag)
{
    if (!again && has_row(m, t))
        return OK;
    if (!add_row(m, t))
        return solver_failure(diag, t, "the constraints can't be met");
    return OK;
}

/* What comes of the sides that events' conditions have now, at t and y; the stepper is brought
 * there, to be started anew. */
static Status take_events(March *m, double t, int *sides, Diag *diag)
{
    double span = m->plan->to - m->plan->from;
    int first = m->eq->switch_count;
    bool changed = false;
    Status status = OK;

    if (events_follow(m->ev, sides)) {
        CHECK(add_instant(m, t, false, diag));
        CHECK(events_happen(m->ev, t, span, m->y, sides, &changed, &m->is_over, diag));
        if (changed)
            CHECK(add_instant(m, t, true, diag));
    }
    for (int i = first; i < m->count; i++)
        m->mode[i] = sides[i - first];
    evaluate(m, t, m->y);
    for (int i = first; i < m->count; i++)
        if (fabs(m->conditions[i]) <= EVENT_NOISE * m->largest[i])
            m->band[i] = fmax(10 * fabs(m->conditions[i]), EVENT_NOISE * m->largest[i]);
    m->stepper->t = t;
    memcpy(m->stepper->y, m->y, (size_t)m->grid->length * sizeof(double));
done:
    return status;
}

/* whether an event becomes true as condition i changes; if not, that is noted and no more */
static bool matters(March *m, int i)
{
    const int *sides = m->mode + m->eq->switch_count;

    m->mode[i] = -m->mode[i];
    if (!events_follow(m->ev, sides))
        return false;
    m->mode[i] = -m->mode[i];
    return true;
}

/* The last step again, until it ends where condition i is zero as near as numbers tell, by Newton's
 * method; m->y and the time there. Where a step can't be as short as that, the interpolant has y.
 */
static double reach_zero(March *m, int i, double when)
{
    const Stepper *s = m->stepper;
    size_t bytes = (size_t)m->grid->length * sizeof(double);
    double before = s->before, end = s->t, t = when;
    double *kept = NEW_ARRAY(double, m->grid->length);
    double value = 0, slope = 0, left = 0;
    Diag ignored;

    for (int k = 0; k < 12 && t > before; k++) {
        s->method->at(m->stepper, t, kept);
        if (s->method->shorten(m->stepper, t, &ignored) != OK) {
            memcpy(m->stepper->y, kept, bytes);
            m->stepper->t = t;
            left = 0;
            break;
        }
        slope = condition_rate(m, i, &value);
        left = slope * m->mode[i] < 0 ? -value / slope : 0; /* else a grazing contact */
        if (fabs(left) <= 4e-16 * fabs(t) || (left > 0 && t + left > end))
            break;
        t = fmax(before + 1e-3 * (t - before), t + left);
    }
    if (t <= before) {
        s->method->at(m->stepper, before, m->y);
        mem_free(kept);
        return before;
    }
    t = s->t;
    memcpy(m->y, s->y, bytes);
    for (int k = 0; k < m->grid->length && fabs(left) <= 1e-3 * (t - before); k++)
        m->y[k] += left * m->slope[k];
    mem_free(kept);
    return fabs(left) <= 1e-3 * (t - before) ? t + left : t;
}

/* End the last step where condition i of an event is zero, and go on from there. */
static Status meet_event(March *m, int i, double when, Diag *diag)
{
    double span = m->plan->to - m->plan->from;
    int first = m->eq->switch_count;
    size_t bytes = (size_t)m->grid->length * sizeof(double);
    int *sides = NEW_ARRAY(int, m->count - first);
    double *y = NEW_ARRAY(double, m->grid->length);
    double t = reach_zero(m, i, when);
    Status status = OK;

    memcpy(y, m->y, bytes);
    m->stepper->t = fmin(m->stepper->t, t);
    CHECK(add_rows(m, diag));
    memcpy(m->y, y, bytes);
    if (!motion_project(m->plan->motion, t, m->y))
        CHECK(solver_failure(diag, t, "the constraints can't be met"));
    memcpy(sides, m->mode + first, (size_t)(m->count - first) * sizeof(int));
    events_settle(m->ev, t, span, m->y, i - first, sides);
    CHECK(take_events(m, t, sides, diag));
    CHECK(check_pace(m, i, diag));
    CHECK(m->stepper->method->start(m->stepper, t, m->y, diag));
done:
    mem_free(sides);
    mem_free(y);
    return status;
}

/* the same where conditions in time alone change, between two stretches */
static Status meet_time(March *m, Jump jump, Diag *diag)
{
    int first = m->eq->switch_count;
    int timed = events_time_only(m->ev);
    int *sides = NEW_ARRAY(int, m->count - first);
    double *values = NEW_ARRAY(double, timed);
    bool moved = false;
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
        memcpy(m->y, m->stepper->y, (size_t)m->grid->length * sizeof(double));
        CHECK(take_events(m, fmax(m->stepper->t, jump.before + (jump.behind - jump.before) / 2),
                          sides, diag));
    }
done:
    mem_free(values);
    mem_free(sides);
    return status;
}

/* conditions at the start, some of which may become true there */
static Status begin_events(March *m, Diag *diag)
{
    double from = m->plan->from;
    int first = m->eq->switch_count;
    int *sides = NEW_ARRAY(int, m->count - first);
    double *values = NEW_ARRAY(double, events_time_only(m->ev));
    Status status = OK;

    m->is_over = events_begin(m->ev, from, m->y);
    if (m->is_over)
        goto done;
    events_time_conditions(m->ev, from, values);
    for (int i = 0; i < events_time_only(m->ev); i++)
        sides[i] = sign_of(values[i]);
    events_time_conditions(m->ev, nextafter(from, INFINITY), values);
    for (int i = 0; i < events_time_only(m->ev); i++)
        sides[i] = sides[i] != 0 ? sides[i] : sign_of(values[i]);
    events_settle(m->ev, from, m->plan->to - from, m->y, -1, sides);
    evaluate(m, from, m->y);
    for (int i = first; i < m->count; i++)
        m->largest[i] = fabs(m->conditions[i]);
    CHECK(take_events(m, from, sides, diag));
done:
    mem_free(values);
    mem_free(sides);
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
    m->stepper->method->destroy(m->stepper);
    m->stepper = NULL;
}

/* The explicit method has found that stability limits its steps. */
static Status hand_over(March *m, Diag *diag)
{
    const Method *stiff = m->plan->stiff;
    double t = m->stepper->t;

    memcpy(m->y, m->stepper->y, (size_t)m->grid->length * sizeof(double));
    m->control.first = m->stepper->next;
    text_addf(&m->out->remarks, "stiff from t = %.6g s: went on with %s\n", t, stiff->name);
    give_up_stepper(m);
    m->stepper = stiff->create(motion_ode(m->plan->motion), &m->control);
    m->out->method = stiff;
    return stiff->start(m->stepper, t, m->y, diag);
}

/* The same accelerations by other independent ones: the integrator needn't know. */
static void repartition(March *m)
{
    const Stepper *s = m->stepper;

    if (!motion_is_worn(m->plan->motion))
        return;
    memcpy(m->y, s->y, (size_t)m->grid->length * sizeof(double));
    if (motion_project(m->plan->motion, s->t, m->y) &&
        motion_repartition(m->plan->motion, s->t, m->y))
        text_addf(&m->out->remarks, "independent coordinates chosen anew at t = %.6g s\n", s->t);
}

static Status one_step(March *m, double end, Diag *diag)
{
    Status status = OK;
    double when = 0;

    CHECK(m->stepper->method->step(m->stepper, end, diag));
    m->scanned = m->stepper->before;
    while (state_conditions(m) > 0) {
        int i = find_switch(m, &when);

        if (i < 0)
            break;
        if (!is_of_event(m, i))
            return meet_switch(m, i, when, diag);
        if (matters(m, i))
            return meet_event(m, i, when, diag);
        m->scanned = when;
    }
    CHECK(add_rows(m, diag));
    repartition(m);
    if (m->plan->method == NULL && m->stepper->is_stiff &&
        !(m->plan->stiff_decays && m->stepper->swings))
        CHECK(hand_over(m, diag));
done:
    return status;
}

/* from the stepper's time to `end`, conditions in time as they are now */
static Status stretch(March *m, double end, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    double least = 4e-16 * fabs(end); /* what an event may leave of the way, too short for a step */
    Status status = OK;

    begin_modes(m);
    while (end - m->stepper->t > least && !m->is_over) {
        if (poll(plan->watch) != OK)
            return diag_set(diag, E_STOPPED, "stopped at t = %.6g s", m->stepper->t);
        report(plan->watch, "simulate", (m->stepper->t - plan->from) / (plan->to - plan->from));
        CHECK(one_step(m, end, diag));
    }
    if (!m->is_over)
        m->stepper->t = end;
done:
    return status;
}

/* held states at a sampling instant, where the stepper stands */
static Status take_samples(March *m, double t, Diag *diag)
{
    bool due = false;
    Status status = OK;

    CHECK(samples_take(m->plan->samples, t, m->stepper->y, &due, diag));
done:
    return status;
}

static Status all_stretches(March *m, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    double low = -INFINITY;
    Status status = OK;

    for (int i = 0; i <= m->jumps.count && !m->is_over; i++) {
        bool last = i == m->jumps.count;
        double end = last ? plan->to : m->jumps.at[i].before;

        motion_window(plan->motion, low, last ? INFINITY : end);
        /* jumps that rounding alone tells apart are one */
        if (end - m->stepper->t > 1e-13 * (plan->to - plan->from)) {
            memcpy(m->y, m->stepper->y, (size_t)m->grid->length * sizeof(double));
            CHECK(m->stepper->method->start(m->stepper, m->stepper->t, m->y, diag));
            CHECK(stretch(m, fmin(end, plan->to), diag));
        }
        if (!last && !m->is_over) {
            low = fmax(low, m->jumps.at[i].behind);
            CHECK(meet_time(m, m->jumps.at[i], diag));
            CHECK(take_samples(m, m->jumps.at[i].before, diag));
        }
    }
done:
    motion_window(plan->motion, -INFINITY, INFINITY);
    return status;
}

static Status run(March *m, const double *start, Diag *diag)
{
    const MarchPlan *plan = m->plan;
    bool due;
    Status status = OK;

    memcpy(m->y, start, (size_t)m->grid->length * sizeof(double));
    CHECK(samples_take(plan->samples, plan->from, m->y, &due, diag));
    (void)motion_repartition(plan->motion, plan->from, m->y);
    if (!plan->skip_first && !add_row(m, plan->from))
        return solver_failure(diag, plan->from, "the start does not meet the constraints");
    memcpy(m->stepper->y, m->y, (size_t)m->grid->length * sizeof(double));
    m->stepper->t = plan->from;
    if (events_count(m->ev) > 0)
        CHECK(begin_events(m, diag));
    find_jumps(m);
    CHECK(all_stretches(m, diag));
    /* a row on the very end that rounding, or a switch on it, left out */
    if (!m->is_over) {
        if (plan->to - m->stepper->t <= 1e-12 * (plan->to - plan->from))
            m->stepper->t = plan->to;
        CHECK(add_rows(m, diag));
    }
done:
    return status;
}

Status march(const MarchPlan *plan, const double *start, Grid *grid, MarchReport *out, Diag *diag)
{
    const Method *method = plan->method != NULL ? plan->method : &method_dop853;
    int conditions = plan->equations->switch_count + events_condition_count(plan->events);
    March m = {.plan = plan,
               .eq = plan->equations,
               .ev = plan->events,
               .count = conditions,
               .grid = grid,
               .out = out,
               .control = plan->control,
               .next_row = 1,
               .rows = grid_rows(plan->from, plan->to, plan->every),
               .switched_since = -INFINITY};
    Status status;

    grid->length = motion_length(plan->motion);
    m.y = NEW_ARRAY(double, grid->length);
    m.slope = NEW_ARRAY(double, grid->length);
    m.conditions = NEW_ARRAY(double, conditions);
    m.largest = NEW_ARRAY(double, conditions);
    m.band = NEW_ARRAY(double, conditions);
    m.mode = NEW_ARRAY(int, conditions);
    if (method == &method_rk4 && !(m.control.step > 0))
        m.control.step = plan->every;
    m.control.span = plan->to - plan->from;
    m.stepper = method->create(motion_ode(plan->motion), &m.control);
    *out = (MarchReport){.method = method, .reached = plan->from};
    status = run(&m, start, diag);
    give_up_stepper(&m);
    out->counts = m.earlier;
    LIST_FREE(m.jumps);
    mem_free(m.y);
    mem_free(m.slope);
    mem_free(m.conditions);
    mem_free(m.largest);
    mem_free(m.band);
    mem_free(m.mode);
    return status;
}

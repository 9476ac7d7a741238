/* integration_meet.c: a step of a forward run ended where a condition of the state is zero, and
 * crossed
 */
#include "simulate/run/integration_impl.h"

#include "algebra/linear.h"

#include <math.h>
#include <string.h>

#define SHORT       1e-3  /* of a step: a move of its end that needn't take it again, */
#define NEXT_TO     1e-12 /* or of the run */
#define WIDER       5     /* times a step that ended where a longer one had erred */
#define CONTRADICTS 1e-3  /* of a condition's largest size: so far off no error leads */
#define PLACES      8     /* of a step, at which a margin is looked at */
#define ZENO_EVENTS 100
#define ZENO_EACH   10   /* of every condition, which all may go over at one instant */
#define ZENO_SPAN   1e-9 /* of the run */
#define SLOW_EVENTS                                                                                \
    5000 /* in a longer part of the run, which would take many minutes at that pace */
#define SLOW_SPAN 1e-5

/* Whether h is short beside the last step or the run, and no state goes further along the slope in
 * it than errors may: where a problem is stiff the slope is steep beside any motion. */
static bool is_short(const Integration *m, double h)
{
    double step = m->stepper->t - m->stepper->before, span = m->plan->to - m->plan->from;

    if (!(fabs(h) <= fmax(SHORT * step, NEXT_TO * span)))
        return false;
    for (int k = 0; k < m->length - 1; k++)
        if (!(fabs(h * m->slope[k]) <=
              10 * (m->control.rtol * fabs(m->stepper->y[k]) + m->control.atol)))
            return false;
    return true;
}

/* Move the stepper's end to t along m->slope; false: that is no short way. */
static bool move_end(Integration *m, double t)
{
    Stepper *s = m->stepper;
    double h = t - s->t;

    if (!is_short(m, h))
        return false;
    for (int k = 0; k < m->length; k++)
        s->y[k] += h * m->slope[k];
    s->t = t;
    return true;
}

/* whether condition i never came clear of its noise on the side it is to be on, in the last step
 * until `when` */
static bool has_no_zero(Integration *m, int i, double when)
{
    const double before = m->stepper->before;

    for (int k = 0; k < PLACES; k++) {
        integration_conditions_at(m, before + (when - before) * k / PLACES);
        if (m->conditions[i] > m->noise[i])
            return false;
    }
    return true;
}

/* How far beyond 0 condition i is met, at about `when`. A margin that began beyond is met where it
 * leaves its band; one that began at 0, as near as noise tells, and turned away from there, where
 * it comes clear of noise: there is no other zero in the step. */
static double met_beyond(Integration *m, int i, double when)
{
    if (!integration_is_margin(m, i))
        return 0;
    if (m->band[i] > m->noise[i])
        return m->band[i];
    return has_no_zero(m, i, when) ? m->noise[i] : 0;
}

/* Repeat the last step, shortened by Newton's method, until it ends just before the zero, so that
 * no stage is evaluated behind it. Behind a margin the equations are the same: there the end may be
 * moved by an Euler step if that is short, but no repeated step is lengthened, since other margins
 * may lie in between. If the method can't shorten the step, it is cut at its interpolated state. */
static Status approach(Integration *m, int i, double when, double *value, double *slope, Diag *diag)
{
    double enough = fmax(1e-11 * m->largest[i], integration_is_margin(m, i) ? m->noise[i] : 0);
    const double band = met_beyond(m, i, when);
    double before = m->stepper->before, end = m->stepper->t;
    Diag ignored = {0};

    for (int k = 0; k < 12; k++) {
        bool moved = k > 0 && integration_is_margin(m, i) && move_end(m, when);
        double inside;

        if (k > 0 && integration_is_margin(m, i) && !moved && when > m->stepper->t)
            break;
        if (!moved && m->stepper->method->shorten(m->stepper, when, &ignored) != OK) {
            *slope = 0;
            TRY(integration_cut(m, when, diag));
            break;
        }
        *slope = integration_condition_rate(m, i, value);
        inside = *value * m->mode[i] + band;
        if (inside > 0 && inside <= enough)
            break;
        if (*slope * m->mode[i] >= 0)
            break; /* a grazing contact: no clean root */
        when -= (inside - 1e-2 * enough) / (*slope * m->mode[i]);
        when = fmin(end, fmax(before + 1e-3 * (m->stepper->t - before), when));
    }
    return OK;
}

/* From just before a switch to just behind it: so short a way that Euler's rule is exact. A slope
 * tells little of a source that has just begun to rise. */
static bool cross(Integration *m, int i, double value, double slope)
{
    Stepper *s = m->stepper;
    double h = fmax(NEAREST_TIME * fabs(s->t), 2 * fabs(value / slope));

    for (int k = 0; k < 20 && is_short(m, h); k++, h *= 2) {
        if (!onset_is_calm(m->segment.onset, s->t, s->t + h))
            break;
        for (int j = 0; j < m->length; j++)
            m->y[j] = s->y[j] + h * m->slope[j];
        integration_evaluate(m, s->t + h, m->y);
        if (sign_of(m->conditions[i]) == -m->mode[i]) {
            memcpy(s->y, m->y, (size_t)m->length * sizeof(double));
            s->t += h;
            return true;
        }
    }
    return false;
}

static void report_condition(const Integration *m, int i, Text *out)
{
    if (m->plan->tell != NULL)
        m->plan->tell(m->plan->context, &m->segment, i, out);
    if (out->at == NULL)
        text_add(out, "a condition in the equations");
}

static Status switches_endlessly(const Integration *m, int i, Diag *diag)
{
    Text what = {0};

    report_condition(m, i, &what);
    (void)diag_set(diag, E_SOLVER, "at t = %.9g s: %s switches to and fro without end",
                   m->stepper->t, what.at);
    if (integration_is_margin(m, i))
        diag_hint(diag, "smaller rtol= and atol= locate its switching more closely");
    else if (m->plan->mode_switch != NULL && equations_guard(m->eq, i).surface < 0)
        diag_hint(diag, "let the switch read what a gain with period= has sampled; or put a source "
                        "of two values in its place, as vsource E a 0 if(L1.i < 2, 12, 0), whose "
                        "mean then holds the condition");
    else if (equations_guard(m->eq, i).is_norm)
        diag_hint(diag,
                  "several parts may hold the same motion there, and which of them does is not "
                  "determined: one friction in their place, or a stiff connection between "
                  "them, has a motion");
    else
        diag_hint(
            diag,
            "a hysteresis, or a steep but continuous law such as tanh(x/0.001) in the place of "
            "sign(x), has a motion there; a smaller rtol=%s may follow swings that fade",
            m->stepper->method->has_history ? ", or method=radau," : "");
    text_free(&what);
    return E_SOLVER;
}

/* A surface whose side the equations are on while what they are solved for lies far on the other,
 * by condition i as evaluated last: a solution of no meaning, as of a law that is steep behind what
 * jumps. E_SOLVER. */
static Status check_side(const Integration *m, int i, Diag *diag)
{
    const Guard guard = equations_guard(m->eq, i);
    Text what = {0};

    if (!guard.solved || guard.side == 0 ||
        guard.side * m->conditions[i] >= -CONTRADICTS * m->largest[i])
        return OK;
    report_condition(m, i, &what);
    (void)diag_set(diag, E_SOLVER,
                   "at t = %.9g s: %s contradicts the side that the equations are solved on: "
                   "they have no solution that leads on near there",
                   m->stepper->t, what.at);
    diag_hint(diag, "a steep but continuous law, such as tanh(x/0.001) in the place of sign(x), "
                    "has a solution there");
    text_free(&what);
    return E_SOLVER;
}

/* E_SOLVER where switches come without a pause; i is the last of them */
static Status check_pace(Integration *m, int i, Diag *diag)
{
    double span = m->plan->to - m->plan->from;

    if (m->stepper->t - m->switched_since > ZENO_SPAN * span) {
        m->switched_since = m->stepper->t;
        m->switches = 0;
    }
    if (m->stepper->t - m->slow_since > SLOW_SPAN * span) {
        m->slow_since = m->stepper->t;
        m->slow_switches = 0;
    }
    if (++m->switches <= ZENO_EVENTS + ZENO_EACH * m->count && ++m->slow_switches <= SLOW_EVENTS)
        return OK;
    if (integration_is_of_event(m, i))
        return events_are_stuck(m->ev, i - m->eq->switch_count, m->stepper->t, diag);
    return switches_endlessly(m, i, diag);
}

/* Behind a surface that was crossed: whether the motion is led back to it. Where it couldn't be
 * crossed that is for others to tell, too. */
static bool is_led_back(Integration *m, int i, bool crossed)
{
    double value = 0, rate;

    if (!crossed)
        return true;
    rate = integration_condition_rate(m, i, &value);
    return rate * value < 0;
}

/* Where the step, taken again to meet condition i, ends after `when`, nobody has looked whether
 * others are met between the two. Before `when` modes have followed what was crossed: there they
 * are no longer those of the step's begin. */
static bool passes_others(Integration *m, int i, double when)
{
    double first;
    int found;

    if (!(m->stepper->t > when))
        return false;
    m->scanned = when;
    found = integration_find_switch(m, &first);
    return found >= 0 && found != i;
}

Status integration_meet_switch(Integration *m, int i, double when, bool *again, Diag *diag)
{
    const Guard guard = equations_guard(m->eq, i);
    bool on_surface = guard.side != 0 || guard.end != 0 || guard.is_norm, crossed = false;
    double value = 0, slope = 0;
    bool is_margin = integration_is_margin(m, i), entered;

    /* a switch on the very start of the step can't be determined from the one just met */
    if (when > m->stepper->before) {
        TRY(approach(m, i, when, &value, &slope, diag));
        *again = *again && !is_margin && passes_others(m, i, when);
        if (*again)
            return OK;
        TRY(integration_add_rows(m, diag));
        /* the interpolant erred: it is told again where steps from here go, if they do */
        if (is_margin && value > integration_rounding(m) && m->stepper->t > m->stepper->before &&
            (slope >= 0 || !is_short(m, -value / slope))) {
            m->needs_restart = m->stepper->method->has_history;
            m->stepper->next = fmin(m->stepper->next, WIDER * (m->stepper->t - m->stepper->before));
            return OK;
        }
        integration_open_crossing(m, CROSSING_CONDITION, i, m->stepper->t, m->stepper->y);
        if (!on_surface && slope * m->mode[i] < 0 && value * m->mode[i] > 0)
            crossed = cross(m, i, value, slope);
    }
    integration_open_crossing(m, CROSSING_CONDITION, i, m->stepper->t, m->stepper->y);
    integration_conditions_at(m, m->stepper->t);
    TRY(check_side(m, i, diag));
    m->band[i] = fmax(10 * fabs(m->conditions[i]), fmax(1e-10 * m->largest[i], m->noise[i]));
    if (guard.is_unilateral) /* its largest size is that since it was left */
        m->band[i] = fmax(m->band[i], integration_on_surface(m, i));
    m->mode[i] = is_margin ? 1 : -m->mode[i];
    TRY(check_pace(m, i, diag));
    integration_note_chatter(m, i, m->stepper->t);
    integration_report_settling(m, i);
    m->root = on_surface || (guard.surface >= 0 && is_led_back(m, i, crossed)) ? i : ROOT_NONE;
    m->ahead = is_margin && slope < 0 ? (fabs(value) + m->noise[i]) / -slope : 0;
    TRY(integration_go_on(m, m->stepper->t, m->stepper->y, &entered, diag));
    integration_close_crossing(m);
    if (on_surface && !entered) /* errors alone led over: the segment is on its side as before */
        m->mode[i] = guard.end != 0 ? 1 : guard.side;
    if (is_margin && !entered) {
        m->noise[i] = m->band[i] =
            fmin(10 * fmax(m->noise[i], m->band[i]), integration_most_noise(m));
        integration_let_margins_rise(m);
    }
    return OK;
}

/* The last step again, until it ends where condition i is zero as near as numbers tell, by Newton's
 * method; m->y and the time there, *zero. Where a step can't be as short as that, the interpolant
 * has y. */
static Status reach_zero(Integration *m, int i, double when, double *zero, Diag *diag)
{
    const Stepper *s = m->stepper;
    size_t bytes = (size_t)m->length * sizeof(double);
    double before = s->before, end = s->t, t = when;
    double value = 0, slope = 0, left = 0;
    Diag ignored = {0};

    for (int k = 0; k < 12 && t > before; k++) {
        if (s->method->shorten(m->stepper, t, &ignored) != OK) {
            TRY(integration_cut(m, t, diag));
            left = 0;
            break;
        }
        slope = integration_condition_rate(m, i, &value);
        left = slope * m->mode[i] < 0 ? -value / slope : 0; /* else a grazing contact */
        if (fabs(left) <= NEAREST_TIME * fabs(t) || (left > 0 && t + left > end))
            break;
        t = fmax(before + 1e-3 * (t - before), t + left);
    }
    if (t <= before) {
        s->method->at(m->stepper, before, m->y);
        *zero = before;
        return OK;
    }
    t = s->t;
    memcpy(m->y, s->y, bytes);
    for (int k = 0; k < m->length && fabs(left) <= 1e-3 * (t - before); k++)
        m->y[k] += left * m->slope[k];
    *zero = fabs(left) <= 1e-3 * (t - before) ? t + left : t;
    return OK;
}

Status integration_meet_event(Integration *m, int i, double when, bool *again, Diag *diag)
{
    double span = m->plan->to - m->plan->from;
    int first = m->eq->switch_count;
    size_t bytes = (size_t)m->length * sizeof(double);
    int *sides = NEW_ARRAY(int, m->count - first);
    double *y = NEW_ARRAY(double, m->length);
    double t = when;
    bool changed, entered;
    Status status = OK;

    CHECK(reach_zero(m, i, when, &t, diag));
    memcpy(y, m->y, bytes);
    *again = *again && passes_others(m, i, when);
    if (*again)
        goto done;
    m->stepper->t = fmin(m->stepper->t, t);
    CHECK(integration_add_rows(m, diag));
    memcpy(m->y, y, bytes);
    if (!motion_project(m->segment.motion, t, m->y))
        CHECK(solver_failure(diag, t, "the constraints can't be met"));
    integration_open_crossing(m, CROSSING_EVENT, i, t, m->y);
    memcpy(sides, m->mode + first, (size_t)(m->count - first) * sizeof(int));
    events_settle(m->ev, t, span, m->y, i - first, sides);
    CHECK(integration_take_events(m, t, sides, &changed, diag));
    CHECK(check_pace(m, i, diag));
    CHECK(integration_go_on(m, t, m->y, &entered, diag));
    integration_close_crossing(m);
done:
    MEM_FREE(sides, y);
    return status;
}

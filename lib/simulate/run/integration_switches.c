/* integration_switches.c: where conditions in the state change sign: located, met, crossed */
#include "simulate/run/integration_impl.h"

#include "algebra/linear.h"
#include "base/random.h"
#include "simulate/run/mode_margins.h"

#include <math.h>
#include <string.h>

#define LOOKS     20000 /* at conditions that follow sources, in a run */
#define POINTS    5     /* of a step, where they are looked at */
#define SLIDING   40    /* likewise, where a force may leave its interval for a moment */
#define DEEPER    2     /* times what a margin begins with, */
#define LASTS     10    /* or times as long as it ought to take to rise above 0, */
#define NEXT_TO   1e-12 /* or of the run: it isn't let go on like that */
#define MOST      1e-6  /* of the largest margin: more than that is no noise */
#define MOVES     3     /* that tell how far errors reach */
#define PAUSELESS 20    /* switches at one instant, more than sides of diodes take to be found */
#define PART      0.5   /* of the way to there, a step */
#define BY_HALVES 4     /* so often a search goes by halves */

/* --- conditions --- */

/* A norm is never negative: it changes its sign where it counts as 0. */
static void evaluate_equations(Integration *m, double t, const double *y)
{
    motion_switches(m->segment.motion, t, y, m->conditions);
    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);

        if (guard.is_norm && guard.end == 0 && !guard.is_idle)
            m->conditions[i] -= m->rest[i];
    }
}

void integration_evaluate(Integration *m, double t, const double *y)
{
    const Equations *eq = m->eq;

    /* the time that rates see: on a jump what is behind it */
    t = motion_clock(m->segment.motion, t);

    if (eq->switch_count > 0)
        evaluate_equations(m, t, y);
    if (m->count > eq->switch_count)
        events_conditions(m->ev, t, y, m->conditions + eq->switch_count);
}

bool integration_is_of_event(const Integration *m, int i)
{
    return i >= m->eq->switch_count;
}

static bool is_of_time(const Integration *m, int i)
{
    return integration_is_of_event(m, i) ? i - m->eq->switch_count < events_time_only(m->ev)
                                         : i < m->eq->time_only;
}

int integration_state_conditions(const Integration *m)
{
    return m->count - m->eq->time_only - events_time_only(m->ev);
}

/* what says that the segment is the right one, as long as it is positive */
bool integration_is_margin(const Integration *m, int i)
{
    return i < m->eq->switch_count && i >= m->eq->switch_count - m->eq->margin_count;
}

/* Not for a step to look at: of t alone, or, where a part of a run is taken again, what would end
 * the segment that is known to go on. */
static bool is_left_out(const Integration *m, int i)
{
    Guard guard;

    if (is_of_time(m, i))
        return true;
    if (integration_is_of_event(m, i))
        return events_condition_is_held(m->ev, i - m->eq->switch_count);
    guard = equations_guard(m->eq, i);
    if (guard.is_of_event && guard.end == 0)
        return true;
    if (guard.held || guard.is_idle || !(m->plan->span > 0))
        return guard.held || guard.is_idle;
    return integration_is_margin(m, i) || guard.side != 0 || guard.end != 0;
}

void integration_choose_conditions(Integration *m)
{
    m->looked_count = 0;
    for (int i = 0; i < m->count; i++)
        if (!is_left_out(m, i))
            m->looked_at[m->looked_count++] = i;
}

/* --- conditions in the state --- */

bool integration_turns(void *integration, double t, const double *y)
{
    Integration *m = integration;

    integration_evaluate(m, t, y);
    for (int k = 0; k < m->looked_count; k++)
        if (sign_of(m->conditions[m->looked_at[k]]) == -m->mode[m->looked_at[k]])
            return true;
    return false;
}

/* all of them where the stepper's interpolant is at t, which goes into m->y */
void integration_conditions_at(Integration *m, double t)
{
    m->stepper->method->at(m->stepper, t, m->y);
    integration_evaluate(m, t, m->y);
}

/* all of them a little way h, which is the result, further than the stepper's end along m->slope */
static double conditions_ahead(Integration *m)
{
    const Stepper *s = m->stepper;
    double h = 1e-7 * fmax(1e-3, s->t - s->before);

    for (int k = 0; k < m->length; k++)
        m->y[k] = s->y[k] + h * m->slope[k];
    integration_evaluate(m, s->t + h, m->y);
    return h;
}

static bool is_stiff(const Integration *m, int i)
{
    int k = i - (m->eq->switch_count - m->eq->margin_count);

    return m->eq->guard_is_of_stiff_element != NULL &&
           m->eq->guard_is_of_stiff_element(m->eq->context, k);
}

double integration_largest_margin(const Integration *m)
{
    return vector_largest(m->largest + m->eq->switch_count - m->eq->margin_count,
                          m->eq->margin_count);
}

double integration_rounding(const Integration *m)
{
    return MARGIN_ROUNDING * integration_largest_margin(m);
}

double integration_most_noise(const Integration *m)
{
    return MOST * integration_largest_margin(m);
}

/* What errors of the state within the tolerance do to margins where the stepper stands, into bands:
 * by a few moves of all states at once, as far as the tolerance lets them. */
static void widen_bands(Integration *m)
{
    double *here = NEW_ARRAY(double, m->eq->switch_count);
    uint64_t seed = 1;

    memcpy(here, m->conditions, (size_t)m->eq->switch_count * sizeof(double));
    for (int turn = 0; turn < MOVES; turn++) {
        for (int k = 0; k < m->length; k++) {
            double tolerance = m->control.rtol * fabs(m->stepper->y[k]) + m->control.atol;

            m->y[k] = m->stepper->y[k] + tolerance * random_unit(&seed);
        }
        motion_switches(m->segment.motion, m->stepper->t, m->y, m->conditions);
        for (int i = 0; i < m->eq->switch_count; i++)
            if (integration_is_margin(m, i) && !is_stiff(m, i))
                m->band[i] = fmax(m->band[i], fabs(m->conditions[i] - here[i]));
    }
    memcpy(m->conditions, here, (size_t)m->eq->switch_count * sizeof(double));
    mem_free(here);
}

/* Sizes of margins that tell no sign: what rounding does. Not what errors of the state do to them,
 * for a margin crosses 0 as well as the state tells when, and a diode that blocks what some noise
 * makes of a large resistor holds back what a coil beside it carries. But where switches follow one
 * another without a pause those errors are what drives them, and tell no sign until margins have
 * come clear of them. */
static void find_noise(Integration *m)
{
    const double least = mode_margins_noise(integration_largest_margin(m), &m->control);

    if (m->eq->margin_count == 0)
        return;
    for (int i = 0; i < m->eq->switch_count; i++)
        m->band[i] = m->noise[i] = integration_is_margin(m, i) ? least : 0;
    if (m->switches > PAUSELESS)
        widen_bands(m);
}

/* The margin is negative where the segment begins, and will have risen above 0 in so long a time,
 * as it goes there: whether it is so because the instant is located only so well. */
static bool is_badly_located(const Integration *m, double margin, double time)
{
    return fabs(margin) <= integration_most_noise(m) ||
           mode_margins_moves(time, m->stepper->y, m->slope, m->length - 1, &m->control) <= 1;
}

/* The segment is the one that goes on a little behind where it begins. Margins that are still
 * negative there, and on their way up, are so because an instant is located only so well: they tell
 * nothing as long as they fall no deeper, until they should be far above 0. */
void integration_let_margins_rise(Integration *m)
{
    const Ode *ode = motion_ode(m->segment.motion);
    const Stepper *s = m->stepper;
    const double soon = NEXT_TO * (m->plan->to - m->plan->from);
    bool negative = false;
    double *here, way;

    integration_conditions_at(m, s->t);
    for (int i = m->eq->time_only; i < m->eq->switch_count; i++)
        negative = negative || (integration_is_margin(m, i) && m->conditions[i] < -m->noise[i]);
    if (!negative || !ode->rate(ode->context, s->t, s->y, m->slope))
        return;
    here = NEW_ARRAY(double, m->eq->switch_count);
    memcpy(here, m->conditions, (size_t)m->eq->switch_count * sizeof(double));
    way = conditions_ahead(m);
    for (int i = m->eq->time_only; i < m->eq->switch_count; i++) {
        const double time = way * here[i] / (here[i] - m->conditions[i]);

        if (!integration_is_margin(m, i) || !(here[i] < -m->noise[i]) ||
            !(m->conditions[i] > here[i]) || !is_badly_located(m, here[i], time))
            continue;
        m->band[i] = fmax(m->band[i], -DEEPER * here[i]);
        m->band_ends[i] = s->t + fmax(LASTS * time, soon);
    }
    mem_free(here);
}

void integration_begin_modes(Integration *m)
{
    if (m->eq->switch_count == m->eq->time_only)
        return;
    integration_conditions_at(m, m->stepper->t);
    for (int i = m->eq->time_only; i < m->eq->switch_count; i++) {
        m->mode[i] = integration_is_margin(m, i) ? 1 : sign_of(m->conditions[i]);
        m->largest[i] = fabs(m->conditions[i]);
        m->band[i] = 0;
        m->band_ends[i] = INFINITY;
    }
    m->depths_at = NAN;
    find_noise(m);
    integration_let_margins_rise(m);
    integration_begin_surfaces(m);
}

/* sizes of condition i at t that are too small to tell a sign from */
static double band_at(const Integration *m, int i, double t)
{
    return t <= m->band_ends[i] ? m->band[i] : m->noise[i];
}

/* whether condition i, as evaluated last, at t, has left its mode; learns a mode not known yet */
static bool has_switched(Integration *m, int i, double t)
{
    double value = m->conditions[i];

    m->largest[i] = fmax(m->largest[i], fabs(value));
    if (!(fabs(value) > band_at(m, i, t)))
        return false;
    if (m->mode[i] == 0) /* what had no value till now becomes what it is */
        m->mode[i] = integration_is_of_event(m, i) ? -sign_of(value) : sign_of(value);
    return sign_of(value) != m->mode[i] && value != 0;
}

/* Where nothing has switched up to here, what has come clear of its band needs it no more. Not
 * earlier: between here and the last point it may be what holds. */
static void forget_bands(Integration *m)
{
    for (int k = 0; k < m->looked_count; k++) {
        const int i = m->looked_at[k];

        if (fabs(m->conditions[i]) > m->band[i])
            m->band[i] = m->noise[i];
    }
}

/* Steps are as short as states want them. What a source does to a condition while no state moves
 * asks for points of its own. */
static int points_in(const Integration *m, double length)
{
    double end = m->stepper->t, span = m->plan->to - m->plan->from;
    int points = m->eq->slide_count > 0 ? SLIDING : POINTS;
    int looks = (int)fmax(points, ceil(length / span * LOOKS));

    if (events_follow_time(m->ev) || (m->eq->switches_follow_time && m->segment.onset == NULL))
        return looks;
    if (!m->eq->switches_follow_time)
        return points;
    return (int)fmax(points, onset_pieces(m->segment.onset, end - length, end, looks));
}

/* How far inside its mode each condition that is looked at is, as evaluated last, at t; negative:
 * beyond its band, and so switched. */
static void find_depths(const Integration *m, double t, double *out)
{
    for (int k = 0; k < m->looked_count; k++) {
        const int i = m->looked_at[k];

        out[k] = m->conditions[i] == 0 || m->mode[i] == 0
                     ? INFINITY
                     : m->mode[i] * m->conditions[i] + band_at(m, i, t);
    }
}

/* Where the first of the conditions that are switched at `high` would cross if all were straight
 * from `low` on, by depths there and here; as a part of the way. */
static double first_crossing(const Integration *m, double share_low, double share_high)
{
    double first = 1;

    for (int k = 0; k < m->looked_count; k++) {
        double inside = share_low * m->depth_low[k], beyond = -share_high * m->depth_high[k];

        if (m->depth_high[k] < 0 && isfinite(inside))
            first = fmin(first, inside > 0 ? inside / (inside + beyond) : 0);
    }
    return first;
}

/* any that is switched, by depths; -1: none */
static int one_switched(const Integration *m, const double *depth)
{
    for (int k = m->looked_count - 1; k >= 0; k--)
        if (depth[k] < 0)
            return m->looked_at[k];
    return -1;
}

/* The first condition that switches between low, where none has, and *high, which becomes a time
 * just behind that: by false position, with the weight of an end that stays halved (Illinois), and
 * by halves where that is slow. `found` has switched at *high. */
static int locate_first(Integration *m, double low, double *high, int found)
{
    double share_low = 1, share_high = 1;
    int last = 0; /* end that moved last: -1 low, 1 high */

    find_depths(m, *high, m->depth_high);
    integration_conditions_at(m, low);
    find_depths(m, low, m->depth_low);
    for (int k = 1; k <= 100; k++) {
        const double least = 2e-16 * fmax(fabs(*high), 1e-300), width = *high - low;
        double part = k % BY_HALVES == 0 ? 0.5 : first_crossing(m, share_low, share_high);
        double t = fmin(fmax(low + part * width, low + least), *high - least);
        double *depth = m->depth;
        int which;

        if (!(width > 2 * least))
            break;
        integration_conditions_at(m, t);
        find_depths(m, t, depth);
        which = one_switched(m, depth);
        if (which >= 0) {
            *high = t;
            found = which;
            m->depth = m->depth_high;
            m->depth_high = depth;
            share_low = last == 1 ? share_low / 2 : 1;
            share_high = 1;
            last = 1;
        } else {
            low = t;
            m->depth = m->depth_low;
            m->depth_low = depth;
            share_high = last == -1 ? share_high / 2 : 1;
            share_low = 1;
            last = -1;
        }
    }
    return found;
}

/* Of parabolas through the depths at three points in a row, the vertex that lies deepest where one
 * may reach 0, in spacings after the middle point, between `from` and `to`; NAN: none may. */
static double dip_between(const Integration *m, double from, double to)
{
    double deepest = 0, where = NAN;

    for (int k = 0; k < m->looked_count; k++) {
        double a = m->depth_low[k], b = m->depth[k], c = m->depth_high[k], bend = a - 2 * b + c;
        double vertex = (a - c) / (2 * bend);

        if (!(isfinite(bend) && vertex >= from && vertex <= to && bend > 0 && b - bend < deepest))
            continue;
        deepest = b - bend;
        where = vertex;
    }
    return where;
}

/* whether a condition has switched at t, the first of them; -1: none has */
static int switched_at(Integration *m, double t)
{
    int found = -1;

    integration_conditions_at(m, t);
    for (int k = 0; k < m->looked_count; k++)
        if (has_switched(m, m->looked_at[k], t) && found < 0)
            found = m->looked_at[k];
    return found;
}

static void next_depths(Integration *m, double t)
{
    double *oldest = m->depth_low;

    m->depth_low = m->depth;
    m->depth = m->depth_high;
    m->depth_high = oldest;
    find_depths(m, t, m->depth_high);
}

static bool has_unilateral(const Integration *m)
{
    for (int k = 0; k < m->looked_count; k++)
        if (!integration_is_of_event(m, m->looked_at[k]) &&
            equations_guard(m->eq, m->looked_at[k]).is_unilateral)
            return true;
    return false;
}

/* The depths where the last step begins, which those at the end of the one before are. After a
 * switch they are evaluated where something must not be passed. False: they are not known. */
static bool begin_depths(Integration *m)
{
    if (m->scanned != m->stepper->before)
        return false;
    if (m->depths_at == m->stepper->before)
        return true;
    if (!has_unilateral(m))
        return false;
    integration_conditions_at(m, m->stepper->before);
    next_depths(m, m->stepper->before);
    return true;
}

/* The first point of the last step at which a condition has switched, *at, and a point *low before
 * it where none has. -1: there is none. Between three points a condition may dip and come back. */
static int find_switched(Integration *m, double *low, double *at)
{
    double length = m->stepper->t - m->stepper->before;
    const bool is_whole = begin_depths(m);
    int points = points_in(m, length), looked = is_whole, found = -1;

    *low = m->scanned;
    for (int k = 1; k <= points && found < 0; k++) {
        const double t = k == points ? m->stepper->t : m->stepper->before + length * k / points;
        double dip;

        if (t < m->scanned)
            continue;
        *at = t;
        found = switched_at(m, t);
        next_depths(m, t);
        dip = ++looked >= 3 && found < 0
                  ? dip_between(m, is_whole && looked == 3 ? -1 : -0.5, k == points ? 1 : 0.5)
                  : NAN;
        if (!isnan(dip)) {
            *low = t - 2 * length / points;
            *at = t + (dip - 1) * length / points;
            found = switched_at(m, *at);
            if (found < 0)
                integration_conditions_at(m, t);
        }
        if (found < 0) {
            *low = t;
            if (!is_whole ||
                looked != 2) /* else the way from the first point on is looked at once more */
                forget_bands(m);
        }
    }
    m->depths_at = found < 0 ? m->stepper->t : NAN;
    return found;
}

/* Currents through small resistances show what is stiff in a step, which is right at its end and
 * anything before: a switch is believed once a step that ends there tells it. */
static bool retake(Integration *m, int found, double t)
{
    const Method *method = m->stepper->method;
    Diag ignored = {0};

    return integration_is_margin(m, found) && is_stiff(m, found) && !method->has_history &&
           t < m->stepper->t && method->shorten(m->stepper, t, &ignored) == OK;
}

int integration_find_switch(Integration *m, double *when)
{
    double low, high;
    int found = find_switched(m, &low, &high);

    while (found >= 0 && retake(m, found, high))
        found = find_switched(m, &low, &high);
    if (found < 0)
        return -1;
    found = locate_first(m, low, &high, found);
    *when = high;
    return found;
}

double integration_condition_rate(Integration *m, int i, double *value)
{
    const Ode *ode = motion_ode(m->segment.motion);
    const Stepper *s = m->stepper;
    double h;

    integration_conditions_at(m, s->t);
    *value = m->conditions[i];
    if (!ode->rate(ode->context, s->t, s->y, m->slope))
        return 0;
    h = conditions_ahead(m);
    return (m->conditions[i] - *value) / h;
}

/* Where the direction of a small vector turns ever faster a step that passes by shows no zero of
 * its norm. */
double integration_end_of_step(Integration *m, double end)
{
    const double t = m->stepper->t;

    for (int i = 0; i < m->eq->switch_count; i++) {
        const Guard guard = equations_guard(m->eq, i);
        double value, rate;

        if (!guard.is_norm || guard.is_idle || guard.end != 0)
            continue;
        rate = integration_condition_rate(m, i, &value);
        m->largest[i] = fmax(m->largest[i], value);
        m->rest[i] = integration_rest(m, i);
        if (rate < 0 && value > 0)
            end = fmin(end, t + PART * (value + m->rest[i]) / -rate);
    }
    return end;
}

/* march_jumps.c: where conditions in time alone change sign, found before a run begins */
#include "simulate/march_impl.h"

#include <math.h>

#define SAMPLES 20000 /* of the run, at least, where they are looked at */
#define MOST    2000000

static const Equations *equations_in_time(const March *m)
{
    return m->plan->in_time != NULL ? m->plan->in_time : m->eq;
}

/* condition i of those of t alone: first those of the equations, then those of events */
static double time_condition(March *m, int i, double t)
{
    const Equations *eq = equations_in_time(m);

    if (i >= eq->time_only) {
        events_time_conditions(m->ev, t, m->conditions);
        return m->conditions[i - eq->time_only];
    }
    eq->switches(eq->context, t, m->y, m->y + eq->n, m->y + eq->n + eq->nu, m->conditions);
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

void march_find_jumps(March *m)
{
    int count = equations_in_time(m)->time_only + events_time_only(m->ev);
    double t = samples_next(m->leg.samples, m->plan->from);

    while (t < m->plan->to) {
        add_jump(m, (Jump){t, t});
        t = samples_next(m->leg.samples, t);
    }
    for (int i = 0; i < count; i++)
        find_jumps_of(m, i);
}

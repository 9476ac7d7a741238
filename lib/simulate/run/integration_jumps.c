/* integration_jumps.c: where conditions in time alone change sign, found before a run begins */
#include "simulate/run/integration_impl.h"

#include <math.h>
#include <stdlib.h>

#define SAMPLES 20000 /* of the run, at least, where they are looked at */
#define MOST    2.5e7
#define FINER   1.618 /* no ratio of small numbers, for no period to keep step with all of them, */
#define COARSE  4.236 /* and its third power, while most changes are missed */
#define WATCHED 65536 /* samples between two looks at who waits */

static const Equations *equations_in_time(const Integration *m)
{
    return m->plan->in_time != NULL ? m->plan->in_time : m->eq;
}

/* condition i of those of t alone: first those of the equations, then those of events */
static double time_condition(Integration *m, int i, double t)
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
static Jump narrow(Integration *m, int i, int sign, double low, double high)
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
    jump = (Jump){.before = low, .behind = high};
    /* a comparison may hold or fail on the zero itself: step over it */
    if (time_condition(m, i, high) == 0 && time_condition(m, i, nextafter(high, INFINITY)) != 0)
        jump.behind = nextafter(high, INFINITY);
    return jump;
}

static int compare_jumps(const void *left, const void *right)
{
    const Jump *a = left, *b = right;

    if (a->before != b->before)
        return a->before < b->before ? -1 : 1;
    return (a->behind > b->behind) - (a->behind < b->behind);
}

static Status look_who_waits(const Integration *m, int k, Diag *diag)
{
    if (k % WATCHED == 0 && monitor_poll(m->plan->watch) != OK)
        return diag_set(diag, E_STOPPED, "stopped at t = %.6g s", m->plan->from);
    return OK;
}

/* how often the sign of condition i changes from sample to sample */
static Status count_changes(Integration *m, int i, int samples, int *out, Diag *diag)
{
    double from = m->plan->from, to = m->plan->to;
    int sign = 0;

    *out = 0;
    for (int k = 0; k <= samples; k++) {
        int now = sign_of(time_condition(m, i, from + (to - from) * k / samples));

        TRY(look_who_waits(m, k, diag));
        *out += now * sign < 0;
        sign = now != 0 ? now : sign;
    }
    return OK;
}

/* So many samples that more of them see no more changes. */
static Status find_samples(Integration *m, int i, int *out, Diag *diag)
{
    double samples = fmax(SAMPLES, 16 * (m->plan->to - m->plan->from) / m->plan->every);
    int before = -2, changes = -1;

    for (samples = fmin(samples, MOST); before != changes;) {
        if (samples > MOST) {
            (void)diag_set(diag, E_SOLVER,
                           "what switches by time does so more often than this run can resolve");
            diag_hint(diag, "a shorter run");
            return E_SOLVER;
        }
        before = changes;
        TRY(count_changes(m, i, (int)samples, &changes, diag));
        *out = (int)samples;
        samples = ceil((changes > samples / 4 ? COARSE : FINER) * samples);
    }
    return OK;
}

static Status find_jumps_of(Integration *m, int i, Diag *diag)
{
    double from = m->plan->from, to = m->plan->to;
    int samples = 0;
    int sign = sign_of(time_condition(m, i, from));
    double last = from;

    TRY(find_samples(m, i, &samples, diag));
    if (sign == 0) { /* a switch at the start lies behind us */
        double behind = nextafter(from, INFINITY);

        sign = sign_of(time_condition(m, i, behind));
        if (sign != 0)
            LIST_PUSH(m->jumps, ((Jump){.before = from, .behind = behind}));
    }
    for (int k = 1; k <= samples; k++) {
        double t = k == samples ? to : from + (to - from) * k / samples;
        int now = sign_of(time_condition(m, i, t));

        TRY(look_who_waits(m, k, diag));
        if (now != sign) {
            Jump jump = narrow(m, i, sign, last, t);

            LIST_PUSH(m->jumps, jump);
            sign = sign_of(time_condition(m, i, jump.behind));
            last = jump.behind;
            if (now != sign && last < t)
                k--; /* there was more than one between the samples */
            continue;
        }
        last = t;
    }
    return OK;
}

Status integration_find_jumps(Integration *m, Diag *diag)
{
    int count = equations_in_time(m)->time_only + events_time_only(m->ev);
    double t = samples_next(m->segment.samples, m->plan->from);
    const Jumps *known = m->plan->jumps;

    /* what is due at the start is sampled before it */
    for (int i = 0; known != NULL && i < known->count; i++)
        if (known->at[i].before < m->plan->to &&
            (known->at[i].before > m->plan->from ||
             (known->at[i].before == m->plan->from && known->at[i].behind > m->plan->from)))
            LIST_PUSH(m->jumps, known->at[i]);
    if (known != NULL)
        return OK;
    while (t < m->plan->to) {
        LIST_PUSH(m->jumps, ((Jump){t, t, .samples = true}));
        t = samples_next(m->segment.samples, t);
    }
    for (int i = 0; i < count; i++)
        TRY(find_jumps_of(m, i, diag));
    if (m->jumps.count > 0)
        qsort(m->jumps.at, (size_t)m->jumps.count, sizeof(Jump), compare_jumps);
    return OK;
}

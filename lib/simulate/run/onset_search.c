/* onset_search.c: the first place where a quantity passes a level, by interval arithmetic
 *
 * Between two times the range of a source bounds what elements and sources can do there; halving
 * finds the first place. What passes one level and falls below another is a pulse. */
#include "simulate/run/onset_impl.h"

#include <math.h>

#define FINEST 1e-12 /* of the way: no search goes on below it */

/* by one source, or by all */
static double excess_over(OnsetSearch *s, Range over)
{
    StiffElements *stiff_elements = s->o->stiff_elements;
    Range source;

    if (!s->is_of_source)
        return s->excess(s, over, stiff_elements_sources_over(stiff_elements, over));
    source = stiff_elements_source_over(stiff_elements, s->which, over);
    return s->excess(s, over, &source);
}

static double excess_close(OnsetSearch *s, Range over)
{
    StiffElements *stiff_elements = s->o->stiff_elements;
    Range source;

    if (!s->is_of_source)
        return s->excess(s, over, stiff_elements_sources_close(stiff_elements, over));
    source = stiff_elements_source_close(stiff_elements, s->which, over);
    return s->excess(s, over, &source);
}

/* whether it may have passed somewhere between: at first as terms are, then closer */
static bool may_pass(OnsetSearch *s, Range over)
{
    return excess_over(s, over) > 0 && excess_close(s, over) > 0;
}

double onset_first_place(OnsetSearch *s, double from, double to)
{
    double finest = FINEST * (to - from) + 4e-16 * fabs(to);
    double low = from, high = to, looked = NAN;

    if (!(to > from))
        return INFINITY;
    for (;;) {
        double middle = low + (high - low) / 2;

        if (!may_pass(s, (Range){low, high})) {
            /* nothing here: on to the next piece, twice as long where halves were cleared */
            if (high >= to)
                return INFINITY;
            middle = 2 * (high - low);
            low = high;
            high = fmin(to, low + middle);
            if (to - high < 0.25 * (high - low))
                high = to;
        } else if (high - low <= finest) {
            return high;
        } else {
            high = middle;
        }
        if (low != looked && excess_over(s, (Range){low, low}) > -s->error_floor)
            return low;
        looked = low;
        if (--s->left <= 0)
            return high;
    }
}

Pulse onset_pulse(OnsetSearch *rise, OnsetSearch *fall, double t, double end, double steps)
{
    double top = onset_first_place(rise, t, end);
    double until = onset_first_place(fall, top < end ? top : t, end);

    top = fmin(top, end);
    until = fmin(until, end);
    return (Pulse){
        .is_on = true, .from = t, .first = top - t, .until = until, .bound = (until - t) / steps};
}

void onset_pulse_prolong(Pulse *pulse, double t, double steps)
{
    pulse->bound *= 2;
    pulse->until = t + steps * pulse->bound;
}

double onset_pulse_bound(const Pulse *pulses, int count, double t)
{
    double bound = INFINITY;

    for (int i = 0; i < count; i++)
        if (pulses[i].is_on && t < pulses[i].until) {
            bound = fmin(bound, pulses[i].bound);
            if (t == pulses[i].from)
                bound = fmin(bound, pulses[i].first);
        }
    return bound;
}

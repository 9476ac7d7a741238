/* onset_elements.c: where steep elements begin to conduct, and how far steps may go while they do
 *
 * Arguments of the elements are followed along a parabola in time and by what sources may do. */
#include "simulate/run/onset_impl.h"

#include "algebra/elementary.h"
#include "base/memory.h"

#include <math.h>

#define NEAR      1.0   /* of u below its threshold: an element that near counts as conducting */
#define REACHED   0.25  /* of u below its threshold: as good as there */
#define LEAK      1e3   /* less than at its threshold: what one that blocks lets through as well */
#define MOST_SIZE 300.0 /* of u: the logarithm of what numbers can be */
#define RISE      3.0   /* of u: the first step in a pulse goes no further */
#define SETTLING  6.0   /* and no later one further while it still grows */
#define EFFECTS   8     /* steps for which effects are good */
#define LATE      0.9   /* of a step: what begins behind is left to the next one */
#define OPEN      0.5   /* of u below its threshold: an element that has done with it */

/* an element's argument in an interval */
static Range argument_over(const Onset *o, int k, Range over, const Range *sources)
{
    double rate = o->at.rate[k], bend = o->at.bend[k];
    double from = over.low - o->t, to = over.high - o->t;
    double a = (rate + bend * from) * from, b = (rate + bend * to) * to;
    double top = bend != 0 ? -rate / (2 * bend) : -1;
    Range out = {o->at.a[k] + fmin(a, b), o->at.a[k] + fmax(a, b)};

    if (top > from && top < to) {
        double there = o->at.a[k] + rate / 2 * top;

        out = (Range){fmin(out.low, there), fmax(out.high, there)};
    }

    for (int j = 0; j < o->sources; j++) {
        double by = o->at.by_source[k * o->sources + j];

        if (by == 0)
            continue;
        a = by * (sources[j].low - o->source_at[j]);
        b = by * (sources[j].high - o->source_at[j]);
        out.low += fmin(a, b);
        out.high += fmax(a, b);
    }
    return out;
}

/* some element that doesn't conduct, over its threshold */
static double conduction(OnsetSearch *s, Range over, const Range *sources)
{
    const Onset *o = s->o;
    double most = -INFINITY;

    for (int k = 0; k < o->elements; k++)
        if (!o->conducts[k])
            most = fmax(
                most,
                stiff_elements_size(o->stiff_elements, k, argument_over(o, k, over, sources)).high -
                    o->threshold[k]);
    return most;
}

/* one element's size beyond the level */
static double size_beyond(OnsetSearch *s, Range over, const Range *sources)
{
    Range u = stiff_elements_size(s->o->stiff_elements, s->which,
                                  argument_over(s->o, s->which, over, sources));

    return s->sign > 0 ? u.high - s->level : s->level - u.low;
}

static double threshold_of(double h, double effect)
{
    return effect > 0 ? elementary_log(ONSET_AIM / (h * effect)) : INFINITY;
}

static double size_at(const Onset *o, int k)
{
    return stiff_elements_size(o->stiff_elements, k, (Range){o->at.a[k], o->at.a[k]}).high;
}

static bool linearise(Onset *o, const Stepper *stepper)
{
    const double *y = stepper->y;

    if (stiff_elements_linearise(o->stiff_elements, stepper->t, y, o->slope, o->h, o->leaks,
                                 &o->at))
        return true;
    /* what is open all around determines nothing: with the slopes there are, then */
    for (int k = 0; k < o->elements; k++)
        o->leaks[k] = NAN;
    return stiff_elements_linearise(o->stiff_elements, stepper->t, y, o->slope, o->h, o->leaks,
                                    &o->at);
}

static bool find_effects(Onset *o, const Stepper *stepper)
{
    if (o->age++ % EFFECTS == 0) {
        if (!linearise(o, stepper))
            return false;
        for (int k = 0; k < o->elements; k++)
            o->effect[k] = stiff_elements_effect_of_element(o->stiff_elements, k, o->scale);
    }
    for (int k = 0; k < o->elements; k++)
        o->threshold[k] = threshold_of(o->h, o->effect[k]);
    return true;
}

/* an element that has just reached its threshold */
static Pulse element_pulse(Onset *o, int k, double end, double steps)
{
    OnsetSearch rise = {o, size_beyond, 0, k, size_at(o, k) + RISE, 1, ONSET_INTERVALS, false};
    OnsetSearch fall = {o, size_beyond, 0, k, o->threshold[k] - NEAR, -1, ONSET_INTERVALS, false};
    Pulse pulse = onset_pulse(&rise, &fall, o->t, end, steps);

    pulse.level = o->threshold[k];
    return pulse;
}

static void follow_pulses(Onset *o, double end, double steps)
{
    for (int k = 0; k < o->elements; k++) {
        Pulse *pulse = &o->element_pulses[k];

        if (!o->conducts[k])
            pulse->is_on = false;
        else if (pulse->is_on && o->t >= pulse->until)
            onset_pulse_prolong(pulse, o->t, steps);
        else if (!pulse->is_on && o->is_first) /* where it begins nothing rises */
            *pulse = (Pulse){.is_on = true,
                             .from = NAN,
                             .until = INFINITY,
                             .bound = INFINITY,
                             .level = o->threshold[k]};
        else if (!pulse->is_on)
            *pulse = element_pulse(o, k, end, steps);
    }
}

/* One that conducts goes through many orders of magnitude before it settles, and an estimate of
 * errors over more than some of them at once means little: how far to go for these, s. */
static double growth_bound(Onset *o)
{
    double bound = INFINITY;

    for (int k = 0; k < o->elements; k++) {
        OnsetSearch grown = {o, size_beyond,     0,    k, size_at(o, k) + SETTLING,
                             1, ONSET_INTERVALS, false};

        if (o->conducts[k])
            bound = fmin(bound, onset_first_place(&grown, o->t, o->t + fmin(o->h, bound)) - o->t);
    }
    return bound;
}

/* Steps that get shorter raise an element's threshold: it does less in each. That alone doesn't end
 * what it does, or it would begin anew, with the short steps of a beginning, when they get longer.
 */
static bool conducts(const Onset *o, int k)
{
    const Pulse *pulse = &o->element_pulses[k];
    const double level = pulse->is_on ? fmin(pulse->level, o->threshold[k]) : o->threshold[k];

    return size_at(o, k) >= level - NEAR;
}

double onset_next_conduction(Onset *o, Stepper *stepper, double end, double *bound)
{
    const double steps = stepper->method->pulse_steps;
    OnsetSearch search = {o, conduction, REACHED, 0, 0, 1, ONSET_INTERVALS, false};

    if (!stepper_slope(stepper, o->slope) ||
        !stiff_elements_arguments(o->stiff_elements, o->t, stepper->y, o->at.a) ||
        !find_effects(o, stepper))
        return end;
    for (int k = 0; k < o->elements; k++) {
        o->conducts[k] = conducts(o, k);
        o->leaks[k] = o->conducts[k] && (o->is_first || o->element_pulses[k].is_on)
                          ? (double)NAN
                          : elementary_exp(fmin(o->threshold[k], MOST_SIZE)) / LEAK;
    }
    if (!linearise(o, stepper))
        return end;
    o->is_affine = true;
    follow_pulses(o, end, steps);
    *bound = fmin(*bound, growth_bound(o));
    *bound = fmin(*bound, onset_pulse_bound(o->element_pulses, o->elements, o->t));
    o->h = fmin(o->h, *bound);
    return fmin(end, onset_first_place(&search, o->t, o->t + o->h));
}

bool onset_has_conducted(Onset *o, const Stepper *stepper, double *when)
{
    OnsetSearch search = {o, conduction, REACHED, 0, 0, 1, ONSET_INTERVALS, false};
    double h = stepper->t - o->t, x;
    double *a = NEW_ARRAY(double, o->elements);
    bool is_open = true, passed = false;

    if (stiff_elements_arguments(o->stiff_elements, stepper->t, stepper->y, a)) {
        const Range *sources =
            stiff_elements_sources_over(o->stiff_elements, (Range){stepper->t, stepper->t});

        for (int k = 0; k < o->elements; k++) {
            double way = a[k] - o->at.a[k];

            for (int j = 0; j < o->sources; j++)
                way -= o->at.by_source[k * o->sources + j] *
                       ((sources[j].low + sources[j].high) / 2 - o->source_at[j]);
            o->at.rate[k] = way / h - o->at.bend[k] * h;
            is_open =
                is_open && (o->conducts[k] ||
                            stiff_elements_size(o->stiff_elements, k, (Range){a[k], a[k]}).high <
                                o->threshold[k] - OPEN);
        }
        x = onset_first_place(&search, o->t, stepper->t);
        passed = x > o->t && (x < o->t + LATE * h || (is_open && x < stepper->t));
        *when = x;
    }
    mem_free(a);
    return passed;
}

/* onset.c: the search for the first place in a step where something begins to act
 *
 * Between two times the range of a source, by interval arithmetic, bounds what elements and sources
 * can do there; halving finds the first place. An element acts from u = ln(AIM / (h effect)) on,
 * u = ln N its size: the logarithm makes a rough effect good enough. */
#include "simulate/run/onset.h"

#include "algebra/elementary.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

#define AIM       0.1   /* of the tolerance, in a step: that is to act */
#define NEAR      1.0   /* of u below its threshold: an element that near counts as conducting */
#define REACHED   0.25  /* of u below its threshold: as good as there */
#define LEAK      1e3   /* less than at its threshold: what one that blocks lets through as well */
#define MOST_SIZE 300.0 /* of u: the logarithm of what numbers can be */
#define RISE      3.0   /* of u: the first step in a pulse goes no further */
#define SETTLING  6.0   /* and no later one further while it still grows */
#define GROWN     20.0  /* the same of a source, in what it is to act */
#define SEEN                                                                                       \
    0.125 /* of what a source does in a step: a place that sees this much leaves it to the         \
             error estimate */
#define AHEAD     16.0  /* steps that are looked over at once for sources that hardly bend, */
#define LONGER    1.5   /* also when they get longer by this: */
#define STRAIGHT  0.125 /* of its range there, that a source may leave a straight line in a step */
#define INTERVALS 2000  /* that a search may look at: where it ends then, a step has to end, too */
#define FINEST    1e-12 /* of the way: no search goes on below it */
#define BEND      0.025 /* of its range in a run: a source bends no more in a step, see bend_bound() */
#define GROWTH    10    /* that a step may have over the last one */
#define EFFECTS   8     /* steps for which effects are good */
#define LATE      0.9  /* of a step: what begins behind is left to the next one */
#define OPEN      0.5  /* of u below its threshold: an element that has done with it */
#define FAINT     1e-3 /* of what an interval promises of a source: it promises too much */
#define STRAIGHTER                                                                                 \
    1e-4            /* of its range in a run: a source that bends no more is as good as straight */
#define CALM  1e-8  /* of its range in a run: a source that goes no further stays as it is */
#define NOISE 1e-14 /* of a source's range in a run: what the rounding of its terms may leave */

typedef struct Pulse {
    bool is_on;
    double from, first; /* it began here, with a step no longer than this, s; */
    double until;       /* it lasts to here, */
    double bound;       /* and steps are bounded so, s */
    double level;       /* of an element: its threshold then */
} Pulse;

struct Onset {
    Steep *steep;
    const Ode *ode;
    int elements, sources, length;
    /* about the start of a step */
    double t, h;
    bool is_open;    /* see onset_leave_open() */
    bool is_affine;  /* `at` is known there */
    bool is_first;   /* nothing has been looked at before */
    bool has_pulses; /* there are steep elements, or sources have bent within a step */
    Affine at;
    double *source_at; /* values of the sources */
    double *threshold, *effect;
    bool *conducts; /* elements over their thresholds, or nearly */
    double *leaks;  /* slopes of those that block; NAN: it has its own */
    double *slope, *scale;
    double *seen;    /* what the step's places see of each source, */
    double *seen_at; /* and where, s */
    double t_before; /* start of the step before; NAN: there is none */
    double clear;    /* up to here sources are straight enough for steps up to */
    double clear_step;
    double planned; /* no step that goes so far was cut short */
    double *onset;  /* where each source begins to act, foreseen; s */
    double *acting; /* by how much it does so there; INFINITY: nobody knows */
    double *rates;  /* two y' */
    Turns turns;
    void *context;
    int age; /* of the effects, in steps */
    Pulse *element_pulses, *source_pulses;
};

Onset *onset_new(Steep *steep, const Ode *ode)
{
    Onset *o;
    int k, j;

    if (steep == NULL)
        return NULL;
    o = NEW(Onset);
    o->steep = steep;
    o->ode = ode;
    o->elements = k = steep_elements(steep);
    o->sources = j = steep_sources(steep);
    o->length = ode->n + ode->quadratures;
    o->has_pulses = k > 0;
    o->at = (Affine){NEW_ARRAY(double, k), NEW_ARRAY(double, k), NEW_ARRAY(double, k),
                     NEW_ARRAY(double, k *j)};
    o->source_at = NEW_ARRAY(double, j);
    o->threshold = NEW_ARRAY(double, k);
    o->effect = NEW_ARRAY(double, k);
    o->conducts = NEW_ARRAY(bool, k);
    o->leaks = NEW_ARRAY(double, k);
    o->slope = NEW_ARRAY(double, o->length);
    o->scale = NEW_ARRAY(double, o->length);
    o->seen = NEW_ARRAY(double, j);
    o->seen_at = NEW_ARRAY(double, j);
    o->onset = NEW_ARRAY(double, j);
    o->acting = NEW_ARRAY(double, j);
    o->rates = NEW_ARRAY(double, 2 * o->length);
    o->element_pulses = NEW_ARRAY(Pulse, k);
    o->source_pulses = NEW_ARRAY(Pulse, j);
    onset_forget(o);
    return o;
}

void onset_free(Onset *o)
{
    if (o == NULL)
        return;
    MEM_FREE(o->at.a, o->at.rate, o->at.bend, o->at.by_source, o->source_at, o->threshold,
             o->effect, o->conducts, o->slope, o->scale, o->leaks, o->seen, o->seen_at, o->onset,
             o->acting, o->rates, o->element_pulses, o->source_pulses, o);
}

void onset_watch(Onset *o, Turns turns, void *context)
{
    if (o == NULL)
        return;
    o->turns = turns;
    o->context = context;
}

void onset_leave_open(Onset *o, bool is_open)
{
    if (o != NULL)
        o->is_open = is_open;
}

void onset_forget(Onset *o)
{
    if (o == NULL)
        return;
    memset(o->element_pulses, 0, (size_t)o->elements * sizeof(Pulse));
    memset(o->source_pulses, 0, (size_t)o->sources * sizeof(Pulse));
    for (int j = 0; j < o->sources; j++)
        o->onset[j] = NAN;
    o->t = NAN;
    o->clear = -INFINITY;
    o->age = 0;
    o->is_first = true;
}

/* --- what is looked for --- */

/* first time in (from, to] at which a quantity passes a level, upwards or downwards */
typedef struct OnsetSearch {
    Onset *o;
    /* above 0: it may have passed somewhere in the interval `over` */
    double (*excess)(struct OnsetSearch *search, Range over, const Range *sources);
    double slack; /* this much below 0 is passed, at a point */
    int which;    /* element or source */
    double level, sign;
    int left; /* intervals to go */
} OnsetSearch;

/* whether it may have passed somewhere between: at first as terms are, then closer */
static bool may_pass(OnsetSearch *s, Range over)
{
    Steep *steep = s->o->steep;

    return s->excess(s, over, steep_sources_over(steep, over)) > 0 &&
           s->excess(s, over, steep_sources_close(steep, over)) > 0;
}

/* first place, or INFINITY; halves from left to right */
static double first_place(OnsetSearch *s, double from, double to)
{
    Steep *steep = s->o->steep;
    double finest = FINEST * (to - from) + 4e-16 * fabs(to);
    double low = from, high = to;

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
        if (s->excess(s, (Range){low, low}, steep_sources_over(steep, (Range){low, low})) >
            -s->slack)
            return low;
        if (--s->left <= 0)
            return high;
    }
}

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
            most = fmax(most, steep_size(o->steep, k, argument_over(o, k, over, sources)).high -
                                  o->threshold[k]);
    return most;
}

/* one element's size beyond the level */
static double size_beyond(OnsetSearch *s, Range over, const Range *sources)
{
    Range u = steep_size(s->o->steep, s->which, argument_over(s->o, s->which, over, sources));

    return s->sign > 0 ? u.high - s->level : s->level - u.low;
}

/* a source's way from where it was, beyond the level */
static double way_beyond(OnsetSearch *s, Range over, const Range *sources)
{
    double here = s->o->source_at[s->which];
    double low = sources[s->which].low - here, high = sources[s->which].high - here;
    double most = fmax(fabs(low), fabs(high));
    double least = low <= 0 && high >= 0 ? 0 : fmin(fabs(low), fabs(high));

    (void)over;
    return s->sign > 0 ? most - s->level : s->level - least;
}

/* --- about a step's start --- */

static void choose_scale(Onset *o, const Stepper *stepper)
{
    const Control *control = &stepper->control;
    const double part = stepper_part(stepper);

    for (int i = 0; i < o->length; i++) {
        double size = fabs(stepper->y[i]);

        if (o->ode->cap != NULL && i < o->ode->n)
            size = fmin(size, o->ode->cap[i]);
        o->scale[i] = part * (control->atol * ode_unit(o->ode, i) + control->rtol * size);
    }
}

static void take_sources(Onset *o, double t)
{
    const Range *at = steep_sources_over(o->steep, (Range){t, t});

    for (int j = 0; j < o->sources; j++)
        o->source_at[j] = (at[j].low + at[j].high) / 2;
}

static double threshold_of(double h, double effect)
{
    return effect > 0 ? elementary_log(AIM / (h * effect)) : INFINITY;
}

static double size_at(const Onset *o, int k)
{
    return steep_size(o->steep, k, (Range){o->at.a[k], o->at.a[k]}).high;
}

static bool linearise(Onset *o, const Stepper *stepper)
{
    const double *y = stepper->y;

    if (steep_linearise(o->steep, stepper->t, y, o->slope, o->h, o->leaks, &o->at))
        return true;
    /* what is open all around determines nothing: with the slopes there are, then */
    for (int k = 0; k < o->elements; k++)
        o->leaks[k] = NAN;
    return steep_linearise(o->steep, stepper->t, y, o->slope, o->h, o->leaks, &o->at);
}

static bool find_effects(Onset *o, const Stepper *stepper)
{
    if (o->age++ % EFFECTS == 0) {
        if (!linearise(o, stepper))
            return false;
        for (int k = 0; k < o->elements; k++)
            o->effect[k] = steep_effect_of_element(o->steep, k, o->scale);
    }
    for (int k = 0; k < o->elements; k++)
        o->threshold[k] = threshold_of(o->h, o->effect[k]);
    return true;
}

/* --- pulses --- */

/* from what passes two levels: when it has risen, and when it is over */
static Pulse pulse_of(OnsetSearch *rise, OnsetSearch *fall, double t, double end, double steps)
{
    double top = first_place(rise, t, end);
    double until = first_place(fall, top < end ? top : t, end);

    top = fmin(top, end);
    until = fmin(until, end);
    return (Pulse){
        .is_on = true, .from = t, .first = top - t, .until = until, .bound = (until - t) / steps};
}

/* an element that has just reached its threshold */
static Pulse element_pulse(Onset *o, int k, double end, double steps)
{
    OnsetSearch rise = {o, size_beyond, 0, k, size_at(o, k) + RISE, 1, INTERVALS};
    OnsetSearch fall = {o, size_beyond, 0, k, o->threshold[k] - NEAR, -1, INTERVALS};
    Pulse pulse = pulse_of(&rise, &fall, o->t, end, steps);

    pulse.level = o->threshold[k];
    return pulse;
}

/* a source that has just begun to act */
static Pulse source_pulse(Onset *o, int j, double delta, double end, double steps)
{
    OnsetSearch rise = {o, way_beyond, 0, j, GROWN * delta, 1, INTERVALS};
    OnsetSearch fall = {o, way_beyond, 0, j, 2 * delta, -1, INTERVALS};

    return pulse_of(&rise, &fall, o->t, end, steps);
}

/* One that outlasts what was foreseen goes on with twice the bound. */
static void prolong(Pulse *pulse, double t, double steps)
{
    pulse->bound *= 2;
    pulse->until = t + steps * pulse->bound;
}

static double bound_by(const Pulse *pulses, int count, double t)
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

/* --- elements --- */

static void follow_pulses(Onset *o, double end, double steps)
{
    for (int k = 0; k < o->elements; k++) {
        Pulse *pulse = &o->element_pulses[k];

        if (!o->conducts[k])
            pulse->is_on = false;
        else if (pulse->is_on && o->t >= pulse->until)
            prolong(pulse, o->t, steps);
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

/* how far what has such a second derivative may leave a straight line over a time h */
static double bend_over(Range second, double h)
{
    return fmax(fabs(second.low), fabs(second.high)) * h * h / 8;
}

/* A multistep or implicit method sees little of a source that turns within a step. One that bends
 * by so much of its range, a tenth of a period of a sine, ends it; looked for as far as steps may
 * grow.
 */
static double bend_bound(Onset *o, double end)
{
    double far = fmin(GROWTH * o->h, end - o->t), h = far;

    for (int turn = 0; turn < 60; turn++, h *= 0.7) {
        const Range *bends = steep_bends_over(o->steep, (Range){o->t, o->t + h});
        bool is_short = true;

        for (int j = 0; j < o->sources && is_short; j++) {
            double bend = bend_over(bends[j], h);

            is_short = !(isfinite(bend) && steep_source_size(o->steep, j) > 0 &&
                         bend > BEND * steep_source_size(o->steep, j));
        }
        if (is_short)
            break;
    }
    return h < far ? h : INFINITY;
}

/* One that conducts goes through many orders of magnitude before it settles, and an estimate of
 * errors over more than some of them at once means little: how far to go for these, s. */
static double growth_bound(Onset *o)
{
    double bound = INFINITY;

    for (int k = 0; k < o->elements; k++) {
        OnsetSearch grown = {o, size_beyond, 0, k, size_at(o, k) + SETTLING, 1, INTERVALS};

        if (o->conducts[k])
            bound = fmin(bound, first_place(&grown, o->t, o->t + fmin(o->h, bound)) - o->t);
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

/* Where the next element begins to conduct, at most `end`; *bound of the steps until then. */
static double next_conduction(Onset *o, Stepper *stepper, double end, double *bound)
{
    const double steps = stepper->method->pulse_steps;
    OnsetSearch search = {o, conduction, REACHED, 0, 0, 1, INTERVALS};

    if (!stepper_slope(stepper, o->slope) ||
        !steep_arguments(o->steep, o->t, stepper->y, o->at.a) || !find_effects(o, stepper))
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
    *bound = fmin(*bound, bound_by(o->element_pulses, o->elements, o->t));
    o->h = fmin(o->h, *bound);
    return fmin(end, first_place(&search, o->t, o->t + o->h));
}

/* --- sources --- */

static void look_at(Onset *o, double t, const double *from)
{
    const Range *at = steep_sources_over(o->steep, (Range){t, t});

    for (int j = 0; j < o->sources; j++) {
        const double way = fabs((at[j].low + at[j].high) / 2 - from[j]);

        if (way > o->seen[j]) {
            o->seen[j] = way;
            o->seen_at[j] = t;
        }
    }
}

/* What the places where the method looks, and what it remembers, see of the sources: as many as are
 * needed for enough of each one's way. */
static void look_around(Onset *o, const Method *method, double h, const double *way)
{
    int i = method->node_count;

    memset(o->seen, 0, (size_t)o->sources * sizeof(double));
    if (method->has_history && !isnan(o->t_before))
        look_at(o, o->t_before, o->source_at);
    while (i-- > 0) { /* the end first */
        bool enough = true;

        look_at(o, o->t + method->nodes[i] * h, o->source_at);
        for (int j = 0; j < o->sources && enough; j++)
            enough = o->seen[j] >= SEEN * way[j];
        if (enough)
            return;
    }
}

/* Whether no source can hide anything in this step, for it bends too little: looked for some steps
 * ahead at once. */
static bool is_clear(Onset *o, double h, double end)
{
    const Range *over;
    Range ahead = {o->t, fmin(end, o->t + AHEAD * h)};

    if (o->t + h <= o->clear && h <= o->clear_step)
        return true;
    h *= LONGER;
    over = steep_sources_over(o->steep, ahead);
    for (int j = 0; j < o->sources; j++)
        o->seen[j] = over[j].high - over[j].low;
    over = steep_bends_over(o->steep, ahead);
    for (int j = 0; j < o->sources; j++)
        if (!(bend_over(over[j], h) <= STRAIGHT * o->seen[j]))
            return false;
    o->clear = ahead.high;
    o->clear_step = h;
    return true;
}

/* What source j may do until `to` while a step sees nothing of it. Where terms cancel, intervals
 * promise more than there is, and at a point rounding alone would keep that promise. */
static double delta_of(Onset *o, int j, const Stepper *stepper, double to)
{
    double effect = steep_effect_of_source(o->steep, j, o->t, stepper->y, o->scale);
    double delta = effect > 0 ? AIM / ((to - o->t) * effect) : INFINITY;

    return fmax(delta, NOISE * steep_source_size(o->steep, j));
}

static double way_at(Onset *o, int j, double t)
{
    const Range *at = steep_sources_over(o->steep, (Range){t, t});

    return fabs((at[j].low + at[j].high) / 2 - o->source_at[j]);
}

/* A place at which source j has gone as far as `level`, or INFINITY: an interval may promise more
 * than there is. */
static double place_beyond(Onset *o, int j, double level, double to)
{
    OnsetSearch peak = {o, way_beyond, 0, j, level, 1, INTERVALS};
    double at = first_place(&peak, o->t, to);

    return at <= to && !(peak.left > 0 && way_at(o, j, at) < 0.5 * level) ? at : INFINITY;
}

/* The largest change of a rate from the step's start to `at`, with the state as it is, in what a
 * step may change. */
static double change_of_rates(Onset *o, Stepper *stepper, double at, double h)
{
    const Ode *ode = o->ode;
    double *here = o->rates, *there = o->rates + o->length;
    double largest = 0;

    stepper->counts.evaluations += 2;
    if (!ode->rate(ode->context, o->t, stepper->y, here) ||
        !ode->rate(ode->context, at, stepper->y, there))
        return INFINITY;
    for (int i = 0; i < ode->n; i++)
        largest = fmax(largest, h * fabs(there[i] - here[i]) / (AIM * o->scale[i]));
    return largest;
}

/* The same for a source that rates answer to only where it is large, as through a square, or by a
 * condition that has another sign there: where it is furthest from what the step's places see,
 * `way` at most, the equations themselves are asked. */
static double acting_at_large(Onset *o, int j, Stepper *stepper, double to, double way)
{
    const double least = fmax(o->seen[j] / SEEN, NOISE * steep_source_size(o->steep, j));
    double at = INFINITY, reached, change;

    for (double level = 0.9 * way; !(at <= to) && level > fmax(least, FAINT * way); level /= 2)
        at = place_beyond(o, j, level, to);
    if (!(at <= to))
        return INFINITY;
    reached = way_at(o, j, at);
    change = change_of_rates(o, stepper, at, to - o->t);
    if (change > 1 || (o->turns != NULL && o->turns(o->context, at, stepper->y)))
        return reached / fmax(GROWN, change);
    return INFINITY;
}

/* Where source j begins to turn a condition that is back at the step's end: rates that don't answer
 * to it let no estimate see that. INFINITY: it doesn't. */
static double turning(Onset *o, int j, const Stepper *stepper, double to)
{
    OnsetSearch leaves = {o, way_beyond, 0, j, o->seen[j] / GROWN, 1, INTERVALS};

    if (o->turns == NULL || !(o->seen[j] > 0) || !(o->seen_at[j] > o->t && o->seen_at[j] < to) ||
        !o->turns(o->context, o->seen_at[j], stepper->y) || o->turns(o->context, to, stepper->y))
        return INFINITY;
    o->acting[j] = leaves.level;
    return first_place(&leaves, o->t, to);
}

/* Where source j begins to do what no place of the step sees; INFINITY: it doesn't. */
static double unseen(Onset *o, int j, Stepper *stepper, double to, double way)
{
    double delta = delta_of(o, j, stepper, to);
    OnsetSearch leaves = {o, way_beyond, 0, j, delta, 1, INTERVALS};

    if (!(place_beyond(o, j, fmax(delta, o->seen[j] / SEEN), to) <= to)) {
        delta = acting_at_large(o, j, stepper, to, way);
        leaves.level = delta;
        if (!(delta < INFINITY))
            return INFINITY;
    }
    o->acting[j] = delta;
    return first_place(&leaves, o->t, to);
}

/* whether source j may leave a straight line in the step by a good part of its range in the run */
static bool bends_far(Onset *o, int j, double to)
{
    const Range bend = steep_bends_over(o->steep, (Range){o->t, to})[j];
    const double most = fmax(fabs(bend.low), fabs(bend.high)), h = to - o->t;

    return isfinite(most) && steep_source_size(o->steep, j) > 0 &&
           most * h * h / 8 > STRAIGHT * steep_source_size(o->steep, j);
}

static double next_unseen(Onset *o, Stepper *stepper, double end)
{
    const Method *method = stepper->method;
    double to = fmin(end, o->t + o->h), first = end;
    double *way;
    const Range *over;
    bool is_onset = false;

    for (int j = 0; j < o->sources; j++)
        is_onset = is_onset || o->onset[j] == o->t;
    if (!is_onset && is_clear(o, to - o->t, end))
        return end;
    take_sources(o, o->t);
    way = NEW_ARRAY(double, o->sources);
    over = steep_sources_over(o->steep, (Range){o->t, to});
    for (int j = 0; j < o->sources; j++)
        way[j] = fmax(over[j].high - o->source_at[j], o->source_at[j] - over[j].low);
    look_around(o, method, to - o->t, way);
    for (int j = 0; j < o->sources; j++) {
        double at;

        if (o->onset[j] == o->t) {
            double delta = fmin(o->acting[j], delta_of(o, j, stepper, to));

            o->source_pulses[j] = source_pulse(o, j, delta, end, method->pulse_steps);
            o->onset[j] = NAN;
        }
        if (!(way[j] > 0))
            continue;
        /* where a smooth one turns, steps are seldom clear, yet it doesn't bend as far */
        if (stepper->next > 0 && (o->seen[j] < SEEN * way[j] || bends_far(o, j, to)))
            o->has_pulses = true;
        at = o->seen[j] >= SEEN * way[j] ? turning(o, j, stepper, to)
                                         : unseen(o, j, stepper, to, way[j]);
        if (!(at > o->t && at < to))
            continue;
        o->onset[j] = at;
        first = fmin(first, at);
    }
    mem_free(way);
    return first;
}

/* --- steps --- */

double onset_before_step(Onset *o, Stepper *stepper, double end)
{
    double bound = INFINITY, first = end;

    if (o == NULL)
        return end;
    o->t_before = o->t;
    o->t = stepper->t;
    o->h = fmin(stepper->next > 0 ? stepper->next : end - o->t, end - o->t);
    o->h = fmin(o->h, stepper->method->sees_little ? control_largest(&stepper->control)
                                                   : control_asked(&stepper->control));
    choose_scale(o, stepper);
    if (o->is_first && o->sources > 0)
        steep_span(o->steep, o->t, end);
    if (o->elements > 0) {
        take_sources(o, o->t);
        if (stepper->method->sees_little)
            bound = bend_bound(o, end);
        o->h = fmin(o->h, bound);
        o->is_affine = false;
        if (!(o->is_open && stepper->method->solves_dae))
            first = next_conduction(o, stepper, end, &bound);
    }
    if (o->sources > 0)
        first = fmin(first, next_unseen(o, stepper, first));
    bound = fmin(bound, bound_by(o->source_pulses, o->sources, o->t));
    stepper->has_pulses = stepper->has_pulses || o->has_pulses;
    stepper->bound = bound < end - o->t ? bound : 0;
    stepper->may_bend = false;
    for (int k = 0; k < o->elements; k++)
        stepper->may_bend = stepper->may_bend || o->conducts[k];
    o->is_first = false;
    o->planned = fmin(first, o->t + o->h * (1 - 1e-9));
    return first;
}

/* whether elements have acted in the last step, on the way that led to where it is */
static bool has_conducted(Onset *o, const Stepper *stepper, double *when)
{
    OnsetSearch search = {o, conduction, REACHED, 0, 0, 1, INTERVALS};
    double h = stepper->t - o->t, x;
    double *a = NEW_ARRAY(double, o->elements);
    bool is_open = true, passed = false;

    if (steep_arguments(o->steep, stepper->t, stepper->y, a)) {
        const Range *sources = steep_sources_over(o->steep, (Range){stepper->t, stepper->t});

        for (int k = 0; k < o->elements; k++) {
            double way = a[k] - o->at.a[k];

            for (int j = 0; j < o->sources; j++)
                way -= o->at.by_source[k * o->sources + j] *
                       ((sources[j].low + sources[j].high) / 2 - o->source_at[j]);
            o->at.rate[k] = way / h - o->at.bend[k] * h;
            is_open = is_open &&
                      (o->conducts[k] ||
                       steep_size(o->steep, k, (Range){a[k], a[k]}).high < o->threshold[k] - OPEN);
        }
        x = first_place(&search, o->t, stepper->t);
        passed = x > o->t && (x < o->t + LATE * h || (is_open && x < stepper->t));
        *when = x;
    }
    mem_free(a);
    return passed;
}

bool onset_is_calm(Onset *o, double from, double to)
{
    const Range *over;

    if (o == NULL || o->sources == 0)
        return true;
    over = steep_sources_over(o->steep, (Range){from, to});
    for (int j = 0; j < o->sources; j++)
        if (steep_source_size(o->steep, j) > 0 &&
            !(over[j].high - over[j].low <= CALM * steep_source_size(o->steep, j)))
            return false;
    return true;
}

int onset_pieces(Onset *o, double from, double to, int most)
{
    const Range *bends;
    double pieces = 1;

    if (o == NULL || o->sources == 0)
        return 1;
    bends = steep_bends_over(o->steep, (Range){from, to});
    for (int j = 0; j < o->sources; j++) {
        double size = steep_source_size(o->steep, j);
        double bend = bend_over(bends[j], to - from);

        if (size > 0)
            pieces = fmax(pieces, isfinite(bend) ? sqrt(bend / (STRAIGHTER * size)) : most);
    }
    return (int)fmin(ceil(pieces), most);
}

bool onset_after_step(Onset *o, Stepper *stepper, double *when)
{
    double first;

    if (o == NULL || (o->elements > 0 && o->is_affine && has_conducted(o, stepper, when)))
        return o != NULL;
    /* a step that was tried again, shorter, has looked in other places than foreseen */
    if (o->sources == 0 || !(stepper->t < o->planned))
        return false;
    o->h = stepper->t - o->t;
    first = next_unseen(o, stepper, stepper->t);
    *when = first;
    return first < stepper->t;
}

/* onset_sources.c: what sources do between the places that a step sees, and how far they bend */
#include "simulate/run/onset_impl.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define SEEN                                                                                       \
    0.125 /* of what a source does in a step: a place that sees this much leaves it to the         \
             error estimate */
#define GROWN    20.0  /* times what a source does to act: the first step goes no further */
#define AHEAD    16.0  /* steps that are looked over at once for sources that hardly bend, */
#define LONGER   1.5   /* also when they get longer by this: */
#define STRAIGHT 0.125 /* of its range there, that a source may leave a straight line in a step */
#define BEND     0.025 /* of its range in a run: a source bends no more in a step that sees little */
#define GROWTH   10    /* that a step may have over the last one */
#define FAINT    1e-3  /* of what an interval promises of a source: it promises too much */
#define CALM     1e-8  /* of its range in a run: a source that goes no further stays as it is */
#define NOISE    1e-14 /* of a source's range in a run: what the rounding of its terms may leave */
#define STRAIGHTER                                                                                 \
    1e-4 /* of its range in a run: a source that bends no more is as good as straight */

void onset_take_sources(Onset *o, double t)
{
    const Range *at = stiff_elements_sources_over(o->stiff_elements, (Range){t, t});

    for (int j = 0; j < o->sources; j++)
        o->source_at[j] = (at[j].low + at[j].high) / 2;
}

/* a source's way from where it was, beyond the level */
static double way_beyond(OnsetSearch *s, Range over, const Range *sources)
{
    double here = s->o->source_at[s->which];
    double low = sources->low - here, high = sources->high - here;
    double most = fmax(fabs(low), fabs(high));
    double least = low <= 0 && high >= 0 ? 0 : fmin(fabs(low), fabs(high));

    (void)over;
    return s->sign > 0 ? most - s->level : s->level - least;
}

/* a source that has just begun to act */
static Pulse source_pulse(Onset *o, int j, double delta, double end, double steps)
{
    OnsetSearch rise = {o, way_beyond, 0, j, GROWN * delta, 1, ONSET_INTERVALS, true};
    OnsetSearch fall = {o, way_beyond, 0, j, 2 * delta, -1, ONSET_INTERVALS, true};

    return onset_pulse(&rise, &fall, o->t, end, steps);
}

/* how far what has such a second derivative may leave a straight line over a time h */
static double bend_over(Range second, double h)
{
    return fmax(fabs(second.low), fabs(second.high)) * h * h / 8;
}

double onset_bend_bound(Onset *o, double end)
{
    double far = fmin(GROWTH * o->h, end - o->t), h = far;

    for (int turn = 0; turn < 60; turn++, h *= 0.7) {
        const Range *bends = stiff_elements_bends_over(o->stiff_elements, (Range){o->t, o->t + h});
        bool is_short = true;

        for (int j = 0; j < o->sources && is_short; j++) {
            double bend = bend_over(bends[j], h);

            is_short = !(isfinite(bend) && stiff_elements_source_size(o->stiff_elements, j) > 0 &&
                         bend > BEND * stiff_elements_source_size(o->stiff_elements, j));
        }
        if (is_short)
            break;
    }
    return h < far ? h : INFINITY;
}

static void look_at(Onset *o, double t, const double *from)
{
    const Range *at = stiff_elements_sources_over(o->stiff_elements, (Range){t, t});

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
    over = stiff_elements_sources_over(o->stiff_elements, ahead);
    for (int j = 0; j < o->sources; j++)
        o->seen[j] = over[j].high - over[j].low;
    over = stiff_elements_bends_over(o->stiff_elements, ahead);
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
    double effect =
        stiff_elements_effect_of_source(o->stiff_elements, j, o->t, stepper->y, o->scale);
    double delta = effect > 0 ? ONSET_AIM / ((to - o->t) * effect) : INFINITY;

    return fmax(delta, NOISE * stiff_elements_source_size(o->stiff_elements, j));
}

static double way_at(Onset *o, int j, double t)
{
    const Range at = stiff_elements_source_over(o->stiff_elements, j, (Range){t, t});

    return fabs((at.low + at.high) / 2 - o->source_at[j]);
}

/* A place at which source j has gone as far as `level`, or INFINITY: an interval may promise more
 * than there is. */
static double place_beyond(Onset *o, int j, double level, double to)
{
    OnsetSearch peak = {o, way_beyond, 0, j, level, 1, ONSET_INTERVALS, true};
    double at = onset_first_place(&peak, o->t, to);

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
        largest = fmax(largest, h * fabs(there[i] - here[i]) / (ONSET_AIM * o->scale[i]));
    return largest;
}

/* The same for a source that rates answer to only where it is large, as through a square, or by a
 * condition that has another sign there: where it is furthest from what the step's places see,
 * `way` at most, the equations themselves are asked. */
static double acting_at_large(Onset *o, int j, Stepper *stepper, double to, double way)
{
    const double least =
        fmax(o->seen[j] / SEEN, NOISE * stiff_elements_source_size(o->stiff_elements, j));
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
    OnsetSearch leaves = {o, way_beyond, 0, j, o->seen[j] / GROWN, 1, ONSET_INTERVALS, true};

    if (o->turns == NULL || !(o->seen[j] > 0) || !(o->seen_at[j] > o->t && o->seen_at[j] < to) ||
        !o->turns(o->context, o->seen_at[j], stepper->y) || o->turns(o->context, to, stepper->y))
        return INFINITY;
    o->acting[j] = leaves.level;
    return onset_first_place(&leaves, o->t, to);
}

/* Where source j begins to do what no place of the step sees; INFINITY: it doesn't. */
static double unseen(Onset *o, int j, Stepper *stepper, double to, double way)
{
    double delta = delta_of(o, j, stepper, to);
    OnsetSearch leaves = {o, way_beyond, 0, j, delta, 1, ONSET_INTERVALS, true};

    if (!(place_beyond(o, j, fmax(delta, o->seen[j] / SEEN), to) <= to)) {
        delta = acting_at_large(o, j, stepper, to, way);
        leaves.level = delta;
        if (!(delta < INFINITY))
            return INFINITY;
    }
    o->acting[j] = delta;
    return onset_first_place(&leaves, o->t, to);
}

/* whether source j may leave a straight line in the step by a good part of its range in the run */
static bool bends_far(Onset *o, int j, double to)
{
    const Range bend = stiff_elements_bends_over(o->stiff_elements, (Range){o->t, to})[j];
    const double most = fmax(fabs(bend.low), fabs(bend.high)), h = to - o->t;

    return isfinite(most) && stiff_elements_source_size(o->stiff_elements, j) > 0 &&
           most * h * h / 8 > STRAIGHT * stiff_elements_source_size(o->stiff_elements, j);
}

double onset_next_unseen(Onset *o, Stepper *stepper, double end)
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
    onset_take_sources(o, o->t);
    way = NEW_ARRAY(double, o->sources);
    over = stiff_elements_sources_over(o->stiff_elements, (Range){o->t, to});
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

bool onset_is_calm(Onset *o, double from, double to)
{
    const Range *over;

    if (o == NULL || o->sources == 0)
        return true;
    over = stiff_elements_sources_over(o->stiff_elements, (Range){from, to});
    for (int j = 0; j < o->sources; j++)
        if (stiff_elements_source_size(o->stiff_elements, j) > 0 &&
            !(over[j].high - over[j].low <=
              CALM * stiff_elements_source_size(o->stiff_elements, j)))
            return false;
    return true;
}

int onset_pieces(Onset *o, double from, double to, int most)
{
    const Range *bends;
    double pieces = 1;

    if (o == NULL || o->sources == 0)
        return 1;
    bends = stiff_elements_bends_over(o->stiff_elements, (Range){from, to});
    for (int j = 0; j < o->sources; j++) {
        double size = stiff_elements_source_size(o->stiff_elements, j);
        double bend = bend_over(bends[j], to - from);

        if (size > 0)
            pieces = fmax(pieces, isfinite(bend) ? sqrt(bend / (STRAIGHTER * size)) : most);
    }
    return (int)fmin(ceil(pieces), most);
}

/* events_series.c: events that happen ever faster: at the limit of the series their guard is held,
 * where the equations have an effort for it (SystemOptions.rests), or the run ends there */
#include "simulate/run/events_impl.h"
#include "simulate/run/series.h"

#include <math.h>

#define PACKED      1e-9  /* of the run: events as close as that, */
#define PACKED_MOST 100   /* so many of them in a row, are without end */
#define FASTER_MOST 8     /* events ever sooner after one another, */
#define FASTER_SPAN 1e-6  /* that add up to less than this, of the run, likewise: */
#define SHRUNK      1e-3  /* bounces, whose pauses are this part of the longest one */
#define SOONER      0.999 /* of the pause before: a shorter one */
#define BOUNCES     4     /* so many of them at least; before a rest */
#define STEEP       0.05  /* fewer where each pause is such a part of the one before */
#define STEEP_LEAST 2
#define MEANS       8 /* pauses, at most, whose mean ratio is that of the series */

static Status happens_endlessly(EventItem *item, double t, Diag *diag)
{
    Text how = {0};

    item->course.accumulates = item->guard != NULL && item->surface < 0;
    if (item->course.times.count > 1 && isfinite(item->course.gap))
        text_addf(&how, ": %s became true %d times, at last %.3g s after the time before",
                  item->condition, item->course.times.count, item->course.gap);
    else
        text_addf(&how, ": %s changes to and fro within an instant", item->condition);
    (void)diag_set(diag, E_SOLVER, "at t = %.9g s: event %s happens without end%s", t, item->name,
                   how.at);
    text_free(&how);
    if (item->course.accumulates)
        diag_hint(diag, "a run from the start on (simulate) holds it at rest from there on");
    else
        diag_hint(diag, "another event can end the run before it comes to that, do=stop, for "
                        "instance where the speed is small");
    return E_SOLVER;
}

static void settle(Course *course, double rest)
{
    course->settles = true;
    course->rest = rest;
}

/* the mean ratio of the last pauses, which instants determine better than that of two */
static double mean_ratio(const Course *course)
{
    const int n = course->times.count - 1;
    const int pauses = course->faster < MEANS ? course->faster : MEANS;
    const int first = n - pauses + 1;

    if (pauses < 2 || first < 1)
        return INFINITY;
    return pow((course->times.at[n] - course->times.at[n - 1]) /
                   (course->times.at[first] - course->times.at[first - 1]),
               1.0 / (pauses - 1));
}

Status events_end_series(EventItem *item, double t, Diag *diag)
{
    const double ratio = mean_ratio(&item->course);
    double left;

    if (item->surface < 0)
        return happens_endlessly(item, t, diag);
    left = series_left(item->course.gap * ratio, ratio);
    settle(&item->course, isfinite(left) ? t + left : t);
    return OK;
}

/* whether the pauses up to now are the begin of a series that ends at once, `left` later */
static bool comes_to_rest(const Course *course, double span, double *left)
{
    const double ratio = mean_ratio(course);

    *left = series_left(course->gap * ratio, ratio);
    return course->faster >= (ratio < STEEP ? STEEP_LEAST : BOUNCES) &&
           course->gap <= SHRUNK * course->longest && *left <= FASTER_SPAN * span;
}

Status events_note_pace(EventItem *item, double t, double span, Diag *diag)
{
    Course *course = &item->course;
    const double gap = t - course->last, ratio = gap / course->gap;
    double left = series_left(gap * ratio, ratio);

    course->faster = gap < SOONER * course->gap ? course->faster + 1 : 0;
    course->packed = gap <= PACKED * span ? course->packed + 1 : 0;
    course->last = t;
    course->gap = gap;
    if (isfinite(gap))
        course->longest = fmax(course->longest, gap);
    if (item->surface >= 0 && comes_to_rest(course, span, &left)) {
        settle(course, t + left);
        return OK;
    }
    if (course->packed <= PACKED_MOST &&
        !(course->faster >= FASTER_MOST && gap <= SHRUNK * course->longest &&
          gap <= FASTER_SPAN * span && left <= FASTER_SPAN * span))
        return OK;
    return happens_endlessly(item, t, diag);
}

bool events_is_at_rounding(const EventItem *item)
{
    return item->value_count > 0 && item->course.times.count >= BOUNCES &&
           item->course.faster >= BOUNCES && item->course.gap <= SHRUNK * item->course.longest;
}

bool events_settle_on(const Events *events, int surface)
{
    for (int i = 0; i < events_count(events); i++)
        if (events->items.at[i].course.settles && events->items.at[i].surface == surface)
            return true;
    return false;
}

static bool is_slid(const Equations *eq, int surface)
{
    for (int i = 0; i < eq->switch_count; i++)
        if (equations_guard(eq, i).surface == surface && equations_guard(eq, i).end != 0)
            return true;
    return false;
}

void events_hold(Events *events, const Equations *eq, double t)
{
    for (int i = 0; i < events_count(events); i++) {
        EventItem *item = &events->items.at[i];
        Course *course = &item->course;
        const bool was_held = course->is_held;

        if (item->surface < 0)
            continue;
        course->is_held = is_slid(eq, item->surface);
        if (course->is_held && !was_held) {
            course->rests++;
            course->left = INFINITY;
        }
        if (was_held && !course->is_held)
            course->left = t;
        if (course->settles || was_held != course->is_held) {
            course->settles = false;
            course->faster = course->packed = 0;
            course->last = -INFINITY;
            course->gap = INFINITY;
            course->longest = 0;
        }
    }
}

bool events_condition_is_held(const Events *events, int condition)
{
    const Expr symbol = events->conditions.at[condition].symbol;
    bool any = false;

    for (int i = 0; i < events->items.count; i++) {
        const EventItem *item = &events->items.at[i];

        if (!item->is_live || !expr_depends(item->formula, symbol))
            continue;
        if (!item->course.is_held)
            return false;
        any = true;
    }
    return any;
}

Status events_are_stuck(Events *events, int condition, double t, Diag *diag)
{
    const Expr symbol = events->conditions.at[condition].symbol;

    for (int i = 0; i < events->items.count; i++) {
        EventItem *item = &events->items.at[i];

        if (!item->is_live || !expr_depends(item->formula, symbol))
            continue;
        return events_is_at_rounding(item) ? events_end_series(item, t, diag)
                                           : happens_endlessly(item, t, diag);
    }
    return diag_set(diag, E_SOLVER, "at t = %.9g s: an event happens without end", t);
}

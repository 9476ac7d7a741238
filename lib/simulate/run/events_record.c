/* events_record.c: how events fared, over all phases of a run and the runs before it */
#include "simulate/run/events_impl.h"

#include <string.h>

#define SHOWN 6 /* times in a remark */

const char *events_keep(Events *events, const char *text)
{
    return pool_text(events->pool, text, strlen(text));
}

int events_count(const Events *events)
{
    return events != NULL ? events->items.count : 0;
}

EventRecord events_record(const Events *events, int i)
{
    const EventItem *item = &events->items.at[i];

    return (EventRecord){.name = item->name,
                         .condition = item->condition,
                         .action = item->action,
                         .is_known = item->course.is_known,
                         .from_start = item->course.from_start,
                         .holds = item->course.holds,
                         .ended = item->course.ended,
                         .count = item->course.times.count,
                         .times = item->course.times.at};
}

static void take_over(Events *events, const EventRecord *old)
{
    EventItem *item = NULL;

    for (int i = 0; i < events->items.count && item == NULL; i++)
        if (strcmp(events->items.at[i].name, old->name) == 0 &&
            strcmp(events->items.at[i].condition, old->condition) == 0)
            item = &events->items.at[i];
    if (item == NULL && old->count == 0)
        return;
    if (item == NULL) {
        LIST_PUSH(events->items, (EventItem){.name = events_keep(events, old->name),
                                             .condition = events_keep(events, old->condition),
                                             .action = old->action});
        item = &events->items.at[events->items.count - 1];
    }
    item->course.is_known = item->is_live && old->is_known;
    item->course.is_resumed = old->is_known;
    item->course.holds = old->holds;
    item->course.from_start = old->from_start;
    for (int i = 0; i < old->count; i++)
        LIST_PUSH(item->course.times, old->times[i]);
    item->course.earlier = item->course.times.count;
}

void events_go_on(Events *events, const EventRecord *earlier, int count)
{
    for (int i = 0; i < count; i++)
        take_over(events, &earlier[i]);
}

void events_hand_over(Events *events, Events *from)
{
    for (int i = 0; i < from->items.count; i++) {
        EventItem *old = &from->items.at[i];
        Course kept;

        if (i == events->items.count) /* of an earlier run */
            LIST_PUSH(events->items, (EventItem){.name = events_keep(events, old->name),
                                                 .condition = events_keep(events, old->condition),
                                                 .action = old->action});
        kept = events->items.at[i].course;
        events->items.at[i].course = old->course;
        old->course = kept;
    }
}

static void tell_times(const EventItem *item, Text *out)
{
    int count = item->course.times.count - item->course.earlier;

    for (int i = 0; i < count && i < SHOWN; i++)
        text_addf(out, "%s%.9g", i > 0 ? ", " : "",
                  item->course.times.at[item->course.earlier + i]);
    if (count > SHOWN)
        text_addf(out, " ... %.9g", item->course.times.at[item->course.times.count - 1]);
    text_add(out, " s\n");
}

void events_tell(const Events *events, Text *out)
{
    for (int i = 0; i < events_count(events); i++) {
        const EventItem *item = &events->items.at[i];
        int count = item->course.times.count - item->course.earlier;

        if (item->course.from_start && !item->course.ended && !item->course.is_resumed)
            text_addf(out,
                      "event %s: %s holds at the start; it must be false before it can become "
                      "true\n",
                      item->name, item->condition);
        if (count == 0 || item->course.ended)
            continue;
        text_addf(out, "event %s: %s became true ", item->name, item->condition);
        if (count > 1)
            text_addf(out, "%d times, ", count);
        text_add(out, "at t = ");
        tell_times(item, out);
    }
    for (int i = 0; i < events_count(events); i++) {
        const EventItem *item = &events->items.at[i];

        if (item->course.ended)
            text_addf(out, "event %s ended the run at t = %.9g s: %s%s\n", item->name,
                      item->course.times.at[item->course.times.count - 1], item->condition,
                      item->course.from_start && item->course.times.count == 1
                          ? " holds at the start"
                          : " became true");
    }
}

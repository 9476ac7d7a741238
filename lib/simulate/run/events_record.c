/* events_record.c: how events fared, over all phases of a run and the runs before it */
#include "simulate/run/events_impl.h"

#include <string.h>

const char *events_store(Events *events, const char *text)
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
                         .is_bound = item->is_bound,
                         .is_known = item->course.is_known,
                         .from_start = item->course.from_start,
                         .holds = item->course.holds,
                         .ended = item->course.ended,
                         .accumulates = item->course.accumulates,
                         .is_held = item->course.is_held,
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
        LIST_PUSH(events->items, (EventItem){.name = events_store(events, old->name),
                                             .condition = events_store(events, old->condition),
                                             .action = old->action,
                                             .is_bound = old->is_bound});
        item = &events->items.at[events->items.count - 1];
    }
    item->course.is_known = item->is_live && old->is_known;
    item->course.is_resumed = old->is_known;
    item->course.holds = old->holds;
    item->course.from_start = old->from_start;
    item->course.settles = old->is_held;
    item->course.rest = old->is_held && old->count > 0 ? old->times[old->count - 1] : 0;
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
            LIST_PUSH(events->items, (EventItem){.name = events_store(events, old->name),
                                                 .condition = events_store(events, old->condition),
                                                 .action = old->action,
                                                 .is_bound = old->is_bound});
        kept = events->items.at[i].course;
        events->items.at[i].course = old->course;
        old->course = kept;
    }
}

/* how it ended the run */
static RemarkKind kind_of_end(const EventItem *item)
{
    if (item->is_bound)
        return REMARK_BOUND_MET;
    return item->course.from_start && item->course.times.count == 1 ? REMARK_EVENT_ENDED_FIRST
                                                                    : REMARK_EVENT_ENDED;
}

void events_remark(const Events *events, Remarks *out)
{
    for (int i = 0; i < events_count(events); i++) {
        const EventItem *item = &events->items.at[i];
        const int count = item->course.times.count - item->course.earlier;
        Remark remark = {.what = item->name, .more = item->condition};

        remark.kind = REMARK_EVENT_FROM_START;
        if (item->course.from_start && !item->course.ended && !item->course.is_resumed)
            remarks_add(out, remark);
        if (count == 0 || item->course.ended)
            continue;
        remark.kind = REMARK_EVENT;
        remark.times = item->course.times.at + item->course.earlier;
        remark.time_count = count;
        remarks_add(out, remark);
        if (item->course.rests > 0)
            remarks_add(out, (Remark){.kind = REMARK_EVENT_RESTS,
                                      .what = item->name,
                                      .count = item->course.rests,
                                      .t = item->course.rest,
                                      .size = item->course.left});
    }
    for (int i = 0; i < events_count(events); i++) {
        const EventItem *item = &events->items.at[i];

        if (item->course.ended)
            remarks_add(out, (Remark){.kind = kind_of_end(item),
                                      .what = item->name,
                                      .more = item->condition,
                                      .t = item->course.times.at[item->course.times.count - 1]});
    }
}

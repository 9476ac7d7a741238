/* session_bounds.c: runs end at the limit of a part's constitutive law
 *
 * A quantity that must not reach 0, such as the gap of a capacitance, is monitored as an event of
 * the run that isn't part of the model. Beyond 0 the law would continue with the wrong sign and
 * give meaningless results. */
#include "session/session_impl.h"

#include "session/session_limits.h"

#include <math.h>
#include <string.h>

void watch_free(BoundWatch *watch)
{
    LIST_FREE(watch->bounds);
    LIST_FREE(watch->events);
    LIST_FREE(watch->from);
    pool_free(watch->pool);
    *watch = (BoundWatch){0};
}

static const char *keep(BoundWatch *watch, Text *text)
{
    const char *kept = pool_text(watch->pool, text->at, text->length);

    text_free(text);
    return kept;
}

/* `measure < limit`, or the other way round where it is negative at the start */
static Event event_of(BoundWatch *watch, Arena *arena, const Bound *bound, double from)
{
    const Expr limit = expr_real(arena, LAW_BOUND * from);
    Text name = {0}, condition = {0};
    char *measure = expr_text(bound->measure);
    Event event = {.action = EVENT_STOP,
                   .is_bound = true,
                   .when = from > 0 ? expr_call2(arena, OP_LT, bound->measure, limit)
                                    : expr_call2(arena, OP_LT, limit, bound->measure)};

    text_addf(&name, "%s at its bound", bound->instance);
    text_addf(&condition, "%s %c %.3g", measure, from > 0 ? '<' : '>', LAW_BOUND * from);
    event.name = keep(watch, &name);
    event.condition = event.text = keep(watch, &condition);
    mem_free(measure);
    return event;
}

/* the values of the measures at the start of the run; the run itself reports a failing initial
 * state */
static Status measure_start(System *system, const RunInput *input, const Run *old,
                            const Bound *bounds, int count, double *out, Diag *diag)
{
    Expr *measures = NEW_ARRAY(Expr, count);
    Result *start = NULL;
    ResultReader *reader = NULL;
    Status status = OK;

    for (int i = 0; i < count; i++)
        measures[i] = bounds[i].measure;
    if (old == NULL)
        CHECK(run_assemble(system, &input->setting, &start, &reader, diag));
    status =
        result_reader_values_at(old != NULL ? old->reader : reader, measures, count,
                                old != NULL ? result_report(old->result)->reached : 0, out, diag);
done:
    result_reader_free(reader);
    result_free(start);
    mem_free(measures);
    return status;
}

void watch_bounds(System *system, const Run *old, RunInput *input)
{
    BoundWatch *watch = &input->watch;
    Arena *arena = system_arena(system);
    Bound *bounds;
    const int count = system_bounds(system, &bounds);
    const int own = input->setting.event_count;
    double *from = NEW_ARRAY(double, count);
    const Event **events;
    Diag ignored = {0};

    if (count == 0 || measure_start(system, input, old, bounds, count, from, &ignored) != OK)
        goto done;
    watch->pool = pool_new(0);
    for (int i = 0; i < count; i++) {
        if (!isfinite(from[i]) || from[i] == 0)
            continue;
        LIST_PUSH(watch->bounds, bounds[i]);
        LIST_PUSH(watch->from, from[i]);
        LIST_PUSH(watch->events, event_of(watch, arena, &bounds[i], from[i]));
    }
    events = NEW_ARRAY(const Event *, own + watch->events.count);
    for (int i = 0; i < own; i++)
        events[i] = input->events[i];
    for (int i = 0; i < watch->events.count; i++)
        events[own + i] = &watch->events.at[i];
    mem_free(input->events);
    input->events = events;
    input->setting.events = input->events;
    input->setting.event_count = own + watch->events.count;
done:
    MEM_FREE(from, bounds);
}

static Status is_at_bound(const BoundWatch *watch, int i, double t, Diag *diag)
{
    const Bound *bound = &watch->bounds.at[i];
    const double from = watch->from.at[i];
    char *measure = expr_text(bound->measure);

    if (bound->is_gap)
        (void)diag_set(diag, E_SOLVER,
                       "at t = %.9g s the gap of %s closed: %s came to 0, where its law has no "
                       "bound",
                       t, bound->instance, measure);
    else
        (void)diag_set(diag, E_SOLVER, "at t = %.9g s the law of %s came to its end: %s fell to 0",
                       t, bound->instance, measure);
    diag_hint(diag, "an event ends a run before that: event closed when=%s %c %.2g do=stop",
              measure, from > 0 ? '<' : '>', 0.01 * from);
    mem_free(measure);
    return E_SOLVER;
}

/* the measure nearest to 0 at the end, where it is by far nearer than at the start; -1 */
static int nearest(const BoundWatch *watch, ResultReader *reader)
{
    enum { FAR_NEARER = 1000 };
    int best = -1;
    double least = 1.0 / FAR_NEARER;

    for (int i = 0; i < watch->bounds.count; i++) {
        double value;
        Diag ignored = {0};

        if (result_reader_values_at(reader, &watch->bounds.at[i].measure, 1,
                                    result_report(result_reader_result(reader))->reached, &value,
                                    &ignored) == OK &&
            fabs(value / watch->from.at[i]) < least) {
            least = fabs(value / watch->from.at[i]);
            best = i;
        }
    }
    return best;
}

Status check_bounds(const RunInput *input, ResultReader *reader, Status status, Diag *diag)
{
    const BoundWatch *watch = &input->watch;
    const Result *result = result_reader_result(reader);
    int close;

    for (int e = 0; e < result_event_count(result); e++) {
        const EventRecord record = result_event(result, e);

        for (int i = 0; record.ended && record.is_bound && i < watch->events.count; i++)
            if (strcmp(watch->events.at[i].name, record.name) == 0 &&
                strcmp(watch->events.at[i].condition, record.condition) == 0)
                return is_at_bound(watch, i, record.times[record.count - 1], diag);
    }
    if (status != E_SOLVER)
        return status;
    close = nearest(watch, reader);
    return close >= 0 ? is_at_bound(watch, close, result_report(result)->reached, diag) : status;
}

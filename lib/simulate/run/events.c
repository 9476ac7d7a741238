/* events.c: conditions in numbers, and what happens when they become true */
#include "simulate/run/events_impl.h"

#include <math.h>
#include <string.h>

#define AT_ZERO   1e-12 /* of the run: instants that count as one */
#define AHEAD     1e-7  /* of the run: how far to look for the way a condition goes */
#define NEAR_ZERO 1e-13 /* of a condition's largest size, where it was zero just before */
#define ROUNDS    100   /* events that set each other off at one instant */

/* --- reading --- */

static bool holds_time_alone(Expr e)
{
    return (expr_kinds(e) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) == 0;
}

static void add_condition(Events *events, Expr comparison)
{
    Arena *arena = system_arena(events->plan.layout->system);
    Condition condition = {.comparison = comparison};
    Text name = {0};

    for (int i = 0; i < events->conditions.count; i++)
        if (events->conditions.at[i].comparison == comparison)
            return;
    text_addf(&name, "#event %d", events->conditions.count + 1);
    condition.difference = expr_sub(arena, expr_arg(comparison, 0), expr_arg(comparison, 1));
    condition.symbol = expr_symbol(arena, name.at, SYMBOL_ARGUMENT);
    LIST_PUSH(events->conditions, condition);
    text_free(&name);
}

typedef LIST(Expr) Comparisons;

/* the comparisons that a formula is made of */
static void gather(Comparisons *out, Expr e)
{
    if (expr_kind(e) != EXPR_CALL || (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0)
        return;
    if (expr_op(e) == OP_LT || expr_op(e) == OP_LE)
        LIST_PUSH(*out, e);
    else
        for (int i = 0; i < expr_arg_count(e); i++)
            gather(out, expr_arg(e, i));
}

/* whether the whole, which a run looks for conditions of t alone in, has this comparison too */
static bool is_in_whole(const Events *events, const Comparisons *whole, Expr comparison)
{
    if (events->plan.whole == NULL)
        return true;
    for (int i = 0; i < whole->count; i++)
        if (whole->at[i] == comparison)
            return true;
    return false;
}

static void time_first(Events *events)
{
    const EventsPlan *plan = &events->plan;
    Comparisons whole = {0};
    Expr when;

    for (int i = 0; i < plan->event_count && plan->whole != NULL; i++)
        if (system_resolve(plan->whole, plan->events[i]->when, &when, NULL) == OK)
            gather(&whole, when);
    for (int i = 0; i < events->conditions.count; i++)
        if (holds_time_alone(events->conditions.at[i].difference) &&
            is_in_whole(events, &whole, events->conditions.at[i].comparison)) {
            Condition condition = events->conditions.at[i];

            events->conditions.at[i] = events->conditions.at[events->time_only];
            events->conditions.at[events->time_only++] = condition;
        }
    LIST_FREE(whole);
}

/* what a driven run can't tell while it finds the positions, or no run at all */
static Status check_known(const Events *events, Expr e, Diag *diag)
{
    const unsigned never = 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;
    const unsigned later = 1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE |
                           1U << SYMBOL_MULTIPLIER;
    const bool supplied = events->plan.layout->ne > 0;

    if ((expr_kinds(e) & (supplied ? never | later : never)) == 0)
        return OK;
    (void)diag_set(diag, E_MODEL,
                   "forces, currents and voltages are found after the positions, "
                   "where a driver has by=");
    diag_hint(diag, "a condition on positions and rates can be followed");
    return E_MODEL;
}

static Status read_condition(Events *events, EventItem *item, const Event *event, Diag *diag)
{
    Comparisons found = {0};
    Status status = OK;

    CHECK(system_resolve(events->plan.layout->system, event->when, &item->when, diag));
    CHECK(check_known(events, item->when, diag));
    gather(&found, item->when);
    for (int i = 0; i < found.count; i++)
        add_condition(events, found.at[i]);
done:
    LIST_FREE(found);
    return status;
}

static Status read_values(Events *events, EventItem *item, const Event *event, Diag *diag)
{
    item->first_value = events->values.count;
    if (event->action == EVENT_SET && events->plan.kind != RUN_SIMULATE) {
        (void)diag_set(diag, E_MODEL, "new values are for `simulate`: here drivers say the motion");
        diag_hint(diag, "do=mark and do=stop work in driven runs");
        return E_MODEL;
    }
    for (int i = 0; i < event->value_count; i++) {
        const NewValue *value = &event->values[i];
        Expr resolved = NULL;

        TRY(reinit_add(events->reinit, value->name, value->primes, diag));
        TRY(system_resolve(events->plan.layout->system, value->value, &resolved, diag));
        TRY(check_known(events, resolved, diag));
        LIST_PUSH(events->values, resolved);
        item->value_count++;
    }
    return OK;
}

static void find_guard(const Events *events, EventItem *item)
{
    System *system = events->plan.layout->system;

    item->guard = system_rest_guard(system, item->when);
    if (item->guard != NULL)
        item->surface = system_rest_surface(system, item->guard);
}

static Status read_event(Events *events, const Event *event, Diag *diag)
{
    EventItem item = {.name = events_store(events, event->name),
                      .condition = events_store(events, event->condition),
                      .action = event->action,
                      .is_bound = event->is_bound,
                      .is_live = true,
                      .surface = -1,
                      .course = {.last = -INFINITY, .gap = INFINITY}};
    Diag why = {0};
    Status status = read_condition(events, &item, event, &why);

    if (status == OK)
        status = read_values(events, &item, event, &why);
    if (status == OK && event->action == EVENT_SET)
        find_guard(events, &item);
    if (status == E_VALUE && events->plan.whole != NULL) { /* said where it comes to that */
        item.refused = events_store(events, why.message);
        status = OK;
    }
    LIST_PUSH(events->items, item);
    if (status == OK)
        return OK;
    (void)diag_set(diag, status, "event %s: %s", event->name, why.message);
    diag_hint(diag, "%s", why.hint);
    return status;
}

static void write_formulas(Events *events)
{
    int count = events->conditions.count;
    Expr *from = NEW_ARRAY(Expr, count);
    Expr *to = NEW_ARRAY(Expr, count);

    for (int i = 0; i < count; i++) {
        from[i] = events->conditions.at[i].comparison;
        to[i] = events->conditions.at[i].symbol;
    }
    for (int i = 0; i < events->items.count; i++)
        events->items.at[i].formula = expr_substitute(system_arena(events->plan.layout->system),
                                                      events->items.at[i].when, from, to, count);
    mem_free(from);
    mem_free(to);
}

static Status compile(Events *events, const Expr *roots, int count, Probe **out, Diag *diag)
{
    for (int i = 0; roots != NULL && i < count; i++)
        events->solved = events->solved || stage_of(roots[i]) > STAGE_VELOCITY;
    return probe_new(events->plan.layout, events->plan.parameters, roots, count, out, diag);
}

static Status compile_all(Events *events, Diag *diag)
{
    LIST(Expr) roots = {0};
    Status status = OK;

    for (int i = 0; i < events->conditions.count; i++)
        LIST_PUSH(roots, events->conditions.at[i].difference);
    for (int i = 0; i < events->items.count; i++)
        LIST_PUSH(roots, events->items.at[i].when);
    events->follows_time =
        roots.at != NULL &&
        variable_index_follows_time(events->plan.layout, roots.at + events->time_only,
                                    events->conditions.count - events->time_only);
    CHECK(compile(events, roots.at, events->time_only, &events->time, diag));
    CHECK(compile(events, roots.at, events->conditions.count, &events->state, diag));
    CHECK(compile(events, roots.at + events->conditions.count, events->items.count,
                  &events->holding, diag));
    CHECK(compile(events, events->values.at, events->values.count, &events->right, diag));
    CHECK(reinit_compile(events->reinit, diag));
done:
    LIST_FREE(roots);
    return status;
}

Status events_new(const EventsPlan *plan, Events **out, Diag *diag)
{
    const ReinitPlan reinit = {plan->layout, plan->parameters, plan->equations, plan->rows,
                               plan->row_count};
    Events *events = NEW(Events);
    Status status = OK;

    events->plan = *plan;
    events->pool = pool_new(0);
    events->reinit = reinit_new(&reinit);
    for (int i = 0; i < plan->event_count; i++)
        CHECK(read_event(events, plan->events[i], diag));
    time_first(events);
    write_formulas(events);
    CHECK(compile_all(events, diag));
    events->targets = NEW_ARRAY(double, events->values.count);
    events->rate = NEW_ARRAY(double, motion_length(plan->motion));
    for (int i = 0; i < COUNT(events->y); i++) {
        events->y[i] = NEW_ARRAY(double, motion_length(plan->motion));
        events->here[i] = NEW_ARRAY(double, events->conditions.count);
    }
    *out = events;
    events = NULL;
done:
    events_free(events);
    return status;
}

void events_free(Events *events)
{
    if (events == NULL)
        return;
    for (int i = 0; i < events->items.count; i++)
        LIST_FREE(events->items.at[i].course.times);
    LIST_FREE(events->items);
    LIST_FREE(events->conditions);
    LIST_FREE(events->values);
    mem_free(events->targets);
    reinit_free(events->reinit);
    probe_free(events->time);
    probe_free(events->state);
    probe_free(events->holding);
    probe_free(events->right);
    for (int i = 0; i < COUNT(events->y); i++) {
        mem_free(events->y[i]);
        mem_free(events->here[i]);
    }
    mem_free(events->rate);
    pool_free(events->pool);
    mem_free(events);
}

/* --- values --- */

int events_condition_count(const Events *events)
{
    return events != NULL ? events->conditions.count : 0;
}

Expr events_difference(const Events *events, int condition)
{
    return events->conditions.at[condition].difference;
}

int events_time_only(const Events *events)
{
    return events != NULL ? events->time_only : 0;
}

bool events_follow_time(const Events *events)
{
    return events != NULL && events->follows_time;
}

/* the roots of a probe at (t, y); NULL where the equations have no solution */
static const double *roots_at(const Events *events, Probe *probe, double t, const double *y)
{
    const VariableIndex *l = events->plan.layout;
    RowValues row = row_of_state(l, t, y);

    if (events->solved && !row_solve(l, events->plan.motion, t, y, &row))
        return NULL;
    return probe_values(probe, &row);
}

void events_conditions(Events *events, double t, const double *y, double *out)
{
    int count = events->conditions.count;
    const double *values = roots_at(events, events->state, t, y);

    for (int i = 0; i < count; i++) {
        out[i] = values != NULL ? values[i] : NAN;
        events->conditions.at[i].largest = fmax(events->conditions.at[i].largest, fabs(out[i]));
    }
}

void events_time_conditions(Events *events, double t, double *out)
{
    RowValues row = {.t = t};

    if (events->time_only > 0)
        memcpy(out, probe_values(events->time, &row), (size_t)events->time_only * sizeof(double));
}

static double symbol_value(void *context, Expr symbol)
{
    const Events *events = ((void **)context)[0];
    const int *sides = ((void **)context)[1];

    for (int i = 0; i < events->conditions.count; i++)
        if (events->conditions.at[i].symbol == symbol)
            return sides[i] < 0;
    return parameters_value(events->plan.parameters, symbol);
}

static bool is_true(const Events *events, const EventItem *item, const int *sides)
{
    const void *context[] = {events, sides};

    return item->is_live && !item->course.is_held &&
           expr_evaluate(item->formula, symbol_value, (void *)context) != 0;
}

/* --- sides --- */

/* Conditions here and after one and two short steps of Euler's rule; how long they are, or 0. */
static double look_ahead(Events *events, double t, double span, const double *y)
{
    const Ode *ode = motion_ode(events->plan.motion);
    int length = motion_length(events->plan.motion);
    double h = AHEAD * span;

    memcpy(events->y[0], y, (size_t)length * sizeof(double));
    for (int k = 0; k < 3; k++) {
        events_conditions(events, t + k * h, events->y[k], events->here[k]);
        if (k == 2)
            break;
        if (!ode->rate(ode->context, t + k * h, events->y[k], events->rate))
            return 0;
        for (int i = 0; i < length; i++)
            events->y[k + 1][i] = events->y[k][i] + h * events->rate[i];
    }
    return h;
}

/* the way that condition i goes: by its rate, or where it has none by how that changes */
static double direction(const Events *events, int i)
{
    double first = events->here[1][i] - events->here[0][i];
    double second = events->here[2][i] - events->here[1][i];

    return fabs(first) > 1e-3 * fabs(second - first) ? first : first + second;
}

void events_settle(Events *events, double t, double span, const double *y, int root, int *sides)
{
    double h = look_ahead(events, t, span, y);

    for (int i = events->time_only; i < events->conditions.count; i++) {
        double value = events->here[0][i];
        double way = h > 0 ? direction(events, i) : 0;
        bool is_zero = i == root || fabs(value) * h <= fabs(way) * AT_ZERO * span;

        if (!is_zero)
            sides[i] = sign_of(value);
        else if (way != 0 && isfinite(way))
            sides[i] = sign_of(way);
        else if (i == root)
            sides[i] = -sides[i];
    }
}

/* Behind new values: a condition whose zero the event was at has not moved from it, unless it is
 * one of those that did. */
static void settle_again(Events *events, double t, double span, const double *y, const bool *zero,
                         int *sides)
{
    double h = look_ahead(events, t, span, y);

    for (int i = events->time_only; i < events->conditions.count; i++) {
        double value = events->here[0][i];
        double way = h > 0 ? direction(events, i) : 0;
        double near = zero[i] ? NEAR_ZERO * events->conditions.at[i].largest : 0;
        bool is_zero = fabs(value) <= near || fabs(value) * h <= fabs(way) * AT_ZERO * span;

        if (!is_zero)
            sides[i] = sign_of(value);
        else if (way != 0 && isfinite(way))
            sides[i] = sign_of(way);
    }
}

/* --- what happens --- */

static void note(EventItem *item, double t)
{
    LIST_PUSH(item->course.times, t);
    item->course.holds = true;
    if (item->action == EVENT_STOP)
        item->course.ended = true;
}

bool events_begin(Events *events, double t, const double *y)
{
    const double *holding = roots_at(events, events->holding, t, y);
    bool stop = false;

    for (int i = 0; i < events->items.count && holding != NULL; i++) {
        EventItem *item = &events->items.at[i];

        if (!item->is_live || item->course.is_known)
            continue;
        item->course.is_known = true;
        item->course.holds = item->course.from_start = holding[i] != 0 && !isnan(holding[i]);
        if (item->course.holds && item->action == EVENT_STOP) {
            note(item, t);
            stop = true;
        }
    }
    return stop;
}

bool events_have_begun(const Events *events)
{
    for (int i = 0; i < events_count(events); i++)
        if (events->items.at[i].course.is_known)
            return true;
    return false;
}

bool events_would_happen(const Events *events, const int *sides)
{
    for (int i = 0; i < events->items.count; i++)
        if (!events->items.at[i].course.holds && is_true(events, &events->items.at[i], sides))
            return true;
    return false;
}

bool events_follow(Events *events, const int *sides)
{
    bool due = false;

    for (int i = 0; i < events->items.count; i++) {
        EventItem *item = &events->items.at[i];
        bool now = is_true(events, item, sides);

        due = due || (now && !item->course.holds);
        item->course.holds = item->course.holds && now;
    }
    return due;
}

/* Bounces too small to be told from rest: ever sooner after one another, and the new values no
 * longer lead away from the condition. A thermostat switches at an even pace, also where its first
 * pause was long. */
static Status check_away(Events *events, double t, const bool *due, const int *sides, Diag *diag)
{
    for (int i = 0; i < events->items.count; i++) {
        EventItem *item = &events->items.at[i];

        if (due[i] && !item->course.settles && events_is_at_rounding(item) &&
            is_true(events, item, sides))
            TRY(events_end_series(item, t, diag));
    }
    return OK;
}

/* the new values of the items that are due */
static Status apply_values(Events *events, double t, const bool *due, double *y, bool *changed,
                           Diag *diag)
{
    const double *values;
    Text names = {0};
    Status status;

    for (int k = 0; k < events->values.count; k++)
        events->targets[k] = NAN;
    for (int i = 0; i < events->items.count; i++)
        if (due[i] && events->items.at[i].refused != NULL)
            return diag_set(diag, E_SOLVER, "at t = %.9g s: event %s: %s, as ideal switches stand",
                            t, events->items.at[i].name, events->items.at[i].refused);
    if (events->values.count == 0)
        return OK;
    values = roots_at(events, events->right, t, y);
    for (int i = 0; i < events->items.count; i++) {
        const EventItem *item = &events->items.at[i];

        if (!due[i] || item->value_count == 0 || item->course.settles)
            continue;
        text_addf(&names, "%s%s", names.length > 0 ? ", " : "", item->name);
        for (int k = 0; k < item->value_count && values != NULL; k++)
            events->targets[item->first_value + k] = values[item->first_value + k];
    }
    if (names.length == 0)
        return OK;
    if (values == NULL)
        status = diag_set(diag, E_SOLVER, "at t = %.9g s: event %s: the equations have no solution",
                          t, names.at);
    else
        status = reinit_apply(events->reinit, t, events->targets, names.at, y, diag);
    *changed = *changed || status == OK;
    text_free(&names);
    return status;
}

/* one round: who is due, and what comes of it */
static Status happen_once(Events *events, double t, double span, bool *due, double *y,
                          bool *changed, bool *stop, Diag *diag)
{
    for (int i = 0; i < events->items.count; i++)
        if (due[i]) {
            note(&events->items.at[i], t);
            *stop = *stop || events->items.at[i].action == EVENT_STOP;
            TRY(events_note_pace(&events->items.at[i], t, span, diag));
        }
    return apply_values(events, t, due, y, changed, diag);
}

static Status without_end(const Events *events, double t, const bool *due, Diag *diag)
{
    Text names = {0};

    for (int i = 0; i < events->items.count; i++)
        if (due[i])
            text_addf(&names, "%s%s", names.length > 0 ? ", " : "", events->items.at[i].name);
    (void)diag_set(diag, E_SOLVER, "at t = %.9g s: events set each other off without end: %s", t,
                   names.length > 0 ? names.at : "none");
    diag_hint(diag, "their new values make each other's conditions true");
    text_free(&names);
    return E_SOLVER;
}

Status events_happen(Events *events, double t, double span, double *y, int *sides, bool *changed,
                     bool *stop, Diag *diag)
{
    int count = events->conditions.count;
    bool *due = NEW_ARRAY(bool, events->items.count);
    bool *zero = NEW_ARRAY(bool, count);
    double *values = NEW_ARRAY(double, count);
    Status status = OK;

    *changed = *stop = false;
    events_conditions(events, t, y, values);
    for (int i = 0; i < count; i++)
        zero[i] = fabs(values[i]) <= NEAR_ZERO * events->conditions.at[i].largest;
    for (int round = 0;; round++) {
        bool again = false;
        bool moved = false;

        (void)events_follow(events, sides);
        for (int i = 0; i < events->items.count; i++) {
            due[i] =
                !events->items.at[i].course.holds && is_true(events, &events->items.at[i], sides);
            again = again || due[i];
        }
        if (!again)
            break;
        if (round == ROUNDS)
            CHECK(without_end(events, t, due, diag));
        CHECK(happen_once(events, t, span, due, y, &moved, stop, diag));
        if (!moved)
            break;
        *changed = true;
        settle_again(events, t, span, y, zero, sides);
        CHECK(check_away(events, t, due, sides, diag));
    }
done:
    MEM_FREE(due, zero, values);
    return status;
}

/* --- driven runs --- */

bool events_are_due(Events *events, double t, const double *y)
{
    const double *holding = roots_at(events, events->holding, t, y);

    for (int i = 0; i < events->items.count && holding != NULL; i++)
        if (events->items.at[i].is_live && !events->items.at[i].course.holds && holding[i] != 0 &&
            !isnan(holding[i]))
            return true;
    return false;
}

Status events_read(Events *events, double t, double span, const double *y, bool *happened,
                   bool *stop, Diag *diag)
{
    const double *holding = roots_at(events, events->holding, t, y);

    *happened = *stop = false;
    for (int i = 0; i < events->items.count && holding != NULL; i++) {
        EventItem *item = &events->items.at[i];
        bool now = item->is_live && holding[i] != 0 && !isnan(holding[i]);

        if (now && !item->course.holds) {
            note(item, t);
            *happened = true;
            *stop = *stop || item->action == EVENT_STOP;
            TRY(events_note_pace(item, t, span, diag));
        }
        item->course.holds = now;
    }
    return OK;
}

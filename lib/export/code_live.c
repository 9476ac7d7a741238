/* code_live.c: additions to code that handles events by itself
 *
 * Discontinuous expressions depend on signs, which are parameters: all functions are smooth between
 * events, and each event changes a sign. Derivatives are those of the formulas, along a direction
 * (dt, dy, ds) that follows s: one pass each, whatever the number of variables. */
#include "export/code.h"

#include "formulate/kinematics/edges.h"
#include "formulate/system_build/held_coordinates.h"
#include "model/model.h"

#include <stdio.h>
#include <string.h>

/* --- what jumps or bends --- */

typedef struct Calls { /* whose condition may change its sign, in a formula */
    Arena *arena;
} Calls;

static bool has_condition(Expr e, void *context)
{
    const Calls *calls = context;
    Expr condition = switch_condition(calls->arena, e);

    return condition != NULL && !expr_is_number(condition);
}

static Expr side_symbol(Code *code, int i)
{
    char name[24];

    (void)snprintf(name, sizeof name, "#side.%d", i + 1);
    return expr_symbol(code->arena, pool_text(code->texts, name, strlen(name)), SYMBOL_PARAMETER);
}

/* whether time alone moves it at an even rate, between what it jumps at: then it is known when it
 * is 0 next */
static bool is_even(const Code *code, Expr phase)
{
    Expr t = code->layout->symbols[code->layout->t];

    return expr_is_zero(expr_diff(code->arena, expr_diff(code->arena, phase, t), t));
}

/* is_jump: the equations jump there, in the state */
static void add_side(Code *code, Expr condition, Expr call, bool is_jump)
{
    const unsigned unknown = 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;
    const unsigned of_time = 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER;
    CodeSide side = {.call = call};
    int way;

    if (expr_is_number(condition) || (expr_kinds(condition) & unknown) != 0)
        return;
    side.surface.condition = side.surface.measure = surface_of(code->arena, condition, &way);
    side.surface.law = switch_jumps(call) ? surface_law(code->arena, call) : (SurfaceLaw){0};
    side.is_floor = (expr_kinds(condition) & ~of_time) == 0 && expr_op(call) == OP_FLOOR;
    side.is_timed = (expr_kinds(condition) & ~of_time) == 0 &&
                    is_even(code, side.is_floor ? expr_arg(call, 0) : side.surface.condition);
    side.is_floor = side.is_floor && side.is_timed;
    side.is_jump = is_jump && !side.is_timed;
    for (int i = 0; i < code->live.sides.count; i++) {
        CodeSide *known = &code->live.sides.at[i];

        if (known->surface.condition == side.surface.condition &&
            surface_law_is(&known->surface.law, &side.surface.law)) {
            known->is_jump = known->is_jump || side.is_jump;
            return;
        }
    }
    LIST_PUSH(code->live.sides, side);
}

static void add_sides_of(Code *code, const Expr *formulas, int count)
{
    Calls calls = {code->arena};
    Expr *found;
    const int number = expr_find(formulas, count, has_condition, &calls, &found);

    for (int i = 0; i < number; i++)
        add_side(code, switch_condition(code->arena, found[i]), found[i], false);
    mem_free(found);
}

/* those of t alone first, each with a sign */
static void order_sides(Code *code)
{
    CodeLive *live = &code->live;

    for (int i = 0; i < live->sides.count; i++)
        if (live->sides.at[i].is_timed) {
            const CodeSide timed = live->sides.at[i];

            memmove(&live->sides.at[live->timed + 1], &live->sides.at[live->timed],
                    (size_t)(i - live->timed) * sizeof timed);
            live->sides.at[live->timed++] = timed;
        }
    for (int i = 0; i < live->sides.count; i++)
        live->sides.at[i].surface.sign = side_symbol(code, i);
}

/* --- surfaces that a motion slides along --- */

/* The lowest rate of h that signs affect, h or h'; of h that is a position they affect h'', and its
 * sign only changes. False: it can't be formed. */
static bool find_slip(Code *code, CodeSide *side)
{
    const unsigned unknown = 1U << SYMBOL_EFFORT | 1U << SYMBOL_JERK;
    const unsigned solved = 1U << SYMBOL_ALGEBRAIC | 1U << SYMBOL_STATE_RATE;
    const Expr h = side->surface.condition;
    Expr rate;

    side->off = expr_int(code->arena, 0);
    if ((expr_kinds(h) & solved) != 0) {
        side->slip = h;
        return true;
    }
    if (system_rate(code->layout->system, h, &rate, NULL) != OK ||
        (expr_kinds(rate) & unknown) != 0 ||
        (expr_kinds(rate) & (solved | 1U << SYMBOL_ACCELERATION)) == 0)
        return false;
    side->slip = rate;
    side->off = h;
    return true;
}

/* slips, distances from the surfaces, and bounds of the signs */
static void add_slides(Code *code)
{
    CodeLive *live = &code->live;
    LIST(Expr) entries = {0};

    for (int i = 0; i < live->sides.count; i++)
        if (live->sides.at[i].is_jump && find_slip(code, &live->sides.at[i])) {
            live->sides.at[i].surface.may_slide = true;
            LIST_PUSH(live->slides, i);
        }
    for (int k = 0; k < live->slides.count; k++)
        LIST_PUSH(entries, live->sides.at[live->slides.at[k]].slip);
    for (int k = 0; k < live->slides.count; k++)
        LIST_PUSH(entries, live->sides.at[live->slides.at[k]].off);
    for (int k = 0; k < live->slides.count; k++) {
        const Expr ratio = live->sides.at[live->slides.at[k]].surface.law.ratio;

        LIST_PUSH(entries, ratio != NULL ? ratio : expr_int(code->arena, 1));
    }
    code_add_function(code, "slides", "how surfaces are left, how far they are, bounds of signs",
                      entries.at, entries.count, 1);
    LIST_FREE(entries);
}

/* --- events of the model --- */

static CodeLevel level_of(Expr target)
{
    const unsigned kinds = expr_kinds(target);

    return (kinds & 1U << SYMBOL_SPEED) != 0   ? CODE_SPEED
           : (kinds & 1U << SYMBOL_STATE) != 0 ? CODE_STATE
                                               : CODE_COORDINATE;
}

/* in y, if a state is what it is */
static int place_of(const VariableIndex *l, Expr target)
{
    const int first[] = {l->q, l->u, l->x}, counts[] = {l->n, l->nu, l->nx};

    for (int part = 0, at = 0; part < COUNT(first); at += counts[part++])
        for (int i = 0; i < counts[part]; i++)
            if (l->symbols[first[part] + i] == target)
                return at + i;
    return -1;
}

typedef LIST(Expr) CodeLiveExprs;

static int add_target(Code *code, CodeLiveExprs *targets, Expr e, CodeTarget target)
{
    target.place = place_of(code->layout, e);
    target.name = pool_text(code->texts, target.name, strlen(target.name));
    LIST_PUSH(*targets, e);
    LIST_PUSH(code->live.targets, target);
    return targets->count - 1;
}

static Status add_given(Code *code, const NewValue *value, CodeLiveExprs *targets, Diag *diag)
{
    System *system = code->layout->system;
    CodeTarget target = {
        .node = -1, .attitude = -1, .rate = -1, .turning = -1, .name = value->name};
    Expr e;

    TRY(system_variable(system, value->name, value->primes, &e, diag));
    target.level = level_of(e);
    (void)add_target(code, targets, e, target);
    return OK;
}

/* after given positions: their rates, if speeds determine them */
static int add_rate(Code *code, CodeLiveExprs *targets, Expr rate, const char *name)
{
    const CodeTarget target = {
        .level = CODE_SPEED, .node = -1, .attitude = -1, .rate = -1, .turning = -1, .name = name};

    return rate != NULL ? add_target(code, targets, rate, target) : -1;
}

static void add_given_rates(Code *code, CodeLiveExprs *targets)
{
    for (int k = 0; k < code->live.given; k++) {
        const char *name = code->live.targets.at[k].name;
        Named named;
        int rate, turning;

        if (code->live.targets.at[k].level != CODE_COORDINATE)
            continue;
        system_named(code->layout->system, name, &named);
        rate = add_rate(code, targets, named.rate, name);
        turning = add_rate(code, targets, named.turning, name);
        code->live.targets.at[k].node = named.node;
        code->live.targets.at[k].attitude = named.attitude;
        code->live.targets.at[k].rate = rate;
        code->live.targets.at[k].turning = turning;
    }
}

/* If events set positions, these are followed by coordinates to be held where possible, and rates,
 * as in a run (assemble/reinitialise_stay.c). */
static void add_held_coordinates(Code *code, CodeLiveExprs *targets)
{
    typedef LIST(const char *) Names;
    Names named = {0};
    HeldCoordinate *held_kind = NULL;
    int count = 0;

    code->live.given = targets->count;
    for (int k = 0; k < code->live.given; k++)
        if (code->live.targets.at[k].level == CODE_COORDINATE)
            LIST_PUSH(named, code->live.targets.at[k].name);
    if (named.count > 0)
        count = system_held_coordinates(code->layout->system, named.at, named.count, &held_kind);
    add_given_rates(code, targets);
    for (int i = 0; i < count; i++) {
        const HeldCoordinate *held = &held_kind[i];
        const CodeTarget target = {.held_kind = held->node < 0  ? CODE_JOINT
                                                : held->is_body ? CODE_BODY
                                                                : CODE_FRAME,
                                   .node = held->node,
                                   .attitude = held->attitude,
                                   .turning = -1,
                                   .name = held->name != NULL ? held->name : held->part};
        const int position = add_target(code, targets, held->value, target);
        const int rate = add_target(code, targets, held->rate, target);

        code->live.targets.at[position].rate = rate;
        code->live.targets.at[rate].level = CODE_SPEED;
        code->live.targets.at[rate].rate = -1;
    }
    held_coordinates_free(held_kind, count);
    LIST_FREE(named);
}

static Status add_event(Code *code, const Event *event, CodeLiveExprs *truths,
                        CodeLiveExprs *values, CodeLiveExprs *targets, Diag *diag)
{
    Status status = OK;
    Expr e;

    CHECK(code_resolve(code, event->when, &e, event->name, diag));
    LIST_PUSH(*truths, e);
    LIST_PUSH(code->live.events, ((CodeEvent){event, values->count}));
    for (int k = 0; event->action == EVENT_SET && k < event->value_count; k++) {
        const NewValue *value = &event->values[k];

        CHECK(code_resolve(code, value->value, &e, event->name, diag));
        LIST_PUSH(*values, e);
        CHECK(add_given(code, value, targets, diag));
    }
done:
    return status;
}

Status code_add_samples(Code *code, Diag *diag)
{
    System *system = code->layout->system;
    const OwnSample *own;
    CodeLiveExprs periods = {0}, next = {0};
    Status status = OK;

    for (int i = 0; (own = system_sample(system, i)) != NULL; i++) {
        Expr e;

        if (own->is_input)
            LIST_PUSH(code->live.held, own->state);
        if (own->period == NULL || own->is_input)
            continue;
        CHECK(code_resolve(code, own->next, &e, "what is sampled", diag));
        LIST_PUSH(next, e);
        LIST_PUSH(periods, own->period);
        LIST_PUSH(code->live.samples, own->state);
    }
    if (code->live.is_wanted || next.count > 0) {
        code_add_function(code, "periods", "sampling periods", periods.at, periods.count, 1);
        code_add_function(code, "samples", "sampled states after their instants", next.at,
                          next.count, 1);
    }
done:
    LIST_FREE(periods);
    LIST_FREE(next);
    return status;
}

/* where each condition of time is next: its phase, 0 or a whole number there, and that one's rate
 */
static void add_timers(Code *code)
{
    const CodeLive *live = &code->live;
    Expr *entries = NEW_ARRAY(Expr, 2 * live->timed);
    Expr t = code->layout->symbols[code->layout->t];

    for (int i = 0; i < live->timed; i++) {
        const CodeSide *side = &live->sides.at[i];

        entries[2 * i] = side->is_floor ? expr_arg(side->call, 0) : side->surface.condition;
        entries[2 * i + 1] = expr_diff(code->arena, entries[2 * i], t);
    }
    code_add_function(code, "timers", "phases of conditions of time, and their rates", entries,
                      live->timed, 2);
    mem_free(entries);
}

/* roots from `first` on, on the signs of what jumps */
static void write_signs(Code *code)
{
    const CodeLive *live = &code->live;
    Surface *surfaces = NEW_ARRAY(Surface, live->sides.count);

    for (int i = 0; i < live->sides.count; i++)
        surfaces[i] = live->sides.at[i].surface;
    for (int i = 0; i < code->roots.count; i++)
        code->roots.at[i] =
            surfaces_substitute(code->arena, code->roots.at[i], surfaces, live->sides.count);
    mem_free(surfaces);
}

Status code_live_events(Code *code, Diag *diag)
{
    const Model *model = code->view->model;
    CodeLive *live = &code->live;
    CodeLiveExprs truths = {0}, values = {0}, targets = {0}, measures = {0};
    const Switch *switches;
    int time_only;
    const int count = system_switches(code->layout->system, &switches, &time_only);
    const int ideals = code->modes.ideals.count;
    Expr *margins = NEW_ARRAY(Expr, ideals);
    Status status = OK;

    for (int i = 0; i < count; i++)
        if (!code_is_side(code, switches[i].call))
            add_side(code, switches[i].condition, switches[i].call, switches[i].surface >= 0);
    for (int i = 0; i < model_event_count(model); i++)
        CHECK(add_event(code, model_event(model, i), &truths, &values, &targets, diag));
    add_held_coordinates(code, &targets);
    CHECK(code_add_samples(code, diag));
    add_sides_of(code, truths.at, truths.count);
    order_sides(code);
    add_slides(code);
    for (int i = 0; i < live->sides.count; i++)
        LIST_PUSH(measures, live->sides.at[i].surface.condition);
    code_margins(code, margins);
    for (int k = 0; k < ideals; k++)
        LIST_PUSH(measures, margins[k]);
    code_add_function(code, "indicators", "what equations jump or bend at", measures.at,
                      measures.count, 1);
    add_timers(code);
    code_add_function(code, "events", "conditions of events: 1 while they hold", truths.at,
                      truths.count, 1);
    code_add_function(code, "values", "new values of events", values.at, values.count, 1);
    code_add_function(code, "targets", "what they are given to", targets.at, targets.count, 1);
    write_signs(code);
done:
    mem_free(margins);
    LIST_FREE(truths);
    LIST_FREE(values);
    LIST_FREE(targets);
    LIST_FREE(measures);
    return status;
}

/* --- derivatives --- */

/* symbols that change along the direction: t, y, s of groups before `most` */
static int directions(const Code *code, int most, Expr *symbols, Expr *rates)
{
    const VariableIndex *l = code->layout;
    const int y[] = {l->q, l->u, l->x, l->references};
    const int counts[] = {l->n, l->nu, l->nx, l->multi_turns};
    int count = 0;

    symbols[count++] = l->symbols[l->t];
    for (int part = 0; part < COUNT(y); part++)
        for (int i = 0; i < counts[part]; i++)
            symbols[count++] = l->symbols[y[part] + i];
    for (int i = 0; i < most; i++)
        symbols[count++] = l->symbols[l->rates + i];
    memcpy(rates, code->live.seeds, (size_t)count * sizeof(Expr));
    return count;
}

/* model parameters, of which dependent ones have their own seeds, and signs that are slid along */
static Expr along_parameters(const Code *code, Expr e)
{
    const Model *model = code->view->model;
    const int count = model_parameter_count(model), slides = code->live.slides.count;
    Expr *symbols = NEW_ARRAY(Expr, count + slides);

    for (int i = 0; i < count; i++) {
        Expr definition;

        symbols[i] = model_parameter(model, i, &definition);
    }
    for (int k = 0; k < slides; k++)
        symbols[count + k] = code->live.sides.at[code->live.slides.at[k]].surface.sign;
    e = expr_diff_along(code->arena, e, symbols, code->live.seeds + 1 + code->ny + code->ns,
                        count + slides);
    mem_free(symbols);
    return e;
}

static Expr along(const Code *code, Expr e, int most)
{
    const int room = 1 + code->ny + code->ns;
    Expr *symbols = NEW_ARRAY(Expr, room), *rates = NEW_ARRAY(Expr, room);
    const int count = directions(code, most, symbols, rates);

    e = expr_diff_along(code->arena, e, symbols, rates, count);
    MEM_FREE(symbols, rates);
    return e;
}

/* the same of all entries of a function; by parameters */
static void add_tangent(Code *code, const char *of, const char *name, const char *what, bool by_p)
{
    const CodeFunction *f = NULL;
    Expr *entries;

    for (int i = 0; i < code->functions.count; i++)
        if (strcmp(code->functions.at[i].name, of) == 0)
            f = &code->functions.at[i];
    if (f == NULL)
        return;
    const int first = f->first, rows = f->rows;

    entries = NEW_ARRAY(Expr, rows);
    for (int i = 0; i < rows; i++)
        entries[i] = by_p ? along_parameters(code, code->roots.at[first + i])
                          : along(code, code->roots.at[first + i], code->ns);
    code_add_function(code, name, what, entries, rows, 1);
    mem_free(entries);
}

/* what rows [A | b] lack when all but the group's unknowns move, or parameters */
static void add_rows_tangent(Code *code, const CodeGroup *group, int function, int number,
                             bool by_p)
{
    static const char *const names[2][4] = {
        {"tangent_1", "tangent_2", "tangent_3", "tangent_4"},
        {"tangent_p_1", "tangent_p_2", "tangent_p_3", "tangent_p_4"}};
    const CodeFunction f = code->functions.at[function];
    Expr *entries = NEW_ARRAY(Expr, group->count);

    for (int i = 0; i < group->count; i++) {
        const Expr *row = code->roots.at + f.first + (ptrdiff_t)i * f.columns;
        Expr lack = row[group->count];

        for (int k = 0; !group->iterates && k < group->count; k++)
            lack =
                expr_sub(code->arena, lack,
                         expr_mul(code->arena, row[k],
                                  code->layout->symbols[code->layout->rates + group->first + k]));
        entries[i] = by_p ? along_parameters(code, lack) : along(code, lack, group->first);
    }
    code->live.tangents[by_p][number] = code_add_function(
        code, names[by_p][number], "right sides for derivatives along a direction", entries,
        group->count, 1);
    mem_free(entries);
}

void code_live_tangents(Code *code)
{
    const int count = 1 + code->ny + code->ns + model_parameter_count(code->view->model) +
                      code->live.slides.count;

    code->live.seeds = NEW_ARRAY(Expr, count);
    code->live.seed_count = count;
    for (int i = 0; i < count; i++) {
        char name[24];

        (void)snprintf(name, sizeof name, "#along.%d", i);
        code->live.seeds[i] = expr_symbol(code->arena, pool_text(code->texts, name, strlen(name)),
                                          SYMBOL_ACCELERATION);
    }
    for (int by_p = 0; by_p < 2; by_p++) {
        for (int g = 0; g < code->group_count; g++)
            add_rows_tangent(code, &code->groups[g], code->groups[g].function, g, by_p);
        for (int k = 0; code_has_modes(code) && k < COUNT(code->modes.functions); k++)
            add_rows_tangent(code, &code->groups[code->modes.group], code->modes.functions[k],
                             2 + k, by_p);
    }
    add_tangent(code, "accelerations", "tangent_accelerations", "derivatives of u'", false);
    add_tangent(code, "derivative", "tangent_derivative", "derivatives of the rates", false);
    add_tangent(code, "outputs", "tangent_outputs", "derivatives of outputs", false);
    add_tangent(code, "indicators", "tangent_indicators", "derivatives of what is jumped at",
                false);
    add_tangent(code, "targets", "tangent_targets", "derivatives of what events give values to",
                false);
    add_tangent(code, "accelerations", "tangent_p_accelerations", "those of u' by parameters",
                true);
    add_tangent(code, "derivative", "tangent_p_derivative", "those of the rates", true);
    add_tangent(code, "outputs", "tangent_p_outputs", "those of outputs", true);
    add_tangent(code, "slides", "tangent_slides", "derivatives of slides", false);
    add_tangent(code, "slides", "tangent_p_slides", "those by parameters", true);
}

/* --- parameters --- */

void code_live_relations(Code *code)
{
    const Model *model = code->view->model;
    const int count = model_parameter_count(model);
    Expr *symbols = NEW_ARRAY(Expr, count), *values = NEW_ARRAY(Expr, count);
    bool changed = count > 0;

    code->live.depends = NEW_ARRAY(bool, count);
    for (int i = 0; i < count; i++) {
        Expr definition;

        symbols[i] = model_parameter(model, i, &definition);
        code->live.depends[i] = expr_kinds(definition) != 0;
        values[i] = code->live.depends[i] ? definition : symbols[i];
    }
    for (int rounds = 0; changed && rounds < count; rounds++) {
        changed = false;
        for (int i = 0; i < count; i++) {
            Expr value = code->live.depends[i]
                             ? expr_substitute(code->arena, values[i], symbols, values, count)
                             : values[i];

            changed = changed || value != values[i];
            values[i] = value;
        }
    }
    code_add_function(code, "relations", "parameters from those that follow from none", values,
                      count, 1);
    for (int i = 0; i < count; i++)
        values[i] = along_parameters(code, values[i]);
    code_add_function(code, "tangent_relations", "their derivatives", values, count, 1);
    MEM_FREE(symbols, values);
}

void code_live_free(CodeLive *live)
{
    LIST_FREE(live->sides);
    LIST_FREE(live->slides);
    LIST_FREE(live->events);
    LIST_FREE(live->targets);
    LIST_FREE(live->samples);
    LIST_FREE(live->held);
    MEM_FREE(live->seeds, live->depends);
}

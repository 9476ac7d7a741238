/* model.c: a model is the list of accepted statements, and the state that they made */
#include "model/model_history.h"

#include "language/functions.h"
#include "language/verbs.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct Model {
    Arena *arena;
    Overrides *overrides;
    bool is_fork; /* it shares the arena and the overrides of another model */
    State *state;
    Opened *opened; /* the definition that is being read; NULL */
    DataFinder finder;
    EntryFinder entries;
    History history;
    const char *undone;
    char *remarks;
    uint64_t revision;
};

static Model *model_around(Arena *arena, State *state)
{
    Model *model = NEW(Model);

    model->arena = arena;
    model->overrides = state->overrides;
    model->state = state;
    history_open(&model->history);
    model->undone = "";
    model->remarks = mem_text("", 0);
    return model;
}

Model *model_new(void)
{
    Arena *arena = arena_new();

    return model_around(arena, state_new(arena, overrides_new(), verb_apply));
}

static Model *fork_around(const Model *model, State *state)
{
    Model *fork = model_around(model->arena, state);

    fork->is_fork = true;
    fork->finder = model->finder;
    fork->finder.given = true;
    fork->revision = model->revision;
    return fork;
}

Status model_fork(const Model *model, Model **out, Diag *diag)
{
    return model_extract(model, NULL, out, NULL, diag);
}

Status model_fork_named(const Model *model, Model **out, Diag *diag)
{
    State *state = NULL;

    TRY(state_rebuild_named(model->state, &state, diag));
    *out = fork_around(model, state);
    return OK;
}

Status model_extract(const Model *model, const Extract *part, Model **out, ExtractedEnds *ends,
                     Diag *diag)
{
    State *state = NULL;

    TRY(part != NULL ? state_extract(model->state, part, &state, ends, diag)
                     : state_rebuild(model->state, -1, &state, NULL, NULL, diag));
    *out = fork_around(model, state);
    return OK;
}

Status model_isolate(const Model *model, const char *name, Model **out, ExtractedEnds *ends,
                     Diag *diag)
{
    State *state = NULL;

    TRY(state_isolate(model->state, name, &state, ends, diag));
    *out = fork_around(model, state);
    return OK;
}

void model_open_insides(Model *fork)
{
    assert(fork->is_fork);
    fork->state->is_open = true;
}

void model_free(Model *model)
{
    if (model == NULL)
        return;
    opened_free(model->opened);
    state_free(model->state);
    if (!model->is_fork) {
        arena_free(model->arena);
        overrides_free(model->overrides);
    }
    history_close(&model->history);
    MEM_FREE(model->remarks, model);
}

static void set_remarks(Model *model, Text *remarks)
{
    mem_free(model->remarks);
    model->remarks = text_done(remarks);
}

void model_join(Model *model, int count, const char *called)
{
    mem_keep(model);
    history_join(&model->history, count, called);
}

int model_begin_group(Model *model)
{
    const int outer = model->history.low;

    mem_keep(model);
    model->history.low = model->history.done;
    return outer;
}

int model_end_group(Model *model, int outer, const char *called)
{
    History *history = &model->history;
    const int count = history->done - history->low;

    mem_keep(model);
    if (count > 0)
        history_join(history, count, called);
    (void)model_leave_group(model, outer);
    return count;
}

int model_leave_group(Model *model, int outer)
{
    if (outer < model->history.low)
        model->history.low = outer;
    return 0;
}

int model_step_count(const Model *model)
{
    return model->history.done;
}

const char *model_step(const Model *model, int i, int *serial)
{
    *serial = model->history.list.at[i].serial;
    return model->history.list.at[i].text;
}

bool model_step_clears(const Model *model, int i)
{
    return model->history.list.at[i].clears;
}

/* --- a definition, from its first line to its end --- */

static bool starts_definition(const Statement *statement)
{
    return statement->row.name != NULL && statement->row.number == VERB_subsystem &&
           statement->body == NULL;
}

const char *model_defining(const Model *model)
{
    return model->opened != NULL ? opened_name(model->opened) : NULL;
}

void model_drop_definition(Model *model)
{
    mem_keep(model);
    opened_free(model->opened);
    model->opened = NULL;
}

static Status end_definition(Model *model, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const Statement *whole = NULL;

    TRY(opened_end(model->opened, statement->place, &whole, diag));
    TRY(history_restore(&model->history, &model->state, whole, outcome, diag));
    model_drop_definition(model);
    model->revision += outcome->changes_equations;
    return OK;
}

static Status apply_in_definition(Model *model, const Statement *statement, Outcome *outcome,
                                  Diag *diag)
{
    if (model->opened == NULL)
        return opened_begin(model->state, statement, &model->opened, diag);
    if (statement->row.name != NULL && statement->row.number == VERB_end)
        return end_definition(model, statement, outcome, diag);
    return opened_add(model->opened, statement, diag);
}

Status model_apply(Model *model, const Statement *statement, Diag *diag)
{
    Status status = OK;
    Outcome outcome = {0};

    mem_keep(model);
    CHECK(data_read_statement(&model->finder, model->arena, statement, !model->finder.given, diag));
    if (model->opened != NULL || starts_definition(statement)) {
        status = apply_in_definition(model, statement, &outcome, diag);
        goto done;
    }
    CHECK(history_restore(&model->history, &model->state, statement, &outcome, diag));
    set_remarks(model, &outcome.remarks);
    model->revision += outcome.changes_equations;
done:
    if (status != OK) {
        Text none = {0};
        set_remarks(model, &none);
    }
    text_free(&outcome.remarks);
    return status;
}

void model_find_data(Model *model, const DataFinder *finder)
{
    mem_keep(model);
    model->finder = *finder;
}

void model_find_entries(Model *model, const EntryFinder *finder)
{
    mem_keep(model);
    model->entries = *finder;
}

const char *model_remarks(const Model *model)
{
    return model->remarks;
}

/* --- undo and redo --- */

static Status move(Model *model, Status (*go)(History *, State **, const char **, bool *, Diag *),
                   Diag *diag)
{
    bool changes_equations = false;
    Text none = {0};
    Status status = OK;

    mem_keep(model);
    CHECK(go(&model->history, &model->state, &model->undone, &changes_equations, diag));
    set_remarks(model, &none);
    model->revision += changes_equations;
done:
    return status;
}

Status model_undo(Model *model, Diag *diag)
{
    return move(model, history_undo, diag);
}

Status model_redo(Model *model, Diag *diag)
{
    return move(model, history_redo, diag);
}

void model_forget_undone(Model *model)
{
    mem_keep(model);
    model->history.list.count = model->history.done;
}

const char *model_undone(const Model *model)
{
    return model->undone;
}

void model_clear(Model *model)
{
    Text none = {0};

    mem_keep(model);
    history_clear(&model->history, &model->state);
    set_remarks(model, &none);
    model->revision++;
}

char *model_save(const Model *model)
{
    Text text = {0};

    state_save(model->state, &text);
    return text_done(&text);
}

/* --- queries --- */

uint64_t model_revision(const Model *model)
{
    return model->revision;
}

Arena *model_arena(const Model *model)
{
    return model->arena;
}

const Graph *model_graph(const Model *model)
{
    return model->state->graph;
}

bool model_is_planar(const Model *model)
{
    return model->state->setup.planar;
}

const Expr *model_gravity(const Model *model)
{
    return model->state->setup.gravity;
}

const char *model_title(const Model *model)
{
    return model->state->setup.title;
}

int model_count(const Model *model)
{
    return model->state->parts.count;
}

const Instance *model_instance(const Model *model, int i)
{
    return model->state->parts.at[i];
}

const Instance *model_find(const Model *model, const char *name)
{
    return state_part(model->state, name);
}

const Instance *model_owner(const Model *model, const char *path, const char **member)
{
    return state_owner(model->state, path, member);
}

const Instance *model_edge_owner(const Model *model, int edge)
{
    return model->state->parts.at[model->state->edge_owner.at[edge]];
}

bool model_coordinate(const Model *model, const char *name, const Instance **owner, int *index)
{
    const Thing *thing = state_thing(model->state, name);

    if (thing != NULL && thing->kind == THING_COORDINATE) {
        *owner = model->state->parts.at[thing->index];
        *index = thing->coordinate;
        return true;
    }
    /* a coordinate whose name is its owner's */
    if (thing == NULL || thing->kind != THING_PART)
        return false;
    *owner = model->state->parts.at[thing->index];
    *index = 0;
    return (*owner)->coord_count == 1 && strcmp((*owner)->coord[0], name) == 0;
}

Status model_trees(const Model *model, const Tree *trees[TREE_KINDS], Diag *diag)
{
    return state_trees(model->state, trees, diag);
}

Status model_preset_trees(const Model *model, bool absolute, Tree *out[2], Diag *diag)
{
    return state_preset_trees(model->state, absolute, out, diag);
}

int model_parameter_count(const Model *model)
{
    return model->state->parameters.count;
}

Expr model_parameter(const Model *model, int i, Expr *definition)
{
    const Definition *d = &model->state->definitions.at[model->state->parameters.at[i].index];

    if (definition != NULL)
        *definition = d->body;
    return d->symbol;
}

bool model_has_parameter(const Model *model, const char *name)
{
    for (int i = 0; i < model_parameter_count(model); i++)
        if (strcmp(expr_name(model_parameter(model, i, NULL)), name) == 0)
            return true;
    return false;
}

static double symbol_value(void *context, Expr symbol)
{
    State *state = context;
    const Definition *d;

    if (expr_name(symbol)[0] == '#')
        return state_lifted_constant(state, expr_name(symbol));
    d = definition_find(state, expr_name(symbol), DEFINES_PARAMETER);
    if (expr_symbol_kind(symbol) != SYMBOL_PARAMETER || d == NULL)
        return (double)NAN;
    return definition_value(state, definition_index(state, d));
}

double model_parameter_value(const Model *model, Expr symbol)
{
    return symbol_value(model->state, symbol);
}

double model_number(const Model *model, Expr e)
{
    return expr_evaluate(e, symbol_value, model->state);
}

double model_scene_number(const void *model, Expr e)
{
    return model_number(model, e);
}

/* --- overrides --- */

int model_override_count(const Model *model)
{
    return model->overrides->list.count;
}

const char *model_override_name(const Model *model, int i)
{
    return model->overrides->list.at[i].name;
}

void model_override(Model *model, const char *name, double value)
{
    overrides_add(model->overrides, name, value, (Measure){.kind = MEASURE_ANY});
    definitions_forget_values(model->state);
}

Status model_check_parameter(Model *model, const char *name, Diag *diag)
{
    State *state = model->state;
    const Definition *d = definition_find(state, name, DEFINES_PARAMETER);
    Text remarks = {0};
    Status status = OK;

    if (d != NULL && !isfinite(definition_value(state, definition_index(state, d))))
        status = diag_set(diag, E_VALUE, "%s has no finite value", name);
    else if (d != NULL)
        status = parts_check_after(state, definition_index(state, d), &remarks, diag);
    text_free(&remarks);
    return status;
}

Status model_override_by(Model *model, const char *name, const Syntax *value, Diag *diag)
{
    State *state = model->state;
    const Definition *d = definition_find(state, name, DEFINES_PARAMETER);
    Scope scope = {.state = state, .kind = SCOPE_PARAMETER};
    Measure measure;
    double number;
    Expr body;
    Status status;

    CHECK(scope_expression(&scope, value, &body, diag));
    CHECK(measure_of(&scope, value, &measure, diag));
    number = state_number(state, body);
    if (!isfinite(number)) {
        status = diag_at(diag, E_DOMAIN, value->place, "%s has no finite value here", name);
        goto done;
    }
    overrides_add(model->overrides, name, number, measure);
    definitions_forget_values(state);
    status = d != NULL ? override_check(state, name, d->measure, diag) : OK;
    if (status == OK)
        status = model_check_parameter(model, name, diag);
    if (status != OK)
        model_drop_overrides(model, model_override_count(model) - 1);
done:
    LIST_FREE(scope.uses);
    return status;
}

void model_drop_overrides(Model *model, int count)
{
    overrides_drop(model->overrides, count);
    definitions_forget_values(model->state);
}

static Status make_scene(const void *context, Scene *out, Diag *diag)
{
    const Model *model = context;
    const State *state = model->state;
    Scene scene = {.arena = model->arena,
                   .revision = model->revision,
                   .planar = state->setup.planar,
                   .gravity = state->setup.gravity,
                   .graph = state->graph,
                   .instances = (const Instance *const *)state->parts.at,
                   .instance_count = state->parts.count,
                   .form = state->setup.form,
                   .independent = state->independent.at,
                   .independent_count = state->independent.count,
                   .network_form = (NetworkForm)state->setup.settings.at[SETTING_NETWORK],
                   .number = model_scene_number,
                   .context = model};
    Status status = OK;

    CHECK(couplings_check(model->state, diag));
    CHECK(model_trees(model, scene.trees, diag));
    for (int i = 0; i < state->parameters.count; i++) {
        Expr symbol = model_parameter(model, i, NULL);

        LIST_PUSH(scene.parameters, (SceneParameter){symbol, model_parameter_value(model, symbol)});
    }
    state_list_scene(state, &scene);
    *out = scene;
done:
    return status;
}

Status model_scene(const Model *model, Scene *out, Diag *diag)
{
    return make_scene(model, out, diag);
}

SceneSource model_scene_source(const Model *model)
{
    return (SceneSource){make_scene, model};
}

int model_output_count(const Model *model)
{
    return model->state->outputs.count;
}

Expr model_output(const Model *model, int i, const char **name)
{
    const Definition *d = &model->state->definitions.at[model->state->outputs.at[i]];

    *name = d->name;
    return d->body;
}

Expr model_law(const Model *model, const char *name, const Expr **arguments, int *count)
{
    const State *state = model->state;
    const Thing *thing = state_thing(state, name);
    const Definition *law;

    if (thing == NULL || thing->kind != THING_DEFINITION)
        return NULL;
    law = &state->definitions.at[thing->index];
    if (law->kind != DEFINES_LAW)
        return NULL;
    *arguments = law->arguments;
    *count = law->argument_count;
    return law->body;
}

int model_subsystem_count(const Model *model)
{
    int count = 0;

    for (int i = 0; i < model->state->definitions.count; i++)
        count += model->state->definitions.at[i].kind == DEFINES_SUBSYSTEM;
    return count;
}

const Subsystem *model_subsystem(const Model *model, int i)
{
    const Definition *d = model->state->definitions.at;

    while (d->kind != DEFINES_SUBSYSTEM || i-- > 0)
        d++;
    return d->subsystem;
}

const Subsystem *model_find_subsystem(const Model *model, const char *name)
{
    return state_subsystem(model->state, name, NULL);
}

char *model_store(const Model *model, const char *name)
{
    return state_store(model->state, name);
}

const char *model_definition_like(const Model *model, const Statement *s, bool *same)
{
    return state_definition_like(model->state, s, same);
}

const char *model_subsystem_key(const Model *model, const char *name, int i)
{
    const Subsystem *subsystem = state_subsystem(model->state, name, NULL);

    for (int k = 0; subsystem != NULL && k < subsystem->port_count; k++)
        if (!subsystem->ports[k].is_through && i-- == 0)
            return subsystem->ports[k].name;
    return subsystem != NULL && i < subsystem->parameter_count ? subsystem->parameters[i] : NULL;
}

int model_use_count(const Model *model)
{
    return model->state->uses.count;
}

const Use *model_use(const Model *model, int i)
{
    return &model->state->uses.at[i];
}

const Use *model_find_use(const Model *model, const char *name)
{
    return state_use(model->state, name);
}

int model_use_around(const Model *model, const char *name)
{
    const State *state = model->state;
    int use = state_use_around(state, name);

    while (use >= 0 && state->uses.at[use].outer >= 0)
        use = state->uses.at[use].outer;
    return use;
}

int model_event_count(const Model *model)
{
    return model->state->events.count;
}

const Event *model_event(const Model *model, int i)
{
    return model->state->definitions.at[model->state->events.at[i]].event;
}

int model_start_count(const Model *model)
{
    return model->state->starts.count;
}

const Start *model_start(const Model *model, int i)
{
    return &model->state->starts.at[i].start;
}

Form model_form(const Model *model, const char *const **independent, int *count)
{
    *independent = model->state->independent.at;
    *count = model->state->independent.count;
    return model->state->setup.form;
}

const SettingValues *model_settings(const Model *model)
{
    return &model->state->setup.settings;
}

void model_setting_text(const Model *model, ModelSetting setting, Text *out)
{
    setting_text(model->state, setting, out);
}

static Scope ask(const Model *model)
{
    return (Scope){.state = model->state, .kind = SCOPE_ASK, .entries = &model->entries};
}

Status model_expression(const Model *model, const Syntax *syntax, Expr *out, Diag *diag)
{
    Scope scope = ask(model);
    Status status = OK;

    CHECK(data_read(&model->finder, model->arena, syntax, false, diag));
    CHECK(scope_expression(&scope, syntax, out, diag));
done:
    LIST_FREE(scope.uses);
    return status;
}

Status model_call(const Model *model, const Syntax *syntax, const Expr *args, Expr *out, Diag *diag)
{
    Scope scope = ask(model);
    Status status = OK;

    CHECK(data_read(&model->finder, model->arena, syntax, false, diag));
    CHECK(function_call(&scope, syntax, args, out, diag));
done:
    LIST_FREE(scope.uses);
    return status;
}

Status model_check_shown(const Model *model, const Syntax *item, Diag *diag)
{
    const Scope scope = ask(model);

    return unit_check_shown(&scope, item, diag);
}

Status model_check_unit(const Model *model, const Syntax *syntax, const char *unit,
                        const char *name, Diag *diag)
{
    const Scope scope = ask(model);

    return unit_check(&scope, syntax, unit, name, diag);
}

bool model_dimension(const Model *model, const Syntax *syntax, Dimension *out)
{
    const Scope scope = ask(model);
    Measure measure;

    if (measure_of(&scope, syntax, &measure, NULL) != OK || measure.kind != MEASURE_KNOWN)
        return false;
    *out = measure.dimension;
    return true;
}

bool model_is_integral(const Model *model, const char *name)
{
    return variable_is_integral(model->state, name);
}

const char *model_member_unit(const Model *model, const Instance *part, const char *member)
{
    return member_unit(ask(model).state, part, member);
}

const char *model_place_unit(const Model *model, const char *text)
{
    return place_unit(ask(model).state, text);
}

Status model_check_alike(const Model *model, const Syntax *left, const Syntax *right, Diag *diag)
{
    const Scope scope = ask(model);

    return unit_check_compared(&scope, left, right, diag);
}

Status model_check_variable(const Model *model, const char *path, int primes, Place place,
                            Diag *diag)
{
    Text name = {0};
    const Thing *thing = state_thing(model->state, path);
    Status status = OK;

    if (thing != NULL && thing->kind == THING_DEFINITION &&
        model->state->definitions.at[thing->index].kind == DEFINES_OUTPUT)
        return OK;
    status = variable_resolve(model->state, NULL, path, primes, ALLOW_MODEL | ALLOW_RUNS, place,
                              &name, diag);

    text_free(&name);
    return status;
}

bool model_can_go(const Model *model, const char *name)
{
    const Thing *thing = state_thing(model->state, name);

    return thing != NULL && thing->kind != THING_COORDINATE;
}

bool model_has_name(const Model *model, const char *name)
{
    return state_thing(model->state, name) != NULL ||
           names_find(model->state->terminals, name) >= 0;
}

const char *model_name(const Model *model, int i)
{
    return state_name_at(model->state, i);
}

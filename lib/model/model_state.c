/* model_state.c: a state, and queries of it */
#include "model/model_impl.h"

#include <string.h>

State *state_new(Arena *arena, Overrides *overrides, Apply *apply)
{
    State *state = NEW(State);

    state->arena = arena;
    state->overrides = overrides;
    state->apply = apply;
    state->pool = pool_new(0);
    for (int i = 0; i < 3; i++)
        state->setup.gravity[i] = expr_int(arena, 0);
    state->setup.title = "";
    state->inside = -1;
    state->graph = graph_new();
    state->names = names_new();
    state->parameter_names = names_new();
    state->terminals = names_new();
    state->start_names = names_new();
    for (int i = 0; i < DOMAIN_COUNT; i++)
        state->setup.datum[i] = -1;
    state->setup.datum[DOMAIN_MECHANICAL] =
        graph_add_node(state->graph, "ground", DOMAIN_MECHANICAL, true);
    return state;
}

void state_forget_trees(State *state)
{
    mem_keep(state);
    for (int kind = 0; kind < TREE_KINDS; kind++) {
        tree_free(state->trees[kind]);
        state->trees[kind] = NULL;
    }
    state->has_trees = false;
}

const char *state_text(State *state, const char *text)
{
    return pool_text(state->pool, text, strlen(text));
}

static const Thing *find_parameter(const State *state, const char *name)
{
    const int number = names_find(state->parameter_names, name);

    return number >= 0 ? &state->parameters.at[number] : NULL;
}

const Thing *state_thing(const State *state, const char *name)
{
    const int number = names_find(state->names, name);

    return number >= 0 ? &state->things.at[number] : find_parameter(state, name);
}

const Thing *state_value_thing(const State *state, const char *name)
{
    const Thing *parameter = find_parameter(state, name);

    return parameter != NULL ? parameter : state_thing(state, name);
}

const Instance *state_part(const State *state, const char *name)
{
    const Thing *thing = state_thing(state, name);

    return thing != NULL && thing->kind == THING_PART ? state->parts.at[thing->index] : NULL;
}

const Instance *state_owner(const State *state, const char *path, const char **member)
{
    const Instance *part = NULL;
    size_t length = 0;

    while (part == NULL && path[length] != '\0') {
        char *owner;

        length += path[length] == '.';
        length += strcspn(path + length, ".");
        owner = mem_text(path, length);
        part = state_part(state, owner);
        mem_free(owner);
    }
    if (part != NULL)
        *member = path[length] == '.' ? path + length + 1 : "";
    return part;
}

void state_name(State *state, const char *name, ThingKind kind, int index, int coordinate)
{
    (void)names_add(state->names, name);
    LIST_PUSH(state->things, (Thing){kind, index, coordinate});
}

void state_name_parameter(State *state, const char *name, int definition)
{
    (void)names_add(state->parameter_names, name);
    LIST_PUSH(state->parameters, (Thing){THING_DEFINITION, definition, 0});
}

void name_list_add(NameList *list, const char *name)
{
    for (int i = 0; i < list->count; i++)
        if (strcmp(list->at[i], name) == 0)
            return;
    LIST_PUSH(*list, name);
}

void state_place_start(State *state, int name_index, int place)
{
    int *at = &state->start_of.at[name_index];

    mem_keep_part(state->start_of.at, at, sizeof *at);
    *at = place;
}

void starts_index(State *state, int first)
{
    while (state->start_of.count < names_count(state->start_names))
        LIST_PUSH(state->start_of, -1);
    for (int i = first; i < state->starts.count; i++)
        state_place_start(state, state->starts.at[i].name_index, i);
}

void scope_use(Scope *scope, int definition)
{
    for (int i = 0; i < scope->uses.count; i++)
        if (scope->uses.at[i] == definition)
            return;
    LIST_PUSH(scope->uses, definition);
}

Definition *definition_find(const State *state, const char *name, DefinitionKind kind)
{
    const Thing *thing =
        kind == DEFINES_PARAMETER ? state_value_thing(state, name) : state_thing(state, name);
    Definition *d = thing != NULL && thing->kind == THING_DEFINITION
                        ? &state->definitions.at[thing->index]
                        : NULL;

    return d != NULL && d->kind == kind ? d : NULL;
}

int definition_index(const State *state, const Definition *d)
{
    return (int)(d - state->definitions.at);
}

/* --- instances of subsystems --- */

const Use *state_use(const State *state, const char *name)
{
    const Thing *thing = state_thing(state, name);

    return thing != NULL && thing->kind == THING_USE ? &state->uses.at[thing->index] : NULL;
}

bool name_is_inside(const char *name, const char *use)
{
    const size_t length = strlen(use);

    return strncmp(name, use, length) == 0 && name[length] == '.';
}

int state_use_around(const State *state, const char *name)
{
    int found = -1;

    for (const char *dot = strchr(name, '.'); dot != NULL; dot = strchr(dot + 1, '.')) {
        char *head = mem_text(name, (size_t)(dot - name));
        const Thing *thing = state_thing(state, head);

        if (thing != NULL && thing->kind == THING_USE)
            found = thing->index;
        mem_free(head);
    }
    return found;
}

const Subsystem *state_subsystem(const State *state, const char *name, int *definition)
{
    const Definition *d = definition_find(state, name, DEFINES_SUBSYSTEM);

    if (d == NULL)
        return NULL;
    if (definition != NULL)
        *definition = definition_index(state, d);
    return d->subsystem;
}

int subsystem_port(const Subsystem *subsystem, const char *name)
{
    for (int i = 0; i < subsystem->port_count; i++)
        if (strcmp(subsystem->ports[i].name, name) == 0)
            return i;
    return -1;
}

/* --- statements --- */

Status state_apply(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    return (*state)->apply(state, statement, outcome, diag);
}

Status state_apply_text(State **state, const char *text, Diag *diag)
{
    Statement *statement = NULL;
    Outcome outcome = {0};
    Status status = OK;

    CHECK(statement_parse(text, 1, (SyntaxOptions){.whole = true}, NULL, &statement, diag));
    CHECK(state_apply(state, statement, &outcome, diag));
done:
    text_free(&outcome.remarks);
    statement_free(statement);
    return status;
}

/* model_state.c: a state, and queries of it */
#include "model/model_impl.h"

#include <string.h>

State *state_new(Arena *arena)
{
    State *state = NEW(State);

    state->arena = arena;
    state->pool = pool_new(0);
    for (int i = 0; i < 3; i++)
        state->gravity[i] = expr_int(arena, 0);
    state->title = "";
    state->inside = -1;
    state->graph = graph_new();
    state->names = names_new();
    state->parameter_names = names_new();
    state->terminals = names_new();
    state->start_names = names_new();
    for (int i = 0; i < DOMAIN_COUNT; i++)
        state->datum[i] = -1;
    state->datum[DOMAIN_MECHANICAL] =
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

void state_place_start(State *state, int name, int place)
{
    int *at = &state->start_of.at[name];

    mem_keep_part(state->start_of.at, at, sizeof *at);
    *at = place;
}

void starts_index(State *state, int first)
{
    while (state->start_of.count < names_count(state->start_names))
        LIST_PUSH(state->start_of, -1);
    for (int i = first; i < state->starts.count; i++)
        state_place_start(state, state->starts.at[i].name, i);
}

void scope_use(Scope *scope, int definition)
{
    for (int i = 0; i < scope->uses.count; i++)
        if (scope->uses.at[i] == definition)
            return;
    LIST_PUSH(scope->uses, definition);
}

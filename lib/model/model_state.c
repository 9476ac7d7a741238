/* model_state.c: making, freeing and looking at a state; which verb is applied by whom */
#include "language/verbs.h"
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
    state->graph = graph_new();
    state->names = names_new();
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
    for (int kind = 0; kind < TREE_KINDS; kind++) {
        tree_free(state->trees[kind]);
        state->trees[kind] = NULL;
    }
    state->has_trees = false;
}

static void free_one(State *state)
{
    state_forget_trees(state);
    graph_free(state->graph);
    names_free(state->names);
    names_free(state->terminals);
    names_free(state->start_names);
    LIST_FREE(state->things);
    LIST_FREE(state->terminal_nodes);
    LIST_FREE(state->parts);
    LIST_FREE(state->edge_owner);
    LIST_FREE(state->definitions);
    LIST_FREE(state->parameters);
    LIST_FREE(state->outputs);
    LIST_FREE(state->events);
    LIST_FREE(state->lines);
    LIST_FREE(state->starts);
    LIST_FREE(state->start_of);
    LIST_FREE(state->independent);
    for (int kind = 0; kind < TREE_KINDS; kind++) {
        LIST_FREE(state->choices[kind].chosen);
        LIST_FREE(state->choices[kind].excluded);
    }
    state_free_changes(state);
    pool_free(state->pool);
    mem_free(state);
}

void state_free(State *state)
{
    while (state != NULL) {
        State *before = state->before;

        free_one(state);
        state = before;
    }
}

const char *state_text(State *state, const char *text)
{
    return pool_text(state->pool, text, strlen(text));
}

const Thing *state_thing(const State *state, const char *name)
{
    int number = names_find(state->names, name);

    return number >= 0 ? &state->things.at[number] : NULL;
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

/* --- verbs --- */

static Apply *const verbs[VERB_COUNT] = {
#define MODEL_VERB(word, ...) [VERB_##word] = apply_##word,
#include "language/verbs.def"
};

Status state_apply(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    Status status = OK;
    Apply *apply = NULL;

    switch (statement->kind) {
    case STATEMENT_EMPTY:
        return OK;
    case STATEMENT_PARAMETER:
        apply = apply_parameter;
        break;
    case STATEMENT_LAW:
        apply = apply_law;
        break;
    case STATEMENT_VERB:
        apply = statement->row.component != NULL ? apply_component : verbs[statement->row.number];
        break;
    }
    if (apply == NULL)
        return diag_at(diag, E_MISSING, statement->verb_place, "'%s' builds nothing",
                       statement->verb);
    status = apply(state, statement, outcome, diag);
    if (status != OK && diag != NULL && diag->place.line == 0)
        diag->place = statement->place;
    return status;
}

/* model_mark.c: undoes a statement without rebuilding the state
 *
 * Most statements only add parts, names and lines to the ends of lists. A mark of the lengths,
 * with the setup, is enough to undo that. What else a statement changes in place is stored with its
 * old value, in the order of the changes. A state that replaced another owns that one, which then
 * no longer changes. */
#include "model/model_given.h"
#include "model/model_impl.h"

#include <assert.h>
#include <string.h>

StateMark state_mark(const State *state)
{
    return (StateMark){.state = state->number,
                       .pool = pool_mark(state->pool),
                       .graph = graph_mark(state->graph),
                       .setup = state->setup,
                       .names = state->things.count,
                       .terminals = state->terminal_nodes.count,
                       .parts = state->parts.count,
                       .couplings = state->couplings.count,
                       .edge_owners = state->edge_owner.count,
                       .definitions = state->definitions.count,
                       .parameters = state->parameters.count,
                       .outputs = state->outputs.count,
                       .events = state->events.count,
                       .lines = state->lines.count,
                       .start_names = names_count(state->start_names),
                       .uses = state->uses.count,
                       .inside_choices = state->inside_choices.count,
                       .changes = state->changes.count};
}

/* --- storing --- */

static Change *keep(State *state, ChangeKind kind, int at)
{
    mem_keep(state);
    LIST_PUSH(state->changes, (Change){.kind = kind, .at = at});
    return &state->changes.at[state->changes.count - 1];
}

void state_retain_line(State *state, int line)
{
    mem_keep_part(state->lines.at, &state->lines.at[line], sizeof *state->lines.at);
    keep(state, CHANGED_LINE, line)->was.line = state->lines.at[line];
}

void state_retain_definition(State *state, int definition)
{
    mem_keep_part(state->definitions.at, &state->definitions.at[definition],
                  sizeof *state->definitions.at);
    keep(state, CHANGED_DEFINITION, definition)->was.definition = state->definitions.at[definition];
}

void state_retain_values(State *state, int part, Value *values)
{
    keep(state, CHANGED_VALUES, part)->was.values = values;
}

/* lines are only added to equations, so that their list up to now suffices */
void state_retain_equations(State *state, int use)
{
    BlockEquations *equations = state->uses.at[use].equations;
    BlockEquations *copy = pool_alloc(state->pool, sizeof *copy);

    pool_retain(state->pool, equations, sizeof *equations);
    *copy = *equations;
    keep(state, CHANGED_EQUATIONS, use)->was.equations = copy;
}

static void copy_names(NameList *to, const NameList *from)
{
    for (int i = 0; i < from->count; i++)
        LIST_PUSH(*to, from->at[i]);
}

void state_retain_choice(State *state, TreeKind kind)
{
    const Choice *choice = &state->choices[kind];
    Choice *copy = NEW(Choice);

    copy->absolute = choice->absolute;
    copy_names(&copy->chosen, &choice->chosen);
    copy_names(&copy->excluded, &choice->excluded);
    keep(state, CHANGED_CHOICE, (int)kind)->was.choice = copy;
}

void state_retain_independent(State *state)
{
    NameList *copy = NEW(NameList);

    copy_names(copy, &state->independent);
    keep(state, CHANGED_INDEPENDENT, 0)->was.independent = copy;
}

/* --- restoring --- */

/* values of parameters depend on each other */
static void restore_definition(State *state, int at, const Definition *was)
{
    mem_keep_part(state->definitions.at, &state->definitions.at[at], sizeof *was);
    state->definitions.at[at] = *was;
    definitions_forget_values(state);
}

static void restore_choice(State *state, int kind, Choice *was)
{
    Choice *choice = &state->choices[kind];

    mem_keep(was);
    LIST_FREE(choice->chosen);
    LIST_FREE(choice->excluded);
    *choice = *was;
    *was = (Choice){false, {0}, {0}};
}

static void restore_start(State *state, int at, const StartEntry *was)
{
    LIST_PUSH(state->starts, *was);
    mem_keep_part(state->starts.at, &state->starts.at[at],
                  sizeof *state->starts.at * (size_t)(state->starts.count - at));
    memmove(&state->starts.at[at + 1], &state->starts.at[at],
            sizeof *state->starts.at * (size_t)(state->starts.count - 1 - at));
    state->starts.at[at] = *was;
}

static void restore_equations(State *state, BlockEquations *equations, const BlockEquations *was)
{
    pool_retain(state->pool, equations, sizeof *equations);
    *equations = *was;
    if (equations->last == NULL)
        return;
    pool_retain(state->pool, equations->last, sizeof *equations->last);
    equations->last->next = NULL;
}

static void restore(State *state, Change *change)
{
    switch (change->kind) {
    case CHANGED_LINE:
        mem_keep_part(state->lines.at, &state->lines.at[change->at], sizeof *state->lines.at);
        state->lines.at[change->at] = change->was.line;
        break;
    case CHANGED_DEFINITION:
        restore_definition(state, change->at, &change->was.definition);
        break;
    case CHANGED_VALUES:
        pool_retain(state->pool, state->parts.at[change->at], sizeof(Instance));
        state->parts.at[change->at]->values = change->was.values;
        break;
    case CHANGED_CHOICE:
        restore_choice(state, change->at, change->was.choice);
        break;
    case CHANGED_INDEPENDENT:
        LIST_FREE(state->independent);
        copy_names((NameList *)&state->independent, change->was.independent);
        break;
    case CHANGED_EQUATIONS:
        restore_equations(state, state->uses.at[change->at].equations, change->was.equations);
        break;
    case ADDED_START:
        state->starts.count--;
        break;
    case REMOVED_START:
        restore_start(state, change->at, &change->was.start);
        break;
    }
}

static void change_free(Change *change)
{
    if (change->kind == CHANGED_CHOICE) {
        mem_keep(change->was.choice);
        LIST_FREE(change->was.choice->chosen);
        LIST_FREE(change->was.choice->excluded);
        mem_free(change->was.choice);
    } else if (change->kind == CHANGED_INDEPENDENT) {
        mem_keep(change->was.independent);
        LIST_FREE(*change->was.independent);
        mem_free(change->was.independent);
    }
}

static void state_free_changes(State *state)
{
    for (int i = 0; i < state->changes.count; i++)
        change_free(&state->changes.at[i]);
    LIST_FREE(state->changes);
}

static void restore_changes(State *state, int count)
{
    bool starts = false;

    mem_keep(state);
    while (state->changes.count > count) {
        Change *change = &state->changes.at[--state->changes.count];

        starts = starts || change->kind == ADDED_START || change->kind == REMOVED_START;
        restore(state, change);
        change_free(change);
    }
    if (starts) {
        state->start_of.count = 0;
        starts_index(state, 0);
    }
}

static void trim(State *state, const StateMark *mark)
{
    state_forget_trees(state);
    state->setup = mark->setup;
    names_trim(state->names, mark->names);
    state->things.count = mark->names;
    names_trim(state->terminals, mark->terminals);
    state->terminal_nodes.count = mark->terminals;
    state->parts.count = mark->parts;
    state->couplings.count = mark->couplings;
    state->edge_owner.count = mark->edge_owners;
    state->definitions.count = mark->definitions;
    names_trim(state->parameter_names, mark->parameters);
    state->parameters.count = mark->parameters;
    state->outputs.count = mark->outputs;
    state->events.count = mark->events;
    state->lines.count = mark->lines;
    state->uses.count = mark->uses;
    state->inside_choices.count = mark->inside_choices;
    names_trim(state->start_names, mark->start_names);
    if (state->start_of.count > mark->start_names)
        state->start_of.count = mark->start_names;
    graph_trim(state->graph, &mark->graph);
    pool_release(state->pool, mark->pool);
}

bool state_go_back(State **state, const StateMark *mark)
{
    const State *found = *state;

    while (found != NULL && found->number != mark->state)
        found = found->before;
    if (found == NULL)
        return false;
    while (*state != found) {
        State *gone = *state;

        mem_keep(gone);
        *state = gone->before;
        gone->before = NULL;
        state_free(gone);
    }
    restore_changes(*state, mark->changes);
    trim(*state, mark);
    return true;
}

void state_replace(State **state, State *next)
{
    State *first = next;
    int more = 1;

    assert(*state != NULL);
    for (; first->before != NULL; more++)
        first = first->before;
    mem_keep(*state);
    first->before = *state;
    for (State *s = next; more > 0; s = s->before)
        s->number = (*state)->number + more--;
    *state = next;
}

void state_forget_before(State *state, size_t bytes)
{
    size_t held = 0;

    for (; state->before != NULL; state = state->before) {
        held += pool_bytes(state->before->pool);
        if (held > bytes) {
            mem_keep(state);
            state_free(state->before);
            state->before = NULL;
            return;
        }
    }
}

/* --- freeing --- */

static void free_one(State *state)
{
    state_forget_trees(state);
    graph_free(state->graph);
    names_free(state->names);
    names_free(state->parameter_names);
    names_free(state->terminals);
    names_free(state->start_names);
    LIST_FREE(state->things);
    LIST_FREE(state->terminal_nodes);
    LIST_FREE(state->parts);
    LIST_FREE(state->edge_owner);
    LIST_FREE(state->definitions);
    LIST_FREE(state->parameters);
    LIST_FREE(state->outputs);
    LIST_FREE(state->couplings);
    LIST_FREE(state->events);
    LIST_FREE(state->lines);
    LIST_FREE(state->uses);
    LIST_FREE(state->inside_choices);
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

static void state_free_later(void *object)
{
    state_free(object);
}

void state_free(State *state)
{
    if (state != NULL && mem_frees_later(state, state_free_later))
        return;
    while (state != NULL) {
        State *before = state->before;

        free_one(state);
        state = before;
    }
}

/* model_store.c: a definition of a subsystem with all that it needs, as a separate text */
#include "model/model_impl.h"

#include <string.h>

/* marks a definition, those that its line needs, and theirs too */
static void want(const State *state, int definition, bool *wanted)
{
    LIST(int) open = {0};

    LIST_PUSH(open, definition);
    while (open.count > 0) {
        const int next = open.at[--open.count];
        const Line *line = &state->lines.at[state->definitions.at[next].line];

        if (wanted[next])
            continue;
        wanted[next] = true;
        for (int i = 0; i < line->use_count; i++)
            LIST_PUSH(open, line->uses[i]);
    }
    LIST_FREE(open);
}

static void add_ports(const Subsystem *subsystem, bool gives, Text *out)
{
    int count = 0;

    for (int i = 0; i < subsystem->port_count; i++) {
        const Port *port = &subsystem->ports[i];

        if (port->is_through == gives)
            text_addf(out, "%s%s", count++ == 0 ? "" : ", ", port->name);
    }
    if (count == 0)
        text_add(out, "nothing");
}

/* a comment for the reader about the contents of the file */
static void add_head(const Subsystem *subsystem, Text *out)
{
    text_addf(out, "# %s: motion and voltage are given at ", subsystem->name);
    add_ports(subsystem, false, out);
    text_add(out, "; it gives them at ");
    add_ports(subsystem, true, out);
    text_add(out, "\n# parameters:");
    for (int i = 0; i < subsystem->parameter_count; i++)
        text_addf(out, " %s", subsystem->parameters[i]);
    text_add(out, subsystem->parameter_count == 0 ? " none\n" : "\n");
}

char *state_store(const State *state, const char *name)
{
    const Definition *d = definition_find(state, name, DEFINES_SUBSYSTEM);
    bool *wanted;
    int count, *order;
    Text text = {0};

    if (d == NULL)
        return NULL;
    wanted = NEW_ARRAY(bool, state->definitions.count);
    want(state, definition_index(state, d), wanted);
    add_head(d->subsystem, &text);
    order = lines_in_order(state, &count);
    for (int i = 0; i < count; i++) {
        const Line *line = &state->lines.at[order[i]];

        if (line->definition >= 0 && wanted[line->definition])
            text_addf(&text, "%s\n", line->text);
    }
    MEM_FREE(order, wanted);
    return text_done(&text);
}

const char *state_definition_like(const State *state, const Statement *s, bool *same)
{
    const char *name = s->kind == STATEMENT_VERB ? s->operands.at[0].value->text : s->name;
    const Thing *thing = state_value_thing(state, name);
    const char *text;
    char *own;

    if (thing == NULL || thing->kind != THING_DEFINITION)
        return NULL;
    text = state->lines.at[state->definitions.at[thing->index].line].text;
    own = statement_full_text(s);
    *same = strcmp(own, text) == 0;
    mem_free(own);
    return text;
}

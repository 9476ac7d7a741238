/* model_subsystem.c: definitions of subsystems: their ports and their statements
 *
 * A definition is tried on an instance with its own name, whose ports are bound to anything that is
 * valid there. So its faults are reported where it is written. The instance is removed when the
 * definition is complete: only the statements are stored. */
#include "model/model_given.h"

#include <string.h>

/* --- the first line --- */

typedef struct Header {
    State *state;
    Subsystem *subsystem;
    Diag *diag;
} Header;

static Status read_port(const Header *h, const Syntax *syntax, const char *key)
{
    const char *name = syntax_name(syntax);
    const bool is_through = strcmp(key, "through") == 0;
    Subsystem *subsystem = h->subsystem;
    int port;

    if (name == NULL || strchr(name, '.') != NULL || name_is_reserved(name)) {
        (void)diag_at(h->diag, E_NAME, syntax->place, "a port is a new name");
        diag_hint(h->diag, "as in frames=[A, B] terminals=[e]");
        return E_NAME;
    }
    port = subsystem_port(subsystem, name);
    if (is_through && port >= 0) {
        subsystem->ports[port].is_through = true;
        return OK;
    }
    if (port >= 0)
        return diag_at(h->diag, E_NAME, syntax->place, "the port %s is named twice", name);
    subsystem->ports[subsystem->port_count++] = (Port){.name = state_text(h->state, name),
                                                       .is_frame = strcmp(key, "frames") == 0,
                                                       .is_through = is_through};
    return OK;
}

/* the ports of one key; ports come before through ports, which may name some of them */
static Status read_ports(const Header *h, const Statement *statement, const char *key)
{
    for (int i = 0; i < statement->pairs.count; i++) {
        const Syntax *value = statement->pairs.at[i].value;

        if (strcmp(statement->pairs.at[i].name, key) != 0)
            continue;
        if (value->kind != SYNTAX_VECTOR)
            return read_port(h, value, key);
        for (int k = 0; k < value->count; k++)
            TRY(read_port(h, value->args[k], key));
    }
    return OK;
}

static int most_ports(const Statement *statement)
{
    int most = 1;

    for (int i = 0; i < statement->pairs.count; i++)
        most += statement->pairs.at[i].value->count + 1;
    return most;
}

static Status read_header(State *state, const Statement *statement, Subsystem *out, Diag *diag)
{
    static const char *const keys[] = {"frames", "terminals", "through"};
    const Operand *name = &statement->operands.at[0];
    const Header h = {state, out, diag};

    TRY(name_is_free(state, name->value->text, name->place, diag));
    if (names_find(state->terminals, name->value->text) >= 0)
        return diag_at(diag, E_NAME, name->place, "'%s' is already a terminal", name->value->text);
    *out = (Subsystem){.name = state_text(state, name->value->text)};
    out->ports = pool_alloc(state->pool, sizeof *out->ports * (size_t)most_ports(statement));
    for (int i = 0; i < COUNT(keys); i++)
        TRY(read_ports(&h, statement, keys[i]));
    return OK;
}

Status subsystem_begin(State *state, const Statement *statement, int *use, Diag *diag)
{
    Subsystem *subsystem = pool_alloc(state->pool, sizeof *subsystem);

    TRY(read_header(state, statement, subsystem, diag));
    *use = state->uses.count;
    LIST_PUSH(state->uses,
              (Use){.name = subsystem->name,
                    .subsystem = subsystem,
                    .bound = pool_alloc(state->pool,
                                        sizeof(char *) * ((size_t)subsystem->port_count + 1)),
                    .equations = pool_alloc(state->pool, sizeof(BlockEquations)),
                    .outer = -1,
                    .line = line_add(state, subsystem->name, -1, -1, NULL),
                    .is_trial = true});
    state_name(state, subsystem->name, THING_USE, *use, 0);
    return OK;
}

/* --- end of the definition --- */

/* whether anything inside is attached to the port, or names it */
static bool is_made(const State *state, const Use *use, int port)
{
    Text name = {0};
    bool made;

    text_addf(&name, "%s.%s", use->name, use->subsystem->ports[port].name);
    made = use->subsystem->ports[port].is_frame ? state_part(state, name.at) != NULL
                                                : names_find(state->terminals, name.at) >= 0;
    text_free(&name);
    return made;
}

void subsystem_forget_places(State *state, int use)
{
    const Use *u = &state->uses.at[use];

    for (int i = 0; i < u->subsystem->port_count; i++) {
        if (u->bound[i] == NULL || is_made(state, u, i))
            continue;
        pool_retain(state->pool, &u->bound[i], sizeof *u->bound);
        u->bound[i] = NULL;
    }
}

Status subsystem_check_ports(const State *state, int use, Place place, Diag *diag)
{
    const Use *u = &state->uses.at[use];

    for (int i = 0; i < u->subsystem->port_count; i++) {
        const Port *port = &u->subsystem->ports[i];

        if (is_made(state, u, i))
            continue;
        (void)diag_at(diag, E_MODEL, place, "nothing in %s stands on its port %s", u->name,
                      port->name);
        diag_hint(diag,
                  port->is_frame ? "make it, arm %s BODY [..], or use it as a place of a part"
                                 : "use it as a terminal of a part, or as %s.v",
                  port->name);
        return E_MODEL;
    }
    return OK;
}

/* Results of the trial: which frames it makes, and the parameters. */
static void learn(State *state, int use, Subsystem *out)
{
    const Use *u = &state->uses.at[use];
    const size_t prefix = strlen(u->name) + 1;

    for (int i = 0; i < out->port_count; i++)
        if (out->ports[i].is_frame)
            out->ports[i].is_through = u->bound[i] == NULL;
    for (int i = 0; i < state->parameters.count; i++) {
        const char *name = state->definitions.at[state->parameters.at[i].index].name;

        if (name_is_inside(name, u->name) && strchr(name + prefix, '.') == NULL)
            out->parameters[out->parameter_count++] =
                mem_text(name + prefix, strlen(name) - prefix);
    }
}

/* the model's definitions that lines from `first` on need */
static void models_uses(const State *state, int first, int definitions, Scope *scope)
{
    for (int i = first; i < state->lines.count; i++)
        for (int k = 0; k < state->lines.at[i].use_count; k++)
            if (state->lines.at[i].uses[k] < definitions)
                scope_use(scope, state->lines.at[i].uses[k]);
}

/* Tries the body; `out` gets the results, with new names. */
static Status try_definition(State **state, const Statement *statement, Subsystem *out,
                             Scope *scope, Diag *diag)
{
    const int first = (*state)->lines.count;
    const int definitions = (*state)->definitions.count;
    Outcome outcome = {0};
    int use = -1;
    Status status = OK;

    CHECK(subsystem_begin(*state, statement, &use, diag));
    CHECK(use_apply_body(state, use, statement->body, &outcome, diag));
    CHECK(subsystem_check_ports(*state, use, statement->place, diag));
    out->port_count = (*state)->uses.at[use].subsystem->port_count;
    out->ports = NEW_ARRAY(Port, out->port_count + 1);
    for (int i = 0; i < out->port_count; i++) {
        const Port *port = &(*state)->uses.at[use].subsystem->ports[i];

        out->ports[i] = *port;
        out->ports[i].name = mem_text(port->name, strlen(port->name));
    }
    out->parameters = NEW_ARRAY(const char *, (*state)->parameters.count + 1);
    learn(*state, use, out);
    out->size = (*state)->lines.count - first;
    models_uses(*state, first, definitions, scope);
done:
    text_free(&outcome.remarks);
    return status;
}

/* copies the result of try_definition() to the pool */
static const Subsystem *settle(State *state, const Statement *statement, Subsystem *learnt)
{
    Subsystem *subsystem = pool_alloc(state->pool, sizeof *subsystem);
    const size_t ports = (size_t)learnt->port_count, parameters = (size_t)learnt->parameter_count;
    const Body *body = statement->body;
    Statement *at = pool_alloc(state->pool, sizeof *at * ((size_t)body->count + 1));

    *subsystem = *learnt;
    subsystem->name = state_text(state, statement->operands.at[0].value->text);
    subsystem->body = (Body){.text = state_text(state, body->text), .at = at, .count = body->count};
    for (int i = 0; i < body->count; i++)
        statement_copy(state->pool, &body->at[i], &at[i]);
    subsystem->ports = pool_alloc(state->pool, sizeof(Port) * (ports + 1));
    subsystem->parameters = pool_alloc(state->pool, sizeof(char *) * (parameters + 1));
    for (size_t i = 0; i < ports; i++) {
        subsystem->ports[i] = learnt->ports[i];
        subsystem->ports[i].name = state_text(state, learnt->ports[i].name);
    }
    for (size_t i = 0; i < parameters; i++)
        subsystem->parameters[i] = state_text(state, learnt->parameters[i]);
    return subsystem;
}

static void forget(Subsystem *learnt)
{
    for (int i = 0; learnt->ports != NULL && i < learnt->port_count; i++)
        mem_free((char *)learnt->ports[i].name);
    for (int i = 0; i < learnt->parameter_count; i++)
        mem_free((char *)learnt->parameters[i]);
    MEM_FREE(learnt->ports, (void *)learnt->parameters);
}

Status apply_subsystem(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const StateMark mark = state_mark(*state);
    Scope scope = {.state = *state};
    Subsystem learnt = {0};
    char *text = NULL;
    Status status = OK;

    (void)outcome;
    if (statement->body == NULL)
        return diag_at(diag, E_SYNTAX, statement->verb_place,
                       "a definition can't stand in another one");
    status = try_definition(state, statement, &learnt, &scope, diag);
    (void)state_go_back(state, &mark);
    CHECK(status);
    text = statement_full_text(statement);
    (void)definition_add(*state,
                         (Definition){.kind = DEFINES_SUBSYSTEM,
                                      .name = statement->operands.at[0].value->text,
                                      .subsystem = settle(*state, statement, &learnt)},
                         text, &scope);
done:
    forget(&learnt);
    LIST_FREE(scope.uses);
    mem_free(text);
    return status;
}

Status apply_end(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)state, (void)outcome;
    (void)diag_at(diag, E_SYNTAX, statement->verb_place, "no definition is open");
    diag_hint(diag, "'subsystem NAME frames=[..]' begins one");
    return E_SYNTAX;
}

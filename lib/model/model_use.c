/* model_use.c: instances of subsystems: a definition's statements, applied in their names
 *
 * A `use` of several instances becomes one line for each, so that one can be deleted alone. What an
 * instance makes has lines of its own, which are added and removed with that line. */
#include "language/verbs.h"
#include "model/model_given.h"

#include <string.h>

enum { MOST_STATEMENTS = 20000 }; /* of one instance: definitions that double soon have more */

/* The value for one instance, from a vector with a value for each. */
static Status value_for(const Pair *pair, int which, int count, Syntax *out, Diag *diag)
{
    const Syntax *value = pair->value;

    if (value->kind != SYNTAX_VECTOR) {
        *out = *value;
        return OK;
    }
    if (value->count != count) {
        (void)diag_at(diag, E_VALUE, value->place, "%s has %d value%s for %d instance%s",
                      pair->name, value->count, value->count == 1 ? "" : "s", count,
                      count == 1 ? "" : "s");
        diag_hint(diag, "a vector has one value for each; a single value is for all");
        return E_VALUE;
    }
    *out = *value->args[which];
    if (value->has_unit && out->kind == SYNTAX_NUMBER && !out->has_unit) {
        out->has_unit = true;
        out->unit = value->unit;
        out->unit_text = value->unit_text;
    } else if (value->has_unit)
        return diag_at(diag, E_VALUE, value->place, "a unit stands behind numbers here");
    return OK;
}

/* --- a statement of a definition --- */

static Status check_allowed(const State *state, int use, const Statement *s, Diag *diag)
{
    static const int allowed[] = {VERB_output, VERB_event, VERB_init,    VERB_guess,    VERB_tree,
                                  VERB_cotree, VERB_use,   VERB_unknown, VERB_internal, VERB_give};

    if (s->kind != STATEMENT_VERB || s->row.component != NULL)
        return OK;
    for (int i = 0; i < COUNT(allowed); i++)
        if (s->row.number == allowed[i] && s->redirect == NULL &&
            (s->operands.count > 0 || s->pairs.count > 0))
            return OK;
    (void)diag_at(diag, E_SYNTAX, s->verb_place, "'%s' can't stand in the definition of %s",
                  s->verb, state->uses.at[use].subsystem->name);
    if (s->row.number == VERB_subsystem)
        diag_hint(diag, "define the inner one before this one; here stands: use %s NAME ...",
                  s->operands.count > 0 ? s->operands.at[0].value->text : "SUBSYSTEM");
    else
        diag_hint(diag, "in it stand parts, parameters, laws, output, event, init, guess, tree "
                        "EDGE, cotree and use; 'end' closes it, and Ctrl-C drops it");
    return E_SYNTAX;
}

/* a definition must make each name once */
static Status check_new(const State *state, const Statement *renamed, const Statement *statement,
                        Diag *diag)
{
    const Thing *thing = state_value_thing(state, renamed->name);
    Text what = {0};

    /* a parameter may have the name of a part */
    if (thing == NULL || (statement->kind == STATEMENT_PARAMETER && thing->kind == THING_PART))
        return OK;
    name_describe(state, thing, &what);
    (void)diag_at(diag, E_NAME, statement->name_place, "'%s' is already %s of this definition",
                  statement->name, what.at);
    text_free(&what);
    return E_NAME;
}

static Status apply_renamed(State **state, Statement *s, const Statement *from, Outcome *outcome,
                            Diag *diag)
{
    const int pairs = s->pairs.count;
    Pair *const at = s->pairs.at;
    Status status = OK;

    if (verb_gives(s))
        return given_add(*state, (*state)->inside, s, from, diag);
    if (s->row.number == VERB_tree || s->row.number == VERB_cotree)
        return apply_tree_inside(state, s, outcome, diag);
    if (s->row.number != VERB_output)
        return state_apply(state, s, outcome, diag);
    /* one by one: several would be tried on a rebuilt state, which lacks the statements before */
    s->pairs.count = 1;
    for (int i = 0; i < pairs && status == OK; i++) {
        s->pairs.at = at + i;
        status = state_apply(state, s, outcome, diag);
    }
    s->pairs.at = at;
    s->pairs.count = pairs;
    return status;
}

/* `use` of several, one by one: each may be bound to ports of those before it */
static Status apply_each(State **state, int use, const Statement *statement, Outcome *outcome,
                         Diag *diag)
{
    const int count = statement->operands.count - 1, pairs = statement->pairs.count;
    Syntax *values = NEW_ARRAY(Syntax, pairs + 1);
    Pair *pair = NEW_ARRAY(Pair, pairs + 1);
    Operand operands[2] = {statement->operands.at[0]};
    Statement one = *statement;
    Status status = OK;

    one.operands.at = operands;
    one.operands.count = COUNT(operands);
    one.pairs.at = pair;
    for (int i = 0; i < count; i++) {
        operands[1] = statement->operands.at[1 + i];
        for (int k = 0; k < pairs; k++) {
            pair[k] = statement->pairs.at[k];
            CHECK(value_for(&pair[k], i, count, &values[k], diag));
            pair[k].value = &values[k];
        }
        CHECK(use_apply(state, use, &one, outcome, diag));
    }
done:
    MEM_FREE(values, pair);
    return status;
}

Status use_apply(State **state, int use, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *const s = *state;
    const int outer = s->inside;
    Pool *pool = NULL;
    Statement renamed = {0};
    Status status = OK;

    if (statement->kind == STATEMENT_EMPTY)
        return OK;
    mem_keep(s);
    TRY(check_allowed(s, use, statement, diag));
    if (statement->kind == STATEMENT_VERB && statement->row.number == VERB_use &&
        statement->operands.count > 2)
        return apply_each(state, use, statement, outcome, diag);
    pool = pool_new(0);
    CHECK(given_allows(s, use, statement, diag));
    CHECK(statement_rename(s, use, statement, pool, &renamed, diag));
    if (statement->kind != STATEMENT_VERB)
        CHECK(check_new(s, &renamed, statement, diag));
    s->inside = use;
    status = apply_renamed(state, &renamed, statement, outcome, diag);
    s->inside = outer;
done:
    pool_free(pool);
    return status;
}

/* --- the body --- */

typedef struct Expansion {
    int use;
    /* by parameter: the value in `use` instead, or NULL; NULL: none */
    const Syntax *const *overrides;
    Outcome *outcome;
    bool at_use; /* the fault is there, not in the definition */
} Expansion;

/* Shows the line of a definition that failed, with a caret under its fault. The first line is the
 * definition's head. */
static void show_inside(const Expansion *x, const State *state, const char *text, int number,
                        Diag *diag)
{
    const Place place = diag->place;
    Text out = {0};

    for (; number > 2 && *text != '\0'; number--)
        text += strcspn(text, "\n") + (strchr(text, '\n') != NULL);
    text_addf(&out, "in %s, line %d:\n", state->uses.at[x->use].subsystem->name, place.line);
    text_add_n(&out, text, strcspn(text, "\n"));
    text_char(&out, '\n');
    text_fill(&out, ' ', place.column > 0 ? place.column - 1 : 0);
    text_char(&out, '^');
    text_fill(&out, '~', place.width - 1);
    if (out.length < sizeof diag->inside)
        memcpy(diag->inside, out.at, out.length + 1);
    text_free(&out);
}

/* Applies a parameter of the definition with another value, in the names of the user of the
 * instance. */
static Status apply_override(State **state, const Expansion *x, const Statement *statement,
                             const Syntax *given, Diag *diag)
{
    State *const s = *state;
    const int outer = s->inside;
    Pool *pool = pool_new(0);
    Statement renamed = {0};
    Scope scope = {.state = s, .kind = SCOPE_PARAMETER};
    Measure measure;
    Text text = {0};
    Status status = OK;

    CHECK(statement_rename(s, x->use, statement, pool, &renamed, diag));
    CHECK(check_new(s, &renamed, statement, diag));
    CHECK(measure_of(&scope, renamed.value, &measure, diag));
    CHECK(parameter_check_alike(&scope, statement->name, measure, given, diag));
    renamed.value = syntax_copy(pool, given);
    text_addf(&text, "%s = ", renamed.name);
    syntax_print(&text, given);
    renamed.text = pool_text(pool, text.at, text.length);
    s->inside = x->use;
    status = state_apply(state, &renamed, x->outcome, diag);
    s->inside = outer;
    if (status == OK)
        parameter_measure_like(*state, renamed.name, measure);
done:
    text_free(&text);
    LIST_FREE(scope.uses);
    pool_free(pool);
    return status;
}

static Status apply_statement(State **state, Expansion *x, const Statement *statement, Diag *diag)
{
    const Subsystem *subsystem = (*state)->uses.at[x->use].subsystem;
    const Syntax *given = NULL;

    for (int i = 0; i < subsystem->parameter_count && x->overrides != NULL; i++)
        if (statement->kind == STATEMENT_PARAMETER &&
            strcmp(subsystem->parameters[i], statement->name) == 0)
            given = x->overrides[i];
    if (given == NULL)
        return use_apply(state, x->use, statement, x->outcome, diag);
    x->at_use = true;
    TRY(apply_override(state, x, statement, given, diag));
    x->at_use = false;
    return OK;
}

static Status apply_body(State **state, Expansion *x, const Body *body, Diag *diag)
{
    Diag found = {0};
    Status status = OK;
    bool at_use = false; /* the fault is in no line */
    int line = 0;        /* of the statement that failed */

    given_begin(*state, x->use, body);
    for (int i = 0; i < body->count && status == OK; i++) {
        status = apply_statement(state, x, &body->at[i], &found);
        line = body->at[i].place.line;
        at_use = x->at_use;
    }
    if (status == OK && body->fault != NULL) {
        found = *body->fault;
        status = found.status;
        line = found.place.line;
    } else if (status == OK) {
        status = given_end(*state, x->use, &at_use, &found);
        line = found.place.line;
    }
    if (status != OK && !at_use && found.inside[0] == '\0')
        show_inside(x, *state, body->text, line, &found);
    if (status != OK && diag != NULL)
        *diag = found;
    return status;
}

Status use_apply_body(State **state, int use, const Body *body, Outcome *outcome, Diag *diag)
{
    return apply_body(state, &(Expansion){.use = use, .outcome = outcome}, body, diag);
}

/* --- use --- */

typedef struct UseDraft {
    State **state;
    const Statement *statement;
    const Subsystem *subsystem;
    int definition;
    int count; /* of instances */
    int which;
    const Syntax **overrides; /* of this instance, by parameter */
    Use use;
    Text text; /* `use` of this one alone */
    Scope scope;
    Outcome *outcome;
    Diag *diag;
} UseDraft;

static Status key_fits_none(const UseDraft *d, const Pair *pair)
{
    const Subsystem *subsystem = d->subsystem;
    Suggest suggest = suggest_for(pair->name);
    Text list = {0};

    for (int i = 0; i < subsystem->port_count; i++)
        if (!subsystem->ports[i].is_through) {
            suggest_offer(&suggest, subsystem->ports[i].name);
            text_addf(&list, " %s=", subsystem->ports[i].name);
        }
    for (int i = 0; i < subsystem->parameter_count; i++) {
        suggest_offer(&suggest, subsystem->parameters[i]);
        text_addf(&list, " %s=", subsystem->parameters[i]);
    }
    (void)diag_at(d->diag, E_NAME, pair->name_place, "%s has no port and no parameter '%s'",
                  subsystem->name, pair->name);
    if (suggest.best != NULL)
        diag_hint(d->diag, "did you mean '%s'?", suggest.best);
    else if (list.at != NULL)
        diag_hint(d->diag, "it takes%s", list.at);
    text_free(&list);
    return E_NAME;
}

static Status bind_frame(UseDraft *d, int port, const Syntax *value)
{
    State *state = *d->state;
    const char *name = syntax_name(value);
    const Instance *part = name != NULL ? state_part(state, name) : NULL;
    Text what = {0};

    if (name == NULL ||
        (strcmp(name, "ground") != 0 &&
         (part == NULL || (part->row->family != FAMILY_BODY && part->row->family != FAMILY_ARM)))) {
        const Thing *thing = name != NULL ? state_thing(state, name) : NULL;

        if (thing != NULL)
            name_describe(state, thing, &what);
        (void)diag_at(d->diag, E_NAME, value->place, "%s %s%s",
                      name == NULL    ? "a frame"
                      : thing != NULL ? name
                                      : "unknown frame",
                      name == NULL    ? "is expected here"
                      : thing != NULL ? "is "
                                      : "",
                      name == NULL    ? ""
                      : thing != NULL ? what.at
                                      : name);
        diag_hint(d->diag, "the port %s of %s is a frame: ground, a body or an arm",
                  d->subsystem->ports[port].name, d->subsystem->name);
        text_free(&what);
        return E_NAME;
    }
    TRY(use_check_reach(state, name, value->place, d->diag));
    d->use.bound[port] = state_text(state, name);
    return OK;
}

static Status bind_terminal(UseDraft *d, int port, const Syntax *value)
{
    State *state = *d->state;
    const bool is_zero = value->kind == SYNTAX_NUMBER && strcmp(value->text, "0") == 0;
    const char *name = is_zero ? "0" : syntax_name(value);
    const bool is_there = name != NULL && names_find(state->terminals, name) >= 0;

    if (name != NULL && strcmp(name, "gnd") == 0)
        name = "0";
    if (name == NULL || strcmp(name, "ground") == 0 ||
        (!is_there && strchr(name, '.') != NULL && state->inside < 0 && !state->is_open)) {
        (void)diag_at(d->diag, E_NAME, value->place, "a terminal is expected here");
        if (name != NULL && strncmp(name, d->use.name, strlen(d->use.name)) == 0 &&
            name[strlen(d->use.name)] == '.')
            diag_hint(d->diag,
                      "%s comes with this line: bind a new name, such as %s=n, and join the two "
                      "behind it: vsource J n %s 0",
                      name, d->subsystem->ports[port].name, name);
        else
            diag_hint(d->diag, "the port %s of %s is a terminal: any new name, or 0",
                      d->subsystem->ports[port].name, d->subsystem->name);
        return E_NAME;
    }
    if (strcmp(name, "0") != 0 && !is_there &&
        definition_find(state, name, DEFINES_PARAMETER) == NULL)
        TRY(name_is_free(state, name, value->place, d->diag));
    TRY(use_check_reach(state, name, value->place, d->diag));
    d->use.bound[port] = state_text(state, name);
    return OK;
}

/* Reads the value of a parameter in `use`, before the definition is read. */
static Status read_override(UseDraft *d, int parameter, const Syntax *value)
{
    Scope scope = {.state = *d->state, .kind = SCOPE_PARAMETER};
    Expr body = NULL;
    Status status = scope_expression(&scope, value, &body, d->diag);

    for (int i = 0; i < scope.uses.count && status == OK; i++)
        scope_use(&d->scope, scope.uses.at[i]);
    LIST_FREE(scope.uses);
    d->overrides[parameter] = value;
    return status;
}

static Status read_pair(UseDraft *d, const Pair *pair)
{
    const Subsystem *subsystem = d->subsystem;
    const int port = subsystem_port(subsystem, pair->name);
    Syntax *value = pool_alloc((*d->state)->pool, sizeof *value);
    int parameter = 0;

    while (parameter < subsystem->parameter_count &&
           strcmp(subsystem->parameters[parameter], pair->name) != 0)
        parameter++;
    if (pair->primes > 0 || (port < 0 && parameter == subsystem->parameter_count))
        return key_fits_none(d, pair);
    if (port >= 0 && subsystem->ports[port].is_through) {
        (void)diag_at(d->diag, E_NAME, pair->name_place, "%s gives %s itself: it isn't bound",
                      subsystem->name, pair->name);
        diag_hint(d->diag,
                  subsystem->ports[port].is_frame
                      ? "it is reached as %s.%s; weld NAME %s.%s FRAME joins it to another"
                      : "it is reached as %s.%s; vsource NAME %s.%s TERMINAL 0 joins it to another",
                  d->use.name, pair->name, d->use.name, pair->name);
        return E_NAME;
    }
    TRY(value_for(pair, d->which, d->count, value, d->diag));
    text_addf(&d->text, " %s=", pair->name);
    syntax_print(&d->text, value);
    if (port < 0)
        return read_override(d, parameter, value);
    return subsystem->ports[port].is_frame ? bind_frame(d, port, value)
                                           : bind_terminal(d, port, value);
}

static Status check_bound(const UseDraft *d)
{
    for (int i = 0; i < d->subsystem->port_count; i++) {
        const Port *port = &d->subsystem->ports[i];

        if (port->is_through || d->use.bound[i] != NULL)
            continue;
        (void)diag_at(d->diag, E_VALUE,
                      (Place){d->statement->place.line,
                              d->statement->place.column + d->statement->place.width, 1},
                      "use %s %s needs %s=", d->subsystem->name, d->use.name, port->name);
        diag_hint(d->diag,
                  port->is_frame ? "%s is a frame that is given from outside: %s=FRAME"
                                 : "%s is a terminal that is given from outside: %s=TERMINAL; "
                                   "with through=[%s] in the first line of %s it is %s.%s",
                  port->name, port->name, port->name, d->subsystem->name, d->use.name, port->name);
        return E_VALUE;
    }
    return OK;
}

static Status check_name(const UseDraft *d, const Operand *operand)
{
    const State *state = *d->state;
    const char *name = syntax_name(operand->value);

    if (name == NULL || (strchr(name, '.') != NULL && state->inside < 0))
        return diag_at(d->diag, E_NAME, operand->place, "an instance's name is a new name");
    if (names_find(state->terminals, name) >= 0)
        return diag_at(d->diag, E_NAME, operand->place, "'%s' is already a terminal", name);
    return name_is_free(state, name, operand->place, d->diag);
}

/* Reports the error of a definition's line where it is used. */
static Status report_inside(const UseDraft *d, const Operand *operand, const Diag *fault)
{
    (void)diag_at(d->diag, fault->status, operand->place, "%s: %s", d->use.name, fault->message);
    diag_hint(d->diag, "%s", fault->hint);
    if (d->diag != NULL)
        memcpy(d->diag->inside, fault->inside, sizeof fault->inside);
    return fault->status;
}

static Status make_instance(UseDraft *d, const Operand *operand)
{
    State *state = *d->state;
    const int definitions = state->definitions.count;
    const int number = state->uses.count;
    Expansion x = {.use = number, .outcome = d->outcome};
    Diag fault = {0};
    Status status = OK;
    int line;

    TRY(check_name(d, operand));
    d->use = (Use){
        .name = state_text(state, syntax_name(operand->value)),
        .subsystem = d->subsystem,
        .bound = pool_alloc(state->pool, sizeof(char *) * ((size_t)d->subsystem->port_count + 1)),
        .equations = pool_alloc(state->pool, sizeof(BlockEquations)),
        .outer = state->inside};
    d->overrides =
        pool_alloc(state->pool, sizeof *d->overrides * ((size_t)d->subsystem->parameter_count + 1));
    d->scope.uses.count = 0;
    scope_use(&d->scope, d->definition);
    text_addf(&d->text, "use %s %s", d->subsystem->name, d->use.name);
    for (int i = 0; i < d->statement->pairs.count; i++)
        TRY(read_pair(d, &d->statement->pairs.at[i]));
    TRY(check_bound(d));

    d->use.line = line = line_add(state, d->text.at, -1, -1, NULL);
    state->lines.at[line].use = number;
    LIST_PUSH(state->uses, d->use);
    state_name(state, d->use.name, THING_USE, number, 0);
    x.overrides = d->overrides;
    status = apply_body(d->state, &x, &d->subsystem->body, &fault);
    if (status != OK && !x.at_use)
        return report_inside(d, operand, &fault);
    if (status != OK) {
        if (d->diag != NULL)
            *d->diag = fault;
        return status;
    }

    for (int i = line; i < state->lines.count; i++)
        for (int k = 0; k < state->lines.at[i].use_count; k++)
            if (state->lines.at[i].uses[k] < definitions)
                scope_use(&d->scope, state->lines.at[i].uses[k]);
    line_uses(state, &state->lines.at[line], &d->scope);
    return OK;
}

Status apply_use(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const StateMark mark = state_mark(*state);
    const Operand *what = &statement->operands.at[0];
    const char *name = syntax_name(what->value);
    UseDraft draft = {.state = state, .statement = statement, .outcome = outcome, .diag = diag};
    const Thing *thing = name != NULL ? state_thing(*state, name) : NULL;
    Status status = OK;

    mem_keep(*state);
    if (name == NULL)
        return diag_at(diag, E_VALUE, what->place, "the name of a subsystem stands here");
    draft.subsystem = state_subsystem(*state, name, &draft.definition);
    if (draft.subsystem == NULL && thing != NULL && thing->kind == THING_USE &&
        strcmp((*state)->uses.at[thing->index].subsystem->name, name) == 0) {
        (void)diag_at(diag, E_NAME, what->place, "%s can't be used in its own definition", name);
        diag_hint(diag, "'end' closes it");
        return E_NAME;
    }
    if (draft.subsystem == NULL)
        return name_unknown(*state, "subsystem", name, what->place, diag);
    if (draft.subsystem->size > MOST_STATEMENTS) {
        (void)diag_at(diag, E_VALUE, what->place, "an instance of %s has %d statements", name,
                      draft.subsystem->size);
        diag_hint(diag, "%d are the most; definitions that use others several times grow fast",
                  MOST_STATEMENTS);
        return E_VALUE;
    }
    draft.count = statement->operands.count - 1;
    for (int i = 1; i < statement->operands.count && status == OK; i++) {
        draft.which = i - 1;
        status = make_instance(&draft, &statement->operands.at[i]);
        text_free(&draft.text);
    }
    if (status != OK)
        (void)state_go_back(state, &mark);
    outcome->changes_equations = true;
    LIST_FREE(draft.scope.uses);
    return status;
}

/* model_define.c: parameters, laws and outputs
 *
 * A parameter remains a symbol, so a new value changes no equation. A law or output is substituted
 * wherever it is used, so a new one rebuilds the state from its lines. */
#include "model/model_impl.h"

#include <math.h>
#include <string.h>

/* --- circular definitions --- */

static Status report_circle(const State *state, const int *from, int definition, int last,
                            Place place, Diag *diag)
{
    Text path = {0};
    const char *name = state->definitions.at[definition].name;
    NumberList way = {0};

    for (int d = last; d >= 0; d = from[d])
        LIST_PUSH(way, d);
    for (int i = way.count - 1; i >= 0; i--)
        text_addf(&path, "%s, ", state->definitions.at[way.at[i]].name);
    (void)diag_at(diag, E_VALUE, place, "%s would depend on itself: %s, %s%s", name, name, path.at,
                  name);
    text_free(&path);
    LIST_FREE(way);
    return E_VALUE;
}

/* Refuses when `uses` lead back to the definition. */
static Status check_circle(const State *state, int definition, const int *uses, int count,
                           Place place, Diag *diag)
{
    int n = state->definitions.count;
    /* the definition that led here; -1 the new text itself, -2 not seen */
    int *from = NEW_ARRAY(int, n);
    NumberList stack = {0};
    Status status = OK;

    for (int i = 0; i < n; i++)
        from[i] = -2;
    for (int i = 0; i < count; i++) {
        if (uses[i] == definition) {
            status = diag_at(diag, E_VALUE, place, "%s would depend on itself",
                             state->definitions.at[definition].name);
            goto done;
        }
        from[uses[i]] = -1;
        LIST_PUSH(stack, uses[i]);
    }
    while (stack.count > 0) {
        int d = stack.at[--stack.count];
        int at = state->definitions.at[d].line;
        const int root = line_root(state, at);

        /* for an instance also the needs of its statement, which must come first */
        for (bool more = true; more; at = root) {
            const Line *line = &state->lines.at[at];

            more = at != root;
            for (int i = 0; i < line->use_count; i++) {
                if (line->uses[i] == definition) {
                    status = report_circle(state, from, definition, d, place, diag);
                    goto done;
                }
                if (from[line->uses[i]] != -2)
                    continue;
                from[line->uses[i]] = d;
                LIST_PUSH(stack, line->uses[i]);
            }
        }
    }
done:
    LIST_FREE(stack);
    mem_free(from);
    return status;
}

/* --- adding and changing --- */

int definition_add(State *state, Definition d, const char *text, const Scope *scope)
{
    int index = state->definitions.count;

    d.name = state_text(state, d.name);
    d.line = line_add(state, text, index, -1, scope);
    LIST_PUSH(state->definitions, d);
    if (d.kind == DEFINES_PARAMETER)
        state_name_parameter(state, d.name, index);
    else
        state_name(state, d.name, THING_DEFINITION, index, 0);
    return index;
}

static Status check_new_name(const State *state, const char *name, DefinitionKind kind, Place place,
                             Diag *diag)
{
    if (kind != DEFINES_PARAMETER && names_find(state->terminals, name) >= 0)
        return diag_at(diag, E_NAME, place, "'%s' is already a terminal", name);
    return kind == DEFINES_PARAMETER ? name_is_free_for_parameter(state, name, place, diag)
                                     : name_is_free(state, name, place, diag);
}

/* Replaces the line of a definition: rebuilds the state from its lines. On failure nothing has
 * changed. */
static Status replace_line(State **state, int index, const char *text, const Scope *scope,
                           Place place, bool changes_equations, Outcome *outcome, Diag *diag)
{
    Line *line = &(*state)->lines.at[(*state)->definitions.at[index].line];
    Line before = *line;
    const char *name = (*state)->definitions.at[index].name;
    State *next = NULL;
    Diag fault = {0};
    Status status;

    mem_keep_part((*state)->lines.at, line, sizeof *line);
    line->text = state_text(*state, text);
    line_uses(*state, line, scope);
    status = state_rebuild(*state, -1, &next, NULL, &outcome->remarks, &fault);
    *line = before;
    if (status != OK) {
        status = diag_at(diag, status, place, "what uses %s would fail: %s", name, fault.message);
        diag_hint(diag, "%s", fault.hint);
        return status;
    }
    state_replace(state, next);
    outcome->changes_equations = outcome->changes_equations || changes_equations;
    return OK;
}

static void set_body(State *state, Definition *d, Expr body)
{
    mem_keep_part(state->definitions.at, d, sizeof *d);
    d->body = body;
    definitions_forget_values(state);
}

/* Sets another body of the parameter, unless parts refuse the resulting values. */
static Status try_body(State *state, Definition *d, Expr body, const Statement *statement,
                       Outcome *outcome, Diag *diag)
{
    const Expr before = d->body;
    Diag fault = {0};
    Status status;

    state_retain_definition(state, definition_index(state, d));
    set_body(state, d, body);
    status = parts_check_after(state, definition_index(state, d), &outcome->remarks, &fault);
    if (status == OK)
        return OK;
    status = diag_at(diag, status, statement->value->place, "%s = %g is refused: %s", d->name,
                     definition_value(state, definition_index(state, d)), fault.message);
    diag_hint(diag, "%s", fault.hint);
    set_body(state, d, before);
    return status;
}

/* A value of another dimension may not match where the name is used. */
static Status change_parameter(State **in, Definition *d, Expr body, Measure measure,
                               const Statement *statement, const Scope *scope, const char *text,
                               Outcome *outcome, Diag *diag)
{
    State *state = *in;
    Line *line = &state->lines.at[d->line];
    const Expr before = d->body;
    Status status = OK;

    CHECK(check_circle(state, definition_index(state, d), scope->uses.at, scope->uses.count,
                       statement->name_place, diag));
    CHECK(try_body(state, d, body, statement, outcome, diag));
    if (!measure_same(d->measure, measure)) {
        status = replace_line(in, definition_index(state, d), text, scope, statement->value->place,
                              false, outcome, diag);
        if (status != OK)
            set_body(state, d, before);
        return status;
    }
    state_retain_line(state, d->line);
    line->text = state_text(state, text);
    line_uses(state, line, scope);
done:
    return status;
}

Status parameter_check_alike(const Scope *scope, const char *name, Measure measure,
                             const Syntax *value, Diag *diag)
{
    Measure own;
    Text was = {0};
    Text is = {0};

    TRY(measure_of(scope, value, &own, diag));
    if (measures_fit(measure, own))
        return OK;
    measure_print(&was, measure);
    measure_print(&is, own);
    (void)diag_at(diag, E_UNIT, value->place, "%s is in %s, and this in %s", name, was.at, is.at);
    diag_hint(diag, "a new value has the dimension of the old one; " SI_HINT);
    text_free(&was);
    text_free(&is);
    return E_UNIT;
}

void parameter_measure_like(State *state, const char *name, Measure measure)
{
    Definition *d = definition_find(state, name, DEFINES_PARAMETER);

    if (measure.kind == MEASURE_KNOWN && d->measure.kind != MEASURE_KNOWN)
        d->measure = measure;
}

Status override_check(const State *state, const char *name, Measure measure, Diag *diag)
{
    const Override *override = override_find(state, name);
    Text was = {0}, is = {0};

    if (override == NULL || measures_fit(measure, override->measure))
        return OK;
    measure_print(&was, measure);
    measure_print(&is, override->measure);
    (void)diag_set(diag, E_UNIT, "%s is in %s, and the value that overrides it in %s", name, was.at,
                   is.at);
    diag_hint(diag, SI_HINT);
    text_free(&was);
    text_free(&is);
    return E_UNIT;
}

Status apply_parameter(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    Definition *d = definition_find(s, statement->name, DEFINES_PARAMETER);
    Scope scope = {.state = s, .kind = SCOPE_PARAMETER};
    char *text = statement_full_text(statement);
    Expr body = NULL;
    Measure measure;
    Status status = OK;

    if (d == NULL)
        CHECK(check_new_name(s, statement->name, DEFINES_PARAMETER, statement->name_place, diag));
    CHECK(scope_expression(&scope, statement->value, &body, diag));
    CHECK(measure_of(&scope, statement->value, &measure, diag));
    status = override_check(s, statement->name, measure, diag);
    if (status != OK) {
        diag->place = statement->value->place;
        goto done;
    }
    if (!isfinite(state_number(s, body))) {
        status = diag_at(diag, E_DOMAIN, statement->value->place, "%s has no finite value here",
                         statement->name);
        goto done;
    }
    if (d != NULL) {
        status = change_parameter(state, d, body, measure, statement, &scope, text, outcome, diag);
        goto done;
    }
    (void)definition_add(
        s,
        (Definition){.kind = DEFINES_PARAMETER,
                     .name = statement->name,
                     .symbol = expr_symbol(s->arena, statement->name, SYMBOL_PARAMETER),
                     .body = body,
                     .measure = measure},
        text, &scope);
done:
    LIST_FREE(scope.uses);
    mem_free(text);
    return status;
}

Status set_inside_parameter(State *state, const Pair *pair, Outcome *outcome, Diag *diag)
{
    Definition *d = definition_find(state, pair->name, DEFINES_PARAMETER);
    const Statement statement = {.value = pair->value};
    Scope scope = {.state = state, .kind = SCOPE_PARAMETER};
    Expr body = NULL;
    Text text = {0};
    Status status = OK;
    int line;

    CHECK(scope_expression(&scope, pair->value, &body, diag));
    CHECK(parameter_check_alike(&scope, d->name, d->measure, pair->value, diag));
    if (!isfinite(state_number(state, body))) {
        status =
            diag_at(diag, E_DOMAIN, pair->value->place, "%s has no finite value here", pair->name);
        goto done;
    }
    CHECK(check_circle(state, definition_index(state, d), scope.uses.at, scope.uses.count,
                       pair->name_place, diag));
    CHECK(try_body(state, d, body, &statement, outcome, diag));
    state_retain_line(state, d->line);
    line_uses(state, &state->lines.at[d->line], &scope);
    text_addf(&text, "set %s = ", pair->name);
    syntax_print(&text, pair->value);
    line_supersede(state, -1, d->name);
    line = line_add(state, text.at, -1, -1, &scope);
    state->lines.at[line].key = d->name;
done:
    LIST_FREE(scope.uses);
    text_free(&text);
    return status;
}

/* --- laws --- */

static Expr *argument_symbols(State *state, const Statement *statement)
{
    int count = statement->argument_count;
    Expr *arguments = pool_alloc(state->pool, sizeof(Expr) * ((size_t)count + 1));

    for (int i = 0; i < count; i++)
        arguments[i] = expr_symbol(state->arena, statement->arguments[i], SYMBOL_ARGUMENT);
    return arguments;
}

/* whether equations with either law are the same */
static bool is_same_law(const Definition *law, const Statement *statement, Expr body)
{
    bool same = law->body == body && law->argument_count == statement->argument_count;

    for (int i = 0; same && i < law->argument_count; i++)
        same = strcmp(expr_name(law->arguments[i]), statement->arguments[i]) == 0;
    return same;
}

Status apply_law(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    Definition *law = definition_find(s, statement->name, DEFINES_LAW);
    Scope scope = {.state = s,
                   .kind = SCOPE_LAW,
                   .arguments = statement->arguments,
                   .argument_count = statement->argument_count};
    char *text = statement_full_text(statement);
    Expr body = NULL;
    Status status = OK;

    if (law == NULL)
        CHECK(check_new_name(s, statement->name, DEFINES_LAW, statement->name_place, diag));
    CHECK(scope_expression(&scope, statement->value, &body, diag));
    if (law != NULL) {
        CHECK(check_circle(s, definition_index(s, law), scope.uses.at, scope.uses.count,
                           statement->name_place, diag));
        /* also with another text of equal value: its units may differ */
        if (strcmp(s->lines.at[law->line].text, text) != 0)
            status =
                replace_line(state, definition_index(s, law), text, &scope, statement->name_place,
                             !is_same_law(law, statement, body), outcome, diag);
        goto done;
    }
    (void)definition_add(s,
                         (Definition){.kind = DEFINES_LAW,
                                      .name = statement->name,
                                      .body = body,
                                      .syntax = syntax_copy(s->pool, statement->value),
                                      .arguments = argument_symbols(s, statement),
                                      .argument_count = statement->argument_count},
                         text, &scope);
done:
    LIST_FREE(scope.uses);
    mem_free(text);
    return status;
}

/* --- outputs --- */

static bool is_used(const State *state, int definition)
{
    for (int i = 0; i < state->lines.count; i++)
        for (int j = 0; j < state->lines.at[i].use_count; j++)
            if (state->lines.at[i].uses[j] == definition && !state->lines.at[i].is_gone)
                return true;
    return false;
}

static Status change_output(State **state, Definition *output, Expr body, Measure measure,
                            const Pair *pair, const Scope *scope, const char *text,
                            Outcome *outcome, Diag *diag)
{
    State *s = *state;
    Line *line = &s->lines.at[output->line];
    bool is_same = output->body == body;

    TRY(check_circle(s, definition_index(s, output), scope->uses.at, scope->uses.count,
                     pair->name_place, diag));
    if (is_used(s, definition_index(s, output)) &&
        !(is_same && measure_same(output->measure, measure))) {
        return replace_line(state, definition_index(s, output), text, scope, pair->name_place,
                            !is_same, outcome, diag);
    }
    state_retain_line(s, output->line);
    state_retain_definition(s, definition_index(s, output));
    line->text = state_text(s, text);
    line_uses(s, line, scope);
    output->body = body;
    output->measure = measure;
    return OK;
}

static Status output_pair(State **state, const Pair *pair, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    Definition *output = definition_find(s, pair->name, DEFINES_OUTPUT);
    Scope scope = {.state = s, .kind = SCOPE_OUTPUT};
    Text text = {0};
    Expr body = NULL;
    Measure measure;
    Status status = OK;

    if (pair->primes > 0 || (strchr(pair->name, '.') != NULL && s->inside < 0)) {
        status = diag_at(diag, E_NAME, pair->name_place, "a new name has no dot and no primes");
        goto done;
    }
    if (output == NULL)
        CHECK(check_new_name(s, pair->name, DEFINES_OUTPUT, pair->name_place, diag));
    CHECK(scope_expression(&scope, pair->value, &body, diag));
    CHECK(measure_of(&scope, pair->value, &measure, diag));
    text_addf(&text, "output %s = ", pair->name);
    syntax_print(&text, pair->value);
    if (output != NULL) {
        status = change_output(state, output, body, measure, pair, &scope, text.at, outcome, diag);
        goto done;
    }
    LIST_PUSH(s->outputs, definition_add(s,
                                         (Definition){.kind = DEFINES_OUTPUT,
                                                      .name = pair->name,
                                                      .body = body,
                                                      .measure = measure},
                                         text.at, &scope));
done:
    LIST_FREE(scope.uses);
    text_free(&text);
    return status;
}

Status apply_output(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    return apply_pairs(state, statement, output_pair, outcome, diag);
}

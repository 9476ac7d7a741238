/* model_start.c: initial values, guesses, and the form of the equations */
#include "language/verbs.h"
#include "model/model_impl.h"

#include <string.h>

/* writes the required unit of the value of a variable and its derivatives; nothing: any unit */
static void unit_of(const State *state, const char *name, int primes, Text *unit)
{
    Measure measure = variable_measure(state, NULL, name);

    if (measure.kind != MEASURE_KNOWN)
        return;
    dimension_print(unit, measure.dimension);
    for (int i = 0; i < primes; i++)
        text_add(unit, "/s");
}

/* Checks the variable and the unit of an initial value or guess, and writes the variable's full
 * name. Positions, speeds, voltages, currents, charges and fluxes can have one; E_VALUE for
 * variables that follow from these. */
Status initial_check(const Scope *scope, const Pair *pair, Text *name, Diag *diag)
{
    const State *state = scope->state;
    Text again = {0};
    Text unit = {0};
    Status status = OK;

    CHECK(variable_resolve(state, NULL, pair->name, 0, 0, pair->name_place, name, diag));
    if (variable_resolve(state, NULL, pair->name, pair->primes + 1, 0, pair->name_place, &again,
                         NULL) != OK) {
        status = diag_at(diag, E_VALUE, pair->name_place,
                         "%s%.*s can't be given: it follows from the rest", pair->name,
                         pair->primes, "'''''''''");
        diag_hint(diag, "positions, rates, voltages and currents can");
        goto done;
    }
    unit_of(state, name->at, pair->primes, &unit);
    if (unit.at != NULL)
        CHECK(unit_check(scope, pair->value, unit.at, pair->name, diag));
done:
    text_free(&again);
    text_free(&unit);
    return status;
}

static Status read_start(State *state, const Pair *pair, bool is_guess, StartEntry *out, Diag *diag)
{
    Scope scope = {.state = state, .kind = SCOPE_START};
    Text name = {0};
    Text text = {0};
    Expr value = NULL;
    int name_index = 0;
    Status status = OK;

    CHECK(initial_check(&scope, pair, &name, diag));
    CHECK(scope_expression(&scope, pair->value, &value, diag));
    text_add(&text, name.at);
    text_fill(&text, '\'', pair->primes);
    name_index = names_add(state->start_names, text.at);
    text_add(&text, " = ");
    syntax_print(&text, pair->value);
    *out = (StartEntry){
        .start = {state_text(state, name.at), pair->primes, value, is_guess, pair->name_place},
        .text = state_text(state, text.at),
        .name_index = name_index,
        .group = state->setup.group_count,
    };
done:
    LIST_FREE(scope.uses);
    text_free(&name);
    text_free(&text);
    return status;
}

static void remove_start(State *state, int at)
{
    LIST_PUSH(state->changes,
              (Change){.kind = REMOVED_START, .at = at, .was.start = state->starts.at[at]});
    state_place_start(state, state->starts.at[at].name_index, -1);
    mem_keep_part(state->starts.at, &state->starts.at[at],
                  sizeof *state->starts.at * (size_t)(state->starts.count - at));
    state->starts.count--;
    memmove(&state->starts.at[at], &state->starts.at[at + 1],
            sizeof *state->starts.at * (size_t)(state->starts.count - at));
    starts_index(state, at);
}

/* adds a value; it replaces an earlier one of the same variable */
static void put_start(State *state, const StartEntry *entry)
{
    starts_index(state, state->starts.count);
    if (state->start_of.at[entry->name_index] >= 0)
        remove_start(state, state->start_of.at[entry->name_index]);
    LIST_PUSH(state->starts, *entry);
    LIST_PUSH(state->changes, (Change){.kind = ADDED_START});
    starts_index(state, state->starts.count - 1);
}

static void forget_starts(State *state, bool guesses)
{
    for (int i = state->starts.count - 1; i >= 0; i--)
        if (state->starts.at[i].start.is_guess == guesses)
            remove_start(state, i);
}

static Status apply_starts(State *state, const Statement *statement, bool is_guess, Diag *diag)
{
    LIST(StartEntry) entries = {0};
    Status status = OK;

    for (int i = 0; i < statement->pairs.count; i++) {
        LIST_PUSH(entries, (StartEntry){.text = ""});
        CHECK(read_start(state, &statement->pairs.at[i], is_guess, &entries.at[i], diag));
    }
    if (statement->operands.count > 0)
        forget_starts(state, is_guess);
    for (int i = 0; i < entries.count; i++)
        put_start(state, &entries.at[i]);
    state->setup.group_count++;
done:
    LIST_FREE(entries);
    return status;
}

Status apply_init(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)outcome;
    return apply_starts(*state, statement, false, diag);
}

Status apply_guess(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)outcome;
    return apply_starts(*state, statement, true, diag);
}

/* --- form --- */

static Status read_independent(State *state, const Syntax *value, NameList *names, Diag *diag)
{
    bool is_list = value->kind == SYNTAX_VECTOR;

    for (int i = 0; i < (is_list ? value->count : 1); i++) {
        const Syntax *entry = is_list ? value->args[i] : value;
        const char *name = syntax_name(entry);
        int owner = 0;
        int coordinate = 0;

        if (name == NULL) {
            (void)diag_at(diag, E_NAME, entry->place, "independent= names coordinates");
            diag_hint(diag, "as in independent=[h8, s11]");
            return E_NAME;
        }
        TRY(coordinate_resolve(state, name, entry->place, &owner, &coordinate, diag));
        name_list_add(names, state_text(state, state->parts.at[owner]->coord[coordinate]));
    }
    return OK;
}

Status apply_form(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    bool embedded = strcmp(statement->operands.at[0].value->text, "embedded") == 0;
    NameList names = {0};
    Status status = OK;

    if (statement->pairs.count > 0 && !embedded) {
        status = diag_at(diag, E_VALUE, statement->pairs.at[0].name_place,
                         "the augmented form has no independent coordinates");
        diag_hint(diag, "form embedded independent=[..]");
        goto done;
    }
    if (statement->pairs.count > 0)
        CHECK(read_independent(s, statement->pairs.at[0].value, &names, diag));
    s->setup.form = embedded ? FORM_EMBEDDED : FORM_AUGMENTED;
    state_retain_independent(s);
    LIST_FREE(s->independent);
    for (int i = 0; i < names.count; i++)
        LIST_PUSH(s->independent, names.at[i]);
    outcome->changes_equations = true;
done:
    LIST_FREE(names);
    return status;
}

/* --- copying and saving --- */

static Status copy_start(State *to, const StartEntry *entry, NameList *broken, Text *remarks,
                         Diag *diag)
{
    const char *verb = entry->start.is_guess ? "guess" : "init";
    Text name = {0};
    Text text = {0};
    Status status = OK;

    if (variable_resolve(to, NULL, entry->start.name, 0, 0, entry->start.place, &name, NULL) !=
        OK) {
        if (remarks != NULL)
            text_addf(remarks, "forgot %s %s\n", verb, entry->text);
        goto done;
    }
    text_addf(&text, "%s %s", verb, entry->text);
    status = state_apply_text(&to, text.at, diag);
    if (status == OK)
        to->starts.at[to->starts.count - 1].group = entry->group;
    else if (broken != NULL) {
        name_list_add(broken, verb);
        status = OK;
    }
done:
    text_free(&name);
    text_free(&text);
    return status;
}

Status starts_copy(State *to, const State *from, NameList *broken, Text *remarks, Diag *diag)
{
    /* `from` also has the values that subsystems set, unless the user removed them */
    forget_starts(to, false);
    forget_starts(to, true);
    for (int i = 0; i < from->starts.count; i++)
        TRY(copy_start(to, &from->starts.at[i], broken, remarks, diag));
    to->setup.group_count = from->setup.group_count;
    to->setup.form = from->setup.form;
    to->setup.settings = from->setup.settings;
    for (int i = 0; i < from->independent.count; i++) {
        int owner;
        int coordinate;

        if (coordinate_resolve(to, from->independent.at[i], (Place){0}, &owner, &coordinate,
                               NULL) == OK)
            LIST_PUSH(to->independent, state_text(to, from->independent.at[i]));
        else if (remarks != NULL)
            text_addf(remarks, "%s is no longer an independent coordinate\n",
                      from->independent.at[i]);
    }
    return OK;
}

/* whether a subsystem in use sets such values: `verb` is VERB_init or VERB_guess */
static bool gives_starts(const State *state, int verb)
{
    for (int i = 0; i < state->uses.count; i++) {
        const Body *body = &state->uses.at[i].subsystem->body;

        for (int k = 0; k < body->count; k++)
            if (body->at[k].kind == STATEMENT_VERB && body->at[k].row.number == verb)
                return true;
    }
    return false;
}

void starts_save(const State *state, Text *text)
{
    if (state->setup.form == FORM_EMBEDDED) {
        text_add(text, "form embedded");
        for (int i = 0; i < state->independent.count; i++)
            text_addf(text, "%s%s", i == 0 ? " independent=[" : ", ", state->independent.at[i]);
        text_add(text, state->independent.count > 0 ? "]\n" : "\n");
    }
    for (int i = 0; i < MODEL_SETTINGS; i++)
        if (state->setup.settings.at[i] != 0) {
            text_addf(text, "set %s ", model_setting(i)[0]);
            setting_text(state, (ModelSetting)i, text);
            text_char(text, '\n');
        }
    if (gives_starts(state, VERB_init))
        text_add(text, "init none\n");
    if (gives_starts(state, VERB_guess))
        text_add(text, "guess none\n");
    for (int i = 0; i < state->starts.count; i++) {
        const StartEntry *entry = &state->starts.at[i];
        const StartEntry *before = i > 0 ? entry - 1 : NULL;
        bool goes_on = before != NULL && before->group == entry->group &&
                       before->start.is_guess == entry->start.is_guess;

        if (goes_on)
            text_addf(text, ", %s", entry->text);
        else
            text_addf(text, "%s%s %s", i > 0 ? "\n" : "", entry->start.is_guess ? "guess" : "init",
                      entry->text);
    }
    if (state->starts.count > 0)
        text_char(text, '\n');
}

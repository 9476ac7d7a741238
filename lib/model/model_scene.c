/* model_scene.c: scene, gravity, title; changing and deleting existing things */
#include "language/verbs.h"
#include "model/model_impl.h"

#include <assert.h>
#include <string.h>

/* adds the line of a statement of which only the last one has effect */
static void add_only_line(State *state, const Statement *statement, const Scope *scope)
{
    char *text = statement_full_text(statement);
    int line;

    line_supersede(state, -1, statement->verb);
    line = line_add(state, text, -1, -1, scope);
    state->lines.at[line].key = state_text(state, statement->verb);
    mem_free(text);
}

static Line *find_line(State *state, const char *key)
{
    for (int i = 0; i < state->lines.count; i++) {
        Line *line = &state->lines.at[i];

        if (line->part < 0 && !line->is_gone && line->key != NULL && strcmp(line->key, key) == 0)
            return line;
    }
    return NULL;
}

static Status check_scene(const State *state, const Operand *operand, bool planar, Diag *diag)
{
    Status status = OK;

    if (planar == state->setup.planar)
        return OK;
    if (state->parts.count > 0) {
        status = diag_at(diag, E_VALUE, operand->place, "the scene can't become %s any more",
                         operand->value->text);
        diag_hint(diag, "it is said before the first part; %s was made already",
                  state->parts.at[0]->name);
    } else if (planar && !expr_is_zero(state->setup.gravity[2])) {
        status = diag_at(diag, E_VALUE, operand->place, "gravity leaves the plane");
        diag_hint(diag, "say the scene first, then gravity [gx, gy]");
    }
    return status;
}

/* The scene's line remains before the others, which may be invalid in the new scene. */
static Status change_scene(State **state, Line *line, const Statement *statement, Diag *diag)
{
    Place place = statement->operands.at[0].place;
    char *text = statement_full_text(statement);
    const char *before = line->text;
    State *next = NULL;
    Diag fault = {0};
    Status status;

    line->text = state_text(*state, text);
    mem_free(text);
    status = state_rebuild(*state, -1, &next, NULL, NULL, &fault);
    line->text = before;
    if (status != OK) {
        status = diag_at(diag, status, place, "the scene can't become %s any more: %s",
                         statement->operands.at[0].value->text, fault.message);
        diag_hint(diag, "%s", fault.hint);
        return status;
    }
    state_replace(state, next);
    return OK;
}

Status apply_scene(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    const Operand *operand = &statement->operands.at[0];
    bool planar = strcmp(operand->value->text, "planar") == 0;
    Line *line = find_line(s, statement->verb);

    TRY(check_scene(s, operand, planar, diag));
    if (planar != s->setup.planar)
        outcome->changes_equations = true;
    if (line == NULL) {
        s->setup.planar = planar;
        add_only_line(s, statement, NULL);
    } else if (planar != s->setup.planar)
        return change_scene(state, line, statement, diag);
    return OK;
}

Status apply_gravity(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    static const Param param = {"gravity", PARAM_VECTOR, "m/s^2", NULL, "", POSITIONAL};
    State *s = *state;
    Scope scope = {.state = s};
    Value value = {0};
    Status status = OK;

    CHECK(
        param_read(&scope, (Wanted){&param, false}, statement->operands.at[0].value, &value, diag));
    for (int i = 0; i < 3; i++) {
        if (s->setup.gravity[i] != value.at[i])
            outcome->changes_equations = true;
        s->setup.gravity[i] = value.at[i];
    }
    add_only_line(s, statement, &scope);
done:
    LIST_FREE(scope.uses);
    return status;
}

Status apply_title(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)outcome;
    (void)diag;
    (*state)->setup.title = state_text(*state, statement->operands.at[0].value->text);
    add_only_line(*state, statement, NULL);
    return OK;
}

/* --- set NAME.key = value --- */

/* message for `set leg1.A = ...`, where A is no parameter */
static Status key_of_use(const State *state, const Use *use, const char *key, const Pair *pair,
                         Diag *diag)
{
    const char *const subsystem = use->subsystem->name;

    if (subsystem_port(use->subsystem, key) >= 0) {
        (void)diag_at(diag, E_NAME, pair->name_place, "%s is a port of %s: 'use' binds it", key,
                      use->name);
        diag_hint(diag, "delete %s, and make it anew: use %s %s %s=...", use->name, subsystem,
                  use->name, key);
    } else if (state_part(state, pair->name) != NULL) {
        (void)diag_at(diag, E_NAME, pair->name_place,
                      "%s is a part of %s: 'set' changes a key of it", pair->name, use->name);
        diag_hint(diag, "it is written set %s.KEY = value; 'info %s' lists its keys", pair->name,
                  pair->name);
    } else {
        (void)diag_at(diag, E_NAME, pair->name_place, "%s has no parameter '%s'", use->name, key);
        diag_hint(diag, "'info %s' shows what it has", use->name);
    }
    return E_NAME;
}

static Status find_key(State *state, const Pair *pair, Instance **part, int *param, Diag *diag)
{
    const char *dot = strrchr(pair->name, '.');
    char *owner = mem_text(pair->name, dot != NULL ? (size_t)(dot - pair->name) : 0);
    const Instance *found = state_part(state, owner);
    Status status = OK;

    if (dot == NULL || pair->primes > 0) {
        status = diag_at(diag, E_NAME, pair->name_place, "'set' changes a key of a part");
        diag_hint(diag, "it is written set NAME.KEY = value");
        goto done;
    }
    if (found == NULL && state_use(state, owner) != NULL) {
        status = key_of_use(state, state_use(state, owner), dot + 1, pair, diag);
        goto done;
    }
    if (found == NULL) {
        status = name_unknown(state, "part", owner, pair->name_place, diag);
        goto done;
    }
    *part = state->parts.at[found->number];
    *param = component_param(found->row, dot + 1);
    if (*param < 0)
        status = key_unknown(found->row, dot + 1, pair->name_place, diag);
done:
    mem_free(owner);
    return status;
}

/* offset of a position in a text */
static size_t offset_of(const char *text, Place place)
{
    const char *at = text;

    for (int line = 1; line < place.line; line++)
        at = strchr(at, '\n') + 1;
    return (size_t)(at - text) + (size_t)place.column - 1;
}

/* the statement of a part with another value for a key; new */
static char *statement_with(const Instance *part, const char *key, const Syntax *value, Diag *diag)
{
    Statement *statement = NULL;
    const size_t length = strlen(part->text);
    size_t from = length, to = length;
    Text text = {0};

    if (statement_parse(part->text, 1, (SyntaxOptions){false}, NULL, &statement, diag) == OK)
        for (int i = 0; i < statement->pairs.count; i++) {
            const Pair *pair = &statement->pairs.at[i];
            const size_t at = offset_of(part->text, pair->name_place);

            if (strcmp(pair->name, key) == 0)
                from = at;
            else if (at > from && at < to)
                to = at;
        }
    text_addf(&text, "%.*s %s=", (int)from, part->text, key);
    syntax_print(&text, value);
    text_addf(&text, " %s", part->text + to);
    statement_free(statement);
    return text_done(&text);
}

/* Sets a key that determines which shapes a part has: its statement gets the value, and the state
 * is rebuilt. */
static Status change_shapes(State **state, const Instance *part, const Pair *pair, const char *key,
                            Outcome *outcome, Diag *diag)
{
    State *s = *state, *next = NULL;
    Line *line = NULL;
    const char *before = part->text;
    char *text = statement_with(part, key, pair->value, diag);
    Diag fault = {0};
    Status status;

    for (int i = 0; line == NULL; i++)
        if (s->lines.at[i].part == part->number)
            line = &s->lines.at[i];
    line->text = state_text(s, text);
    status = state_rebuild(s, -1, &next, NULL, &outcome->remarks, &fault);
    line->text = before;
    mem_free(text);
    if (status != OK) {
        status = diag_at(diag, status, pair->value->place, "what uses %s would fail: %s",
                         part->name, fault.message);
        diag_hint(diag, "%s", fault.hint);
        return status;
    }
    state_replace(state, next);
    outcome->changes_equations = true;
    return OK;
}

/* Coordinates have names, which other statements use: no key may change the set of coordinates. */
static Status keeps_coordinates(const State *state, const Instance *part, const Pair *pair,
                                Diag *diag)
{
    Status status;

    if (instance_coord_count(part, state->setup.planar) == part->coord_count)
        return OK;
    status = diag_at(diag, E_VALUE, pair->name_place, "%s decides which coordinates %s has",
                     pair->name, part->name);
    diag_hint(diag, "delete %s and make it anew with the other value", part->name);
    return status;
}

/* set k = 3: same as k = 3 */
static Status set_parameter(State **state, const Pair *pair, Outcome *outcome, Diag *diag)
{
    Text text = {0};
    Status status;

    text_addf(&text, "%s = ", pair->name);
    syntax_print(&text, pair->value);
    status = apply_parameter(state,
                             &(Statement){.kind = STATEMENT_PARAMETER,
                                          .text = text.at,
                                          .name = pair->name,
                                          .name_place = pair->name_place,
                                          .value = pair->value},
                             outcome, diag);
    text_free(&text);
    return status;
}

static Status set_pair(State **state, const Pair *pair, Outcome *outcome, Diag *diag)
{
    State *s = *state;
    Instance *part = NULL;
    Scope scope = {.state = s};
    Value *values = NULL;
    Value *kept = NULL;
    Text text = {0};
    int index = -1;
    int line;
    Status status = OK;

    if (pair->primes == 0 && definition_find(s, pair->name, DEFINES_PARAMETER) != NULL)
        return state_use_around(s, pair->name) >= 0 ? set_inside_parameter(s, pair, outcome, diag)
                                                    : set_parameter(state, pair, outcome, diag);
    CHECK(find_key(s, pair, &part, &index, diag));
    assert(part != NULL && index >= 0);
    scope.own = part;
    if (part->row->family == FAMILY_DRIVER)
        scope.kind = SCOPE_DRIVE;
    kept = part->values;
    values = pool_alloc(s->pool, sizeof *values * (size_t)part->row->param_count);
    memcpy(values, kept, sizeof *values * (size_t)part->row->param_count);
    values[index] = (Value){0};
    CHECK(param_read(
        &scope,
        (Wanted){&part->row->params[index], instance_takes_angle(part, &part->row->params[index])},
        pair->value, &values[index], diag));
    CHECK(param_check_alike(part->row, values, index, pair->value, diag));
    pool_retain(s->pool, part, sizeof *part);
    part->values = values;
    part->is_geared = part->is_geared || (part->row->params[index].use & GEARS) != 0;
    if (part->row->deforming != NULL &&
        instance_coord_count(part, s->setup.planar) != part->coord_count) {
        part->values = kept;
        status = change_shapes(state, part, pair, part->row->params[index].name, outcome, diag);
        goto done;
    }
    status = part_check_plane(s, part, pair->value->place, diag);
    if (status == OK)
        status = keeps_coordinates(s, part, pair, diag);
    if (status == OK)
        status = part_check(s, part, &outcome->remarks, diag);
    if (status != OK) {
        if (diag != NULL && diag->place.line == 0)
            diag->place = pair->value->place;
        part->values = kept;
        goto done;
    }
    state_retain_values(s, part->number, kept);
    text_addf(&text, "set %s = ", pair->name);
    syntax_print(&text, pair->value);
    line_supersede(s, part->number, part->row->params[index].name);
    line = line_add(s, text.at, -1, part->number, &scope);
    s->lines.at[line].key = part->row->params[index].name;
    outcome->changes_equations = true;
done:
    LIST_FREE(scope.uses);
    text_free(&text);
    return status;
}

Status apply_set(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const char *name = statement->operands.count > 0 ? syntax_name(statement->operands.at[0].value)
                       : statement->pairs.count > 0 && statement->pairs.at[0].primes == 0
                           ? statement->pairs.at[0].name
                           : NULL;

    for (int i = 0; name != NULL && i < MODEL_SETTINGS; i++)
        if (strcmp(model_setting(i)[0], name) == 0)
            return setting_apply(*state, (ModelSetting)i, statement, outcome, diag);
    return apply_pairs(state, statement, set_pair, outcome, diag);
}

/* --- delete --- */

static int defining_line(const State *state, const Thing *thing)
{
    if (thing->kind == THING_USE)
        return state->uses.at[thing->index].line;
    if (thing->kind == THING_DEFINITION)
        return state->definitions.at[thing->index].line;
    for (int i = 0; i < state->lines.count; i++)
        if (state->lines.at[i].part == thing->index)
            return i;
    return -1;
}

static Status find_doomed(const State *state, const char *name, Place place, int *line, Diag *diag)
{
    const Thing *thing = name != NULL ? state_thing(state, name) : NULL;
    Status status;

    if (name != NULL && names_find(state->terminals, name) >= 0 && thing == NULL) {
        status = diag_at(diag, E_NAME, place, "%s is a terminal", name);
        diag_hint(diag, "it goes with the last component on it");
        return status;
    }
    if (thing == NULL)
        return name_unknown(state, "name", name != NULL ? name : "", place, diag);
    if (state_use_around(state, name) >= 0) {
        const char *use = state->uses.at[state_use_around(state, name)].name;

        status = diag_at(diag, E_NAME, place, "%s is a part of %s, which 'use' made as a whole",
                         name, use);
        diag_hint(diag, "delete %s removes all of it", use);
        return status;
    }
    if (thing->kind == THING_COORDINATE) {
        const char *owner = state->parts.at[thing->index]->name;

        status = diag_at(diag, E_NAME, place, "%s is a coordinate of %s", name, owner);
        diag_hint(diag, "delete %s removes both", owner);
        return status;
    }
    *line = defining_line(state, thing);
    return OK;
}

Status apply_delete(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const Operand *operand = &statement->operands.at[0];
    const char *name = syntax_name(operand->value);
    NameList broken = {0};
    State *next = NULL;
    Text users = {0};
    int line = -1;
    Status status = OK;

    CHECK(find_doomed(*state, name, operand->place, &line, diag));
    CHECK(state_rebuild(*state, line, &next, &broken, &outcome->remarks, diag));
    if (broken.count > 0) {
        for (int i = 0; i < broken.count && i < 6; i++)
            text_addf(&users, "%s%s", i > 0 ? ", " : "", broken.at[i]);
        if (broken.count > 6)
            text_addf(&users, " and %d more", broken.count - 6);
        status = diag_at(diag, E_VALUE, operand->place, "%s is used by %s", name, users.at);
        diag_hint(diag, "delete what uses it first");
        goto done;
    }
    outcome->changes_equations = (*state)->lines.at[line].definition < 0;
    if (definition_find(next, name, DEFINES_PARAMETER) != NULL)
        text_addf(&outcome->remarks, "the parameter %s is still there\n", name);
    state_replace(state, next);
    next = NULL;
done:
    state_free(next);
    LIST_FREE(broken);
    text_free(&users);
    return status;
}

void state_list_scene(const State *state, Scene *scene)
{
    for (int i = 0; i < state->outputs.count; i++) {
        const Definition *d = &state->definitions.at[state->outputs.at[i]];

        LIST_PUSH(scene->outputs, (SceneOutput){d->name, d->body});
    }
    for (int i = 0; i < state->uses.count; i++) {
        const Use *use = &state->uses.at[i];

        LIST_PUSH(scene->uses, (SceneUse){use->name, use->subsystem->name, use->outer});
    }
}

void scene_free(Scene *scene)
{
    LIST_FREE(scene->parameters);
    LIST_FREE(scene->outputs);
    LIST_FREE(scene->uses);
}

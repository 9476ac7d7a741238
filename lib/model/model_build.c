/* model_build.c: from a component's statement to an instance, its frame, terminals and edges
 *
 * A statement is completely read into a PartDraft first; only then nodes, edges and names are
 * added. */
#include "model/model_draft.h"

#include <assert.h>
#include <string.h>

/* --- values --- */

static Status give(PartDraft *draft, int index, const Syntax *value, Place place)
{
    Instance *part = draft->part;
    const Param *param = &part->row->params[index];

    if (part->values[index].given)
        return diag_at(draft->diag, E_SYNTAX, place, "%s is given twice", param->name);
    TRY(param_read(&draft->scope, (Wanted){param, instance_takes_angle(part, param)}, value,
                   &part->values[index], draft->diag));
    return param_check_alike(part->row, part->values, index, value, draft->diag);
}

static Status read_positional(PartDraft *draft)
{
    const Component *row = draft->part->row;
    Status status = OK;
    const Operand *operand;
    Text form = {0};

    for (int i = 0; i < row->param_count && draft->at < draft->statement->operands.count; i++) {
        if ((row->params[i].use & POSITIONAL) == 0)
            continue;
        operand = &draft->statement->operands.at[draft->at++];
        CHECK(give(draft, i, operand->value, operand->place));
    }
    if (draft->at < draft->statement->operands.count) {
        operand = &draft->statement->operands.at[draft->at];
        status =
            diag_at(draft->diag, E_SYNTAX, operand->place, "%s has no place for this", row->name);
        places_form(row, &form);
        diag_hint(draft->diag, "it is written %s %s%s", row->name, form.at,
                  row->param_count > 0 ? ", then key=value" : "");
    }
done:
    text_free(&form);
    return status;
}

Status key_unknown(const Component *row, const char *key, Place place, Diag *diag)
{
    Suggest suggest = suggest_for(key);
    Text list = {0};

    for (int i = 0; i < row->param_count; i++) {
        suggest_offer(&suggest, row->params[i].name);
        text_addf(&list, " %s=", row->params[i].name);
    }
    (void)diag_at(diag, E_NAME, place, "'%s' has no key '%s'", row->name, key);
    if (suggest.best != NULL)
        diag_hint(diag, "did you mean '%s'?", suggest.best);
    else if (list.length > 0)
        diag_hint(diag, "it has%s", list.at);
    text_free(&list);
    return E_NAME;
}

/* by=V1, by=leg1.th1: the source or coordinate that supplies the motion of a driver */
static Status read_by(PartDraft *draft, const Pair *pair)
{
    Instance *part = draft->part;
    const char *name = syntax_name(pair->value);
    const Instance *source = name != NULL ? state_part(draft->state, name) : NULL;

    if (name == NULL)
        return diag_at(draft->diag, E_NAME, pair->value->place,
                       "by= names a coordinate or a source");
    if (source == NULL || source->row->family != FAMILY_SCALAR)
        return coordinate_resolve(draft->state, name, pair->value->place, &part->by,
                                  &part->by_coordinate, draft->diag);
    if (component_source(source->row) < 0) {
        (void)diag_at(draft->diag, E_VALUE, pair->value->place, "%s is a %s, not a source", name,
                      source->row->name);
        diag_hint(draft->diag, "a vsource or isource can supply a motion");
        return E_VALUE;
    }
    part->by = source->number;
    return OK;
}

static Status read_key(PartDraft *draft, const Pair *pair)
{
    Instance *part = draft->part;
    const Component *row = part->row;
    int index = component_param(row, pair->name);
    bool names_coordinates = strcmp(pair->name, "coord") == 0 || strcmp(pair->name, "coords") == 0;

    if (pair->primes > 0)
        return diag_at(draft->diag, E_SYNTAX, pair->name_place, "a key has no primes");
    if (index >= 0 && row->family != FAMILY_DRIVER)
        return give(draft, index, pair->value, pair->name_place);
    if (row->family == FAMILY_DRIVER && strcmp(pair->name, "by") == 0 && part->by < 0)
        return read_by(draft, pair);
    if (row->family == FAMILY_DRIVER) {
        (void)diag_at(draft->diag, E_NAME, pair->name_place,
                      "a driver takes one coordinate, and by=");
        diag_hint(draft->diag, "by= names a coordinate or a source that supplies the motion");
        return E_NAME;
    }
    if (row->family != FAMILY_JOINT || !names_coordinates)
        return key_unknown(row, pair->name, pair->name_place, draft->diag);
    draft->coordinate_names = pair->value;
    return OK;
}

static Status read_values(PartDraft *draft)
{
    const Statement *statement = draft->statement;
    Instance *part = draft->part;
    const Component *row = part->row;
    int first = 0;
    Status status = OK;

    if (row->places == PLACES_COORDINATE) {
        CHECK(give(draft, 0, statement->pairs.at[0].value, statement->pairs.at[0].name_place));
        first = 1;
    }
    draft->first_value = draft->at;
    for (int i = 0; i < statement->pairs.count; i++) {
        const int param = component_param(row, statement->pairs.at[i].name);

        part->is_geared = part->is_geared || (param >= 0 && (row->params[param].use & GEARS) != 0);
    }
    CHECK(read_positional(draft));
    for (int i = first; i < statement->pairs.count; i++)
        CHECK(read_key(draft, &statement->pairs.at[i]));
    for (int i = 0; i < row->param_count; i++) {
        const Param *param = &row->params[i];

        if (part->values[i].given)
            continue;
        if (param->fallback == NULL) {
            status = diag_at(draft->diag, E_VALUE, statement_end(statement), "%s %s needs %s%s",
                             row->name, part->name, param->name,
                             (param->use & POSITIONAL) != 0 ? "" : "=");
            diag_hint(draft->diag, "%s: %s", param->name, param->meaning);
            goto done;
        }
        param_fallback(draft->state, param, &part->values[i]);
    }
done:
    return status;
}

/* --- coordinates of the part itself --- */

static Status coordinate_name(PartDraft *draft, const Syntax *syntax, int index)
{
    const char *name = syntax_name(syntax);
    Instance *part = draft->part;

    if (name == NULL || (strchr(name, '.') != NULL && draft->state->inside < 0))
        return diag_at(draft->diag, E_NAME, syntax->place, "a new name is expected here");
    if (strcmp(name, part->name) != 0) {
        if (names_find(draft->state->terminals, name) >= 0)
            return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is already a terminal", name);
        TRY(name_is_free(draft->state, name, syntax->place, draft->diag));
    } else if (part->coord_count > 1)
        return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is the name of the joint", name);
    for (int i = 0; i < index; i++)
        if (strcmp(part->coord[i], name) == 0)
            return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is named twice", name);
    part->coord[index] = state_text(draft->state, name);
    return OK;
}

static Status rename_coordinates(PartDraft *draft)
{
    const Syntax *syntax = draft->coordinate_names;
    int count = draft->part->coord_count;
    bool is_list = syntax->kind == SYNTAX_VECTOR;
    int given = is_list ? syntax->count : 1;
    Status status = OK;

    if (given != count) {
        status = diag_at(draft->diag, E_VALUE, syntax->place, "%s has %d coordinate%s, %d named",
                         draft->part->row->name, count, count == 1 ? "" : "s", given);
        diag_hint(draft->diag, count > 1 ? "coords=[a, b, ...] names all of them"
                                         : "coord=NAME names the only one");
        goto done;
    }
    for (int i = 0; i < count; i++)
        CHECK(coordinate_name(draft, is_list ? syntax->args[i] : syntax, i));
done:
    return status;
}

/* "h8", or "m1.x", "m1.y" ... */
static void own_coordinates(PartDraft *draft)
{
    Instance *part = draft->part;
    const bool planar = draft->state->setup.planar;
    const size_t count = (size_t)instance_coord_count(part, planar);
    Pool *pool = draft->state->pool;

    part->coord_count = (int)count;
    (void)instance_coords(part, planar, &part->pose_count);
    part->coord = pool_alloc(pool, count * sizeof *part->coord);
    part->coord_kind = pool_alloc(pool, count * sizeof *part->coord_kind);
    part->coord_rotation = pool_alloc(pool, count * sizeof *part->coord_rotation);
    for (int i = 0; i < part->coord_count; i++) {
        const CoordinateRow row = instance_coord(part, planar, i);
        Text name = {0};

        text_add(&name, part->name);
        if (row.member[0] != '\0')
            text_addf(&name, ".%s", row.member);
        part->coord[i] = state_text(draft->state, name.at);
        part->coord_kind[i] = row.kind;
        part->coord_rotation[i] = row.rotation;
        text_free(&name);
    }
}

Status part_check_plane(const State *state, const Instance *part, Place place, Diag *diag)
{
    Steps steps;
    bool leaves = false;
    Status status;

    if (!state->setup.planar || part->row->steps == NULL)
        return OK;
    part->row->steps(part, state->arena, true, &steps);
    for (int i = 0; i < steps.shift_count; i++)
        leaves = leaves || !expr_is_zero(steps.shift[i].axis[2]);
    for (int i = 0; i < steps.turn_count; i++)
        leaves =
            leaves || !expr_is_zero(steps.turn[i].axis[0]) || !expr_is_zero(steps.turn[i].axis[1]);
    if (!leaves)
        return OK;
    status = diag_at(diag, E_VALUE, place, "%s %s leaves the plane", part->row->name, part->name);
    diag_hint(diag, steps.shift_count == 1 && steps.turn_count == 0
                        ? "the scene is planar: axis=x, axis=y, or a vector [a, b]"
                        : "the scene is planar: it turns about z");
    return status;
}

/* position in the statement of the direction that is out of plane */
static Place direction_place(const PartDraft *draft)
{
    const Statement *statement = draft->statement;

    for (int i = 0; i < statement->pairs.count; i++) {
        int index = component_param(draft->part->row, statement->pairs.at[i].name);

        if (index >= 0 && draft->part->row->params[index].kind == PARAM_AXIS)
            return statement->pairs.at[i].value->place;
    }
    return statement->place;
}

/* position in the statement of that value; otherwise the whole statement */
static Place value_place(const PartDraft *draft, const char *key)
{
    const Statement *statement = draft->statement;
    const Component *row = draft->part->row;
    int operand = draft->first_value;

    for (int i = 0; i < statement->pairs.count; i++)
        if (strcmp(statement->pairs.at[i].name, key) == 0)
            return statement->pairs.at[i].value->place;
    for (int i = 0; i < row->param_count && operand < statement->operands.count; i++) {
        if ((row->params[i].use & POSITIONAL) == 0)
            continue;
        if (strcmp(row->params[i].name, key) == 0)
            return statement->operands.at[operand].place;
        operand++;
    }
    return statement->place;
}

/* --- commit --- */

int state_terminal(State *state, const char *name, Domain domain)
{
    int number;

    if (state->setup.datum[domain] < 0)
        state->setup.datum[domain] = graph_add_node(state->graph, "0", domain, true);
    if (strcmp(name, "0") == 0)
        return state->setup.datum[domain];
    number = names_find(state->terminals, name);
    if (number >= 0)
        return state->terminal_nodes.at[number];
    (void)names_add(state->terminals, name);
    LIST_PUSH(state->terminal_nodes, graph_add_node(state->graph, name, domain, false));
    return state->terminal_nodes.at[state->terminal_nodes.count - 1];
}

static int add_edge(State *state, const Edge *edge)
{
    LIST_PUSH(state->edge_owner, edge->component);
    return graph_add_edge(state->graph, edge);
}

/* A virtual joint is a branch only in trees in which it has freedom, and only if the user chooses
 * it. */
static Branching branching_of(const Instance *part, bool rotation, int freedom)
{
    if (part->row->domain != DOMAIN_MECHANICAL)
        return BRANCH_NEVER; /* the mechanical side of a transducer */
    if (!part->is_virtual)
        return rotation ? part->row->rotation : part->row->translation;
    return freedom > 0 ? BRANCH_UNCHOSEN : BRANCH_NEVER;
}

static void add_mechanical_edge(State *state, Instance *part)
{
    Edge edge = {.name = part->name,
                 .tail = part->tail,
                 .head = part->head,
                 .domain = DOMAIN_MECHANICAL,
                 .component = part->number};
    int freedom[2] = {0, 0};
    Steps steps;

    if (part->row->steps != NULL) {
        part->row->steps(part, state->arena, state->setup.planar, &steps);
        steps_freedom(&steps, freedom);
    }
    for (int half = 0; half < 2; half++) {
        edge.branching[half] = branching_of(part, half == 1, freedom[half]);
        edge.preference[half] = part->row->preference + (part->is_virtual ? 1000 : 0);
        if (part->row->family == FAMILY_JOINT)
            edge.preference[half] += freedom[half];
    }
    part->edge = add_edge(state, &edge);
}

static void add_scalar_edges(State *state, Instance *part)
{
    const ScalarEdge *rows = component_scalar_edges(part->row, &part->scalar_count);

    part->scalar_edges =
        pool_alloc(state->pool, (size_t)part->scalar_count * sizeof *part->scalar_edges);
    for (int k = 0; k < part->scalar_count; k++) {
        int datum = state->setup.datum[part->row->domain];
        Text name = {0};
        Edge edge = {.tail = rows[k].plus < 0 ? datum : part->terminals[rows[k].plus],
                     .head = rows[k].minus < 0 ? datum : part->terminals[rows[k].minus],
                     .domain = part->row->domain,
                     .component = part->number,
                     .branching = {rows[k].branching, BRANCH_NEVER},
                     .preference = {rows[k].preference, 0}};

        if (part->row->scalar_edges == NULL)
            edge.preference[0] = part->row->preference;
        text_addf(&name, "%s%s%s", part->name, rows[k].suffix[0] != '\0' ? "." : "",
                  rows[k].suffix);
        edge.name = name.at;
        part->scalar_edges[k] = add_edge(state, &edge);
        text_free(&name);
    }
}

static void add_terminals(PartDraft *draft)
{
    Instance *part = draft->part;
    const size_t count = (size_t)component_terminals(part->row);

    part->terminal_count = component_terminals(part->row);
    part->terminals = pool_alloc(draft->state->pool, count * sizeof *part->terminals);
    part->terminal_names = pool_alloc(draft->state->pool, count * sizeof *part->terminal_names);
    for (int k = 0; k < part->terminal_count; k++) {
        part->terminals[k] = state_terminal(draft->state, draft->terminals[k], part->row->domain);
        part->terminal_names[k] = state_text(draft->state, draft->terminals[k]);
    }
    add_scalar_edges(draft->state, part);
    if (part->head < 0 && part->scalar_count > 0) {
        const Edge *edge = graph_edge(draft->state->graph, part->scalar_edges[0]);

        part->tail = edge->tail;
        part->head = edge->head;
    }
}

void part_draft_commit(PartDraft *draft, const char *text)
{
    State *state = draft->state;
    Instance *part = draft->part;
    int line;

    if (part_is_frame(part))
        part->head = graph_add_node(state->graph, part->name, DOMAIN_MECHANICAL, false);
    if (part->head >= 0)
        add_mechanical_edge(state, part);
    if (draft->terminals != NULL)
        add_terminals(draft);
    state_name(state, part->name, THING_PART, part->number, 0);
    for (int i = 0; i < part->coord_count; i++)
        if (strcmp(part->coord[i], part->name) != 0)
            state_name(state, part->coord[i], THING_COORDINATE, part->number, i);
    LIST_PUSH(state->parts, part);
    if (part->row->couple != NULL)
        LIST_PUSH(state->couplings, part->number);
    line = line_add(state, text, -1, part->number, &draft->scope);
    part->text = state->lines.at[line].text;
    state_forget_trees(state);
}

/* joints that have no meaning in a plane, whatever their axes */
static Status check_scene(const State *state, const Component *row, Place place, Diag *diag)
{
    if (!state->setup.planar || row->not_in_plane == NULL)
        return OK;
    (void)diag_at(diag, E_VALUE, place, "a %s joint leaves the plane", row->name);
    diag_hint(diag, "the scene is planar: %s serves there", row->not_in_plane);
    return E_VALUE;
}

Instance *part_new(State *state, const Component *row, bool is_virtual)
{
    Instance *part = pool_alloc(state->pool, sizeof *part);

    part->row = row;
    part->number = state->parts.count;
    part->is_virtual = is_virtual;
    part->tail = part->head = part->edge = part->joint = part->second_joint = part->rubbed = -1;
    part->parts[0] = part->parts[1] = -1;
    part->by = part->by_coordinate = -1;
    part->values = pool_alloc(state->pool, sizeof *part->values * ((size_t)row->param_count + 1));
    return part;
}

Instance *part_add(State *state, const Component *row, const char *name, int tail, int head,
                   const char *terminal)
{
    const char *terminals[] = {terminal, "0", "0", "0"};
    PartDraft draft = {.state = state, .part = part_new(state, row, false)};

    draft.part->name = state_text(state, name);
    draft.part->tail = tail;
    draft.part->head = head;
    for (int k = 0; k < row->param_count; k++)
        param_fallback(state, &row->params[k], &draft.part->values[k]);
    if (terminal != NULL) {
        (void)state_terminal(state, "0", row->domain);
        draft.terminals = terminals;
    }
    part_draft_commit(&draft, row->name);
    return draft.part;
}

Status apply_component(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const Component *row = row_at_places(*state, statement, component_find(statement->verb));
    PoolMark mark = pool_mark((*state)->pool);
    PartDraft draft = {.state = *state, .statement = statement, .diag = diag};
    char *text = NULL;
    Status status = OK;

    draft.part = part_new(*state, row, statement->is_virtual);
    draft.scope = (Scope){.state = *state,
                          .kind = row->family == FAMILY_DRIVER ? SCOPE_DRIVE : SCOPE_NUMBER,
                          .own = draft.part};
    assert(!statement->is_virtual || row->family == FAMILY_JOINT);
    CHECK(check_scene(*state, row, statement->verb_place, diag));
    CHECK(part_draft_read_name(&draft));
    CHECK(part_draft_read_terminals(&draft));
    CHECK(read_values(&draft));
    own_coordinates(&draft);
    if (draft.coordinate_names != NULL)
        CHECK(rename_coordinates(&draft));
    CHECK(part_can_share(*state, draft.part, statement->operands.at[0].place, diag));
    CHECK(part_check_plane(*state, draft.part, direction_place(&draft), diag));
    status = part_check(draft.state, draft.part, &outcome->remarks, diag);
    if (status != OK && diag != NULL && diag->place.line == 0)
        diag->place = value_place(&draft, diag->about);
    CHECK(status);

    text = statement_full_text(statement);
    part_draft_commit(&draft, text);
    outcome->changes_equations = true;
done:
    if (status != OK)
        pool_release((*state)->pool, mark);
    LIST_FREE(draft.scope.uses);
    mem_free(text);
    return status;
}

/* model_build.c: a component's statement to an instance, its frame, terminals and edges
 *
 * A statement is read in full into a Draft; only then nodes, edges and names are added. */
#include "model/model_impl.h"

#include <assert.h>
#include <string.h>

typedef struct Draft {
    State *state;
    const Statement *statement;
    Instance *part; /* in the state's pool */
    Scope scope;
    int at;                   /* next operand */
    const char *terminals[2]; /* names, where the part has a scalar edge */
    const Syntax *coordinate_names;
    Diag *diag;
} Draft;

/* --- operands --- */

static Place end_place(const Statement *statement)
{
    return (Place){statement->place.line, statement->place.column + statement->place.width, 1};
}

static const char *const forms[] = {
    [PLACES_NONE] = "NAME",
    [PLACES_FROM] = "NAME FRAME",
    [PLACES_FRAMES] = "NAME TAIL TIP",
    [PLACES_ON] = "NAME FRAME",
    [PLACES_LINK] = "NAME TAIL TIP, or NAME JOINT",
    [PLACES_COORDINATE] = "NAME COORDINATE = value",
    [PLACES_TERMINALS] = "NAME PLUS MINUS",
    [PLACES_TRANSDUCER] = "NAME JOINT PLUS MINUS",
};

static Status next_operand(Draft *draft, const Operand **out)
{
    const Statement *statement = draft->statement;

    if (draft->at >= statement->operands.count) {
        (void)diag_at(draft->diag, E_SYNTAX, end_place(statement), "%s misses a place",
                      statement->verb);
        diag_hint(draft->diag, "it is written %s %s", statement->verb,
                  forms[draft->part->row->places]);
        return E_SYNTAX;
    }
    *out = &statement->operands.at[draft->at++];
    return OK;
}

static Status next_name(Draft *draft, const char **name, Place *place)
{
    const Operand *operand = NULL;
    Status status = OK;

    CHECK(next_operand(draft, &operand));
    *name = syntax_name(operand->value);
    *place = operand->place;
    if (*name == NULL)
        status = diag_at(draft->diag, E_NAME, operand->place, "a name is expected here");
done:
    return status;
}

static Status new_name(Draft *draft)
{
    const char *name = NULL;
    Place place;
    Status status = OK;

    CHECK(next_name(draft, &name, &place));
    if (strchr(name, '.') != NULL) {
        status = diag_at(draft->diag, E_NAME, place, "a new name has no dot");
        goto done;
    }
    if (names_find(draft->state->terminals, name) >= 0) {
        status = diag_at(draft->diag, E_NAME, place, "'%s' is already a terminal", name);
        goto done;
    }
    CHECK(name_is_free(draft->state, name, place, draft->diag));
    draft->part->name = state_text(draft->state, name);
done:
    return status;
}

/* --- frames --- */

static bool is_frame(const Instance *part)
{
    return part->row->family == FAMILY_BODY || part->row->family == FAMILY_ARM;
}

static Status not_a_frame(const Draft *draft, const char *name, Place place)
{
    const State *state = draft->state;
    const Thing *thing = state_thing(state, name);
    Suggest suggest = suggest_for(name);
    Text what = {0};

    if (thing != NULL) {
        name_describe(state, thing, &what);
        (void)diag_at(draft->diag, E_NAME, place, "%s is %s, not a frame", name, what.at);
    } else
        (void)diag_at(draft->diag, E_NAME, place, "unknown frame '%s'", name);
    for (int i = 0; i < state->parts.count; i++)
        if (is_frame(state->parts.at[i]))
            suggest_offer(&suggest, state->parts.at[i]->name);
    suggest_offer(&suggest, "ground");
    if (suggest.best != NULL)
        diag_hint(draft->diag, "did you mean '%s'?", suggest.best);
    else
        diag_hint(draft->diag, "frames are ground, bodies and arms; arm %s BODY [x, y] makes one",
                  thing == NULL ? name : "NAME");
    text_free(&what);
    return E_NAME;
}

static Status next_frame(Draft *draft, int *node, Place *place)
{
    const char *name = NULL;
    const Instance *part;
    Status status = OK;

    CHECK(next_name(draft, &name, place));
    *node = draft->state->datum[DOMAIN_MECHANICAL];
    if (strcmp(name, "ground") == 0)
        goto done;
    part = state_part(draft->state, name);
    if (part == NULL || !is_frame(part))
        status = not_a_frame(draft, name, *place);
    else
        *node = part->head;
done:
    return status;
}

static Status two_frames(Draft *draft)
{
    Instance *part = draft->part;
    Place place;
    Status status = OK;

    CHECK(next_frame(draft, &part->tail, &place));
    CHECK(next_frame(draft, &part->head, &place));
    if (part->tail == part->head)
        status = diag_at(draft->diag, E_VALUE, place, "both ends of %s are %s", part->name,
                         graph_node(draft->state->graph, part->head)->name);
done:
    return status;
}

static Status on_frame(Draft *draft)
{
    Instance *part = draft->part;
    Place place;
    Status status = OK;

    part->tail = draft->state->datum[DOMAIN_MECHANICAL];
    CHECK(next_frame(draft, &part->head, &place));
    if (part->head == part->tail)
        status = diag_at(draft->diag, E_VALUE, place,
                         "ground doesn't move: a %s on it has no effect", part->row->name);
done:
    return status;
}

/* --- coordinates that a part acts on --- */

static Status act_on(Draft *draft, const char *name, Place place)
{
    Instance *part = draft->part;
    const Instance *owner;
    int joint = -1;
    Status status = OK;

    CHECK(coordinate_resolve(draft->state, name, place, &joint, &part->joint_coordinate,
                             draft->diag));
    owner = draft->state->parts.at[joint];
    if (part->row->family != FAMILY_DRIVER && owner->row->family != FAMILY_JOINT) {
        status = diag_at(draft->diag, E_NAME, place, "%s acts on a joint, and %s is none",
                         part->row->name, owner->name);
        goto done;
    }
    if (owner->coord_kind[part->joint_coordinate] == COORDINATE_PARAMETER) {
        status = diag_at(draft->diag, E_VALUE, place,
                         "%s is an Euler parameter: nothing can act on it alone", name);
        goto done;
    }
    part->joint = joint;
    part->on_angle = owner->coord_kind[part->joint_coordinate] == COORDINATE_ANGLE;
    part->tail = owner->tail;
    part->head = owner->head;
done:
    return status;
}

static Status on_joint(Draft *draft)
{
    const char *name = NULL;
    Place place;
    Status status = OK;

    CHECK(next_name(draft, &name, &place));
    CHECK(act_on(draft, name, place));
done:
    return status;
}

/* spring k1 r1 r2, or spring k1 h8: one place that is no frame is a coordinate */
static Status link_places(Draft *draft)
{
    if (draft->statement->operands.count > 2)
        return two_frames(draft);
    if (draft->statement->operands.count == 2) {
        const char *name = syntax_name(draft->statement->operands.at[1].value);
        const Instance *part = name != NULL ? state_part(draft->state, name) : NULL;

        if (name != NULL && (strcmp(name, "ground") == 0 || (part != NULL && is_frame(part))))
            return two_frames(draft);
    }
    return on_joint(draft);
}

/* driver D1 h8 = 2*t: the first pair */
static Status driven_coordinate(Draft *draft)
{
    const Statement *statement = draft->statement;
    const State *state = draft->state;
    const Instance *part = draft->part;
    Status status = OK;
    const Pair *pair;

    if (statement->pairs.count == 0) {
        status = diag_at(draft->diag, E_SYNTAX, end_place(statement),
                         "a driver says what its coordinate follows");
        diag_hint(draft->diag, "it is written driver NAME COORDINATE = value");
        goto done;
    }
    pair = &statement->pairs.at[0];
    if (pair->primes > 0) {
        status = diag_at(draft->diag, E_NAME, pair->name_place,
                         "a driver prescribes the coordinate itself, not its rate");
        diag_hint(draft->diag, "integrate: %s = ... of t", pair->name);
        goto done;
    }
    CHECK(act_on(draft, pair->name, pair->name_place));
    for (int i = 0; i < state->parts.count; i++) {
        const Instance *other = state->parts.at[i];

        if (other->row->family == FAMILY_DRIVER && other->joint == part->joint &&
            other->joint_coordinate == part->joint_coordinate) {
            status = diag_at(draft->diag, E_VALUE, pair->name_place, "%s is already driven by %s",
                             pair->name, other->name);
            goto done;
        }
    }
done:
    return status;
}

/* --- terminals --- */

static Status next_terminal(Draft *draft, int which)
{
    const Operand *operand = NULL;
    const char *name;
    const Thing *thing;
    Text what = {0};
    Status status = OK;

    CHECK(next_operand(draft, &operand));
    name = syntax_name(operand->value);
    if (operand->value->kind == SYNTAX_NUMBER && strcmp(operand->value->text, "0") == 0 &&
        !operand->value->has_unit)
        name = "0";
    if (name == NULL || strchr(name, '.') != NULL) {
        status = diag_at(draft->diag, E_NAME, operand->place, "a terminal is expected here");
        diag_hint(draft->diag, "a terminal is any new name, or 0 for the reference");
        goto done;
    }
    if (strcmp(name, "gnd") == 0)
        name = "0";
    if (strcmp(name, "ground") == 0) {
        status = diag_at(draft->diag, E_NAME, operand->place,
                         "ground is the mechanical reference frame");
        diag_hint(draft->diag, "the electrical one is 0 or gnd");
        goto done;
    }
    thing = state_thing(draft->state, name);
    if (strcmp(name, draft->part->name) == 0) {
        status = diag_at(draft->diag, E_NAME, operand->place, "'%s' is the name of this %s", name,
                         draft->part->row->name);
        goto done;
    }
    if (thing != NULL && (thing->kind != THING_DEFINITION ||
                          draft->state->definitions.at[thing->index].kind != DEFINES_PARAMETER)) {
        name_describe(draft->state, thing, &what);
        status = diag_at(draft->diag, E_NAME, operand->place, "'%s' is %s, not a terminal", name,
                         what.at);
        goto done;
    }
    if (thing == NULL && strcmp(name, "0") != 0)
        CHECK(name_is_free(draft->state, name, operand->place, draft->diag));
    draft->terminals[which] = name;
done:
    text_free(&what);
    return status;
}

static Status two_terminals(Draft *draft)
{
    Status status = OK;

    CHECK(next_terminal(draft, 0));
    CHECK(next_terminal(draft, 1));
    if (strcmp(draft->terminals[0], draft->terminals[1]) == 0)
        status = diag_at(draft->diag, E_VALUE, draft->statement->operands.at[draft->at - 1].place,
                         "both ends of %s are %s", draft->part->name, draft->terminals[0]);
done:
    return status;
}

static Status read_places(Draft *draft)
{
    Instance *part = draft->part;
    Status status = OK;

    switch (part->row->places) {
    case PLACES_NONE:
        part->tail = draft->state->datum[DOMAIN_MECHANICAL];
        break;
    case PLACES_FROM: {
        Place place;
        return next_frame(draft, &part->tail, &place);
    }
    case PLACES_FRAMES:
        return two_frames(draft);
    case PLACES_ON:
        return on_frame(draft);
    case PLACES_LINK:
        return link_places(draft);
    case PLACES_COORDINATE:
        return driven_coordinate(draft);
    case PLACES_TRANSDUCER:
        CHECK(on_joint(draft));
        return two_terminals(draft);
    case PLACES_TERMINALS:
        return two_terminals(draft);
    }
done:
    return status;
}

/* --- values --- */

static Status give(Draft *draft, int index, const Syntax *value, Place place)
{
    Instance *part = draft->part;
    const Param *param = &part->row->params[index];

    if (part->values[index].given)
        return diag_at(draft->diag, E_SYNTAX, place, "%s is given twice", param->name);
    return param_read(&draft->scope, (Wanted){param, part->on_angle}, value, &part->values[index],
                      draft->diag);
}

static Status read_positional(Draft *draft)
{
    const Component *row = draft->part->row;
    Status status = OK;
    const Operand *operand;

    for (int i = 0; i < row->param_count && draft->at < draft->statement->operands.count; i++) {
        if (!row->params[i].positional)
            continue;
        operand = &draft->statement->operands.at[draft->at++];
        CHECK(give(draft, i, operand->value, operand->place));
    }
    if (draft->at < draft->statement->operands.count) {
        operand = &draft->statement->operands.at[draft->at];
        status =
            diag_at(draft->diag, E_SYNTAX, operand->place, "%s has no place for this", row->name);
        diag_hint(draft->diag, "it is written %s %s%s", row->name, forms[row->places],
                  row->param_count > 0 ? ", then key=value" : "");
    }
done:
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

/* by=V1, by=leg1.th1: what supplies the motion of a driver instead of itself */
static Status read_by(Draft *draft, const Pair *pair)
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
    if (component_param(source->row, "value") < 0) {
        (void)diag_at(draft->diag, E_VALUE, pair->value->place, "%s is a %s, not a source", name,
                      source->row->name);
        diag_hint(draft->diag, "a vsource or isource can supply a motion");
        return E_VALUE;
    }
    part->by = source->number;
    return OK;
}

static Status read_key(Draft *draft, const Pair *pair)
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

static Status read_values(Draft *draft)
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
    CHECK(read_positional(draft));
    for (int i = first; i < statement->pairs.count; i++)
        CHECK(read_key(draft, &statement->pairs.at[i]));
    for (int i = 0; i < row->param_count; i++) {
        const Param *param = &row->params[i];

        if (part->values[i].given)
            continue;
        if (param->fallback == NULL) {
            status = diag_at(draft->diag, E_VALUE, end_place(statement), "%s %s needs %s%s",
                             row->name, part->name, param->name, param->positional ? "" : "=");
            diag_hint(draft->diag, "%s: %s", param->name, param->meaning);
            goto done;
        }
        param_fallback(draft->state, param, &part->values[i]);
    }
done:
    return status;
}

/* --- coordinates of the part itself --- */

static Status coordinate_name(Draft *draft, const Syntax *syntax, int index)
{
    const char *name = syntax_name(syntax);
    Instance *part = draft->part;
    Status status = OK;

    if (name == NULL || strchr(name, '.') != NULL)
        return diag_at(draft->diag, E_NAME, syntax->place, "a new name is expected here");
    if (strcmp(name, part->name) != 0) {
        if (names_find(draft->state->terminals, name) >= 0)
            return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is already a terminal", name);
        CHECK(name_is_free(draft->state, name, syntax->place, draft->diag));
    } else if (part->coord_count > 1)
        return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is the name of the joint", name);
    for (int i = 0; i < index; i++)
        if (strcmp(part->coord[i], name) == 0)
            return diag_at(draft->diag, E_NAME, syntax->place, "'%s' is named twice", name);
    part->coord[index] = state_text(draft->state, name);
done:
    return status;
}

static Status rename_coordinates(Draft *draft)
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
static void own_coordinates(Draft *draft)
{
    Instance *part = draft->part;
    const CoordinateRow *rows =
        component_coords(part->row, draft->state->planar, &part->coord_count);

    for (int i = 0; i < part->coord_count; i++) {
        Text name = {0};

        text_add(&name, part->name);
        if (rows[i].member[0] != '\0')
            text_addf(&name, ".%s", rows[i].member);
        part->coord[i] = state_text(draft->state, name.at);
        part->coord_kind[i] = rows[i].kind;
        part->coord_rotation[i] = rows[i].rotation;
        text_free(&name);
    }
}

Status part_check_plane(const State *state, const Instance *part, Place place, Diag *diag)
{
    Steps steps;
    bool leaves = false;
    Status status;

    if (!state->planar || part->row->steps == NULL)
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

/* where the statement gives the direction that left the plane */
static Place direction_place(const Draft *draft)
{
    const Statement *statement = draft->statement;

    for (int i = 0; i < statement->pairs.count; i++) {
        int index = component_param(draft->part->row, statement->pairs.at[i].name);

        if (index >= 0 && draft->part->row->params[index].kind == PARAM_AXIS)
            return statement->pairs.at[i].value->place;
    }
    return statement->place;
}

/* --- committing --- */

static int terminal_node(State *state, const char *name, Domain domain)
{
    int number;

    if (state->datum[domain] < 0)
        state->datum[domain] = graph_add_node(state->graph, "0", domain, true);
    if (strcmp(name, "0") == 0)
        return state->datum[domain];
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

/* A virtual joint enters only trees in which it has freedom, and only when the user says so. */
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

    for (int i = 0; i < part->coord_count; i++)
        freedom[part->coord_rotation[i] ? 1 : 0]++;
    for (int half = 0; half < 2; half++) {
        edge.branching[half] = branching_of(part, half == 1, freedom[half]);
        edge.preference[half] = part->row->preference + (part->is_virtual ? 1000 : 0);
        if (part->row->family == FAMILY_JOINT)
            edge.preference[half] += freedom[half];
    }
    part->edge = add_edge(state, &edge);
}

static void add_scalar_edge(State *state, Instance *part, int plus, int minus)
{
    Edge edge = {.name = part->name,
                 .tail = plus,
                 .head = minus,
                 .domain = part->row->domain,
                 .component = part->number,
                 .branching = {part->row->translation, BRANCH_NEVER},
                 .preference = {part->row->preference, 0}};

    part->scalar_edge = add_edge(state, &edge);
}

static void commit(Draft *draft, const char *text)
{
    State *state = draft->state;
    Instance *part = draft->part;
    int line;

    if (is_frame(part))
        part->head = graph_add_node(state->graph, part->name, DOMAIN_MECHANICAL, false);
    if (part->head >= 0)
        add_mechanical_edge(state, part);
    if (draft->terminals[0] != NULL) {
        int plus = terminal_node(state, draft->terminals[0], part->row->domain);
        int minus = terminal_node(state, draft->terminals[1], part->row->domain);

        add_scalar_edge(state, part, plus, minus);
        if (part->head < 0) {
            part->tail = plus;
            part->head = minus;
        }
    }
    state_name(state, part->name, THING_PART, part->number, 0);
    for (int i = 0; i < part->coord_count; i++)
        if (strcmp(part->coord[i], part->name) != 0)
            state_name(state, part->coord[i], THING_COORDINATE, part->number, i);
    LIST_PUSH(state->parts, part);
    line = line_add(state, text, -1, part->number, &draft->scope);
    part->text = state->lines.at[line].text;
    state_forget_trees(state);
}

static Instance *new_part(State *state, const Component *row, bool is_virtual)
{
    Instance *part = pool_alloc(state->pool, sizeof *part);

    part->row = row;
    part->number = state->parts.count;
    part->is_virtual = is_virtual;
    part->tail = part->head = part->edge = part->scalar_edge = part->joint = -1;
    part->by = part->by_coordinate = -1;
    part->values = pool_alloc(state->pool, sizeof *part->values * ((size_t)row->param_count + 1));
    return part;
}

Status apply_component(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    const Component *row = component_find(statement->verb);
    PoolMark mark = pool_mark((*state)->pool);
    Draft draft = {.state = *state, .statement = statement, .diag = diag};
    char *text = NULL;
    Status status = OK;

    draft.part = new_part(*state, row, statement->is_virtual);
    draft.scope = (Scope){.state = *state,
                          .kind = row->family == FAMILY_DRIVER ? SCOPE_DRIVE : SCOPE_NUMBER,
                          .own = draft.part};
    assert(!statement->is_virtual || row->family == FAMILY_JOINT);
    CHECK(new_name(&draft));
    own_coordinates(&draft);
    CHECK(read_places(&draft));
    CHECK(read_values(&draft));
    if (draft.coordinate_names != NULL)
        CHECK(rename_coordinates(&draft));
    CHECK(part_check_plane(*state, draft.part, direction_place(&draft), diag));
    if (row->check != NULL)
        CHECK(row->check(draft.part, diag));

    text = statement_full_text(statement);
    commit(&draft, text);
    outcome->effect = EFFECT_EQUATIONS;
done:
    if (status != OK)
        pool_release((*state)->pool, mark);
    LIST_FREE(draft.scope.uses);
    mem_free(text);
    return status;
}

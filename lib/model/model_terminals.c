/* model_terminals.c: the frames, coordinates and terminals in a component's statement */
#include "model/model_draft.h"

#include <string.h>

/* --- operands --- */

Place statement_end(const Statement *statement)
{
    return (Place){statement->place.line, statement->place.column + statement->place.width, 1};
}

static const char *const forms[] = {
    [PLACES_NONE] = "NAME",
    [PLACES_FROM] = "NAME FRAME",
    [PLACES_FRAMES] = "NAME TAIL TIP",
    [PLACES_ON] = "NAME FRAME",
    [PLACES_LINK] = "NAME TAIL TIP, or NAME JOINT",
    [PLACES_JOINT] = "NAME JOINT, or NAME PLUS MINUS",
    [PLACES_JOINTS] = "NAME JOINT JOINT, or NAME PLUS MINUS",
    [PLACES_COORDINATE] = "NAME COORDINATE = value",
    [PLACES_TERMINALS] = "NAME PLUS MINUS",
    [PLACES_TRANSDUCER] = "NAME JOINT PLUS MINUS",
    [PLACES_SENSED] = "NAME VARIABLE PLUS MINUS",
    [PLACES_PARTS] = "NAME PART PART",
};

void places_form(const Component *row, Text *out)
{
    if (row->terminal_usage != NULL)
        text_addf(out, "NAME%s", row->terminal_usage);
    else
        text_add(out, forms[row->places]);
}

static Status next_operand(PartDraft *draft, const Operand **out)
{
    const Statement *statement = draft->statement;
    Text form = {0};

    if (draft->at >= statement->operands.count) {
        (void)diag_at(draft->diag, E_SYNTAX, statement_end(statement), "%s misses a place",
                      statement->verb);
        places_form(draft->part->row, &form);
        diag_hint(draft->diag, "it is written %s %s", statement->verb, form.at);
        text_free(&form);
        return E_SYNTAX;
    }
    *out = &statement->operands.at[draft->at++];
    return OK;
}

static Status next_name(PartDraft *draft, const char **name, Place *place)
{
    const Operand *operand = NULL;

    TRY(next_operand(draft, &operand));
    *name = syntax_name(operand->value);
    *place = operand->place;
    if (*name == NULL)
        return diag_at(draft->diag, E_NAME, operand->place, "a name is expected here");
    return OK;
}

Status part_draft_read_name(PartDraft *draft)
{
    const char *name = NULL;
    Place place;

    TRY(next_name(draft, &name, &place));
    if (strchr(name, '.') != NULL && draft->state->inside < 0 && !draft->state->is_open)
        return diag_at(draft->diag, E_NAME, place, "a new name has no dot");
    if (names_find(draft->state->terminals, name) >= 0)
        return diag_at(draft->diag, E_NAME, place, "'%s' is already a terminal", name);
    if (definition_find(draft->state, name, DEFINES_PARAMETER) == NULL)
        TRY(name_is_free(draft->state, name, place, draft->diag));
    draft->part->name = state_text(draft->state, name);
    return OK;
}

/* --- frames --- */

bool part_is_frame(const Instance *part)
{
    return part->row->family == FAMILY_BODY || part->row->family == FAMILY_ARM;
}

static Status not_a_frame(const PartDraft *draft, const char *name, Place place)
{
    const State *state = draft->state;
    const Thing *thing = state_thing(state, name);
    Suggest suggest = suggest_for(name);
    Text what = {0};

    TRY(use_check_bound(state, name, place, draft->diag));
    if (thing != NULL) {
        name_describe(state, thing, &what);
        (void)diag_at(draft->diag, E_NAME, place, "%s is %s, not a frame", name, what.at);
    } else
        (void)diag_at(draft->diag, E_NAME, place, "unknown frame '%s'", name);
    for (int i = 0; i < state->parts.count; i++)
        if (part_is_frame(state->parts.at[i]))
            suggest_offer(&suggest, state->parts.at[i]->name);
    suggest_offer(&suggest, "ground");
    suggest_or_hint(&suggest, draft->diag,
                    "frames are ground, bodies and arms; arm %s BODY [x, y] makes one",
                    thing == NULL ? name : "NAME");
    text_free(&what);
    return E_NAME;
}

static Status next_frame(PartDraft *draft, int *node, Place *place)
{
    const char *name = NULL;
    const Instance *part;

    TRY(next_name(draft, &name, place));
    *node = draft->state->setup.datum[DOMAIN_MECHANICAL];
    if (strcmp(name, "ground") == 0)
        return OK;
    part = state_part(draft->state, name);
    if (part == NULL || !part_is_frame(part))
        return not_a_frame(draft, name, *place);
    *node = part->head;
    return use_check_reach(draft->state, name, *place, draft->diag);
}

static Status two_frames(PartDraft *draft)
{
    Instance *part = draft->part;
    Place place;

    TRY(next_frame(draft, &part->tail, &place));
    TRY(next_frame(draft, &part->head, &place));
    if (part->tail == part->head)
        return diag_at(draft->diag, E_VALUE, place, "both ends of %s are %s", part->name,
                       graph_node(draft->state->graph, part->head)->name);
    return OK;
}

static Status on_frame(PartDraft *draft)
{
    Instance *part = draft->part;
    Place place;

    part->tail = draft->state->setup.datum[DOMAIN_MECHANICAL];
    TRY(next_frame(draft, &part->head, &place));
    if (part->head == part->tail)
        return diag_at(draft->diag, E_VALUE, place, "ground doesn't move: a %s on it has no effect",
                       part->row->name);
    return OK;
}

/* --- coordinates that a part acts on --- */

static Status act_on(PartDraft *draft, const char *name, Place place)
{
    Instance *part = draft->part;
    const Instance *owner;
    int joint = -1;

    TRY(coordinate_resolve(draft->state, name, place, &joint, &part->joint_coordinate,
                           draft->diag));
    owner = draft->state->parts.at[joint];
    if (part->row->family != FAMILY_DRIVER && part->row->family != FAMILY_COUPLER &&
        owner->row->family != FAMILY_JOINT)
        return diag_at(draft->diag, E_NAME, place, "%s acts on a joint, and %s is none",
                       part->row->name, owner->name);
    if (owner->coord_kind[part->joint_coordinate] == COORDINATE_PARAMETER)
        return diag_at(draft->diag, E_VALUE, place,
                       "%s is an Euler parameter: nothing can act on it alone", name);
    if (part->row->family != FAMILY_DRIVER)
        TRY(use_check_reach(draft->state, owner->name, place, draft->diag));
    part->joint = joint;
    part->coordinate = owner->coord[part->joint_coordinate];
    part->on_angle = owner->coord_kind[part->joint_coordinate] == COORDINATE_ANGLE;
    part->tail = owner->tail;
    part->head = owner->head;
    return OK;
}

static Status on_joint(PartDraft *draft)
{
    const char *name = NULL;
    Place place;

    TRY(next_name(draft, &name, &place));
    return act_on(draft, name, place);
}

/* clutch c1 h1 h2: the second acts with the other sign */
static Status two_joints(PartDraft *draft)
{
    Instance *part = draft->part, first;
    Place place;
    const char *name = NULL;

    TRY(on_joint(draft));
    first = *part;
    TRY(next_name(draft, &name, &place));
    TRY(act_on(draft, name, place));
    part->second_joint = part->joint;
    part->second_coordinate = part->joint_coordinate;
    part->joint = first.joint;
    part->joint_coordinate = first.joint_coordinate;
    part->coordinate = first.coordinate;
    part->tail = first.tail;
    part->head = first.head;
    if (part->on_angle != first.on_angle)
        return diag_at(draft->diag, E_VALUE, place, "one end of %s is an angle, the other a length",
                       part->name);
    if (part->second_joint == part->joint && part->second_coordinate == part->joint_coordinate)
        return diag_at(draft->diag, E_VALUE, place, "both ends of %s are %s", part->name, name);
    return OK;
}

/* spring k1 r1 r2, or spring k1 h8: a single name that is no frame is a coordinate */
static Status link_places(PartDraft *draft)
{
    if (draft->statement->operands.count > 2)
        return two_frames(draft);
    if (draft->statement->operands.count == 2) {
        const char *name = syntax_name(draft->statement->operands.at[1].value);
        const Instance *part = name != NULL ? state_part(draft->state, name) : NULL;

        if (name != NULL && (strcmp(name, "ground") == 0 || (part != NULL && part_is_frame(part))))
            return two_frames(draft);
    }
    return on_joint(draft);
}

static bool is_frame_name(const State *state, const char *name)
{
    const Instance *part = name != NULL ? state_part(state, name) : NULL;

    return name != NULL && (strcmp(name, "ground") == 0 || (part != NULL && part_is_frame(part)));
}

/* whether friction may act against all of a joint's shifts, or all of its turns, by one bound */
static bool rubs_as_a_whole(const Instance *joint)
{
    int lengths = 0, angles = 0;

    for (int i = 0; i < joint->coord_count; i++) {
        lengths += joint->coord_kind[i] == COORDINATE_LENGTH;
        angles += joint->coord_kind[i] != COORDINATE_LENGTH;
    }
    return lengths > 0 ? lengths == 2 && angles <= 1 : angles >= 3;
}

/* friction f p, on a joint of several coordinates, or friction f k1 k2 */
static Status rubbed_places(PartDraft *draft)
{
    const char *name = NULL;
    Instance *part = draft->part;
    const Instance *joint;
    Place place;

    if (draft->statement->operands.count > 2)
        return two_frames(draft);
    TRY(next_name(draft, &name, &place));
    joint = state_part(draft->state, name);
    if (!rubs_as_a_whole(joint)) {
        (void)diag_at(draft->diag, E_VALUE, place,
                      "the motions of %s don't share one bound: %s acts on one coordinate", name,
                      part->name);
        diag_hint(draft->diag, "%s %s %s", part->row->name, part->name, joint->coord[0]);
        return E_VALUE;
    }
    TRY(use_check_reach(draft->state, name, place, draft->diag));
    part->rubbed = joint->number;
    part->tail = joint->tail;
    part->head = joint->head;
    part->on_angle = joint->coord_kind[0] != COORDINATE_LENGTH;
    return OK;
}

/* driver D1 h8 = 2*t: the first pair */
static Status driven_coordinate(PartDraft *draft)
{
    const Statement *statement = draft->statement;
    const State *state = draft->state;
    const Instance *part = draft->part;
    const bool couples = part->row->family == FAMILY_COUPLER;
    Status status = OK;
    const Pair *pair;

    if (statement->pairs.count == 0) {
        status = diag_at(draft->diag, E_SYNTAX, statement_end(statement),
                         "a %s says what its coordinate follows", part->row->name);
        diag_hint(draft->diag, "it is written %s NAME COORDINATE = value", part->row->name);
        goto done;
    }
    pair = &statement->pairs.at[0];
    if (pair->primes > couples) {
        status = diag_at(draft->diag, E_NAME, pair->name_place,
                         couples ? "a %s gives a coordinate or its rate, not its acceleration"
                                 : "a %s prescribes the coordinate itself, not its rate",
                         part->row->name);
        diag_hint(draft->diag,
                  couples ? "%s' = ... of coordinates and rates" : "integrate: %s = ... of t",
                  pair->name);
        goto done;
    }
    CHECK(act_on(draft, pair->name, pair->name_place));
    for (int i = 0; i < state->parts.count; i++) {
        const Instance *other = state->parts.at[i];

        if (part->row->family == FAMILY_DRIVER && other->row->family == FAMILY_DRIVER &&
            other->joint == part->joint && other->joint_coordinate == part->joint_coordinate) {
            status = diag_at(draft->diag, E_VALUE, pair->name_place, "%s is already driven by %s",
                             pair->name, other->name);
            goto done;
        }
    }
done:
    return status;
}

/* --- terminals --- */

static Status next_terminal(PartDraft *draft, int which)
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
    if (name != NULL && strchr(name, '.') != NULL && draft->state->inside < 0 &&
        names_find(draft->state->terminals, name) >= 0)
        CHECK(use_check_reach(draft->state, name, operand->place, draft->diag));
    else if (name == NULL || (strchr(name, '.') != NULL && draft->state->inside < 0)) {
        if (name != NULL)
            CHECK(use_check_bound(draft->state, name, operand->place, draft->diag));
        status = diag_at(draft->diag, E_NAME, operand->place, "a terminal is expected here");
        diag_hint(draft->diag, name != NULL
                                   ? "a terminal is any new name without a dot, or 0 for the "
                                     "reference; one of an instance comes with its 'use'"
                                   : "a terminal is any new name, or 0 for the reference");
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
    if (names_find(draft->state->terminals, name) >= 0 &&
        terminal_domain(draft->state, name) != draft->part->row->domain) {
        status = diag_at(draft->diag, E_NAME, operand->place, "%s is %s, and a %s is %s", name,
                         domain_name(terminal_domain(draft->state, name)), draft->part->row->name,
                         domain_name(draft->part->row->domain));
        diag_hint(draft->diag, "a terminal belongs to the domain of its first component");
        goto done;
    }
    draft->terminals[which] = name;
done:
    text_free(&what);
    return status;
}

/* The node of a part's own unknown, the load of its joint. One axis tells which components of the
 * reaction press. */
static Status own_terminal(PartDraft *draft)
{
    State *state = draft->state;
    const Instance *joint = state->parts.at[draft->part->joint];
    const Place place = draft->statement->operands.at[draft->at - 1].place;
    Text name = {0};
    Steps steps;
    Status status;

    joint->row->steps(joint, state->arena, state->setup.planar, &steps);
    if (steps.shift_count + steps.turn_count != 1 || steps.quaternion) {
        status = diag_at(draft->diag, E_VALUE, place,
                         "mu= needs a revolute or a prismatic, and %s is a %s", joint->name,
                         joint->row->name);
        diag_hint(draft->diag, "give the bound itself: %s=2",
                  draft->part->on_angle ? "torque" : "force");
        return status;
    }
    if (joint->is_virtual)
        return diag_at(draft->diag, E_VALUE, place, "%s is virtual: it carries no load",
                       joint->name);
    text_addf(&name, "%s.node", draft->part->name);
    draft->terminals = pool_alloc(state->pool, sizeof *draft->terminals);
    draft->terminals[0] = state_text(state, name.at);
    text_free(&name);
    return OK;
}

/* as many as the row requires; the ends of an edge must differ */
static Status read_terminals(PartDraft *draft)
{
    const Component *row = draft->part->row;
    int count;
    const ScalarEdge *edges = component_scalar_edges(row, &count);
    int first = draft->at;

    draft->terminals =
        pool_alloc(draft->state->pool, (size_t)component_terminals(row) * sizeof *draft->terminals);
    for (int k = 0; k < component_terminals(row); k++)
        TRY(next_terminal(draft, k));
    if (row->places == PLACES_TERMINALS) /* else a joint tells */
        draft->part->on_angle = row->domain == DOMAIN_SHAFT;
    for (int k = 0; k < count; k++) {
        const char *plus = edges[k].plus < 0 ? "0" : draft->terminals[edges[k].plus];
        const char *minus = edges[k].minus < 0 ? "0" : draft->terminals[edges[k].minus];
        int last = first + (edges[k].minus < 0 ? edges[k].plus : edges[k].minus);

        if (strcmp(plus, minus) == 0)
            return diag_at(draft->diag, E_VALUE, draft->statement->operands.at[last].place,
                           "both ends of %s are %s", draft->part->name, plus);
    }
    return OK;
}

/* sensor v1 h8' a 0: the measured value may be any expression of variables */
static Status sensed_value(PartDraft *draft)
{
    Scope scope = draft->scope;
    const Operand *operand = NULL;
    Status status = OK;

    CHECK(next_operand(draft, &operand));
    scope.kind = SCOPE_EFFORT;
    status = scope_expression(&scope, operand->value, &draft->part->sensed, draft->diag);
    draft->scope.uses = scope.uses;
done:
    return status;
}

/* coupling K1 L1 L2 */
static Status two_parts(PartDraft *draft)
{
    Instance *part = draft->part;

    for (int k = 0; k < 2; k++) {
        const char *name = NULL;
        const Instance *other;
        Place place;

        TRY(next_name(draft, &name, &place));
        other = state_part(draft->state, name);
        if (other == NULL)
            return name_unknown(draft->state, "component", name, place, draft->diag);
        TRY(use_check_reach(draft->state, name, place, draft->diag));
        if (strcmp(other->row->name, part->row->couples) != 0)
            return diag_at(draft->diag, E_VALUE, place,
                           "%s is a %s: a %s takes two parts of kind %s", name, other->row->name,
                           part->row->name, part->row->couples);
        part->parts[k] = other->number;
        if (k > 0 && part->parts[0] == part->parts[1])
            return diag_at(draft->diag, E_VALUE, place, "both parts of %s are %s", part->name,
                           name);
    }
    return OK;
}

bool state_names_joint(const State *state, const char *name)
{
    int joint, coordinate;
    const Instance *part = state_part(state, name);

    return (part != NULL && part->row->family == FAMILY_JOINT) ||
           coordinate_resolve(state, name, (Place){0}, &joint, &coordinate, NULL) == OK;
}

static bool has_pair(const Statement *statement, const char *key)
{
    for (int i = 0; i < statement->pairs.count; i++)
        if (strcmp(statement->pairs.at[i].name, key) == 0)
            return true;
    return false;
}

/* that variant; NULL: there is none */
static const Component *variant_find(const Component *row, Domain domain)
{
    for (int i = 0; row->variants[i] != NULL; i++)
        if (row->variants[i]->domain == domain)
            return row->variants[i];
    return NULL;
}

/* between two frames, or in a joint that has several coordinates; NULL: another row */
static const Component *row_that_rubs(const State *state, const Statement *statement,
                                      const Component *row)
{
    const Component *found = variant_find(row, DOMAIN_MECHANICAL);
    const char *first = syntax_name(statement->operands.at[1].value);
    const Instance *joint = first != NULL ? state_part(state, first) : NULL;

    if (found == NULL)
        return NULL;
    if (statement->operands.count > 2)
        return is_frame_name(state, first) ? found : NULL;
    return joint != NULL && joint->row->family == FAMILY_JOINT && joint->coord_count > 1 ? found
                                                                                         : NULL;
}

/* A prime asks for a row of rates. mu= of friction asks for a row by the joint's load,
 * that of what rolls for one that slips. The first
 * place tells: a joint, or a terminal that has a domain already; a new terminal is of a slide where
 * a force is given, otherwise of a shaft. */
const Component *row_at_places(const State *state, const Statement *statement, const Component *row)
{
    Domain domain = has_pair(statement, "force") ? DOMAIN_SLIDE : DOMAIN_SHAFT;
    const Component *on_terminals, *by_load, *rubs;

    if (row->places == PLACES_COORDINATE)
        return row->variants != NULL && statement->pairs.count > 0 &&
                       statement->pairs.at[0].primes == 1
                   ? row->variants[0]
                   : row;
    if (row->variants == NULL || statement->operands.count < 2)
        return row;
    if (row->places == PLACES_FRAMES)
        return has_pair(statement, "mu") ? row->variants[0] : row;
    rubs = row_that_rubs(state, statement, row);
    by_load = has_pair(statement, "mu") ? variant_find(row, DOMAIN_LOAD) : NULL;
    for (int i = 1; i < 3 && i < statement->operands.count; i++) {
        const char *name = syntax_name(statement->operands.at[i].value);

        if (name != NULL && rubs == NULL && state_names_joint(state, name))
            return by_load != NULL ? by_load : row;
        if (name != NULL && strcmp(name, "gnd") != 0 && names_find(state->terminals, name) >= 0)
            domain = terminal_domain(state, name);
    }
    if (rubs != NULL)
        return rubs;
    on_terminals = variant_find(row, domain);
    return on_terminals != NULL ? on_terminals : row->variants[0];
}

Status part_draft_read_terminals(PartDraft *draft)
{
    Instance *part = draft->part;

    switch (part->row->places) {
    case PLACES_NONE:
        part->tail = draft->state->setup.datum[DOMAIN_MECHANICAL];
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
        return part->row->rub != NULL ? rubbed_places(draft) : link_places(draft);
    case PLACES_JOINT:
        TRY(on_joint(draft));
        return part->row->scalar_edges != NULL ? own_terminal(draft) : OK;
    case PLACES_JOINTS:
        return two_joints(draft);
    case PLACES_COORDINATE:
        return driven_coordinate(draft);
    case PLACES_TRANSDUCER:
        TRY(on_joint(draft));
        return read_terminals(draft);
    case PLACES_TERMINALS:
        return read_terminals(draft);
    case PLACES_SENSED:
        TRY(sensed_value(draft));
        return read_terminals(draft);
    case PLACES_PARTS:
        return two_parts(draft);
    }
    return OK;
}

/* model_given.c: subsystems that contain equations instead of parts
 *
 * Unknowns that move frames become a block, mass q'' = force. The coefficients of the efforts at
 * these frames must be the transposed Jacobian of their motion; otherwise the ports would create
 * power. A frame in through= without given motion is free: its motion is additional unknowns, on
 * which the efforts given there act. Every other unknown becomes a part of its own in the network.
 * `unknown` and `give` make parts, so that their names exist. Their equations are set when all
 * lines are read (model_given_end.c). */
#include "model/model_given.h"
#include "component/component_rows.h"
#include "language/verbs.h"

#include <stdlib.h>
#include <string.h>

const char *const given_motions[GIVEN_POSE] = {"x", "y", "z", "theta"};
const char *const given_efforts[GIVEN_EFFORTS] = {"fx", "fy", "fz", "tx", "ty", "tz"};
const int given_effort_of[GIVEN_POSE] = {0, 1, 2, 5};
static const char *const given_flows[] = {"i", "v"};

bool verb_gives(const Statement *s)
{
    return s->kind == STATEMENT_VERB && s->row.component == NULL &&
           (s->row.number == VERB_unknown || s->row.number == VERB_internal ||
            s->row.number == VERB_give);
}

static int find_word(const char *const *words, int count, const char *word)
{
    for (int i = 0; i < count; i++)
        if (strcmp(words[i], word) == 0)
            return i;
    return -1;
}

const char *given_effort(const Port *port, const char *rest)
{
    if (rest[0] != '.')
        return NULL;
    if (port->is_frame)
        return find_word(given_efforts, GIVEN_EFFORTS, rest + 1) >= 0 ? rest : NULL;
    return strcmp(rest, ".i") == 0 ? "_source.i" : NULL;
}

/* --- which unknowns move frames: before a statement is applied --- */

typedef LIST(const Statement *) Statements;

/* whether the tree contains the variable with at least that many primes */
static bool holds(const Syntax *syntax, const char *name, int primes)
{
    if (syntax->kind == SYNTAX_VARIABLE && strcmp(syntax->text, name) == 0)
        return syntax->primes >= primes;
    for (int i = 0; i < syntax->count; i++)
        if (holds(syntax->args[i], name, primes))
            return true;
    return false;
}

/* for `P.x`: the port, and which motion; -1: something else */
static int motion_given(const Subsystem *subsystem, const char *path, int *port)
{
    const size_t length = strcspn(path, ".");
    char *first = mem_text(path, length);

    *port = subsystem_port(subsystem, first);
    mem_free(first);
    return *port >= 0 && subsystem->ports[*port].is_frame && path[length] == '.'
               ? find_word(given_motions, GIVEN_POSE, path + length + 1)
               : -1;
}

typedef struct Scan {
    const Subsystem *subsystem;
    Statements lines;
    LIST(const char *) names; /* of unknowns, and "A.x" of free frames */
    bool *moves;
    bool *frames, *free; /* by port: whether its motion is given, or it is free */
} Scan;

static bool mark_all(Scan *scan, const Syntax *syntax, int primes)
{
    bool more = false;

    for (int k = 0; k < scan->names.count; k++) {
        more = more || (!scan->moves[k] && holds(syntax, scan->names.at[k], primes));
        scan->moves[k] = scan->moves[k] || holds(syntax, scan->names.at[k], primes);
    }
    return more;
}

/* frames in through= without given motion */
static void mark_free(Scan *scan, const State *state)
{
    for (int p = 0; p < scan->subsystem->port_count; p++) {
        const Port *port = &scan->subsystem->ports[p];

        scan->free[p] = port->is_frame && port->is_through && !scan->frames[p];
        for (int k = 0; k < GIVEN_POSE && scan->free[p]; k++) {
            Text name = {0};

            if (!given_moves(state, k))
                continue;
            text_addf(&name, "%s.%s", port->name, given_motions[k]);
            scan->moves[scan->names.count] = true;
            LIST_PUSH(scan->names, pool_text(state->pool, name.at, name.length));
            text_free(&name);
        }
    }
}

/* marks unknowns that accelerate in one equation with an unknown that moves a frame, or in the
 * effort on a free frame */
static bool mark_coupled(Scan *scan, const Statement *s)
{
    bool moves = false, more = false;
    int port;

    for (int k = 0; k < scan->names.count && s->row.number == VERB_internal; k++)
        moves = moves || (scan->moves[k] && holds(s->operands.at[0].value, scan->names.at[k], 2));
    if (moves)
        more = mark_all(scan, s->operands.at[0].value, 2);
    for (int p = 0; p < s->pairs.count; p++) {
        (void)motion_given(scan->subsystem, s->pairs.at[p].name, &port);
        if (port >= 0 && scan->free[port])
            more = mark_all(scan, s->pairs.at[p].value, 2) || more;
    }
    return more;
}

/* Marks the unknowns in a frame's motion, and those that accelerate in the same equations. */
static void mark_moving(Scan *scan, const State *state)
{
    bool more = true;
    int port;

    for (int i = 0; i < scan->lines.count; i++)
        for (int p = 0; p < scan->lines.at[i]->pairs.count; p++)
            if (motion_given(scan->subsystem, scan->lines.at[i]->pairs.at[p].name, &port) >= 0) {
                (void)mark_all(scan, scan->lines.at[i]->pairs.at[p].value, 0);
                scan->frames[port] = true;
            }
    if (scan->lines.count > 0)
        mark_free(scan, state);
    while (more) {
        more = false;
        for (int i = 0; i < scan->lines.count; i++)
            more = mark_coupled(scan, scan->lines.at[i]) || more;
    }
}

const BlockEquation *given_find(const BlockEquations *equations, int port, bool is_motion,
                                int member)
{
    for (const BlockEquation *e = equations->first; e != NULL; e = e->next)
        if (e->kind == EQUATION_GIVES && e->port == port && e->is_motion == is_motion &&
            (member < 0 || e->member == member))
            return e;
    return NULL;
}

bool given_moves(const State *state, int motion)
{
    return motion != (state->setup.planar ? 2 : 3);
}

const char *given_name(State *state, const Use *use, const char *name)
{
    Text text = {0};
    const char *own;

    text_addf(&text, "%s.%s", use->name, name);
    if (strchr(name, '.') != NULL)
        text.at[strlen(use->name) + 1 + strcspn(name, ".")] = '_';
    own = state_text(state, text.at);
    text_free(&text);
    return own;
}

void given_begin(State *state, int use, const Body *body)
{
    BlockEquations *equations = state->uses.at[use].equations;
    Scan scan = {.subsystem = state->uses.at[use].subsystem};
    const int ports = scan.subsystem->port_count;

    for (int i = 0; i < body->count; i++)
        if (verb_gives(&body->at[i]))
            LIST_PUSH(scan.lines, &body->at[i]);
    for (int i = 0; i < scan.lines.count; i++)
        for (int k = 0;
             scan.lines.at[i]->row.number == VERB_unknown && k < scan.lines.at[i]->operands.count;
             k++)
            LIST_PUSH(scan.names, scan.lines.at[i]->operands.at[k].value->text);
    const int unknowns = scan.names.count;
    scan.moves = NEW_ARRAY(bool, unknowns + ports * GIVEN_POSE + 1);
    scan.frames = NEW_ARRAY(bool, ports + 1);
    scan.free = NEW_ARRAY(bool, ports + 1);
    mark_moving(&scan, state);
    pool_retain(state->pool, equations, sizeof *equations);
    equations->moving = pool_alloc(state->pool, sizeof(char *) * ((size_t)scan.names.count + 1));
    equations->frames = pool_alloc(state->pool, sizeof(int) * ((size_t)ports + 1));
    for (int k = 0; k < scan.names.count; k++)
        if (scan.moves[k])
            equations->moving[equations->moving_count++] =
                given_name(state, &state->uses.at[use], scan.names.at[k]);
    equations->free_count = scan.names.count - unknowns;
    for (int p = 0; p < ports; p++)
        if (scan.frames[p] || scan.free[p])
            equations->frames[equations->frame_count++] = p;
    LIST_FREE(scan.lines);
    LIST_FREE(scan.names);
    MEM_FREE(scan.moves, scan.frames, scan.free);
}

/* --- parts --- */

static EquationBlock *new_given(State *state, int count, int frames)
{
    EquationBlock *given = pool_alloc(state->pool, sizeof *given);
    const Expr zero = expr_int(state->arena, 0);
    const struct {
        Expr **at;
        int count;
    } lists[] = {
        {&given->mass, count * count}, {&given->force, count}, {&given->pose, frames * GIVEN_POSE}};

    *given = (EquationBlock){.count = count, .frame_count = frames, .equation = zero, .order = 2};
    for (int k = 0; k < COUNT(lists); k++) {
        *lists[k].at = pool_alloc(state->pool, sizeof(Expr) * ((size_t)lists[k].count + 1));
        for (int i = 0; i < lists[k].count; i++)
            (*lists[k].at)[i] = zero;
    }
    return given;
}

static Instance *add_unknown(State *state, const char *name)
{
    Text terminal = {0};
    Instance *part;

    text_addf(&terminal, "%s.node", name);
    part = part_add(state, &component_unknown, name, -1, -1, terminal.at);
    part->given = new_given(state, 0, 0);
    text_free(&terminal);
    return part;
}

static void add_frame(State *state, const Use *use, int port, int tail, int number)
{
    const char *name = given_name(state, use, use->subsystem->ports[port].name);
    const Instance *arm = part_add(state, &component_arm, name, tail, -1, NULL);
    Value *at = &arm->values[component_param(arm->row, "at")];

    at->given = true;
    at->at[0] = expr_int(state->arena, number);
}

static Status is_taken(const Use *use, const char *name, Place place, Diag *diag)
{
    (void)diag_at(diag, E_NAME, place, "'%s' is the name of a part that stands for these equations",
                  name + strlen(use->name) + 1);
    diag_hint(diag, "choose another one for yours");
    return E_NAME;
}

/* whether the name of a part made from equations is still free in the user's model */
static Status name_is_left(const State *state, const Use *use, const char *name, Place place,
                           Diag *diag)
{
    const BlockEquations *equations = use->equations;

    if (state_thing(state, name) == NULL &&
        find_word(equations->moving, equations->moving_count, name) < 0)
        return OK;
    return is_taken(use, name, place, diag);
}

/* adds the block and its coordinates, then the frames that it moves */
static Status add_block(State *state, const Use *use, Place place, Diag *diag)
{
    BlockEquations *equations = use->equations;
    const size_t count = (size_t)equations->moving_count;
    const char *name = given_name(state, use, "block");
    PartDraft draft = {.state = state};
    Instance *block;

    TRY(name_is_left(state, use, name, place, diag));
    for (int k = equations->moving_count - equations->free_count; k < equations->moving_count; k++)
        if (state_thing(state, equations->moving[k]) != NULL)
            return is_taken(use, equations->moving[k], place, diag);
    block = draft.part = part_new(state, &component_block, false);
    block->name = name;
    block->given = new_given(state, (int)count, equations->frame_count);
    block->tail = state->setup.datum[DOMAIN_MECHANICAL];
    block->coord_count = (int)count;
    block->coord = pool_alloc(state->pool, sizeof *block->coord * count);
    block->coord_kind = pool_alloc(state->pool, sizeof *block->coord_kind * count);
    block->coord_rotation = pool_alloc(state->pool, sizeof *block->coord_rotation * count);
    memcpy(block->coord, equations->moving, sizeof *block->coord * count);
    part_draft_commit(&draft, "block");
    equations->block = block;
    for (int f = 0; f < equations->frame_count; f++)
        add_frame(state, use, equations->frames[f], block->head, f);
    return OK;
}

/* --- lines --- */

static void add_equation(State *state, BlockEquations *equations, BlockEquation of)
{
    BlockEquation *equation = pool_alloc(state->pool, sizeof *equation);

    *equation = of;
    if (equations->last != NULL) {
        pool_retain(state->pool, equations->last, sizeof *equations->last);
        equations->last->next = equation;
    } else
        equations->first = equation;
    equations->last = equation;
}

static Status add_unknowns(State *state, const Use *use, const Statement *s, Diag *diag)
{
    BlockEquations *equations = use->equations;
    const char **free = equations->moving + equations->moving_count - equations->free_count;

    for (int i = 0; i < s->operands.count; i++) {
        const Operand *operand = &s->operands.at[i];
        const char *name = operand->value->text;
        const bool moves = find_word(equations->moving, equations->moving_count, name) >= 0;
        BlockEquation equation = {.kind = EQUATION_UNKNOWN, .place = operand->place};

        if (!moves || equations->block == NULL)
            TRY(name_is_free(state, name, operand->place, diag));
        if (find_word(free, equations->free_count, name) >= 0)
            return is_taken(use, name, operand->place, diag);
        if (subsystem_port(use->subsystem, name + strlen(use->name) + 1) >= 0)
            return diag_at(diag, E_NAME, operand->place, "%s is a port",
                           name + strlen(use->name) + 1);
        if (!moves)
            equation.part = add_unknown(state, name);
        else if (equations->block == NULL)
            TRY(add_block(state, use, operand->place, diag));
        add_equation(state, equations, equation);
    }
    return OK;
}

static Status given_twice(const Use *use, const BlockEquation *equation, const Pair *pair,
                          Diag *diag)
{
    const Port *port = &use->subsystem->ports[equation->port];

    if (given_find(use->equations, equation->port, equation->is_motion, equation->member) != NULL)
        return diag_at(diag, E_VALUE, pair->name_place, "%s is given twice", pair->name);
    if (given_find(use->equations, equation->port, port->is_frame && !equation->is_motion, -1) ==
        NULL)
        return OK;
    (void)diag_at(diag, E_VALUE, pair->name_place,
                  port->is_frame ? "both motion and effort of %s are given"
                                 : "both voltage and current of %s are given",
                  port->name);
    diag_hint(diag, "a port hands out one of the two and takes the other");
    return E_VALUE;
}

static Status read_target(const Use *use, const Pair *pair, BlockEquation *out, Diag *diag)
{
    const size_t length = strcspn(pair->name, ".");
    char *first = mem_text(pair->name, length);
    const char *member = pair->name[length] == '.' ? pair->name + length + 1 : "";
    const Port *port = NULL;
    Status status = OK;

    out->port = subsystem_port(use->subsystem, first);
    mem_free(first);
    if (out->port < 0 || pair->primes > 0) {
        (void)diag_at(diag, E_NAME, pair->name_place, "what is given is of a port of %s",
                      use->subsystem->name);
        diag_hint(diag, "as in give B.x = .., B.y = .. of a frame, give e.i = .. of a terminal");
        return E_NAME;
    }
    port = &use->subsystem->ports[out->port];
    out->is_motion = port->is_frame && find_word(given_motions, GIVEN_POSE, member) >= 0;
    out->member = out->is_motion   ? find_word(given_motions, GIVEN_POSE, member)
                  : port->is_frame ? find_word(given_efforts, GIVEN_EFFORTS, member)
                                   : find_word(given_flows, COUNT(given_flows), member);
    if (out->member >= 0)
        return given_twice(use, out, pair, diag);
    status =
        diag_at(diag, E_NAME, pair->name_place, "%s is nothing that a %s gives",
                member[0] != '\0' ? member : port->name, port->is_frame ? "frame" : "terminal");
    diag_hint(diag,
              port->is_frame ? "its motion is %s.x %s.y %s.z %s.theta, its effort %s.fx .. %s.tz"
                             : "its voltage is %s.v, its current %s.i",
              port->name, port->name, port->name, port->name, port->name, port->name);
    return status;
}

static Status in_this_scene(const State *state, const BlockEquation *e, const Pair *pair,
                            Diag *diag)
{
    bool stands = e->is_motion ? given_moves(state, e->member) : !state->setup.planar;

    for (int k = 0; k < GIVEN_POSE && !e->is_motion && state->setup.planar; k++)
        stands = stands || (given_moves(state, k) && given_effort_of[k] == e->member);
    if (stands)
        return OK;
    (void)diag_at(diag, E_VALUE, pair->name_place, "%s is not for a %s scene", pair->name,
                  state->setup.planar ? "planar" : "spatial");
    diag_hint(diag, state->setup.planar
                        ? "in a plane there are x, y, theta and fx, fy, tz"
                        : "in space a frame that is given keeps the axes of ground");
    return E_VALUE;
}

/* The part that applies an effort at a frame, which may exist already; NULL: the frame is at rest,
 * and needs no effort. */
static Instance *loading_part(State *state, const Component *row, const char *name,
                              const char *frame)
{
    const Instance *there = state_part(state, name);
    Expr pose[GIVEN_POSE];

    if (there != NULL)
        return state->parts.at[there->number];
    if (given_rests(state, frame, pose))
        return NULL;
    return part_add(state, row, name, state->setup.datum[DOMAIN_MECHANICAL],
                    graph_find_node(state->graph, frame), NULL);
}

/* *out: the part for the quantity that a port is given, if it has one */
static Status part_given(State *state, const Use *use, const BlockEquation *e, Instance **out,
                         Place place, Diag *diag)
{
    const Port *port = &use->subsystem->ports[e->port];
    const char *own = given_name(state, use, port->name);
    const char *at = use->bound[e->port] != NULL ? use->bound[e->port] : own;
    const bool moves = e->is_motion || (port->is_frame && port->is_through); /* or is free */
    const bool turns = e->member >= 3;
    const Component *load = turns ? &component_torque : &component_force;
    const Instance *there;
    Status status = OK;
    Text name = {0};

    *out = NULL;
    if (moves && !e->is_motion && turns && !state->setup.planar) {
        (void)diag_at(diag, E_VALUE, place, "%s keeps the axes of ground, so no moment moves it",
                      port->name);
        diag_hint(diag, "let it stand in frames= alone, and bind it in 'use'");
        return E_VALUE;
    }
    text_addf(&name, "%s_%s", own, !port->is_frame ? "source" : turns ? "torque" : "force");
    there = state_part(state, name.at);
    if ((!port->is_frame || !moves) && (there == NULL || there->row != load))
        CHECK(name_is_left(state, use, name.at, place, diag));
    if (!port->is_frame && e->member == 0 && e->value->kind == SYNTAX_NUMBER &&
        strtod(e->value->text, NULL) == 0)
        (void)state_terminal(state, at, DOMAIN_ELECTRICAL); /* it has no current */
    else if (!port->is_frame)
        *out = part_add(state, e->member == 0 ? &component_isource : &component_vsource, name.at,
                        -1, -1, at);
    else if (!moves)
        *out = loading_part(state, load, name.at, at);
    else if (state_part(state, own) == NULL) /* of a definition whose end has not been read */
        add_frame(state, use, e->port, state->setup.datum[DOMAIN_MECHANICAL], 0);
done:
    text_free(&name);
    return status;
}

static Status add_given(State *state, int use, const Statement *s, const Statement *from,
                        Diag *diag)
{
    for (int i = 0; i < s->pairs.count; i++) {
        const Use *u = &state->uses.at[use];
        BlockEquation target = {.kind = EQUATION_GIVES};

        TRY(read_target(u, &from->pairs.at[i], &target, diag));
        if (u->subsystem->ports[target.port].is_frame)
            TRY(in_this_scene(state, &target, &from->pairs.at[i], diag));
        target.value = syntax_copy(state->pool, s->pairs.at[i].value);
        target.place = from->pairs.at[i].value->place;
        TRY(part_given(state, u, &target, &target.part, from->pairs.at[i].name_place, diag));
        add_equation(state, u->equations, target);
    }
    return OK;
}

Status given_allows(State *state, int use, const Statement *s, Diag *diag)
{
    BlockEquations *equations = state->uses.at[use].equations;
    const bool is_part =
        s->kind == STATEMENT_VERB && (s->row.component != NULL || s->row.number == VERB_use);

    if (is_part && equations->first == NULL && !equations->has_parts) {
        state_retain_equations(state, use);
        equations->has_parts = true;
    }
    if (is_part ? equations->first == NULL : !verb_gives(s) || !equations->has_parts)
        return OK;
    (void)diag_at(diag, E_MODEL, s->verb_place, "%s holds %s before",
                  state->uses.at[use].subsystem->name, is_part ? "equations" : "parts");
    diag_hint(diag, "a subsystem is made of parts or of equations; two are joined at their ports");
    return E_MODEL;
}

Status given_add(State *state, int use, const Statement *s, const Statement *from, Diag *diag)
{
    BlockEquations *equations = state->uses.at[use].equations;

    state_retain_equations(state, use);
    if (equations->free_count > 0 && equations->block == NULL)
        TRY(add_block(state, &state->uses.at[use], from->place, diag));
    switch (s->row.number) {
    case VERB_unknown:
        return add_unknowns(state, &state->uses.at[use], s, diag);
    case VERB_internal:
        add_equation(state, equations,
                     (BlockEquation){.kind = EQUATION_INTERNAL,
                                     .value = syntax_copy(state->pool, s->operands.at[0].value),
                                     .place = from->operands.at[0].place});
        return OK;
    default:
        return add_given(state, use, s, from, diag);
    }
}

/* --- outside of a definition --- */

static Status only_inside(const Statement *s, Diag *diag)
{
    (void)diag_at(diag, E_SYNTAX, s->verb_place, "'%s' stands in the definition of a subsystem",
                  s->verb);
    diag_hint(diag, "subsystem NAME frames=[..] terminals=[..] ... end");
    return E_SYNTAX;
}

Status apply_unknown(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)state, (void)outcome;
    return only_inside(statement, diag);
}

Status apply_internal(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)state, (void)outcome;
    return only_inside(statement, diag);
}

Status apply_give(State **state, const Statement *statement, Outcome *outcome, Diag *diag)
{
    (void)state, (void)outcome;
    return only_inside(statement, diag);
}

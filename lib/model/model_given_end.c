/* model_given_end.c: sets the values of the parts made for given equations, once all lines are
 * read */
#include "base/random.h"
#include "model/model_given.h"

#include <math.h>
#include <string.h>

typedef LIST(Expr) ModelGivenEndExprs;

typedef struct Ending {
    State *state;
    const Use *use;
    BlockEquations *equations;
    Scope scope;
    NameList arguments;          /* efforts at frames whose motion is given: "leg1.B.fx" */
    ModelGivenEndExprs rates;    /* highest derivatives of unknowns that move */
    ModelGivenEndExprs unknowns; /* the unknowns themselves */
    ModelGivenEndExprs efforts;  /* of `arguments` */
    ModelGivenEndExprs once;     /* rates and efforts: equations of motion are linear in these */
    /* variables of ports at rest, derivatives of the other unknowns; and their replacements */
    ModelGivenEndExprs from, to;
    bool at_use; /* the fault is in the frame or terminal that the instance is bound to */
    Diag *diag;
} Ending;

/* --- ports with known motion --- */

static void put(Ending *ending, Expr from, Expr to)
{
    LIST_PUSH(ending->from, from);
    LIST_PUSH(ending->to, to);
}

static Expr variable(const Ending *ending, const char *head, const char *member)
{
    Text name = {0};
    Expr symbol;

    text_addf(&name, "%s%s", head, member);
    symbol = expr_symbol(ending->state->arena, name.at, SYMBOL_VARIABLE);
    text_free(&name);
    return symbol;
}

/* the members of a frame: which motion (-1: a turn that doesn't exist), and the number of
 * derivatives */
static const struct {
    const char *name;
    int motion, order;
} members[] = {
    {".x", 0, 0},       {".y", 1, 0},       {".z", 2, 0},       {".theta", 3, 0},  {".vx", 0, 1},
    {".vy", 1, 1},      {".vz", 2, 1},      {".wx", -1, 1},     {".wy", -1, 1},    {".wz", 3, 1},
    {".x'", 0, 1},      {".y'", 1, 1},      {".z'", 2, 1},      {".theta'", 3, 1}, {".ax", 0, 2},
    {".ay", 1, 2},      {".az", 2, 2},      {".x''", 0, 2},     {".y''", 1, 2},    {".z''", 2, 2},
    {".theta''", 3, 2}, {".alphax", -1, 2}, {".alphay", -1, 2}, {".alphaz", 3, 2},
};

/* a motion of a free frame, with that number of derivatives */
static Expr free_motion(const Ending *ending, int port, int motion, int order)
{
    static const char *const primes[] = {"", "'", "''"};
    Text name = {0};
    Expr out = expr_int(ending->state->arena, 0);

    text_addf(&name, "%s.%s", ending->use->subsystem->ports[port].name,
              motion < 0 ? "" : given_motions[motion]);
    if (motion >= 0 && given_moves(ending->state, motion))
        out = variable(ending, given_name(ending->state, ending->use, name.at), primes[order]);
    text_free(&name);
    return out;
}

/* a frame in through= without given motion */
static bool is_free(const Ending *ending, int port)
{
    const Port *p = &ending->use->subsystem->ports[port];

    return p->is_frame && p->is_through && given_find(ending->equations, port, true, -1) == NULL;
}

/* A.x and the like are numbers where A is at rest, and so are their rates; for a free frame they
 * are unknowns */
static Status put_ports(Ending *ending)
{
    const Use *use = ending->use;

    for (int p = 0; p < use->subsystem->port_count; p++) {
        const Port *port = &use->subsystem->ports[p];
        Expr pose[GIVEN_POSE], zero = expr_int(ending->state->arena, 0);
        const char *frame = use->bound[p];

        if (is_free(ending, p))
            for (int k = 0; k < COUNT(members); k++)
                put(ending,
                    variable(ending, given_name(ending->state, use, port->name), members[k].name),
                    free_motion(ending, p, members[k].motion, members[k].order));
        if (!port->is_frame || frame == NULL)
            continue;
        if (given_rests(ending->state, frame, pose)) {
            for (int k = 0; k < COUNT(members); k++)
                put(ending, variable(ending, frame, members[k].name),
                    members[k].order == 0 ? pose[members[k].motion] : zero);
        } else if (ending->equations->moving_count > 0) {
            (void)diag_set(ending->diag, E_MODEL,
                           "%s=%s moves, and equations that move frames want %s at rest",
                           port->name, frame, port->name);
            diag_hint(ending->diag,
                      "bind it to ground, or to an arm on ground; or let %s move %s as well, "
                      "through=[%s] in its first line and 'give %s.fx = ..' the effort there: then "
                      "%s %s.%s %s joins them",
                      use->subsystem->name, port->name, port->name, port->name,
                      ending->state->setup.planar ? "weld w" : "spherical s", use->name, port->name,
                      frame);
            return E_MODEL;
        }
    }
    return OK;
}

/* --- expressions --- */

static void name_efforts(Ending *ending)
{
    const Use *use = ending->use;

    for (int f = 0; f < ending->equations->frame_count; f++)
        for (int k = 0; k < GIVEN_EFFORTS; k++) {
            Text name = {0};

            text_addf(&name, "%s.%s.%s", use->name,
                      use->subsystem->ports[ending->equations->frames[f]].name, given_efforts[k]);
            LIST_PUSH(ending->arguments, state_text(ending->state, name.at));
            LIST_PUSH(ending->efforts, expr_symbol(ending->state->arena, name.at, SYMBOL_ARGUMENT));
            text_free(&name);
        }
    ending->scope.arguments = ending->arguments.at;
    ending->scope.argument_count = ending->arguments.count;
}

static void name_moving(Ending *ending)
{
    for (int k = 0; k < ending->equations->moving_count; k++) {
        LIST_PUSH(ending->unknowns, variable(ending, ending->equations->moving[k], ""));
        LIST_PUSH(ending->rates, variable(ending, ending->equations->moving[k], "''"));
    }
}

static Status read_all(Ending *ending)
{
    for (BlockEquation *e = ending->equations->first; e != NULL; e = e->next)
        if (e->kind != EQUATION_UNKNOWN) {
            pool_retain(ending->state->pool, e, sizeof *e);
            TRY(scope_expression(&ending->scope, e->value, &e->e, ending->diag));
        }
    return OK;
}

static bool depends_on_any(Expr e, const ModelGivenEndExprs *symbols)
{
    for (int i = 0; i < symbols->count; i++)
        if (expr_depends(e, symbols->at[i]))
            return true;
    return false;
}

/* the order of an unknown's highest derivative in the equations */
static int order_of(const Ending *ending, const Instance *unknown)
{
    int order = 0;

    for (const BlockEquation *e = ending->equations->first; e != NULL; e = e->next)
        for (int k = 1; k <= 2 && e->kind != EQUATION_UNKNOWN; k++)
            if (k > order &&
                expr_depends(e->e, variable(ending, unknown->name, k == 1 ? "'" : "''")))
                order = k;
    return order;
}

/* Names of derivatives in the equations: the network solves for the last one, the others are
 * states. */
static void report_orders(Ending *ending)
{
    for (BlockEquation *e = ending->equations->first; e != NULL; e = e->next) {
        Instance *part = e->part;
        EquationBlock *given;
        Expr last;

        if (e->kind != EQUATION_UNKNOWN || part == NULL)
            continue;
        given = equation_block_copy(ending->state->pool, part->given);
        pool_retain(ending->state->pool, part, sizeof *part);
        given->order = order_of(ending, part);
        part->given = given;
        last = variable(ending, part->name, ".v");
        put(ending, variable(ending, part->name, "''"), last);
        put(ending, variable(ending, part->name, "'"),
            given->order == 2 ? variable(ending, part->name, ".rate") : last);
        if (given->order == 0)
            put(ending, variable(ending, part->name, ""), last);
    }
}

static void put_variables(Ending *ending)
{
    for (BlockEquation *e = ending->equations->first; e != NULL; e = e->next)
        if (e->kind != EQUATION_UNKNOWN)
            e->e = expr_substitute(ending->state->arena, e->e, ending->from.at, ending->to.at,
                                   ending->from.count);
}

/* --- counts --- */

static int count_kind(const BlockEquations *equations, EquationKind kind)
{
    int count = 0;

    for (const BlockEquation *e = equations->first; e != NULL; e = e->next)
        count += e->kind == kind;
    return count;
}

static const BlockEquation *last_of(const BlockEquations *equations, EquationKind kind)
{
    const BlockEquation *last = NULL;

    for (const BlockEquation *e = equations->first; e != NULL; e = e->next)
        if (e->kind == kind)
            last = e;
    return last;
}

static Status check_counts(const Ending *ending)
{
    const BlockEquations *equations = ending->equations;
    const int unknowns = count_kind(equations, EQUATION_UNKNOWN);
    const int internal = count_kind(equations, EQUATION_INTERNAL);
    const BlockEquation *there =
        last_of(equations, unknowns > 0 ? EQUATION_UNKNOWN : EQUATION_INTERNAL);

    if (unknowns == internal)
        return OK;
    (void)diag_at(ending->diag, E_MODEL, there->place, "%d unknown%s and %d internal equation%s",
                  unknowns, unknowns == 1 ? "" : "s", internal, internal == 1 ? "" : "s");
    diag_hint(ending->diag, "one 'internal EXPR', which is 0, for each unknown");
    return E_MODEL;
}

/* each port must be given a quantity, and a moved frame all of its motion */
static Status check_ports(const Ending *ending)
{
    const Subsystem *subsystem = ending->use->subsystem;
    const BlockEquations *equations = ending->equations;

    for (int p = 0; p < subsystem->port_count; p++) {
        const Port *port = &subsystem->ports[p];

        /* a frame at rest needs no effort */
        if (given_find(equations, p, false, -1) != NULL ||
            given_find(equations, p, true, -1) != NULL ||
            (port->is_frame && equations->moving_count > 0))
            continue;
        (void)diag_at(ending->diag, E_MODEL, equations->last->place,
                      "nothing determines what %s gives", port->name);
        diag_hint(ending->diag,
                  port->is_frame
                      ? "give %s.x = .., %s.y = .., %s.theta = .. its motion, or %s.fx = .., its "
                        "effort"
                      : "give %s.%s = EXPR",
                  port->name,
                  port->is_frame     ? port->name
                  : port->is_through ? "v"
                                     : "i",
                  port->name, port->name);
        return E_MODEL;
    }
    for (int f = 0; f < equations->frame_count; f++)
        for (int k = 0; k < GIVEN_POSE; k++) {
            const int port = equations->frames[f];
            const char *name = subsystem->ports[port].name;

            if (!given_moves(ending->state, k) || is_free(ending, port) ||
                given_find(equations, port, true, k) != NULL)
                continue;
            (void)diag_at(ending->diag, E_MODEL, equations->last->place, "%s.%s isn't given", name,
                          given_motions[k]);
            diag_hint(ending->diag, "of a frame that is moved all is: %s",
                      ending->state->setup.planar ? "x, y, theta" : "x, y, z");
            return E_MODEL;
        }
    return OK;
}

/* --- identities, tested numerically at random points --- */

static double random_value(void *context, Expr symbol)
{
    const State *state = context;
    uint64_t seed = 0;
    double unit, own;

    for (const char *c = expr_name(symbol); *c != '\0'; c++)
        seed = seed * 131 + (unsigned char)*c;
    seed += (uint64_t)state->number * 977; /* another point each time it is incremented */
    unit = random_unit(&seed);
    if (expr_symbol_kind(symbol) != SYMBOL_PARAMETER)
        return unit;
    own = state_number_now(state, symbol);
    /* close to its current value: with the same sign */
    return own != 0 ? own * (1 + unit / 4) : unit / 4;
}

enum { TRIES = 6 };
static const double EQUAL = 1e-9; /* relative to the larger of two numbers: far above rounding */

/* whether a and b are the same function; false where no point decides it */
static bool same_function(const State *state, Expr a, Expr b)
{
    State place = *state; /* its number alone distinguishes points */
    bool same = true, is_decided = a == b;

    for (int i = 0; i < TRIES && same; i++) {
        double x, y;

        place.number = i;
        x = expr_evaluate(a, random_value, &place);
        y = expr_evaluate(b, random_value, &place);
        same = (isnan(x) && isnan(y)) || fabs(x - y) <= EQUAL * fmax(1, fmax(fabs(x), fabs(y)));
        is_decided = is_decided || !isnan(x);
    }
    return same && is_decided;
}

static bool is_negative(const State *state, Expr e)
{
    State place = *state;
    bool negative = false;

    for (int i = 0; i < TRIES; i++) {
        place.number = i;
        negative = negative || expr_evaluate(e, random_value, &place) < 0;
    }
    return negative;
}

/* --- unknowns that move frames --- */

/* its motion (otherwise zero) */
static Expr motion_of(const Ending *ending, int frame, int motion)
{
    const int port = ending->equations->frames[frame];
    const BlockEquation *given = given_find(ending->equations, port, true, motion);

    if (is_free(ending, port))
        return free_motion(ending, port, motion, 0);
    return given != NULL ? given->e : expr_int(ending->state->arena, 0);
}

/* whether it contains unknowns that move and parameters alone */
static bool follows_from_positions(const Ending *ending, Expr e)
{
    const Expr one = expr_int(ending->state->arena, 1);

    for (int k = 0; k < ending->unknowns.count; k++)
        e = expr_substitute(ending->state->arena, e, &ending->unknowns.at[k], &one, 1);
    return (expr_kinds(e) & ~(1U << SYMBOL_PARAMETER)) == 0;
}

static Status read_pose(const Ending *ending, EquationBlock *given)
{
    const BlockEquations *equations = ending->equations;

    for (int f = 0; f < equations->frame_count; f++)
        for (int k = 0; k < GIVEN_POSE; k++)
            given->pose[f * GIVEN_POSE + k] = motion_of(ending, f, k);
    for (const BlockEquation *e = equations->first; e != NULL; e = e->next) {
        if (e->kind != EQUATION_GIVES || !e->is_motion || follows_from_positions(ending, e->e))
            continue;
        (void)diag_at(ending->diag, E_MODEL, e->place,
                      "the motion of a frame follows from unknowns and parameters alone");
        diag_hint(ending->diag, "not from rates, t or other variables; of a port A that rests "
                                "A.x A.y A.theta");
        return E_MODEL;
    }
    return OK;
}

/* The divisor that brings an equation to the form mass q'' - force + J^T effort = 0: from the first
 * effort that acts on the unknown. NULL: none does */
static Expr scale_of(const Ending *ending, const EquationBlock *given, Expr row, int unknown)
{
    Arena *arena = ending->state->arena;

    for (int f = 0; f < given->frame_count; f++)
        for (int k = 0; k < GIVEN_POSE; k++) {
            const Expr moved =
                expr_diff(arena, given->pose[f * GIVEN_POSE + k], ending->unknowns.at[unknown]);
            const Expr felt =
                expr_diff(arena, row, ending->efforts.at[f * GIVEN_EFFORTS + given_effort_of[k]]);

            if (expr_is_zero(moved))
                continue;
            if (expr_is_zero(felt))
                return NULL;
            if (same_function(ending->state, felt, moved))
                return expr_int(arena, 1);
            if (same_function(ending->state, felt, expr_neg(arena, moved)))
                return expr_int(arena, -1);
            return expr_div(arena, felt, moved);
        }
    return expr_int(arena, 1);
}

/* whether the coefficients of all efforts in the row equal those of their work on the unknown's
 * motion */
static bool makes_no_power(const Ending *ending, const EquationBlock *given, Expr row, Expr scale,
                           int unknown)
{
    Arena *arena = ending->state->arena;

    for (int f = 0; f < given->frame_count; f++)
        for (int k = 0; k < GIVEN_EFFORTS; k++) {
            static const int motion_of_effort[GIVEN_EFFORTS] = {0, 1, 2, -1, -1, 3};
            const int motion = motion_of_effort[k];
            const Expr felt = expr_diff(arena, row, ending->efforts.at[f * GIVEN_EFFORTS + k]);
            const Expr moved = motion < 0 ? expr_int(arena, 0)
                                          : expr_diff(arena, given->pose[f * GIVEN_POSE + motion],
                                                      ending->unknowns.at[unknown]);

            if (!same_function(ending->state, felt, expr_mul(arena, scale, moved)))
                return false;
        }
    return true;
}

static Status not_the_one(const Ending *ending, const BlockEquation *row, int unknown)
{
    const char *name = ending->equations->moving[unknown] + strlen(ending->use->name) + 1;

    (void)diag_at(ending->diag, E_MODEL, row->place,
                  "this isn't the equation of %s: efforts at the ports don't stand in it as they "
                  "work on %s",
                  name, name);
    diag_hint(ending->diag,
              "the factor of B.fx is that of d B.x/d %s, and so on, and equations "
              "stand in the order of their unknowns",
              name);
    return E_MODEL;
}

/* checks that it is linear in quantities that may only occur linearly */
static Status check_linear(const Ending *ending, const BlockEquation *row,
                           const ModelGivenEndExprs *symbols, const char *what)
{
    for (int k = 0; k < symbols->count; k++) {
        if (!depends_on_any(expr_diff(ending->state->arena, row->e, symbols->at[k]), symbols))
            continue;
        (void)diag_at(ending->diag, E_MODEL, row->place, "the equation isn't linear in %s", what);
        diag_hint(ending->diag, "solve it for them, or make a part of it a further unknown");
        return E_MODEL;
    }
    return OK;
}

static Status read_row(const Ending *ending, const BlockEquation *row, int unknown,
                       EquationBlock *given)
{
    Arena *arena = ending->state->arena;
    const int n = given->count;
    const Expr zero = expr_int(arena, 0);
    Expr rest = row->e, scale;

    TRY(check_linear(ending, row, &ending->once, "second derivatives and efforts"));
    scale = scale_of(ending, given, row->e, unknown);
    if (scale == NULL || !makes_no_power(ending, given, row->e, scale, unknown))
        return not_the_one(ending, row, unknown);
    for (int k = 0; k < ending->efforts.count; k++)
        rest = expr_substitute(arena, rest, &ending->efforts.at[k], &zero, 1);
    for (int j = 0; j < n; j++) {
        given->mass[unknown * n + j] =
            expr_div(arena, expr_diff(arena, rest, ending->rates.at[j]), scale);
        rest = expr_substitute(arena, rest, &ending->rates.at[j], &zero, 1);
    }
    given->force[unknown] = expr_neg(arena, expr_div(arena, rest, scale));
    return OK;
}

/* the mass matrix must be symmetric, not negative, and depend on positions alone */
static Status check_mass(const Ending *ending, const EquationBlock *given,
                         const BlockEquation *const *rows)
{
    const int n = given->count;
    const State *state = ending->state;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const char *name = ending->equations->moving[j] + strlen(ending->use->name) + 1;

            if (!follows_from_positions(ending, given->mass[i * n + j])) {
                (void)diag_at(ending->diag, E_MODEL, rows[i]->place,
                              "the factor of %s'' follows from more than positions", name);
                diag_hint(ending->diag, "unknowns that move frames and parameters may stand in it");
                return E_MODEL;
            }
            if (j < i && !same_function(state, given->mass[i * n + j], given->mass[j * n + i])) {
                (void)diag_at(ending->diag, E_MODEL, rows[i]->place,
                              "the factor of %s'' here isn't that of the other in its equation",
                              name);
                diag_hint(ending->diag,
                          "factors of second derivatives are symmetric, once each equation is "
                          "divided so that efforts work on its unknown");
                return E_MODEL;
            }
            if (i == j && is_negative(state, given->mass[i * n + i])) {
                (void)diag_at(ending->diag, E_MODEL, rows[i]->place,
                              "the inertia of %s would be negative", name);
                diag_hint(ending->diag,
                          "an effort at a port is what the subsystem exerts there, as that of a "
                          "joint on its tip: it stands on the side of the inertia");
                return E_MODEL;
            }
        }
    return OK;
}

static bool contains_turn(Expr e, Expr symbol)
{
    if (expr_kind(e) == EXPR_CALL && (expr_op(e) == OP_SIN || expr_op(e) == OP_COS) &&
        expr_depends(e, symbol))
        return true;
    for (int i = 0; i < expr_arg_count(e); i++)
        if (contains_turn(expr_arg(e, i), symbol))
            return true;
    return false;
}

/* marks an unknown as an angle where it turns a frame or is the argument of a sine */
static void report_kinds(const Ending *ending, const EquationBlock *given)
{
    Instance *block = ending->equations->block;

    for (int k = 0; k < given->count; k++)
        for (int i = 0; i < given->frame_count * GIVEN_POSE; i++)
            if (contains_turn(given->pose[i], ending->unknowns.at[k]) ||
                (i % GIVEN_POSE == 3 && expr_depends(given->pose[i], ending->unknowns.at[k])))
                block->coord_kind[k] = COORDINATE_ANGLE;
}

static bool is_moving_row(const Ending *ending, const BlockEquation *e)
{
    return e->kind == EQUATION_INTERNAL &&
           (depends_on_any(e->e, &ending->rates) || depends_on_any(e->e, &ending->efforts));
}

/* without a block nothing determines the motion of the frames */
static Status check_no_motion(const Ending *ending)
{
    for (const BlockEquation *e = ending->equations->first; e != NULL; e = e->next) {
        if (e->kind != EQUATION_GIVES || !e->is_motion)
            continue;
        (void)diag_at(ending->diag, E_MODEL, e->place, "no unknown moves %s",
                      ending->use->subsystem->ports[e->port].name);
        diag_hint(ending->diag, "what rests is an arm on ground, beside the subsystem");
        return E_MODEL;
    }
    return OK;
}

/* the equation of a free frame's motion: the effort given there, or none */
static BlockEquation *free_row(const Ending *ending, int frame, int motion)
{
    const int effort = given_effort_of[motion];
    const BlockEquation *given =
        given_find(ending->equations, ending->equations->frames[frame], false, effort);
    BlockEquation *row = pool_alloc(ending->state->pool, sizeof *row);

    *row = *ending->equations->last;
    row->e = ending->efforts.at[frame * GIVEN_EFFORTS + effort];
    if (given != NULL) {
        row->place = given->place;
        row->e = expr_sub(ending->state->arena, row->e, given->e);
    }
    return row;
}

/* the rows of free frames come after the others, as their unknowns do */
static Status read_free(const Ending *ending, EquationBlock *given, const BlockEquation **rows)
{
    int next = given->count - ending->equations->free_count;

    for (int f = 0; f < ending->equations->frame_count; f++)
        for (int k = 0; k < GIVEN_POSE; k++) {
            if (!is_free(ending, ending->equations->frames[f]) || !given_moves(ending->state, k))
                continue;
            rows[next] = free_row(ending, f, k);
            TRY(read_row(ending, rows[next], next, given));
            next++;
        }
    return OK;
}

static Status report_block(Ending *ending)
{
    BlockEquations *equations = ending->equations;
    const int count = equations->moving_count;
    const int own = count - equations->free_count;
    const BlockEquation **rows;
    EquationBlock *given;
    int found = 0;

    if (equations->block == NULL)
        return check_no_motion(ending);
    rows = pool_alloc(ending->state->pool, sizeof(BlockEquation *) * ((size_t)count + 1));
    given = equation_block_copy(ending->state->pool, equations->block->given);
    TRY(read_pose(ending, given));
    for (const BlockEquation *e = equations->first; e != NULL; e = e->next) {
        if (!is_moving_row(ending, e))
            continue;
        if (found < own)
            TRY(read_row(ending, e, found, given));
        rows[found < own ? found : own] = e;
        found++;
    }
    if (found != own) {
        (void)diag_at(ending->diag, E_MODEL, equations->last->place,
                      "%d unknown%s frames, and %d equation%s second derivatives or efforts", own,
                      own == 1 ? " moves" : "s move", found,
                      found == 1 ? " holds their" : "s hold their");
        diag_hint(ending->diag, "each of them needs its equation of motion");
        return E_MODEL;
    }
    TRY(read_free(ending, given, rows));
    TRY(check_mass(ending, given, rows));
    report_kinds(ending, given);
    pool_retain(ending->state->pool, equations->block, sizeof *equations->block);
    equations->block->given = given;
    return OK;
}

/* --- other unknowns --- */

/* sets the other equations, in the order of the other unknowns */
static Status report_unknowns(Ending *ending)
{
    const BlockEquations *equations = ending->equations;
    const BlockEquation *e = equations->first;
    ModelGivenEndExprs last = {0};
    Status status = OK;

    for (const BlockEquation *u = equations->first; u != NULL; u = u->next)
        if (u->kind == EQUATION_UNKNOWN && u->part != NULL)
            LIST_PUSH(last, variable(ending, u->part->name, ".v"));
    for (BlockEquation *u = equations->first; u != NULL; u = u->next) {
        if (u->kind != EQUATION_UNKNOWN || u->part == NULL)
            continue;
        while (e->kind != EQUATION_INTERNAL || is_moving_row(ending, e))
            e = e->next; /* the counts are equal */
        CHECK(check_linear(ending, e, &last, "the highest derivatives"));
        ((EquationBlock *)u->part->given)->equation =
            e->e; /* a copy of its own, see report_orders() */
        e = e->next;
    }
done:
    LIST_FREE(last);
    return status;
}

static Status report_given(Ending *ending)
{
    for (const BlockEquation *e = ending->equations->first; e != NULL; e = e->next) {
        const int entry =
            e->part != NULL && e->part->row->family == FAMILY_FORCE
                ? (e->member < 3 || ending->state->setup.planar ? e->member : e->member - 3)
                : 0;

        if (e->kind != EQUATION_GIVES || e->part == NULL)
            continue;
        if (depends_on_any(e->e, &ending->efforts) || depends_on_any(e->e, &ending->rates)) {
            (void)diag_at(ending->diag, E_MODEL, e->place,
                          "what is handed out here follows from accelerations or efforts");
            diag_hint(ending->diag, "at a port that moves it follows from positions, rates, "
                                    "voltages and currents");
            return E_MODEL;
        }
        e->part->values[0].at[e->member == 5 && ending->state->setup.planar ? 0 : entry] = e->e;
    }
    return OK;
}

/* In order; reports the first fault. */
static Status end_all(Ending *ending)
{
    TRY(check_counts(ending));
    TRY(check_ports(ending));
    name_efforts(ending);
    name_moving(ending);
    for (int i = 0; i < ending->rates.count; i++)
        LIST_PUSH(ending->once, ending->rates.at[i]);
    for (int i = 0; i < ending->efforts.count; i++)
        LIST_PUSH(ending->once, ending->efforts.at[i]);
    TRY(read_all(ending));
    ending->at_use = true;
    TRY(put_ports(ending));
    ending->at_use = false;
    report_orders(ending);
    put_variables(ending);
    TRY(report_block(ending));
    TRY(report_unknowns(ending));
    return report_given(ending);
}

Status given_end(State *state, int use, bool *at_use, Diag *diag)
{
    Ending ending = {.state = state,
                     .use = &state->uses.at[use],
                     .equations = state->uses.at[use].equations,
                     .scope = {.state = state, .kind = SCOPE_EFFORT},
                     .diag = diag};
    Status status = OK;

    *at_use = false;
    if (ending.equations->first == NULL)
        return OK;
    status = end_all(&ending);
    *at_use = ending.at_use;
    /* a line made from the expressions needs what they need */
    if (status == OK)
        line_uses(state, &state->lines.at[state->lines.count - 1], &ending.scope);
    LIST_FREE(ending.scope.uses);
    LIST_FREE(ending.arguments);
    LIST_FREE(ending.rates);
    LIST_FREE(ending.unknowns);
    LIST_FREE(ending.efforts);
    LIST_FREE(ending.once);
    LIST_FREE(ending.from);
    LIST_FREE(ending.to);
    return status;
}

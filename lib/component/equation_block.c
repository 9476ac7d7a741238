/* equation_block.c: blocks and unknowns of subsystems whose equations are given */
#include "component/equation_block.h"

#include <string.h>

static Expr *copy_list(Pool *pool, const Expr *at, int count)
{
    Expr *copy = pool_alloc(pool, sizeof(Expr) * ((size_t)count + 1));

    if (count > 0)
        memcpy(copy, at, sizeof(Expr) * (size_t)count);
    return copy;
}

EquationBlock *equation_block_copy(Pool *pool, const EquationBlock *given)
{
    EquationBlock *copy = given != NULL ? pool_alloc(pool, sizeof *copy) : NULL;

    if (copy == NULL)
        return NULL;
    *copy = *given;
    copy->mass = copy_list(pool, given->mass, given->count * given->count);
    copy->force = copy_list(pool, given->force, given->count);
    copy->pose = copy_list(pool, given->pose, given->frame_count * GIVEN_POSE);
    return copy;
}

static bool same_list(const Expr *a, const Expr *b, int count)
{
    return count == 0 || memcmp(a, b, sizeof(Expr) * (size_t)count) == 0;
}

bool equation_block_same(const EquationBlock *a, const EquationBlock *b)
{
    if (a == NULL || b == NULL)
        return a == b;
    return a->count == b->count && a->frame_count == b->frame_count && a->order == b->order &&
           a->equation == b->equation && same_list(a->mass, b->mass, a->count * a->count) &&
           same_list(a->force, b->force, a->count) &&
           same_list(a->pose, b->pose, a->frame_count * GIVEN_POSE);
}

static bool any_depends(const Expr *at, int count, Expr symbol)
{
    for (int i = 0; i < count; i++)
        if (expr_depends(at[i], symbol))
            return true;
    return false;
}

bool equation_block_depends(const EquationBlock *given, Expr symbol)
{
    return given != NULL && (expr_depends(given->equation, symbol) ||
                             any_depends(given->mass, given->count * given->count, symbol) ||
                             any_depends(given->force, given->count, symbol) ||
                             any_depends(given->pose, given->frame_count * GIVEN_POSE, symbol));
}

/* --- a block --- */

static int block_count(const Instance *instance, bool planar)
{
    (void)planar;
    return instance->given->count;
}

static CoordinateRow block_coordinate(const Instance *instance, bool planar, int i)
{
    (void)planar;
    return (CoordinateRow){"", instance->coord_kind[i], false};
}

static double block_unit(const Instance *instance, bool planar, int i)
{
    (void)instance, (void)planar, (void)i;
    return 1;
}

static int no_load(const Instance *instance, Arena *arena)
{
    (void)instance, (void)arena;
    return 0;
}

static Expr own_symbol(const Instance *instance, Arena *arena, int i)
{
    return expr_symbol(arena, instance->coord[i], SYMBOL_VARIABLE);
}

/* an expression over the coordinates, with their current symbols */
static Expr in_state(const Instance *instance, Arena *arena, const ShapeState *state, Expr e)
{
    for (int i = 0; i < instance->given->count; i++) {
        const Expr own = own_symbol(instance, arena, i);

        e = expr_substitute(arena, e, &own, &state->q[i], 1);
    }
    return e;
}

/* the second rate at q'' = 0 of an expression over q */
static Expr left_of(Arena *arena, const ShapeState *state, int count, Expr e)
{
    Expr first = expr_diff_along(arena, e, state->q, state->rate, count);

    return expr_diff_along(arena, first, state->q, state->rate, count);
}

/* `at` is the number of the frame */
static void block_section_frame(const Instance *instance, Arena *arena, bool planar, Expr at,
                                const ShapeState *state, SectionFrame *out)
{
    const EquationBlock *given = instance->given;
    const Expr *pose = given->pose + (ptrdiff_t)GIVEN_POSE * (int)expr_value(at);
    const Expr zero = expr_int(arena, 0);

    (void)planar;
    for (int k = 0; k < 3; k++) {
        out->position[k] = in_state(instance, arena, state, pose[k]);
        out->bend[k] = left_of(arena, state, given->count, out->position[k]);
        out->angle[k] = out->twist[k] = zero;
    }
    out->angle[0] = in_state(instance, arena, state, pose[3]);
    out->twist[0] = left_of(arena, state, given->count, out->angle[0]);
    for (int i = 0; i < given->count; i++)
        for (int k = 0; k < 3; k++) {
            out->shift[3 * i + k] = expr_diff(arena, out->position[k], state->q[i]);
            out->turn[3 * i + k] = k == 0 ? expr_diff(arena, out->angle[0], state->q[i]) : zero;
        }
}

/* The part of d/dt dT/dq' - dT/dq that depends on rates, due to M alone. It is separate from the
 * forces, so that their power and the kinetic energy balance. */
static Expr rates_of(const Instance *instance, Arena *arena, const ShapeState *state,
                     const Expr *mass, int i)
{
    const int n = instance->given->count;
    const Expr half = expr_rational(arena, 1, 2);
    Expr sum = expr_int(arena, 0);

    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++) {
            const Expr along =
                expr_sub(arena, expr_diff(arena, mass[i * n + j], state->q[k]),
                         expr_mul(arena, half, expr_diff(arena, mass[j * n + k], state->q[i])));

            sum = expr_add(arena, sum,
                           expr_product(arena, (Expr[]){along, state->rate[j], state->rate[k]}, 3));
        }
    return sum;
}

static void block_inertia(const Instance *instance, Arena *arena, bool planar, Expr from,
                          const ShapeState *state, ShapeInertia *out)
{
    enum { LONGEST = 2000 }; /* most terms that are written out so that some may cancel */

    const EquationBlock *given = instance->given;
    const Expr zero = expr_int(arena, 0);
    const int count = given->count;

    (void)planar, (void)from;
    out->mass = out->stored = zero;
#define CLEAR_ROW(name, entries)                                                                   \
    for (int k = 0; k < (entries); k++)                                                            \
        out->name[k] = zero;
    SHAPE_ARRAYS_OF_ROOT(CLEAR_ROW)
    SHAPE_ARRAYS_OF_SHAPES(CLEAR_ROW)
#undef CLEAR_ROW
    for (int k = 0; k < count * count; k++)
        out->block[k] = in_state(instance, arena, state, given->mass[k]);
    for (int i = 0; i < count; i++) {
        Expr own = rates_of(instance, arena, state, out->block, i);

        out->bias[i] = own;
        /* in the user's names, like the rest of it */
        for (int k = 0; k < count; k++) {
            const Expr q = own_symbol(instance, arena, k);
            const Expr rate = system_user_rate(arena, q);

            own = expr_substitute(arena, own, (Expr[]){state->q[k], state->rate[k]},
                                  (Expr[]){q, rate}, 2);
        }
        out->drive[i] = expr_expand(arena, expr_add(arena, given->force[i], own), LONGEST);
    }
}

static const Deforming deforming = {.count = block_count,
                                    .coordinate = block_coordinate,
                                    .unit = block_unit,
                                    .load_powers = no_load,
                                    .station = block_section_frame,
                                    .inertia = block_inertia};

static void block_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    (void)instance, (void)planar;
    steps_none(arena, out);
}

const Component component_block = {
    .name = "block",
    .family = FAMILY_BODY,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_NONE,
    .brief = "what moves the frames of a subsystem whose equations are given",
    .translation = BRANCH_ALWAYS,
    .rotation = BRANCH_ALWAYS,
    .steps = block_steps,
    .deforming = &deforming,
};

/* --- an unknown --- */

static int unknown_states(const Instance *instance)
{
    return instance->given->order;
}

/* q' is the next state, or follows from the equation */
static void unknown_state(const Instance *instance, Arena *arena, int k, OwnState *out)
{
    const bool is_last = k + 1 == instance->given->order;

    *out = (OwnState){.member = k == 0 ? "" : "rate",
                      .initial = expr_int(arena, 0),
                      .rate = instance_variable(instance, arena, is_last ? "v" : "rate")};
}

static void unknown_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    (void)arena, (void)which, (void)motion;
    *out = (Relation){.kind = RELATION_FREE, .value = instance->given->equation};
}

static const Member unknown_members[] = {
    {"rate", NULL, "its derivative, where its second stands in the equations", 1},
};

const Component component_unknown = {
    .name = "unknown",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "unknown of a subsystem whose equations are given",
    .translation = BRANCH_ALWAYS,
    .terminal_count = 1,
    .scalar_edges = (const ScalarEdge[]){{"", 0, -1, BRANCH_ALWAYS, 10}},
    .scalar_edge_count = 1,
    .relation = unknown_relation,
    .own_state_count = unknown_states,
    .own_state = unknown_state,
    .members = unknown_members,
    .member_count = COUNT(unknown_members),
};

bool instance_is_unknown(const Instance *instance)
{
    return instance->row == &component_unknown;
}

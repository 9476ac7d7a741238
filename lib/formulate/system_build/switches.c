/* switches.c: where the equations may jump or have a kink: the arguments of their comparisons and
 * kinks
 *
 * The equations jump on surfaces: the zeros of a condition, whatever its scale and sign. On either
 * side of a surface the functions that jump there are constant; on it they take any value
 * between. */
#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/formulate_limits.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/shown.h"
#include "formulate/system/surfaces.h"
#include "formulate/system/system_impl.h"
#include "formulate/system_build/continuity.h"

#include <math.h>
#include <string.h>

typedef LIST(Expr) SwitchesExprs;

/* --- surfaces --- */

typedef struct Putting {
    const Surface *surfaces;
    int count;
} Putting;

/* whether e may be between 0 and 1 */
static bool may_be_between(const Putting *put, Expr e)
{
    for (int i = 0; i < put->count; i++)
        if (put->surfaces[i].may_slide && expr_depends(e, put->surfaces[i].sign))
            return true;
    return false;
}

/* whether a call of that law may jump on it; its bound may contain signs of other surfaces by now
 */
static bool is_of_surface(const Surface *surface, const SurfaceLaw *law)
{
    SurfaceLaw with_signs = surface->law;

    with_signs.bound = surface->bound;
    with_signs.hold = surface->hold;
    return surface_law_is(&surface->law, law) || surface_law_is(&with_signs, law);
}

/* the bound with the sign of the surface, which is 0 where the part's own symbol is what acts */
static Expr bounded_on(Arena *arena, const Surface *surface, Expr call)
{
    return expr_add(arena, expr_mul(arena, surface->sign, surface_law(arena, call).bound),
                    surface->part_sign[0]);
}

/* What is not 0 where a vector has a direction: off its surface and, since without a load it may
 * rest there, with a bound. */
static Expr is_off(Arena *arena, const Surface *surface, Expr call)
{
    return surface->law.bound == NULL ? surface->sign
                                      : expr_mul(arena, surface->sign, expr_arg(call, 2));
}

/* Of a vector the call itself off its surface, and on it the sign of its component; NULL: none of
 * its components is that of the call. */
static Expr component_on(Arena *arena, const Surface *surface, Expr call)
{
    const Expr part = surface_part(call);
    int way = 1, found = -1;

    for (int k = 0; k < surface->part_count && found < 0; k++)
        if (surface->part[k] == part)
            found = k;
    for (int k = 0; k < surface->part_count && found < 0; k++)
        if (surface_is_same(surface->part[k], part, &way))
            found = k;
    if (found < 0)
        return NULL;
    return expr_if(arena, is_off(arena, surface, call), call,
                   way > 0 ? surface->part_sign[found]
                           : expr_neg(arena, surface->part_sign[found]));
}

/* what replaces a call on its surface, whose condition is `way` times that of the call */
static Expr put_sign(Arena *arena, const Surface *surface, Expr call, int way)
{
    Expr own;

    if (surface->law.is_norm)
        return component_on(arena, surface, call);
    own = surface->law.bound != NULL ? bounded_on(arena, surface, call) : surface->sign;
    return way > 0 ? own : expr_neg(arena, own);
}

/* the replacement for the sign of the condition of a call that jumps; NULL: it is not replaced */
static Expr sign_on(Arena *arena, const Putting *put, Expr call)
{
    int way;
    const Expr condition = surface_of_call(arena, call, &way);
    SurfaceLaw law;

    if (condition == NULL)
        return NULL;
    law = surface_law(arena, call);
    for (int i = 0; i < put->count; i++)
        if (is_of_surface(&put->surfaces[i], &law) &&
            (put->surfaces[i].condition == condition || put->surfaces[i].measure == condition))
            return put_sign(arena, &put->surfaces[i], call, way);
    for (int i = 0; i < put->count; i++) {
        int other;

        if (!is_of_surface(&put->surfaces[i], &law) ||
            !surface_is_same(put->surfaces[i].condition, condition, &other) ||
            (other < 0 && law.is_unilateral))
            continue;
        return put_sign(arena, &put->surfaces[i], call, way * other);
    }
    return NULL;
}

/* (1 + way sign)/2 */
static Expr share(Arena *arena, Expr sign, int way)
{
    Expr half = expr_rational(arena, 1, 2);

    return expr_add(arena, half, expr_mul(arena, expr_rational(arena, way, 2), sign));
}

/* floor(x) near the integer n = floor(x + 1/2): n - 1/2 plus half the sign of x - n, which is the
 * sign of sin(pi x) where n is even */
static Expr put_floor(Arena *arena, Expr x, Expr sign)
{
    Expr half = expr_rational(arena, 1, 2);
    Expr n = expr_call1(arena, OP_FLOOR, expr_add(arena, x, half));
    Expr even = expr_cos(arena, expr_mul(arena, expr_pi(arena, 1), n));

    return expr_add(arena, expr_sub(arena, n, half),
                    expr_product(arena, (Expr[]){half, even, sign}, 3));
}

static Expr put_jump(Arena *arena, const Putting *put, Expr e)
{
    Expr sign = sign_on(arena, put, e);

    if (sign == NULL)
        return e;
    if (expr_op(e) == OP_SIGN || expr_op(e) == OP_STICK || expr_op(e) == OP_UNILATERAL ||
        expr_op(e) == OP_DIRECTION || expr_op(e) == OP_COULOMB)
        return sign;
    if (expr_op(e) == OP_FLOOR)
        return put_floor(arena, expr_arg(e, 0), sign);
    return share(arena, sign, expr_op(e) == OP_STEP ? 1 : -1);
}

/* b + a (c - b); c or b themselves where a is 1 or 0, as the other may have no value on that side.
 * A sign that is solved for may be beyond its interval during a step: the formula holds there, too.
 */
static Expr put_if(Arena *arena, Expr a, Expr c, Expr b)
{
    const Expr between = expr_add(arena, b, expr_mul(arena, a, expr_sub(arena, c, b)));

    return expr_if(arena, expr_call2(arena, OP_EQ, a, expr_int(arena, 1)), c,
                   expr_if(arena, expr_call2(arena, OP_EQ, a, expr_int(arena, 0)), b, between));
}

/* replacement for a choice whose condition may be between 0 and 1 */
static Expr put_choice(Arena *arena, const Putting *put, Expr e)
{
    Expr a = expr_arg(e, 0), one = expr_int(arena, 1);

    switch (expr_op(e)) {
    case OP_IF:
        return may_be_between(put, a) ? put_if(arena, a, expr_arg(e, 1), expr_arg(e, 2)) : e;
    case OP_AND:
        return may_be_between(put, e) ? expr_mul(arena, a, expr_arg(e, 1)) : e;
    case OP_OR: /* 1 - (1 - a)(1 - b) */
        if (!may_be_between(put, e))
            return e;
        return expr_sub(
            arena, one,
            expr_mul(arena, expr_sub(arena, one, a), expr_sub(arena, one, expr_arg(e, 1))));
    case OP_NOT:
        return may_be_between(put, a) ? expr_sub(arena, one, a) : e;
    default:
        return e;
    }
}

/* Whether e is 0 on one of the surfaces, within the rounding of its constants. */
static bool vanishes_on(Arena *arena, const Putting *put, Expr e)
{
    int way;
    Expr surface;

    if (expr_is_number(e))
        return false;
    surface = surface_of(arena, e, &way);
    for (int i = 0; i < put->count; i++) {
        const Expr condition = put->surfaces[i].condition;
        const Expr off = expr_sub(arena, surface, condition);
        const Expr constant =
            expr_kind(condition) == EXPR_SUM ? expr_arg(condition, 0) : expr_int(arena, 0);

        if (expr_is_zero(off) ||
            (expr_is_number(off) && expr_is_number(constant) &&
             fabs(expr_value(off)) <= SWITCH_ROUNDING * fabs(expr_value(constant))))
            return true;
    }
    return false;
}

/* A root of an expression that is 0 on a surface, as (h - 2)^1.5 at h = 2, has no value where
 * errors lead past it: x^a is max(x, 0)^a there. */
static Expr put_root(Arena *arena, const Putting *put, Expr e)
{
    const bool is_root = expr_kind(e) == EXPR_CALL && expr_op(e) == OP_SQRT;
    Expr base, inside;

    if (!is_root && (expr_kind(e) != EXPR_POWER || !expr_is_number(expr_arg(e, 1)) ||
                     expr_value(expr_arg(e, 1)) == floor(expr_value(expr_arg(e, 1)))))
        return e;
    base = expr_arg(e, 0);
    if (!vanishes_on(arena, put, base))
        return e;
    inside = expr_call2(arena, OP_MAX, base, expr_int(arena, 0));
    return is_root ? expr_sqrt(arena, inside) : expr_pow(arena, inside, expr_arg(e, 1));
}

static Expr put_node(Arena *arena, Expr e, void *context)
{
    const Putting *put = context;

    if (expr_kind(e) == EXPR_POWER || (expr_kind(e) == EXPR_CALL && expr_op(e) == OP_SQRT))
        return put_root(arena, put, e);
    if (expr_kind(e) != EXPR_CALL)
        return e;
    return switch_jumps(e) ? put_jump(arena, put, e) : put_choice(arena, put, e);
}

Expr surfaces_substitute(Arena *arena, Expr e, const Surface *surfaces, int count)
{
    Putting put = {surfaces, count};

    return count > 0 ? expr_change(arena, e, put_node, &put) : e;
}

/* --- all of a system --- */

typedef struct Gathering {
    System *system;
    SwitchesExprs stack;
    char *seen; /* by number: 1 seen, 2 also as a condition that jumps */
    uint32_t room;
} Gathering;

static void make_room(Gathering *g, uint32_t number)
{
    uint32_t more = number + number / 2 + 64;

    g->seen = mem_grow(g->seen, more, 1);
    memset(g->seen + g->room, 0, more - g->room);
    g->room = more;
}

static inline char *mark_of(Gathering *g, Expr e)
{
    const uint32_t number = expr_number(e);

    if (number >= g->room)
        make_room(g, number);
    return &g->seen[number];
}

/* a call whose value may be selected or jump */
static void visit_call(Gathering *g, Expr e)
{
    Expr condition = switch_condition(g->system->arena, e);

    if (condition != NULL && !expr_is_number(condition))
        LIST_PUSH(g->system->shown->switches, ((Switch){condition, .call = e, .surface = -1}));
    for (int i = 0; i < expr_arg_count(e); i++) {
        LIST_PUSH(g->stack, expr_arg(e, i));
        if (switch_jumps(expr_arg(e, i)) && !jump_only_bends(g->system->arena, e, i))
            *mark_of(g, expr_arg(e, i)) |= 2;
    }
}

/* visits the nodes below that were not visited before; most of them are no calls */
static void visit(Gathering *g, Expr e)
{
    const int count = expr_arg_count(e);

    if (expr_kind(e) == EXPR_CALL) {
        visit_call(g, e);
        return;
    }
    for (int i = 0; i < count; i++) {
        const Expr arg = expr_arg(e, i);
        const ExprKind kind = expr_kind(arg);
        char *mark;

        if (kind <= EXPR_SYMBOL)
            continue;
        mark = mark_of(g, arg);
        if (kind == EXPR_CALL && switch_jumps(arg) && !jump_only_bends(g->system->arena, e, i))
            *mark |= 2;
        if ((*mark & 1) == 0)
            LIST_PUSH(g->stack, arg);
    }
}

static void gather(Gathering *g, const Expr *roots, int count)
{
    for (int i = 0; i < count; i++) {
        LIST_PUSH(g->stack, roots[i]);
        if (switch_jumps(roots[i]))
            *mark_of(g, roots[i]) |= 2;
    }
    while (g->stack.count > 0) {
        Expr e = g->stack.at[--g->stack.count];
        char *mark = mark_of(g, e);

        if ((*mark & 1) == 0) {
            *mark |= 1;
            visit(g, e);
        }
    }
}

/* Conditions of t alone are located before a run, in the hybrid system. A condition that only a
 * mode makes one of t, as the voltage of a resistor that a switch connects to a source, is
 * monitored like the others. */
static bool is_of_time(System *system, Expr condition)
{
    const Switch *known;
    int count = 0;

    if ((expr_kinds(condition) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) != 0)
        return false;
    if (system->whole == NULL)
        return true;
    (void)system_switches(system->whole, &known, &count);
    for (int i = 0; i < count; i++)
        if (known[i].condition == condition)
            return true;
    return false;
}

/* a component of a vector whose norm is 0 on the surface, each once; or h itself */
static void add_part(SystemSurface *surface, Expr part)
{
    if (!surface->law.is_norm)
        part = surface->law.bound != NULL ? surface->condition : NULL;
    for (int k = 0; k < surface->part_count; k++)
        if (surface->part[k] == part)
            return;
    if (part != NULL && surface->part_count < COUNT(surface->part))
        surface->part[surface->part_count++] = part;
}

static bool is_surface(Arena *arena, const SystemSurface *surface, Expr condition, Expr call)
{
    const SurfaceLaw law = surface_law(arena, call);

    return surface->condition == condition && surface_law_is(&surface->law, &law);
}

/* finds the surface on which the equations jump, among those in the state, each once */
static void find_surface(System *system, Switch *entry)
{
    SystemSurface surface = {.law = surface_law(system->arena, entry->call), .load = -1};
    int way;

    if (is_of_time(system, entry->condition))
        return;
    surface.condition = surface_of_call(system->arena, entry->call, &way);
    for (int i = 0; i < system->shown->surfaces.count && entry->surface < 0; i++)
        if (is_surface(system->arena, &system->shown->surfaces.at[i], surface.condition,
                       entry->call))
            entry->surface = i;
    if (entry->surface < 0) {
        entry->surface = system->shown->surfaces.count;
        LIST_PUSH(system->shown->surfaces, surface);
    }
    add_part(&system->shown->surfaces.at[entry->surface], surface_part(entry->call));
}

static int number_of_surface(System *system, Expr call);

static bool is_effort(Expr e, void *context)
{
    (void)context;
    return expr_kind(e) == EXPR_CALL && expr_op(e) == OP_UNILATERAL;
}

static void find_loads(System *system)
{
    for (int i = 0; i < system->shown->surfaces.count; i++) {
        SystemSurface *surface = &system->shown->surfaces.at[i];
        Expr *calls;

        if (surface->law.bound == NULL)
            continue;
        if (expr_find(&surface->law.bound, 1, is_effort, NULL, &calls) > 0)
            surface->load = number_of_surface(system, calls[0]);
        mem_free(calls);
    }
}

static void gather_all(System *system)
{
    Gathering g = {.system = system};

    gather(&g, system->run.force, system->kinematics->u.count);
    gather(&g, system->run.phi, system->constraints->rows.count);
    gather(&g, system->run.gamma, system->constraints->rows.count);
    gather(&g, system->run.network_residual, system->network->x.count + system->network->z.count);
    for (int i = 0; i < system->shown->switches.count; i++)
        if ((*mark_of(&g, system->shown->switches.at[i].call) & 2) != 0)
            find_surface(system, &system->shown->switches.at[i]);
    find_loads(system);
    for (int i = 0; i < system->network->ideals.count; i++) {
        IdealSwitch ideal;

        if (system_ideal(system, i, &ideal, NULL) == OK && ideal.when != NULL)
            gather(&g, &ideal.when, 1);
    }
    mem_free(g.seen);
    LIST_FREE(g.stack);
}

int system_switches(System *system, const Switch **switches, int *time_only)
{
    system_touch(system);
    if (!system->shown->switches_known) {
        gather_all(system);
        /* those of time alone first, each once */
        for (int i = 0; i < system->shown->switches.count; i++)
            if (is_of_time(system, system->shown->switches.at[i].condition)) {
                Switch entry = system->shown->switches.at[i];

                system->shown->switches.at[i] =
                    system->shown->switches.at[system->shown->switches_of_time];
                system->shown->switches.at[system->shown->switches_of_time++] = entry;
            }
        system->shown->switches_known = true;
    }
    *switches = system->shown->switches.at;
    *time_only = system->shown->switches_of_time;
    return system->shown->switches.count;
}

bool system_surface(System *system, int i, SystemSurface *out)
{
    system_touch(system);
    if (i >= system->shown->surfaces.count)
        return false;
    *out = system->shown->surfaces.at[i];
    return true;
}

/* --- for messages --- */

/* pushes a part's values, over the system's variables */
static void push_values(System *system, const Instance *instance, SwitchesExprs *stack)
{
    for (int k = 0; k < instance->row->param_count; k++)
        for (int i = 0; i < instance->values[k].count; i++) {
            Expr value;

            if (instance->values[k].at[i] != NULL &&
                system_resolve(system, instance->values[k].at[i], &value, NULL) == OK)
                LIST_PUSH(*stack, value);
        }
}

/* what a part that sticks does, over the system's variables */
static void push_law(System *system, const Instance *instance, SwitchesExprs *stack)
{
    Effort effort;
    FrictionLoad rubbing;
    Expr value;

    if (!instance_sticks(instance))
        return;
    if (instance->row->rub != NULL && rubbing_of(system, instance, TAKE_ALL, &rubbing, NULL) == OK)
        for (int k = 0; k < rubbing.count; k++)
            LIST_PUSH(*stack, rubbing.effort[k]);
    if (instance->row->effort != NULL && effort_of(system, instance, &effort, NULL) == OK)
        LIST_PUSH(*stack, effort.value);
    for (int k = 0; k < instance->scalar_count; k++)
        if (system_resolve(system, scalar_branch(system, instance, k)->relation.value, &value,
                           NULL) == OK)
            LIST_PUSH(*stack, value);
}

/* whether a part's values or its law contain a condition of that surface */
static bool part_switches_on(System *system, const Instance *instance, Expr surface)
{
    SwitchesExprs stack = {0};
    bool found = false;

    push_values(system, instance, &stack);
    push_law(system, instance, &stack);
    while (stack.count > 0 && !found) {
        Expr e = stack.at[--stack.count];
        Expr condition = switch_condition(system->arena, e);
        int way;

        found = condition != NULL && !expr_is_number(condition) &&
                (surface_of(system->arena, condition, &way) == surface ||
                 surface_is_same(surface, condition, &way));
        for (int i = 0; i < expr_arg_count(e); i++)
            LIST_PUSH(stack, expr_arg(e, i));
    }
    LIST_FREE(stack);
    return found;
}

const char *system_jumping_part(System *system, Expr condition)
{
    system_touch(system);
    int way;
    Expr surface = surface_of(system->arena, condition, &way);

    for (int i = 0; i < system->origin->instance_count; i++)
        if (part_switches_on(system, &system->origin->instances[i], surface))
            return system->origin->instances[i].name;
    return NULL;
}

bool system_hint_locking(System *system, Diag *diag)
{
    system_touch(system);
    Text names = {0};
    bool found;

    for (int i = 0; i < system->origin->instance_count; i++)
        if (system->origin->instances[i].row->domain == DOMAIN_LOAD)
            text_addf(&names, "%s%s", names.length > 0 ? ", " : "",
                      system->origin->instances[i].name);
    found = names.length > 0;
    if (found)
        diag_hint(diag,
                  "self-locking of %s: the friction presses its joint by more than it holds; a "
                  "smaller mu= or radius=, or a longer span=, has a motion",
                  names.at);
    text_free(&names);
    return found;
}

/* a bound in which each effort of a unilateral surface is a symbol of that surface */
static Expr name_load(Arena *arena, Expr e, void *context)
{
    int number;
    Text name = {0};

    if (!is_effort(e, NULL))
        return e;
    number = number_of_surface(context, e);
    if (number < 0)
        return e;
    text_addf(&name, "#load %d", number);
    e = expr_symbol(arena, name.at, SYMBOL_STATE);
    text_free(&name);
    return e;
}

/* the same law but for how the bound's load is written */
static bool is_law_of(System *system, const SurfaceLaw *law, const SurfaceLaw *other)
{
    SurfaceLaw named = *law, other_named = *other;

    if (law->bound == NULL || other->bound == NULL)
        return surface_law_is(law, other);
    named.bound = expr_change(system->arena, law->bound, name_load, system);
    named.hold = expr_change(system->arena, law->hold, name_load, system);
    other_named.bound = expr_change(system->arena, other->bound, name_load, system);
    other_named.hold = expr_change(system->arena, other->hold, name_load, system);
    return surface_law_is(&named, &other_named);
}

/* a call of a part's law that jumps on a surface of the equations; -1: none */
static int number_of_surface(System *system, Expr call)
{
    int way;
    const Expr condition = switch_jumps(call) ? surface_of_call(system->arena, call, &way) : NULL;
    SurfaceLaw law;

    if (condition == NULL)
        return -1;
    law = surface_law(system->arena, call);
    for (int i = 0; i < system->shown->surfaces.count; i++) {
        const SystemSurface *surface = &system->shown->surfaces.at[i];

        if (is_law_of(system, &surface->law, &law) &&
            (surface->condition == condition ||
             surface_is_same(surface->condition, condition, &way)))
            return i;
    }
    return -1;
}

int system_rest_surface(System *system, Expr guard)
{
    const Switch *switches;
    int time_only;
    const int count = system_switches(system, &switches, &time_only);

    for (int i = 0; i < count; i++) {
        int way;

        if (switches[i].surface < 0 ||
            !surface_rests(surface_law(system->arena, switches[i].call).ratio))
            continue;
        if (expr_arg(switches[i].call, 0) == guard ||
            (surface_is_same(expr_arg(switches[i].call, 0), guard, &way) && way > 0))
            return switches[i].surface;
    }
    return -1;
}

int system_surfaces_of_part(System *system, const char *part, int *out, int room)
{
    SwitchesExprs stack = {0};
    const Switch *switches;
    int time_only, found = 0;

    system_touch(system);
    (void)system_switches(system, &switches, &time_only);
    for (int i = 0; i < system->origin->instance_count; i++)
        if (strcmp(system->origin->instances[i].name, part) == 0)
            push_law(system, &system->origin->instances[i], &stack);
    while (stack.count > 0 && found < room) {
        const Expr e = stack.at[--stack.count];
        const int number = number_of_surface(system, e);

        bool known = number < 0;

        for (int i = 0; i < found; i++)
            known = known || out[i] == number;
        if (!known)
            out[found++] = number;
        for (int i = 0; i < expr_arg_count(e); i++)
            LIST_PUSH(stack, expr_arg(e, i));
    }
    LIST_FREE(stack);
    return found;
}

/* rests.c: the positions at which events that happen ever faster come to rest
 *
 * An event with new values is true where h(q, t) > 0, and its values lead back to h < 0. Where it
 * happens ever faster its series has a limit, from which on h = 0 is held by an effort that does no
 * work,
 *
 *     F_j -= unilateral(h, -1) dh'/du_j
 *
 * until that would pull. The coefficient of restitution -1 leaves the impacts to the event. */
#include "formulate/dynamics/rests.h"

#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

static bool is_position(Expr h)
{
    const unsigned allowed = 1U << SYMBOL_COORDINATE | 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER;

    return (expr_kinds(h) & 1U << SYMBOL_COORDINATE) != 0 && (expr_kinds(h) & ~allowed) == 0;
}

/* b - a of the comparisons a < b on positions; returns their number */
static int count_guards(Arena *arena, Expr when, Expr *guard)
{
    Expr h;

    if (expr_kind(when) != EXPR_CALL)
        return 0;
    if (expr_op(when) == OP_AND) {
        const int first = count_guards(arena, expr_arg(when, 0), guard);

        return first + count_guards(arena, expr_arg(when, 1), guard);
    }
    if (expr_op(when) != OP_LT && expr_op(when) != OP_LE)
        return 0;
    h = expr_sub(arena, expr_arg(when, 1), expr_arg(when, 0));
    if (!is_position(h))
        return 0;
    *guard = h;
    return 1;
}

Expr system_rest_guard(const System *system, Expr when)
{
    Expr guard = NULL;

    return count_guards(system->arena, when, &guard) == 1 ? guard : NULL;
}

Status rest_effort(System *system, int i, Expr *guard, Expr *effort, Diag *diag)
{
    Arena *arena = system->arena;
    Expr when;

    TRY(variables_resolve(system, system->origin->rests[i], &when, diag));
    *guard = system_rest_guard(system, when);
    if (*guard != NULL)
        *effort = expr_neg(arena, expr_call2(arena, OP_UNILATERAL, *guard, expr_int(arena, -1)));
    return OK;
}

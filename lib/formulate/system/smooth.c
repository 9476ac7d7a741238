/* smooth.c: whether an expression has a derivative in time where the equations need one
 *
 * What switches at an instant is found, and the expression looked at just before and behind it:
 * ramp(t)^2 has step(t) in its derivative, and bends there all the same. Switches by other
 * variables are taken for bends, as in the derivative rules. */
#include "formulate/system/smooth.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/surfaces.h"
#include "formulate/system/system_impl.h"

#include <math.h>
#include <string.h>

#define NARROW 1e-14 /* of a time: as near as its numbers are told apart */
#define WIDER  8
#define CHANGE 1e-10 /* of a value: more than rounding */

typedef struct AtTime {
    Expr time;
    double t;
} AtTime;

static double value_at(void *context, Expr symbol)
{
    const AtTime *at = context;

    return symbol == at->time ? at->t : 0.7 + 0.1 * (expr_symbol_number(symbol) % 7);
}

/* what is 0 where a function switches, with a single root; NULL: it doesn't */
static Expr switch_of(Arena *arena, Expr e)
{
    if (expr_kind(e) == EXPR_CALL && expr_op(e) == OP_FLOOR) /* at 1, as at any whole number */
        return expr_sub(arena, expr_arg(e, 0), expr_int(arena, 1));
    return switch_condition(arena, e);
}

/* Newton's method from t = 0; false where it leads nowhere */
static bool instant_of(Arena *arena, Expr condition, AtTime *at)
{
    Expr slope = expr_diff(arena, condition, at->time);
    double move = INFINITY;

    at->t = 0;
    for (int i = 0; i < 50 && fabs(move) > 1e-14 * fabs(at->t); i++) {
        move = expr_evaluate(condition, value_at, at) / expr_evaluate(slope, value_at, at);
        if (!isfinite(move))
            return false;
        at->t -= move;
    }
    return fabs(move) <= 1e-12 * fabs(at->t) + 1e-300;
}

static double change_about(Expr e, AtTime at, double step, double *size)
{
    AtTime before = {at.time, at.t - step};
    AtTime behind = {at.time, at.t + step};
    double first = expr_evaluate(e, value_at, &before), last = expr_evaluate(e, value_at, &behind);

    *size = fabs(first) + fabs(last);
    return fabs(last - first);
}

/* A change that does not grow with the time it is given, however short a ramp may be: over times
 * that numbers just tell apart. */
static bool jumps_at(Expr e, AtTime at)
{
    double step = NARROW * fabs(at.t) + NARROW * NARROW;
    double size;
    double narrow = change_about(e, at, step, &size);

    return narrow > CHANGE * size && !(change_about(e, at, WIDER * step, &size) > 2 * narrow);
}

static bool jumps(Arena *arena, Expr e)
{
    const unsigned plain = 1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER;
    AtTime at = {expr_symbol(arena, "t", SYMBOL_TIME), 0};
    LIST(Expr) stack = {0};
    LIST(bool) seen = {0};
    bool found = false;

    LIST_PUSH(stack, e);
    while (stack.count > 0 && !found) {
        Expr part = stack.at[--stack.count];
        Expr condition = switch_of(arena, part);

        while ((uint32_t)seen.count <= expr_number(part))
            LIST_PUSH(seen, false);
        if (seen.at[expr_number(part)])
            continue;
        seen.at[expr_number(part)] = true;
        if (condition != NULL && (expr_kinds(condition) & ~plain) == 0 &&
            instant_of(arena, condition, &at))
            found = jumps_at(e, at);
        for (int i = 0; i < expr_arg_count(part); i++)
            LIST_PUSH(stack, expr_arg(part, i));
    }
    LIST_FREE(stack);
    LIST_FREE(seen);
    return found;
}

Status system_need_smooth(const System *system, const char *who, Expr e, Diag *diag)
{
    const unsigned plain = 1U << SYMBOL_PARAMETER | 1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC;

    if ((expr_kinds(e) & ~plain) == 0 || !jumps(system->arena, e))
        return OK;
    if (system->network->form == NETWORK_TREE) {
        (void)diag_set(diag, E_MODEL, "in this tree %s needs the derivative of a source that jumps",
                       who);
        diag_hint(diag, "take capacitors into the tree and inductors out of it, or set network "
                        "state");
    } else {
        (void)diag_set(diag, E_MODEL, "a source that jumps would drive an impulse through %s", who);
        diag_hint(diag, "put a resistance into the circuit, or give the source a rise time");
    }
    return E_MODEL;
}

const char *system_rough_driver(const System *system, int order)
{
    Expr time = expr_symbol(system->arena, "t", SYMBOL_TIME);

    for (int k = 0; k < system->constraints->rows.count; k++) {
        Expr f = system->constraints->rows.at[k].prescribed;

        if (system->constraints->rows.at[k].kind != ROW_DRIVER)
            continue;
        for (int i = 0; i <= order; i++) {
            if (jumps(system->arena, f))
                return system->origin->instances[system->constraints->rows.at[k].told.instance]
                    .name;
            f = expr_diff(system->arena, f, time);
        }
    }
    return NULL;
}

/* switches.c: where the equations may jump or bend: what their comparisons and kinks compare */
#include "formulate/system_impl.h"

#include <string.h>

Expr switch_condition(Arena *arena, Expr e)
{
    if (expr_kind(e) != EXPR_CALL)
        return NULL;
    switch (expr_op(e)) {
    case OP_LT:
    case OP_LE:
    case OP_MIN:
    case OP_MAX:
        return expr_sub(arena, expr_arg(e, 0), expr_arg(e, 1));
    case OP_STEP:
    case OP_RAMP:
    case OP_SIGN:
    case OP_ABS:
        return expr_arg(e, 0);
    case OP_FLOOR: /* at whole numbers */
        return expr_sin(arena,
                        expr_mul(arena, expr_real(arena, 3.14159265358979323846), expr_arg(e, 0)));
    default:
        return NULL;
    }
}

static void gather(System *system, const Expr *roots, int count, bool **seen, uint32_t *room)
{
    LIST(Expr) stack = {0};

    for (int i = 0; i < count; i++)
        LIST_PUSH(stack, roots[i]);
    while (stack.count > 0) {
        Expr e = stack.at[--stack.count];
        uint32_t number = expr_number(e);
        Expr condition;

        if (number >= *room) {
            uint32_t more = number + number / 2 + 64;

            *seen = mem_grow(*seen, more, sizeof(bool));
            memset(*seen + *room, 0, more - *room);
            *room = more;
        }
        if ((*seen)[number])
            continue;
        (*seen)[number] = true;
        condition = switch_condition(system->arena, e);
        if (condition != NULL && !expr_is_number(condition))
            LIST_PUSH(system->switches, condition);
        for (int i = 0; i < expr_arg_count(e); i++)
            LIST_PUSH(stack, expr_arg(e, i));
    }
    LIST_FREE(stack);
}

/* Those of t alone are looked for before a run, in the whole: what a mode makes one of them, as the
 * voltage of a resistor that a switch lays on a source, is followed like the others. */
static bool is_of_time(System *system, Expr condition)
{
    const Expr *known;
    int count = 0;

    if ((expr_kinds(condition) & ~(1U << SYMBOL_TIME | 1U << SYMBOL_PARAMETER)) != 0)
        return false;
    if (system->whole == NULL)
        return true;
    (void)system_switches(system->whole, &known, &count);
    for (int i = 0; i < count; i++)
        if (known[i] == condition)
            return true;
    return false;
}

int system_switches(System *system, const Expr **conditions, int *time_only)
{
    int w = system->x.count + system->z.count;
    bool *seen = NULL;
    uint32_t room = 0;

    if (!system->switches_known) {
        gather(system, system->run.force, system->u.count, &seen, &room);
        gather(system, system->run.phi, system->rows.count, &seen, &room);
        gather(system, system->run.gamma, system->rows.count, &seen, &room);
        gather(system, system->run.network_residual, w, &seen, &room);
        for (int i = 0; i < system->ideals.count; i++) {
            IdealSwitch ideal;

            if (system_ideal(system, i, &ideal, NULL) == OK && ideal.when != NULL)
                gather(system, &ideal.when, 1, &seen, &room);
        }
        mem_free(seen);
        /* those of time alone first, each once */
        for (int i = 0; i < system->switches.count; i++)
            if (is_of_time(system, system->switches.at[i])) {
                Expr condition = system->switches.at[i];

                system->switches.at[i] = system->switches.at[system->switches_of_time];
                system->switches.at[system->switches_of_time++] = condition;
            }
        system->switches_known = true;
    }
    *conditions = system->switches.at;
    *time_only = system->switches_of_time;
    return system->switches.count;
}

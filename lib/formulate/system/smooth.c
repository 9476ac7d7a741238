/* smooth.c: whether an expression has a derivative in time where the equations need one
 *
 * Switches by other variables than time count as kinks without a jump, as in the derivative
 * rules. */
#include "formulate/system/smooth.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include "expr/jumps.h"

Status system_need_smooth(const System *system, const char *who, Expr e, Diag *diag)
{
    const unsigned plain = 1U << SYMBOL_PARAMETER | 1U << SYMBOL_STATE | 1U << SYMBOL_ALGEBRAIC;

    if ((expr_kinds(e) & ~plain) == 0 || !expr_jumps(system->arena, e, 1U << SYMBOL_TIME))
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

const char *system_rough_driver(const System *system)
{
    Expr time = expr_symbol(system->arena, "t", SYMBOL_TIME);

    for (int k = 0; k < system->constraints->rows.count; k++) {
        Expr f = system->constraints->rows.at[k].prescribed;

        if (system->constraints->rows.at[k].kind != ROW_DRIVER)
            continue;
        for (int i = 0; i <= 2; i++) {
            if (expr_jumps(system->arena, f, 1U << SYMBOL_TIME))
                return system->origin->instances[system->constraints->rows.at[k].reported.instance]
                    .name;
            f = expr_diff(system->arena, f, time);
        }
    }
    return NULL;
}

/* sensitivity_pass.c: the equations of a segment, with their derivatives */
#include "simulate/sensitivity/sensitivity_impl.h"

#include "base/memory.h"

#include <math.h>

void sensitivity_close(SensitivityPass *pass)
{
    if (pass->phase != NULL)
        motion_window(pass->phase->motion, -INFINITY, INFINITY);
    item_slopes_free(pass->slopes);
    variational_free(pass->variational);
    mem_free(pass->unknowns);
    pass->phase = NULL;
    pass->slopes = NULL;
    pass->variational = NULL;
    pass->unknowns = NULL;
}

static Status open_items(SensitivityPass *pass, Diag *diag)
{
    Phases *phases = pass->reader->phases;
    Expr *roots = NEW_ARRAY(Expr, pass->item_count);
    Status status = OK;

    for (int i = 0; i < pass->item_count; i++)
        CHECK(system_resolve(pass->phase->system, pass->items[i], &roots[i], diag));
    CHECK(item_slopes_new(pass->phase, &phases->parameters, &pass->order->by, roots,
                          pass->item_count, &pass->slopes, diag));
done:
    mem_free(roots);
    return status;
}

Status sensitivity_open(SensitivityPass *pass, int phase, Diag *diag)
{
    Phases *phases = pass->reader->phases;

    sensitivity_close(pass);
    pass->phase = phases->at[phase];
    phase_enter(pass->phase);
    TRY(variational_new(pass->phase, &phases->parameters, &pass->order->by, &pass->variational,
                        diag));
    TRY(open_items(pass, diag));
    pass->unknowns = NEW_ARRAY(double, variational_ode(pass->variational)->n);
    return OK;
}

/* elimination.c: the accelerations that a run's program tells, of mechanisms without constraints */
#include "simulate/equations/elimination.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/solved/accelerations.h"

#include "base/memory.h"
#include "compile/program.h"

Status elimination_choose(const Layout *l, Told *by, Expr **out, Diag *diag)
{
    const Reading *r = system_run(l->system);
    Expr *told = NEW_ARRAY(Expr, 2 * l->nu), *pushes = NEW_ARRAY(Expr, 2 * l->nu);
    Expr *force = pushes + l->nu;
    Status status = OK;

    *out = told;
    *by = TOLD_NOT;
    if (l->m > 0 || l->nu == 0)
        goto done;
    CHECK(system_pushes(l->system, pushes, diag));
    for (int j = 0; j < l->nu; j++) {
        pushes[j] = layout_on_surfaces(l, pushes[j]);
        force[j] = layout_on_surfaces(l, r->force[j]);
    }
    *by = system_accelerations(l->system, force, pushes, told, told + l->nu);
    for (int j = 0; j < l->nu; j++)
        if (*by != TOLD_NOT && stage_of(told[j]) > STAGE_NETWORK)
            *by = TOLD_NOT;
done:
    mem_free(pushes);
    return status;
}

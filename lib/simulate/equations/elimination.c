/* elimination.c: accelerations that a run's program computes in closed form, so that no linear
 * system is left */
#include "simulate/equations/elimination.h"
#include "formulate/dynamics/cutset_equations.h"
#include "formulate/reduced/accelerations.h"

#include "base/memory.h"
#include "compile/program.h"

/* early: none of them may depend on accelerations */
static bool is_known_early(const Expr *eliminated, int count)
{
    for (int i = 0; i < count; i++)
        if (stage_of(eliminated[i]) > STAGE_NETWORK)
            return false;
    return true;
}

/* where no row constrains the speeds */
static Status choose_free(const VariableIndex *l, EliminatedBy *by, Expr *eliminated, Diag *diag)
{
    const EquationForm *r = system_run(l->system);
    Expr *pushes = NEW_ARRAY(Expr, 2 * l->nu), *force = pushes + l->nu;
    Status status = OK;

    CHECK(system_pushes(l->system, pushes, diag));
    for (int j = 0; j < l->nu; j++) {
        pushes[j] = variable_index_on_surfaces(l, pushes[j]);
        force[j] = variable_index_on_surfaces(l, r->force[j]);
    }
    *by = system_accelerations(l->system, force, pushes, eliminated, eliminated + l->nu);
done:
    mem_free(pushes);
    return status;
}

Status elimination_choose(const VariableIndex *l, EliminatedBy *by, Expr **out, Diag *diag)
{
    Expr *eliminated = NEW_ARRAY(Expr, 2 * l->nu);

    *out = eliminated;
    *by = ELIMINATED_NOT;
    if (l->nu > 0 && l->m == 0)
        TRY(choose_free(l, by, eliminated, diag));
    else if (l->nu > 0 && l->m == l->nu && l->surface_count == 0 &&
             system_prescribed(l->system, eliminated, eliminated + l->nu))
        *by = ELIMINATED_PRESCRIBED;
    if (*by != ELIMINATED_NOT && !is_known_early(eliminated, 2 * l->nu))
        *by = ELIMINATED_NOT;
    return OK;
}

Constrained *elimination_of_rows(const VariableIndex *l, const int *rows, int row_count,
                                 double most)
{
    const EquationForm *r = system_run(l->system);
    Expr *force = NEW_ARRAY(Expr, l->nu + l->m), *gamma = force + l->nu;
    Constrained *out;

    for (int j = 0; j < l->nu; j++)
        force[j] = variable_index_on_surfaces(l, r->force[j]);
    for (int k = 0; k < l->m; k++)
        gamma[k] = variable_index_on_surfaces(l, r->gamma[k]);
    out = constrained_new(l->system, rows, row_count, force, gamma, most);
    mem_free(force);
    if (out != NULL && !is_known_early(out->acceleration, out->places.step)) {
        constrained_free(out);
        out = NULL;
    }
    return out;
}

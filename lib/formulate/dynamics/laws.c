/* laws.c: efforts of parts, as functions of the motion
 *
 * A law that contains u' acts as inertia: that of a flywheel on a shaft's end, or of the liquid
 * before a cylinder. Its derivative by u' is added to M, and its value at u' = 0 to F. */
#include "formulate/dynamics/laws.h"
#include "formulate/system/dynamics.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/resolve.h"
#include "formulate/system/system_impl.h"

/* While the equations are being formed, a law cannot read their results. */
Status law_read(System *system, const Instance *instance, Expr law, Expr *out, Diag *diag)
{
    const Status status = variables_resolve(system, law, out, diag);

    if (status == E_MISSING && system->is_early) {
        (void)diag_set(diag, status, "the law of %s reads what follows from all forces",
                       instance->name);
        diag_hint(diag, "it may read coordinates and points with their primes (b.x'' in place of "
                        "b.ax); anything else through a network: vsource S a 0 b.ax, "
                        "resistor R a 0 1 and R.i");
    }
    return status;
}

bool law_is_inertial(Expr law)
{
    return (expr_kinds(law) & 1U << SYMBOL_ACCELERATION) != 0;
}

Status law_add(const System *system, const Instance *instance, int take, Expr *law, Diag *diag)
{
    const Kinematics *kinematics = system->kinematics;

    if (take >= 0) {
        *law = expr_diff(system->arena, *law, kinematics->accelerations[take]);
        if (!law_is_inertial(*law))
            return OK;
        (void)diag_set(diag, E_MODEL, "%s pushes with more than a multiple of an acceleration",
                       instance->name);
        diag_hint(diag, "a law may hold accelerations times what doesn't change with them");
        return E_MODEL;
    }
    if (take == TAKE_AT_REST && law_is_inertial(*law)) {
        *law = expr_substitute(system->arena, *law, kinematics->accelerations, NULL,
                               kinematics->u.count);
        system->dynamics->has_inertial_laws = true;
    }
    return OK;
}

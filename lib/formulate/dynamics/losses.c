/* losses.c: bounds of dry friction, and the power that it takes from the motion
 *
 * On joints the power is minus the effort times the rate, of the first joint against the second. On
 * terminals it is the through times the across variable. */
#include "formulate/dynamics/losses.h"

#include "formulate/dynamics/efforts.h"
#include "formulate/dynamics/laws.h"
#include "formulate/dynamics/rubbing.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/system_impl.h"

#include <string.h>

typedef enum LossMember { LOSS_BOUND, LOSS_HOLD, LOSS_POWER, LOSS_ENERGY, LOSS_NONE } LossMember;

static LossMember find_member(const Instance *part, const char *name)
{
    static const char *const members[] = {[LOSS_BOUND] = "bound",
                                          [LOSS_HOLD] = "hold",
                                          [LOSS_POWER] = "loss",
                                          [LOSS_ENERGY] = "lost"};
    LossMember which = LOSS_BOUND;

    if (!part->row->sticks)
        return LOSS_NONE;
    while (which < LOSS_NONE && strcmp(members[which], name) != 0)
        which++;
    return which;
}

/* the rate of slip, of a contact its normal force, and the power that is lost */
static Status find_slip(System *system, const Instance *part, Expr *rate, Expr *load, Expr *power,
                        Diag *diag)
{
    Arena *arena = system->arena;
    Branchlike *branch;
    Effort effort;
    FrictionLoad rubbing;
    Expr through;

    if (part->row->effort != NULL) {
        TRY(effort_of(system, part, &effort, diag));
        *rate = effort.rate;
        *power = expr_neg(arena, expr_mul(arena, effort.value, effort.rate));
        return OK;
    }
    if (part->row->rub != NULL) {
        TRY(rubbing_of(system, part, TAKE_ALL, &rubbing, diag));
        *rate = rubbing.speed;
        *load = rubbing.first > 0 ? rubbing.effort[0] : NULL;
        *power = rubbing.lost;
        return OK;
    }
    branch = scalar_branch(system, part, 0);
    TRY(network_across(system, branch, rate, diag));
    TRY(network_through(system, branch, &through, diag));
    *power = expr_mul(arena, through, *rate);
    return OK;
}

Status loss_refuse_formula(const char *name, Diag *diag)
{
    (void)diag_set(diag, E_MISSING, "%s is an integral over a run, and has no formula", name);
    diag_hint(diag, "'print' and 'plot' have its value; the power is %.*ss", (int)strlen(name) - 1,
              name);
    return E_MISSING;
}

Status loss_variable(System *system, const Instance *part, const char *member, bool *found,
                     Expr *out, Diag *diag)
{
    const LossMember which = find_member(part, member);
    Text name = {0};
    Expr rate, load = NULL;

    *found = which != LOSS_NONE;
    if (which == LOSS_ENERGY) {
        Status status;

        text_addf(&name, "%s.%s", part->name, member);
        status = loss_refuse_formula(name.at, diag);
        text_free(&name);
        return status;
    }
    if (*found)
        TRY(find_slip(system, part, &rate, &load, out, diag));
    if ((which == LOSS_BOUND || which == LOSS_HOLD) && part->row->press == NULL &&
        instance_is_rigid(part)) {
        (void)diag_set(diag, E_MISSING, "%s has no bound: it is rigid", part->name);
        diag_hint(diag, "torque= or force= bounds it");
        return E_MISSING;
    }
    return which == LOSS_BOUND || which == LOSS_HOLD
               ? law_read(system, part,
                          part->row->bound(part, system->arena, rate, load, which == LOSS_HOLD),
                          out, diag)
               : OK;
}

/* law_ends.c: limits of the laws of storage elements
 *
 * A charge eA/(s0 - s) v (C) is unbounded where the gap s0 - s (m) reaches 0, and has no meaning
 * beyond. A flux (L0 - k s) i (Wb) has no meaning where its coil stores no more energy. For each
 * law this file finds the expression that is 0 there: the variable bases of negative powers, or
 * without any the coefficient itself. */
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

typedef LIST(Expr) Measures;

static bool moves(Expr e)
{
    return (expr_kinds(e) & 1U << SYMBOL_VARIABLE) != 0;
}

static void add_measure(Measures *measures, Expr e)
{
    for (int i = 0; i < measures->count; i++)
        if (measures->at[i] == e)
            return;
    LIST_PUSH(*measures, e);
}

static void add_denominators(Measures *measures, Expr e)
{
    if (!moves(e))
        return;
    if (expr_kind(e) == EXPR_POWER && expr_is_number(expr_arg(e, 1)) &&
        expr_value(expr_arg(e, 1)) < 0 && moves(expr_arg(e, 0)))
        add_measure(measures, expr_arg(e, 0));
    for (int i = 0; i < expr_arg_count(e); i++)
        add_denominators(measures, expr_arg(e, i));
}

/* coefficient of the charge or flux of an edge: of its own voltage or current */
static Expr coefficient(const System *system, const Branchlike *branch)
{
    const Instance *instance = &system->origin->instances[branch->instance];
    Expr own = branch->relation.kind == RELATION_CAPACITIVE
                   ? instance_across(instance, system->arena, branch->which)
                   : instance_through(instance, system->arena, branch->which);

    return expr_diff(system->arena, branch->relation.content, own);
}

int system_bounds(const System *system, Bound **out)
{
    LIST(Bound) bounds = {0};

    for (int b = 0; b < system->network->branches.count; b++) {
        const Branchlike *branch = &system->network->branches.at[b];
        RelationKind kind = branch->relation.kind;
        Measures measures = {0};
        bool has_gap;
        Expr value;

        if ((kind != RELATION_CAPACITIVE && kind != RELATION_INDUCTIVE) ||
            branch->relation.content == NULL)
            continue;
        value = coefficient(system, branch);
        add_denominators(&measures, value);
        has_gap = measures.count > 0;
        if (!has_gap && moves(value))
            add_measure(&measures, value);
        for (int i = 0; i < measures.count; i++)
            LIST_PUSH(bounds, (Bound){.instance = system->origin->instances[branch->instance].name,
                                      .measure = measures.at[i],
                                      .is_gap = has_gap});
        LIST_FREE(measures);
    }
    *out = bounds.at;
    return bounds.count;
}

int system_storages(System *system, Storage **out)
{
    system_touch(system);
    LIST(Storage) storages = {0};

    for (int b = 0; b < system->network->branches.count; b++) {
        const Branchlike *branch = &system->network->branches.at[b];
        const Instance *instance = &system->origin->instances[branch->instance];
        bool holds_charge = branch->relation.kind == RELATION_CAPACITIVE;
        Expr own, content;

        if ((!holds_charge && branch->relation.kind != RELATION_INDUCTIVE) ||
            branch->relation.content == NULL || !moves(coefficient(system, branch)))
            continue;
        own = holds_charge ? instance_across(instance, system->arena, branch->which)
                           : instance_through(instance, system->arena, branch->which);
        if (system_resolve(system, own, &own, NULL) != OK ||
            system_resolve(system, branch->relation.content, &content, NULL) != OK)
            continue;
        for (int i = 0; i < system->network->x.count; i++)
            if (system->network->x.at[i].symbol == own)
                LIST_PUSH(storages, ((Storage){i, content}));
    }
    *out = storages.at;
    return storages.count;
}

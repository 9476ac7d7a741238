/* ideal.c: switches and diodes without resistance
 *
 * A system with both sides of each in one equation is for looking at, and for operating points:
 *
 *     diode    i = max(0, i + g (v - least)), g = 1 S; any g > 0 has the same solutions
 *     switch   v = on i while it is closed, v = off i or i = 0 while it is open
 *
 * In a mode each is on one side. A closed one is a source of across, an open one a source of
 * through variables, of nothing: so the normal tree is another one, and with it what is a state.
 * theory 8. */
#include "formulate/ideal.h"
#include "formulate/network.h"
#include "formulate/origin.h"
#include "formulate/system_impl.h"

/* --- relations --- */

static Expr both_sides(System *system, const Ideal *ideal, Expr v, Expr i)
{
    Arena *arena = system->arena;
    Expr closed = expr_sub(arena, expr_sub(arena, v, ideal->least), expr_mul(arena, ideal->on, i));
    Expr open = i;

    if (ideal->when == NULL)
        return expr_sub(arena, i,
                        expr_call2(arena, OP_MAX, expr_int(arena, 0), expr_add(arena, i, closed)));
    if (ideal->off != NULL)
        open = expr_sub(arena, v, expr_mul(arena, ideal->off, i));
    return expr_if(arena, ideal->when, closed, open);
}

/* Between two resistances: the side is a number of the run, and the equation of both is this one,
 * which gives neither v nor i: a large resistance times a current, and a voltage over a small one,
 * would tell little but rounding.
 *
 *     closed = 1: v = on (i - least/off) + least, closed = 0: v/off = i */
static Expr either_side(System *system, Expr closed, const Ideal *ideal, Expr v, Expr i)
{
    Arena *arena = system->arena;
    Expr one = expr_int(arena, 1);
    Expr meets =
        expr_mul(arena, ideal->least, expr_sub(arena, one, expr_div(arena, ideal->on, ideal->off)));

    return expr_add(
        arena,
        expr_mul(arena, closed,
                 expr_sub(arena, expr_sub(arena, v, meets), expr_mul(arena, ideal->on, i))),
        expr_mul(arena, expr_sub(arena, one, closed),
                 expr_sub(arena, expr_div(arena, v, ideal->off), i)));
}

/* one side, as the relation of a source or a resistor */
static void one_side(System *system, bool closed, Relation *relation)
{
    const Ideal *ideal = &relation->ideal;
    Expr zero = expr_int(system->arena, 0);

    relation->rest = zero;
    if (closed && expr_is_zero(ideal->on)) {
        relation->kind = RELATION_ACROSS;
        relation->value = ideal->least;
    } else if (closed) {
        relation->kind = RELATION_RESISTIVE;
        relation->value = ideal->on;
        relation->rest = ideal->least;
    } else if (ideal->off != NULL) {
        relation->kind = RELATION_RESISTIVE;
        relation->value = ideal->off;
    } else {
        relation->kind = RELATION_THROUGH;
        relation->value = zero;
    }
}

void ideal_take_side(System *system, Branchlike *branch)
{
    const Instance *instance = &system->origin->instances[branch->instance];
    const char *name = graph_edge(system->origin->graph, branch->edge)->name;
    Relation *relation = &branch->relation;
    Expr v = instance_across(instance, system->arena, branch->which);
    Expr i = instance_through(instance, system->arena, branch->which);

    branch->ideal = system->network->ideals.count;
    LIST_PUSH(system->network->ideals, (int)(branch - system->network->branches.at));
    if (relation->switches && system->network->takes_sides) {
        branch->closed =
            expr_symbol(system->arena, system_keep(system, "#%s.closed", name), SYMBOL_PARAMETER);
        relation->kind = RELATION_IDEAL;
        relation->value = either_side(system, branch->closed, &relation->ideal, v, i);
    } else if (relation->kind == RELATION_IDEAL && system->network->closed != NULL) {
        one_side(system, system->network->closed[branch->ideal], relation);
    } else if (relation->kind == RELATION_IDEAL) {
        relation->value = both_sides(system, &relation->ideal, v, i);
    }
}

/* --- looking --- */

int system_scalar_count(const System *system)
{
    return system->network->branches.count;
}

int system_ideal_count(const System *system)
{
    return system->network->ideals.count;
}

static const Branchlike *switching(const System *system, int i)
{
    return &system->network->branches.at[system->network->ideals.at[i]];
}

bool system_is_ideal(const System *system, int i)
{
    return !switching(system, i)->relation.switches;
}

int system_truly_ideal_count(const System *system)
{
    int count = 0;

    for (int i = 0; i < system->network->ideals.count; i++)
        count += system_is_ideal(system, i);
    return count;
}

Expr system_side(const System *system, int i)
{
    return switching(system, i)->closed;
}

bool system_has_modes(const System *system)
{
    if (system->network->ideals.count == 0)
        return false;
    return system_truly_ideal_count(system) > 0 ||
           (system->network->form == system->network->asked_form &&
            (system->network->form == NETWORK_STATE || !system->network->leaves_trees));
}

/* ideal_sides.c: relations of switches and diodes without resistance
 *
 * A system that has both sides of each in one equation serves for display and for operating points:
 *
 *     diode    i = max(0, i + g (v - least)), g = 1 S; any g > 0 has the same solutions
 *     switch   v = on i while it is closed, v = off i or i = 0 while it is open
 *
 * In a mode each is on one side. A closed one is a source of the across variable 0, an open one a
 * source of the through variable 0. So the normal tree of each mode differs, and with it the
 * states. theory 8. */
#include "formulate/network/ideal_sides.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

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

/* Where the side is a number of the run, as between two resistances, this equation serves both
 * sides. It gives neither v nor i: a large resistance times a current, or a voltage over a small
 * resistance, would be mostly rounding error.
 *
 *     closed = 1: v = on (i - least/off) + least, closed = 0: v/off = i
 *
 * Without `off` 1/off is 0. */
static Expr either_side(System *system, Expr closed, const Ideal *ideal, Expr v, Expr i)
{
    Arena *arena = system->arena;
    Expr one = expr_int(arena, 1);
    Expr leak = ideal->off != NULL ? expr_div(arena, one, ideal->off) : expr_int(arena, 0);
    Expr meets =
        expr_mul(arena, ideal->least, expr_sub(arena, one, expr_mul(arena, ideal->on, leak)));

    return expr_add(
        arena,
        expr_mul(arena, closed,
                 expr_sub(arena, expr_sub(arena, v, meets), expr_mul(arena, ideal->on, i))),
        expr_mul(arena, expr_sub(arena, one, closed),
                 expr_sub(arena, expr_mul(arena, v, leak), i)));
}

/* one side, with the relation of a source or a resistor */
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

void ideal_set_side(System *system, Branchlike *branch)
{
    const Instance *instance = &system->origin->instances[branch->instance];
    const char *name = graph_edge(system->origin->graph, branch->edge)->name;
    Relation *relation = &branch->relation;
    Expr v = instance_across(instance, system->arena, branch->which);
    Expr i = instance_through(instance, system->arena, branch->which);

    branch->ideal = system->network->ideals.count;
    LIST_PUSH(system->network->ideals, (int)(branch - system->network->branches.at));
    if (relation->switches ? system->network->takes_sides
                           : relation->kind == RELATION_IDEAL && system->network->takes_all) {
        branch->closed =
            expr_symbol(system->arena, system_retain(system, "#%s.closed", name), SYMBOL_PARAMETER);
        relation->kind = RELATION_IDEAL;
        relation->value = either_side(system, branch->closed, &relation->ideal, v, i);
    } else if (relation->kind == RELATION_IDEAL && system->network->closed != NULL) {
        one_side(system, system->network->closed[branch->ideal], relation);
    } else if (relation->kind == RELATION_IDEAL) {
        relation->value = both_sides(system, &relation->ideal, v, i);
    }
}

/* reactions.c: forces and moments of joints, from lambda where the joint is a chord, from what
 * hangs beyond it where it is a branch (theory 5) */
#include "formulate/system_impl.h"

/* what a constraint row puts on its two ends: -lambda along its direction */
static void add_row(System *system, Loads *loads, const Row *row, Expr lambda)
{
    Arena *arena = system->arena;
    int tail = system->frames[row->tail].chain;
    int chain = row->kind == ROW_DATUM ? 0 : tail;
    Expr push = expr_neg(arena, lambda);
    Vec along = row->n;

    if (row->kind == ROW_DRIVER) {
        loads_add_effort(system, loads, &system->instances[row->owner], row->coordinate, push);
        return;
    }
    if (row->kind == ROW_DOT) {
        Vec b = vec_express(system, row->b, system->frames[row->head].chain, tail);

        along = vec_hold(arena, vec_cross(arena, b, along));
    }
    along = vec_scale(arena, push, along);
    if (row->told.rotation) {
        loads_add_torque(system, loads, row->head, along, chain);
        loads_add_torque(system, loads, row->tail, vec_neg(arena, along), chain);
        return;
    }
    loads_add_force(system, loads, row->head, along, chain);
    loads_add_force(system, loads, row->tail, vec_neg(arena, along), chain);
    if (row->kind == ROW_TIE) {
        Vec moment = vec_scale(arena, expr_neg(arena, row->lead), along);

        loads_add_torque(system, loads, row->head, moment, chain);
        loads_add_torque(system, loads, row->tail, vec_neg(arena, moment), chain);
    }
    if (row->kind == ROW_TAIL || row->kind == ROW_TIE) {
        Vec way =
            vec_sub(arena, node_position(system, row->head), node_position(system, row->tail));
        Vec moment = vec_cross(arena, way, vec_express(system, along, chain, 0));

        loads_add_torque(system, loads, row->tail, vec_neg(arena, moment), 0);
    }
}

static Status add_rotors(System *system, Loads *loads, Diag *diag)
{
    Status status = OK;

    for (int i = 0; i < system->instance_count; i++) {
        const Instance *instance = &system->instances[i];
        const Instance *joint;
        Expr inertia;
        Expr second;

        if (instance->row->rotor == NULL || instance->joint < 0)
            continue;
        inertia = instance->row->rotor(instance, system->arena);
        joint = &system->instances[instance->joint];
        CHECK(coordinate_value(system, joint, instance->joint_coordinate, 2, &second, diag));
        loads_add_effort(system, loads, joint, instance->joint_coordinate,
                         expr_neg(system->arena, expr_mul(system->arena, inertia, second)));
    }
done:
    return status;
}

Status actual_build(System *system, Diag *diag)
{
    Loads loads;
    Status status = OK;

    CHECK(wait_for_motion(system, diag));
    if (system->actual_a == NULL) {
        size_t chains = (size_t)system->chains.count;

        system->actual_alpha = pool_alloc(system->pool, chains * sizeof(Vec));
        system->actual_a =
            pool_alloc(system->pool, (size_t)graph_node_count(system->graph) * sizeof(Vec));
        accelerations_build(system, system->accelerations, system->actual_alpha, system->actual_a);
    }
    if (system->actual != NULL)
        return OK;
    loads = loads_new(system);
    loads_add_inertia(system, &loads, system->actual_alpha, system->actual_a);
    CHECK(efforts_add(system, &loads, true, diag));
    CHECK(add_rotors(system, &loads, diag));
    for (int k = 0; k < system->rows.count; k++)
        add_row(system, &loads, &system->rows.at[k], system->multipliers[k]);
    for (int i = 0; i < system->drives.count; i++) {
        const Instance *driver = &system->instances[system->drives.at[i].instance];

        if (driver->by >= 0 && driver->by_coordinate >= 0)
            loads_add_effort(system, &loads, &system->instances[driver->by], driver->by_coordinate,
                             system->drives.at[i].effort);
    }
    system->actual = loads_sum(system, &loads);
done:
    return status;
}

/* the sum over a chord's rows: force or moment on the head, ground axes */
static Vec chord_reaction(System *system, const Instance *joint, bool rotation)
{
    Arena *arena = system->arena;
    Vec sum = vec_zero(arena);

    for (int k = 0; k < system->rows.count; k++) {
        const Row *row = &system->rows.at[k];
        int tail = system->frames[row->tail].chain;
        Vec along = row->n;

        if (row->told.instance != joint->number ||
            (row->told.rotation != rotation && row->kind != ROW_TIE))
            continue;
        if (row->kind == ROW_TIE && rotation)
            along = vec_scale(arena, expr_neg(arena, row->lead), along);
        if (row->kind == ROW_DOT)
            along = vec_cross(
                arena, vec_express(system, row->b, system->frames[row->head].chain, tail), along);
        along = vec_express(system, along, row->kind == ROW_DATUM ? 0 : tail, 0);
        along = vec_scale(arena, expr_neg(arena, system->multipliers[k]), along);
        sum = vec_add(arena, sum, along);
    }
    return sum;
}

/* a chord some of whose equations vanished, with the branch in its circuit: what it carries may be
 * shifted between the two, so neither is determined; NULL: there is none */
static const Instance *undetermined_with(const System *system, const Tree *tree, int branch,
                                         bool rotation)
{
    for (int i = 0; i < system->instance_count; i++) {
        const Instance *chord = &system->instances[i];

        if (!system->lost_force[i] && !(rotation && system->lost_moment[i]))
            continue;
        if (tree_is_beyond(tree, branch, chord->head) != tree_is_beyond(tree, branch, chord->tail))
            return chord;
    }
    return NULL;
}

static Status reaction(System *system, const Instance *joint, bool rotation, Vec *out, int *chain,
                       Diag *diag)
{
    const Tree *tree = system->trees[rotation ? TREE_ROTATION : TREE_TRANSLATION];
    const Instance *chord;
    int node;
    Status status = OK;

    CHECK(actual_build(system, diag));
    *chain = 0;
    if (joint->is_virtual) {
        *out = vec_zero(system->arena);
        return OK;
    }
    if (!tree_has(tree, joint->edge)) {
        if ((rotation ? system->lost_moment : system->lost_force)[joint->number]) {
            (void)diag_set(diag, E_MISSING, "the %s of %s isn't determined by these trees",
                           rotation ? "moment" : "force", joint->name);
            diag_hint(diag, "an equation of %s holds in every position: make %s a branch",
                      joint->name, joint->name);
            return E_MISSING;
        }
        *out = chord_reaction(system, joint, rotation);
        return OK;
    }
    chord = undetermined_with(system, tree, joint->edge, rotation);
    if (chord != NULL) {
        (void)diag_set(diag, E_MISSING, "the %s of %s isn't determined by these trees",
                       rotation ? "moment" : "force", joint->name);
        diag_hint(diag,
                  "an equation of %s on its circuit holds in every position: make %s a branch",
                  chord->name, chord->name);
        return E_MISSING;
    }
    /* everything beyond the branch and the joint itself are in equilibrium */
    node = tree_far_node(tree, joint->edge);
    *chain = system->chains.at[system->frames[node].chain].resolve;
    *out = (rotation ? system->actual->torque : system->actual->force)[node];
    if (tree_is_forward(tree, node))
        *out = vec_neg(system->arena, *out);
done:
    return status;
}

Status joint_force(System *system, const Instance *joint, Vec *force, int *chain, Diag *diag)
{
    return reaction(system, joint, false, force, chain, diag);
}

Status joint_moment(System *system, const Instance *joint, Vec *moment, int *chain, Diag *diag)
{
    return reaction(system, joint, true, moment, chain, diag);
}

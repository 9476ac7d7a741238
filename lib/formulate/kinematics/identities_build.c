/* identities_build.c: identities of orientation classes and frames */
#include "formulate/kinematics/identity.h"
#include "formulate/kinematics/isomorphic.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

/* distinguishes a plane from space, where each orientation class has axes of its own */
static Expr datum_identity(const System *system)
{
    return expr_tuple(system->arena, (Expr[]){expr_int(system->arena, system->origin->planar)}, 1);
}

static Expr orientation_identity(const System *system, int c)
{
    const Kinematics *kinematics = system->kinematics;
    const OrientationClass *chain = &kinematics->chains.at[c];
    Key key = key_of(kinematics->chains.at[chain->parent].identity);
    int first;

    key_add_turn(&key, chain);
    for (int j = chain->speed; j < chain->speed + chain->speed_count; j++) {
        const Speed *speed = &kinematics->speeds[j];
        const Expr is_own = expr_int(system->arena, speed->axis_chain == c);

        key_add(&key, &kinematics->u.at[j].symbol, sizeof(Expr));
        key_add(&key, &speed->axis, sizeof speed->axis);
        key_add(&key, &is_own, sizeof is_own);
    }
    if (isomorphic_chain(system, c, &first) != NULL)
        key_add(&key, &kinematics->chains.at[first].identity, sizeof(Expr));
    return key_end(system, &key);
}

static Expr frame_identity(const System *system, int node)
{
    const Kinematics *kinematics = system->kinematics;
    const Frame *frame = &kinematics->frames[node];
    Key key = key_of(kinematics->frames[frame->parent].identity);
    int first;

    key_add(&key, &kinematics->chains.at[frame->chain].identity, sizeof(Expr));
    key_add(&key, &kinematics->chains.at[frame->step_chain].identity, sizeof(Expr));
    key_add(&key, &frame->shift, sizeof frame->shift);
    for (int k = 0; k < frame->slide_count; k++) {
        key_add(&key, &kinematics->u.at[frame->slide[k].speed].symbol, sizeof(Expr));
        key_add(&key, &frame->slide[k].axis, sizeof frame->slide[k].axis);
    }
    if (isomorphic_node(system, node, &first) != NULL)
        key_add(&key, &kinematics->frames[first].identity, sizeof(Expr));
    return key_end(system, &key);
}

void identities_build(System *system)
{
    Kinematics *kinematics = system->kinematics;
    int nodes;
    const int *order;

    if (system->origin->trees[TREE_TRANSLATION] == NULL || kinematics->dependents.count > 0)
        return;
    kinematics->chains.at[0].identity = datum_identity(system);
    for (int c = 1; c < kinematics->chains.count; c++)
        kinematics->chains.at[c].identity = orientation_identity(system, c);
    order = tree_nodes(system->origin->trees[TREE_TRANSLATION], &nodes);
    kinematics->frames[order[0]].identity = kinematics->chains.at[0].identity;
    for (int i = 1; i < nodes; i++)
        kinematics->frames[order[i]].identity = frame_identity(system, order[i]);
}

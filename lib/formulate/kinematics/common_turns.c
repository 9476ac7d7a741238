/* common_turns.c: frames whose orientation differs by one turn, whatever turns lie between
 *
 * Turns about parallel axes add. Where those between two orientation classes merge into one and the
 * frames at their ends agree when every angle is 0, the sum is a coordinate that a virtual joint
 * between the frames can have. */
#include "formulate/kinematics/frames.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* the orientation classes between merge to one turn, and there are at least two of them */
static bool merges(const System *system, int from, int to, Vec *axis)
{
    const OrientationClass *chains = system->kinematics->chains.at;
    Turns turns = {0};
    bool one;

    turns_between(system, from, to, &turns);
    one = turns.count == 1 && turns.at[0].matrix == NULL &&
          chains[to].depth - chains[from].depth >= 2;
    if (one)
        *axis = turns.at[0].axis;
    LIST_FREE(turns);
    return one;
}

/* the furthest orientation class inward from which the path to `to` is one turn; -1: none */
static int furthest(const System *system, int to, Vec *axis)
{
    int found = -1;

    for (int from = to; from >= 0; from = system->kinematics->chains.at[from].parent)
        if (merges(system, from, to, axis))
            found = from;
    return found;
}

static bool turns_alike(const System *system, int a, int b)
{
    Rotation back = rotation_transpose(&system->kinematics->frames[a].zero);
    Rotation between = rotation_product(system->arena, &back, &system->kinematics->frames[b].zero);

    return rotation_is_one(&between);
}

/* an edge joins frames of the two orientation classes; it can be a branch that determines their
 * orientation */
static bool are_joined(const System *system, int from, int to)
{
    for (int e = 0; e < graph_edge_count(system->origin->graph); e++) {
        const Edge *edge = graph_edge(system->origin->graph, e);
        int tail, head;

        if (!graph_edge_in(system->origin->graph, e, TREE_ROTATION) ||
            graph_branching(system->origin->graph, e, TREE_ROTATION) == BRANCH_NEVER)
            continue;
        tail = system->kinematics->frames[edge->tail].chain;
        head = system->kinematics->frames[edge->head].chain;
        /* a body's own edge in space adds three angles, where one is enough */
        if ((tail == from && head == to) || (tail == to && head == from))
            if (system->origin->planar ||
                system->origin->instances[edge->component].row->family != FAMILY_BODY)
                return true;
    }
    return false;
}

/* the first frames of the two orientation classes that agree at zero; false: there are none */
static bool find_frames(const System *system, int from, int to, CommonTurn *out)
{
    int count;
    const int *nodes = tree_nodes(system->origin->trees[TREE_ROTATION], &count);

    out->tail = out->head = graph_node_count(system->origin->graph);
    for (int h = 0; h < count; h++)
        for (int t = 0; t < count && system->kinematics->frames[nodes[h]].chain == to; t++) {
            bool earlier = nodes[h] < out->head || (nodes[h] == out->head && nodes[t] < out->tail);

            if (system->kinematics->frames[nodes[t]].chain != from || !earlier ||
                !turns_alike(system, nodes[t], nodes[h]))
                continue;
            out->head = nodes[h];
            out->tail = nodes[t];
        }
    return out->tail < graph_node_count(system->origin->graph);
}

CommonTurn *system_common_turns(const System *system, int *count)
{
    LIST(CommonTurn) found = {0};

    for (int to = 1;
         to < system->kinematics->chains.count && system->origin->trees[TREE_ROTATION] != NULL;
         to++) {
        CommonTurn turn;
        Vec axis;
        int from = furthest(system, to, &axis);
        Rotation back;

        if (from < 0 || are_joined(system, from, to) || !find_frames(system, from, to, &turn))
            continue;
        (void)merges(system, from, to, &axis);
        back = rotation_transpose(&system->kinematics->frames[turn.tail].zero);
        axis = rotation_apply(system->arena, &back, axis);
        for (int i = 0; i < 3; i++)
            turn.axis[i] = axis.at[i];
        LIST_PUSH(found, turn);
    }
    *count = found.count;
    return found.at;
}

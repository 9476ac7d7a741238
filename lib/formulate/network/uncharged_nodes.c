/* uncharged_nodes.c: nodes of a network at which the current of a coil meets only nonlinear laws
 *
 * The current of a coil can't jump. Where a capacitor, a source of voltage or a resistor takes up
 * the change of this current, the node's voltage follows in finite time. Where only diodes,
 * transistors and other nonlinear laws take it up, the voltage v is the root of
 *
 *     sum of i_k(v) = sum of coil currents
 *
 * The smaller the slopes di_k/dv, the faster v changes. The edges at such a node are a cutset of
 * coils and nonlinear laws alone. Edges of the first kind join nodes into sets; the cutset is the
 * set of edges that lead out of such a set. */
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include "graph/sets.h"

static bool reads_variables(Expr e)
{
    return e != NULL && (expr_kinds(e) & 1U << SYMBOL_VARIABLE) != 0;
}

/* i follows from voltages by a law, whose slope may vanish */
static bool is_law(const Branchlike *branch)
{
    const RelationKind kind = branch->relation.kind;

    if (branch->relation.switches)
        return false;
    return kind == RELATION_CONDUCTIVE ||
           ((kind == RELATION_THROUGH || kind == RELATION_RESISTIVE) &&
            reads_variables(branch->relation.value));
}

/* whether a branch is of the first kind: a capacitor, a source of voltage, a resistor, or an ideal
 * switch */
static bool joins(const Branchlike *branch)
{
    return !is_law(branch) && branch->relation.kind != RELATION_INDUCTIVE &&
           (branch->relation.kind != RELATION_THROUGH || branch->ideal >= 0);
}

static Sets *join_nodes(const System *system)
{
    const Graph *graph = system->origin->graph;
    const Network *network = system->network;
    Sets *sets = sets_new(graph_node_count(graph));

    for (int b = 0; b < network->branches.count; b++) {
        const Edge *edge = graph_edge(graph, network->branches.at[b].edge);

        if (joins(&network->branches.at[b]))
            (void)sets_join(sets, edge->tail, edge->head);
    }
    return sets;
}

static bool has_datum(const Graph *graph, Sets *sets, int node)
{
    for (int i = 0; i < graph_node_count(graph); i++)
        if (graph_node(graph, i)->datum && sets_find(sets, i) == sets_find(sets, node))
            return true;
    return false;
}

/* edges that lead out of the set of a node, besides one coil */
typedef struct Leaving {
    int laws, coils, others;
    int coil, towards; /* the last coil: its edge and the node at its far end */
} Leaving;

static Leaving find_leaving(const System *system, Sets *sets, int node, int coil)
{
    const int set = sets_find(sets, node);
    Leaving out = {.coil = -1};

    for (int b = 0; b < system->network->branches.count; b++) {
        const Branchlike *branch = &system->network->branches.at[b];
        const Edge *edge = graph_edge(system->origin->graph, branch->edge);
        const bool from = sets_find(sets, edge->tail) == set;

        if (branch->edge == coil || from == (sets_find(sets, edge->head) == set))
            continue;
        if (is_law(branch))
            out.laws++;
        else if (branch->relation.kind != RELATION_INDUCTIVE)
            out.others++;
        else {
            out.coils++;
            out.coil = branch->edge;
            out.towards = from ? edge->head : edge->tail;
        }
    }
    return out;
}

/* The first such node, from an end of a coil on through coils in series; -1: there is none. */
static int find_uncharged(const System *system, Sets *sets, int node, int coil)
{
    for (int turn = 0; turn < system->network->branches.count; turn++) {
        const Leaving leaving = find_leaving(system, sets, node, coil);

        if (has_datum(system->origin->graph, sets, node))
            return -1;
        if (leaving.laws > 0)
            return node;
        if (leaving.coils != 1 || leaving.others > 0)
            return -1;
        node = leaving.towards;
        coil = leaving.coil;
    }
    return -1;
}

const Node *system_uncharged_node(const System *system, int state)
{
    const int number = system->network->x.at[state].edge;
    const Edge *coil;
    Sets *sets;
    int node;

    if (number < 0 || system->network->scalar_of_edge[number] < 0 ||
        system->network->branches.at[system->network->scalar_of_edge[number]].relation.kind !=
            RELATION_INDUCTIVE)
        return NULL;
    coil = graph_edge(system->origin->graph, number);
    sets = join_nodes(system);
    node = find_uncharged(system, sets, coil->tail, number);
    if (node < 0)
        node = find_uncharged(system, sets, coil->head, number);
    sets_free(sets);
    return node < 0 ? NULL : graph_node(system->origin->graph, node);
}

/* network_steps.c: the derivation of an equation of a scalar domain: laws, circuits, cutsets
 *
 * Lists the steps that network.c computes: a chord's across variable follows from its circuit, a
 * branch's through variable from its cutset, the others from the law of their edge, up to
 * unknowns. */
#include "formulate/network/network_steps.h"
#include "formulate/network/scalar_edges.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <string.h>

/* sets the two sides of the step of an edge's variable, v with `across` and else i, to the edge's
 * constitutive equation, which determines it */
static void report_law(const System *system, const Branchlike *branch, bool across,
                       NetworkStep *step)
{
    Arena *arena = system->arena;
    const Relation *relation = &branch->relation;
    const Instance *owner = branch_owner(system, branch);
    const Expr v = instance_across(owner, arena, branch->which);
    const Expr i = instance_through(owner, arena, branch->which);

    step->left = across ? v : i;
    switch (relation->kind) {
    case RELATION_ACROSS:
        step->left = v;
        step->right = relation->value;
        break;
    case RELATION_THROUGH:
    case RELATION_CONDUCTIVE:
        step->left = i;
        step->right = relation->value;
        break;
    case RELATION_RESISTIVE:
        if (across)
            step->right = expr_add(arena, expr_mul(arena, relation->value, i), relation->rest);
        else if (relation->inverse != NULL)
            step->right = relation->inverse;
        else
            step->right = expr_div(arena, expr_sub(arena, v, relation->rest), relation->value);
        break;
    case RELATION_CAPACITIVE:
    case RELATION_INDUCTIVE:
        step->left = relation->kind == RELATION_CAPACITIVE ? i : v;
        step->right = expr_add(arena, system_user_rate(arena, relation->content), relation->rest);
        break;
    case RELATION_PORT:
        step->left = branch->branch ? v : i;
        step->right = branch->branch ? relation->value : relation->inverse;
        break;
    case RELATION_FREE:
    case RELATION_IMPLICIT:
        step->left = relation->value;
        step->right = expr_int(arena, 0);
        break;
    case RELATION_IDEAL: /* two laws, one for each side */
        step->left = NULL;
        break;
    }
}

/* adds a step for that edge's variable, if it has none yet; the first step is the equation, and
 * stands for no variable */
static void ask_for(NetworkSteps *steps, int edge, bool across)
{
    for (int i = 1; i < steps->steps.count; i++)
        if (steps->steps.at[i].edge == edge && steps->steps.at[i].is_across == across)
            return;
    LIST_PUSH(steps->steps, (NetworkStep){.edge = edge, .is_across = across});
}

/* a member or one of its rates: "v", "v'" */
static bool is_member(const char *word, const char *member)
{
    const size_t length = strlen(member);

    return strncmp(word, member, length) == 0 && (word[length] == '\0' || word[length] == '\'');
}

/* the scalar edge of that name, which may be a transducer's other edge's name too; -1 */
static int scalar_edge(const System *system, const char *name)
{
    for (int i = 0; i < system->network->branches.count; i++) {
        const int edge = system->network->branches.at[i].edge;

        if (strcmp(graph_edge(system->origin->graph, edge)->name, name) == 0)
            return edge;
    }
    return -1;
}

/* the edges' variables in a law: R1.v, T1.s.i, C2.v' */
static void ask_for_variables(const System *system, Expr law, NetworkSteps *steps)
{
    Expr *symbols;
    const int count = expr_symbols(&law, 1, &symbols);

    for (int i = 0; i < count; i++) {
        const char *dot = strrchr(expr_name(symbols[i]), '.');
        char *name;
        int edge;

        if (expr_symbol_kind(symbols[i]) != SYMBOL_VARIABLE || dot == NULL)
            continue;
        name = mem_text(expr_name(symbols[i]), (size_t)(dot - expr_name(symbols[i])));
        edge = scalar_edge(system, name);
        mem_free(name);
        if (edge < 0)
            continue;

        const Domain domain = graph_edge(system->origin->graph, edge)->domain;
        const char *across = domain_across(domain), *through = domain_through(domain);

        if (is_member(dot + 1, across))
            ask_for(steps, edge, true);
        else if (is_member(dot + 1, through))
            ask_for(steps, edge, false);
    }
    mem_free(symbols);
}

/* adds minus the rest of the circuit of a chord, or of the cutset of a branch */
static void sum_up(const System *system, const Branchlike *branch, int at, NetworkSteps *steps)
{
    const SignMatrix *cutsets = system->network->cutsets[branch_tree(system, branch)];
    const Tree *tree = system->origin->trees[branch_tree(system, branch)];
    const Edge *edge = graph_edge(system->origin->graph, branch->edge);
    const int first = steps->signed_edges.count;

    if (branch->branch) {
        for (int k = cutsets->start[branch->cutset]; k < cutsets->start[branch->cutset + 1]; k++)
            if (cutsets->column[k] != branch->edge)
                LIST_PUSH(steps->signed_edges,
                          (SignedEdge){cutsets->column[k], -cutsets->entry[k]});
    } else {
        const int room = tree_depth(tree, edge->tail) + tree_depth(tree, edge->head);
        int *edges = NEW_ARRAY(int, 2 * room + 1);
        const int count = tree_path(tree, edge->tail, edge->head, edges, edges + room);

        for (int k = 0; k < count; k++)
            LIST_PUSH(steps->signed_edges, (SignedEdge){edges[k], edges[room + k]});
        mem_free(edges);
    }
    steps->steps.at[at].is_summed = true;
    steps->steps.at[at].first = first;
    steps->steps.at[at].count = steps->signed_edges.count - first;
    for (int k = first; k < steps->signed_edges.count; k++)
        ask_for(steps, steps->signed_edges.at[k].edge, !branch->branch);
}

/* fills in the step of an edge's variable */
static void follow(const System *system, int at, NetworkSteps *steps)
{
    NetworkStep *step = &steps->steps.at[at];
    const Branchlike *branch =
        &system->network->branches.at[system->network->scalar_of_edge[step->edge]];
    const bool is_own = step->is_across == (branch->branch || branch->is_stiff);

    if (branch->unknown >= 0 && is_own) {
        step->is_unknown = true;
    } else if (step->is_across == branch->branch) {
        report_law(system, branch, step->is_across, step);
        if (step->right != NULL)
            ask_for_variables(system, step->right, steps);
    } else {
        sum_up(system, branch, at, steps);
    }
}

/* the unknown whose equation has that number among the printed ones */
static int equation_unknown(const System *system, int equation)
{
    const Network *network = system->network;
    const int edge = network->equations.at[equation].edge;
    int before = 0;

    for (int i = 0; i < equation; i++)
        before += network->equations.at[i].edge == edge;
    for (int k = 0; k < network->unknowns.count; k++) {
        const Unknown *y = &network->unknowns.at[k];
        const int own = y->branchlike >= 0 ? network->branches.at[y->branchlike].edge
                                           : system->origin->instances[y->instance].scalar_edges[0];

        if (own == edge && before-- == 0)
            return k;
    }
    return -1;
}

void system_network_steps(System *view, int equation, NetworkSteps *out)
{
    const int unknown = equation_unknown(view, equation);
    const Unknown *y = unknown >= 0 ? &view->network->unknowns.at[unknown] : NULL;
    const Branchlike *branch =
        y != NULL && y->branchlike >= 0 ? &view->network->branches.at[y->branchlike] : NULL;
    NetworkStep first = {.edge = view->network->equations.at[equation].edge, .is_first = true};

    system_touch(view);
    if (branch != NULL) {
        first.is_across = !branch->branch;
        report_law(view, branch, first.is_across, &first);
    } else if (y != NULL && y->own >= 0) {
        const Instance *instance = &view->origin->instances[y->instance];
        OwnState own;

        instance->row->own_state(instance, view->arena, y->own, &own);
        first.left = y->symbol;
        first.right = own.rate;
        first.is_rate = true;
    }
    if (branch != NULL && branch->is_stiff) { /* its equation is the circuit, not its law */
        first.left = first.right = NULL;
        LIST_PUSH(out->steps, first);
        sum_up(view, branch, 0, out);
    } else {
        LIST_PUSH(out->steps, first);
    }
    if (branch != NULL && first.left == NULL && !branch->is_stiff) {
        ask_for(out, branch->edge, true); /* a switch: each of its two laws needs both variables */
        ask_for(out, branch->edge, false);
    }
    if (first.left != NULL)
        ask_for_variables(view, first.left, out);
    if (first.right != NULL)
        ask_for_variables(view, first.right, out);
    for (int i = 1; i < out->steps.count; i++)
        follow(view, i, out);
}

void network_steps_free(NetworkSteps *steps)
{
    LIST_FREE(steps->steps);
    LIST_FREE(steps->signed_edges);
}

/* initial_trees.c: the trees along which assembly places frames
 *
 * Assembly chooses them by what is known: first edges whose coordinates are given, then those that
 * are guessed, then joints before bodies. The user's trees have no effect. */
#include "simulate/assemble/initial_place_impl.h"

#include <stdlib.h>

/* A virtual joint is no constraint. It places frames if all of its coordinates are known, and
 * either the user's trees contain it or it leaves every freedom. */
static bool may_place(const Placing *p, int link, TreeKind kind)
{
    const Link *l = &p->s->links[link];
    const bool is_lifted =
        kind == TREE_TRANSLATION ? l->shift_count == 3 : l->has_parameters || l->turn_count == 3;

    return !l->instance->is_virtual ||
           ((is_lifted || tree_has(system_tree(p->s->system, kind), l->edge)) &&
            place_ignorance(p, link, kind) < OPEN);
}

typedef struct Candidate { /* for a branch */
    int edge;
    int ignorance, preference;
} Candidate;

/* best known first, then in the order of completion, then of definition */
static int by_preference(const void *left, const void *right)
{
    const Candidate *a = left, *b = right;

    if (a->ignorance != b->ignorance)
        return a->ignorance < b->ignorance ? -1 : 1;
    if (a->preference != b->preference)
        return a->preference < b->preference ? -1 : 1;
    return (a->edge > b->edge) - (a->edge < b->edge);
}

static int root_of(int *above, int node)
{
    while (above[node] != node)
        node = above[node] = above[above[node]];
    return node;
}

/* Kruskal (1956), with virtual joints included, which completion orders last */
static Status choose_tree(Placing *p, TreeKind kind, Diag *diag)
{
    const Graph *graph = system_graph(p->s->system);
    Candidate *candidates = NEW_ARRAY(Candidate, p->s->link_count);
    int *above = NEW_ARRAY(int, p->s->node_count);
    int *branches = NEW_ARRAY(int, p->s->link_count);
    TreeChoice choice = {.branches = branches};
    int count = 0;
    Status status;

    for (int i = 0; i < p->s->link_count; i++) {
        const int edge = p->s->links[i].edge;

        if (graph_branching(graph, edge, kind) != BRANCH_NEVER && may_place(p, i, kind))
            candidates[count++] =
                (Candidate){edge, place_ignorance(p, i, kind),
                            graph_edge(graph, edge)->preference[kind == TREE_ROTATION]};
    }
    qsort(candidates, (size_t)count, sizeof *candidates, by_preference);
    for (int node = 0; node < p->s->node_count; node++)
        above[node] = node;
    for (int i = 0; i < count; i++) {
        const Edge *edge = graph_edge(graph, candidates[i].edge);
        const int tail = root_of(above, edge->tail), head = root_of(above, edge->head);

        if (tail != head)
            branches[choice.branch_count++] = candidates[i].edge;
        above[tail] = head;
    }
    status = tree_complete(graph, kind, &choice, true, &p->trees[kind], diag);
    MEM_FREE(candidates, above, branches);
    return status;
}

Status place_choose_trees(Placing *p, Diag *diag)
{
    TRY(choose_tree(p, TREE_ROTATION, diag));
    return choose_tree(p, TREE_TRANSLATION, diag);
}

bool place_turns(const Placing *p, int link)
{
    return tree_has(p->trees[TREE_ROTATION], p->s->links[link].edge);
}

bool place_shifts(const Placing *p, int link)
{
    return tree_has(p->trees[TREE_TRANSLATION], p->s->links[link].edge);
}

bool place_has(const Placing *p, int link, int k)
{
    return p->s->links[link].instance->coord_rotation[k] ? place_turns(p, link)
                                                         : place_shifts(p, link);
}

void place_poses(Placing *p, const double *c)
{
    kinematic_tree_poses(p->s, p->trees[TREE_ROTATION], p->trees[TREE_TRANSLATION], c, p->poses);
}

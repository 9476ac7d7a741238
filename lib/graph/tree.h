/* tree.h: spanning trees of a linear graph, and the matrices that follow from one
 *
 * A Tree spans those nodes of one domain that are connected to its datum. It is complete when
 * tree_complete() returns, const ever after, and freed by its one owner; it borrows its graph. */
#ifndef COTREE_GRAPH_TREE_H
#define COTREE_GRAPH_TREE_H

#include "base/memory.h"
#include "graph/graph.h"

typedef struct Tree Tree;

/* The user's choice for one tree. */
typedef struct TreeChoice {
    const int *branches; /* edges that must be branches */
    int branch_count;
    /* one for each edge of the graph: not used for completion; NULL: none. An edge that is both
     * chosen and excluded is a branch. */
    const bool *excluded;
    const int *preference; /* one for each edge, replaces Edge.preference; NULL: Edge.preference */
} TreeChoice;

/* Completes a tree: arms first, then the chosen branches, then the edges of lowest preference that
 * close no circuit.
 *
 * graph    borrowed, unchanged; outlives the tree choice   borrowed; NULL chooses nothing exact
 * the choice (with the arms) is to be the whole tree: nothing is completed out      a new tree; the
 * caller frees it with tree_free()
 *
 * Fails with E_CIRCUIT, naming the edges of the circuit in its order (two messages of theory 7:
 * chosen branches, or arms alone), with E_UNREACHED, naming the nodes that no branch reaches and
 * edges that would, and with E_BRANCH for an edge that may not be a branch or an arm that is
 * excluded. Each has a hint. Long lists of names are truncated. Nodes that no edge of the domain
 * connects to the datum also give E_UNREACHED. O(E log E). Kruskal (1956), with the chosen branches
 * contracted. */
MUST_USE Status tree_complete(const Graph *graph, TreeKind kind, const TreeChoice *choice,
                              bool exact, Tree **out, Diag *diag);
/* New: the same tree in a copy of its graph (graph_copy()), with all its branches chosen. */
Tree *tree_copy(const Tree *from, const Graph *graph);
void tree_free(Tree *tree); /* NULL is fine */

TreeKind tree_kind(const Tree *tree);
const Graph *tree_graph(const Tree *tree);
bool tree_has(const Tree *tree, int edge);
bool tree_has_branches_of(const Tree *tree, const Tree *other); /* of the same graph */
/* a branch that is neither chosen nor an arm */
bool tree_was_completed(const Tree *tree, int edge);
int tree_branch_count(const Tree *tree);
/* depth first from the datum: parents before children, siblings in order of making */
const int *tree_branches(const Tree *tree);
int tree_chord_count(const Tree *tree);
/* edges of the domain that aren't branches, in order of making */
const int *tree_chords(const Tree *tree);
/* the datum, then the far nodes of tree_branches() in their order */
const int *tree_nodes(const Tree *tree, int *count);
int tree_parent(const Tree *tree, int node);      /* -1 for the datum */
int tree_parent_edge(const Tree *tree, int node); /* -1 for the datum */
/* the parent edge leads from the parent to the node */
bool tree_is_forward(const Tree *tree, int node);
int tree_depth(const Tree *tree, int node); /* branches up to the datum */
/* whether `node` is beyond `branch`, seen from the datum. O(1). */
bool tree_is_beyond(const Tree *tree, int branch, int node);
/* all nodes beyond `branch`, *count of them; borrowed */
const int *tree_nodes_beyond(const Tree *tree, int branch, int *count);
/* the node at the far end of a branch; -1 for a chord */
int tree_far_node(const Tree *tree, int branch);

/* The path from one node to another: edges with +1 where the path goes from tail to head, otherwise
 * -1. `edges` and `signs` have room for tree_depth(a) + tree_depth(b); returns their number.
 * O(depth). */
int tree_path(const Tree *tree, int from, int to, int *edges, int *signs);

/* --- matrices, sparse by rows: row r has column[start[r]] .. column[start[r + 1] - 1], ascending,
 * with entries +1 or -1. Columns are all edges of the graph, by number. --- */

typedef struct SignMatrix {
    int rows;
    int columns;
    int *start; /* rows + 1 */
    int *column;
    signed char *entry;
} SignMatrix;

void sign_matrix_free(SignMatrix *matrix); /* NULL is fine */
/* A: one row for each node of the domain (without the datum when reduced), +1 at the tail, -1 at
 * the head */
SignMatrix *graph_incidence(const Graph *graph, Domain domain, bool reduced);
/* B = [-D^T 1]: one row for each chord, in order of tree_chords(): its fundamental circuit, +1 at
 * the chord. The number of entries is the sum of the lengths of the circuits. */
SignMatrix *tree_circuits(const Tree *tree);
/* Q = [1 D]: one row for each branch, in order of tree_branches(): its fundamental cutset, +1 at
 * the branch */
SignMatrix *tree_cutsets(const Tree *tree);

#endif

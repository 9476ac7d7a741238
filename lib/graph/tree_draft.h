/* tree_draft.h: a tree under construction, and the messages when it fails
 *
 * Borrows everything but `standing`, which it owns. */
#ifndef COTREE_GRAPH_TREE_DRAFT_H
#define COTREE_GRAPH_TREE_DRAFT_H

#include "graph/sets.h"
#include "graph/tree.h"

typedef enum Standing {
    STANDING_CHORD,
    STANDING_ARM,
    STANDING_CHOSEN,
    STANDING_COMPLETED
} Standing;

typedef struct Draft {
    const Graph *graph;
    TreeKind kind;
    const TreeChoice *choice; /* never NULL */
    int datum;                /* -1: the domain has none */
    unsigned char *standing;  /* a Standing for each edge of the graph */
    Sets *sets;               /* sets of nodes that branches connect */
    int joined;               /* number of branches so far */
} Draft;

int draft_preference(const Draft *draft, int edge);

/* Edges that aren't branches and could be, by preference; new array, mem_free(). `open`: also those
 * that the choice excludes, and finally those that only the user may choose. O(E log E). */
int draft_candidates(const Draft *draft, bool open, int **edges);

/* Completes the tree, see tree_complete(). The caller always calls draft_free(). */
MUST_USE Status draft_make(Draft *draft, bool exact, Diag *diag);
void draft_free(Draft *draft);

/* --- messages; each returns its status --- */

/* `edge` was named as a branch and may not be a branch */
MUST_USE Status draft_fault_branch(const Draft *draft, int edge, Diag *diag);
/* an arm is excluded */
MUST_USE Status draft_fault_arm(const Draft *draft, int edge, Diag *diag);
/* `closing` is no branch yet and closes a circuit of branches */
MUST_USE Status draft_fault_circuit(const Draft *draft, int closing, Diag *diag);
/* branches do not connect some nodes of the domain to the datum */
MUST_USE Status draft_fault_unreached(const Draft *draft, Diag *diag);

#endif

/* tree_search.h: the mechanical trees of cheapest equations
 *
 * A candidate is a pair of mechanical trees, priced by formulating it (system_price). From each
 * start the search goes to the cheapest neighbour as long as one is cheaper; neighbours exchange
 * one branch for one chord of whose circuit it is part, in one tree or both. Local, so that there
 * may be cheaper ones. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_TREE_SEARCH_H
#define COTREE_FORMULATE_SYSTEM_BUILD_TREE_SEARCH_H

#include "formulate/system/system.h"

enum { TREE_SEARCH_MOST = 200 }; /* systems formed */

typedef struct TreePair {
    bool *branch[2];    /* of translation and rotation, one an edge */
    char *key;          /* names of the branches: one a pair */
    const char *called; /* by whoever named it as a start; NULL */
    bool is_priced;     /* else it is refused, or not formed */
    int n, m;
    int coordinates; /* of its branches */
    int proposed;    /* branches from `own` on */
    int bodies;      /* branches that are bodies */
    OpCount count;
    double price;
} TreePair;

typedef struct TreeSearch {
    Scene scene;              /* borrowed; its scalar trees are those of every candidate */
    int own;                  /* edges from this number on are only proposed */
    const CallMonitor *watch; /* ends the search, too; is told how far it is */
    LIST(TreePair *) seen;
    int formed;
    int *owner; /* instance of an edge */
} TreeSearch;

/* Start with an empty `seen`; tree_search_close() afterwards. */
TreeSearch tree_search_open(const Scene *scene, int own, const CallMonitor *watch);
void tree_search_close(TreeSearch *search);
/* One of the starts, priced; passed over where another one is the same. */
void tree_search_start(TreeSearch *search, const Tree *const halves[2], const char *called);
/* From the starts on; `seen` is then sorted, cheapest first. At most TREE_SEARCH_MOST systems are
 * formed, each forgotten by the arena after it was priced. */
void tree_search_run(TreeSearch *search);
/* The trees of a pair among the scene's edges: new, tree_free(); false: they are none. */
bool tree_search_trees(const TreeSearch *search, const TreePair *pair, Tree *out[2]);

#endif

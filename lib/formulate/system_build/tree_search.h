/* tree_search.h: the mechanical trees of cheapest equations
 *
 * A candidate is a pair of mechanical trees, whose cost is found by forming its equations
 * (system_price). From each start the search moves to the cheapest neighbour as long as one is
 * cheaper. A neighbour replaces one branch by one chord whose circuit contains it, in one tree or
 * both. The result is a local minimum. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_TREE_SEARCH_H
#define COTREE_FORMULATE_SYSTEM_BUILD_TREE_SEARCH_H

#include "formulate/system/system.h"

enum { TREE_SEARCH_MOST = 200 }; /* systems formed */

typedef struct TreePair {
    bool *branch[2];    /* of translation and rotation, one an edge */
    char *key;          /* names of the branches: unique for each pair */
    const char *called; /* name given to a start; NULL */
    bool is_priced;     /* otherwise it is refused, or not formed */
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
    const CallMonitor *watch; /* can stop the search, and receives its progress */
    LIST(TreePair *) seen;
    int formed;
    int *owner; /* instance of an edge */
} TreeSearch;

/* Starts with an empty `seen`; call tree_search_close() afterwards. */
TreeSearch tree_search_open(const Scene *scene, int own, const CallMonitor *watch);
void tree_search_close(TreeSearch *search);
/* Adds a start, with its cost; ignored where it equals another one. */
void tree_search_start(TreeSearch *search, const Tree *const halves[2], const char *called);
/* Searches from the starts; `seen` is then sorted, cheapest first. At most TREE_SEARCH_MOST systems
 * are formed; the arena releases each after its cost is known. */
void tree_search_run(TreeSearch *search);
/* The trees of a pair among the scene's edges: new, tree_free(); false: they are no trees. */
bool tree_search_trees(const TreeSearch *search, const TreePair *pair, Tree *out[2]);

#endif

/* count.h: operations of the equations, block by block, and of the trees tried so far */
#ifndef COTREE_PRESENT_COUNT_H
#define COTREE_PRESENT_COUNT_H

#include "model/model.h"
#include "present/view.h"

/* the names of blocks that can be counted: 0, 1, ... until NULL */
const char *count_block_name(int i);
/* additions, multiplications and functions of one block ("mass", "total"), as written or after
 * sharing; the total is that of the equations in their form. Fails with E_NAME where there is no
 * such block. */
MUST_USE Status count_block(System *system, Form form, const char *name, bool shared, OpCount *out,
                            Diag *diag);

/* A choice of trees and what its equations cost. */
typedef struct TreeCost {
    char *trees; /* "translation h8 h9 h10; rotation h8 h10 s11" */
    int n, m;
    OpCount written;
    OpCount shared;
} TreeCost;

typedef LIST(TreeCost) TreeCosts;
/* the choice that the system was made of; its trees are new */
MUST_USE Status tree_cost(const View *view, TreeCost *out, Diag *diag);
/* Add a choice, or renew its figures where it is in the list; its place. *cost is given. */
int tree_costs_add(TreeCosts *costs, TreeCost *cost);
void tree_costs_free(TreeCosts *costs);
/* branches that the user can choose, for each tree; one text where both mechanical trees agree;
 * new */
char *tree_brief(const Model *model, const Tree *const trees[TREE_KINDS]);

/* `count`, `count mass forces`, `count trees` */
MUST_USE Status count_print(const View *view, const Statement *statement, const TreeCosts *costs,
                            Text *out, Diag *diag);

#endif

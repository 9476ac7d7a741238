/* count.h: operations of the equations, block by block, and of the trees tried so far */
#ifndef COTREE_PRESENT_COUNT_H
#define COTREE_PRESENT_COUNT_H

#include "model/model.h"
#include "present/view.h"

/* the names of blocks that can be counted: 0, 1, ... until NULL */
const char *count_block_name(int i);
/* the form that can be written out: the embedded one has a bound on constraints */
Form form_written(System *system, Form form);
extern const char form_too_long[]; /* a remark where it isn't the form that was asked for */
/* additions, multiplications and functions of one block ("mass", "total"), as written or after
 * sharing; the total is that of the equations in their form. Fails with E_NAME where there is no
 * such block. */
MUST_USE Status count_block(System *system, Form form, const char *name, bool shared, OpCount *out,
                            Diag *diag);

/* A choice of trees and what its equations cost. */
typedef struct TreeCost {
    char *trees;      /* "translation h8 h9 h10; rotation h8 h10 s11" */
    char *statements; /* that choose them */
    int n, m;
    bool is_counted; /* and these are known: */
    OpCount written;
    OpCount shared;
} TreeCost;

typedef LIST(TreeCost) TreeCosts;
/* the choice that the system was made of, not counted yet; its texts are new */
MUST_USE Status tree_cost(const View *view, TreeCost *out, Diag *diag);
/* count the equations of the system, which writes them all out */
MUST_USE Status tree_cost_count(const View *view, TreeCost *cost, Diag *diag);
/* whether they are few enough for that to be done in passing */
bool tree_cost_is_slight(const System *system);
/* Add a choice of trees, or update its figures if it is in the list; returns its index. Takes
 * ownership of *cost. */
int tree_costs_add(TreeCosts *costs, TreeCost *cost);
void tree_costs_free(TreeCosts *costs);
/* branches that the user can choose, for each tree; one text where both mechanical trees agree;
 * new */
char *tree_brief(const Model *model, const Tree *const trees[TREE_KINDS]);

bool count_is_for_trees(const Statement *statement);
/* `count`, `count mass forces`, `count trees` (all of which are counted) */
MUST_USE Status count_print(const View *view, const Statement *statement, const TreeCosts *costs,
                            Text *out, Diag *diag);

#endif

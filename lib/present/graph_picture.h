/* graph_picture.h: the linear graph as a picture: a panel for each tree, branches bold */
#ifndef COTREE_PRESENT_GRAPH_PICTURE_H
#define COTREE_PRESENT_GRAPH_PICTURE_H

#include "present/picture.h"
#include "present/view.h"

enum { PICTURE_WIDEST = 1300 }; /* px: for a screen */

/* Highlighted edges: none, the fundamental circuit of a chord, or the cutset of a branch. */
typedef enum Lit { LIT_NOTHING, LIT_CIRCUIT, LIT_CUTSET } Lit;

/* `widest`, px: panels beyond it start a new row. Free with picture_close() after OK. Fails as
 * model_trees() does; E_MISSING without edges; E_NAME for an unknown edge; E_BRANCH for one that is
 * no chord (no branch) of any tree. */
MUST_USE Status graph_picture(const View *view, double widest, Lit lit, const char *edge,
                              Picture *out, Diag *diag);

#endif

/* graph_picture.h: the linear graph as a picture: a panel for each tree, branches bold */
#ifndef COTREE_PRESENT_GRAPH_PICTURE_H
#define COTREE_PRESENT_GRAPH_PICTURE_H

#include "present/picture.h"
#include "present/view.h"

enum { PICTURE_WIDEST = 1300 }; /* px: for a screen */

/* What is lit: nothing, the fundamental circuit of a chord, or the cutset of a branch. */
typedef enum Lit { LIT_NOTHING, LIT_CIRCUIT, LIT_CUTSET } Lit;

/* `widest`, px: panels beyond it begin a new row. picture_close() where it is OK. Fails as
 * model_trees() does; E_MISSING where there is no edge; E_NAME and E_BRANCH for an edge that isn't
 * there, or is no chord (no branch) of any tree. */
MUST_USE Status graph_picture(const View *view, double widest, Lit lit, const char *edge,
                              Picture *out, Diag *diag);

#endif

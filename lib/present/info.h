/* info.h: what there is to know about one name of the model */
#ifndef COTREE_PRESENT_INFO_H
#define COTREE_PRESENT_INFO_H

#include "present/view.h"

/* Ends, direction, sign convention, tree or cotree, variables, statement of a component; the value
 * of a parameter; the edges at a node. Fails with E_NAME, with a suggestion. */
MUST_USE Status info_print(const View *view, const char *name, Place place, Text *out, Diag *diag);

/* Degrees of freedom, redundant constraints, unused names, and remarks on the assembled initial
 * state (NULL: not assembled, for the reason `why`). */
void check_print(const View *view, const Result *start, const char *why, Text *out);

/* the linear graph: as text, branches indented below their parents, then chords; as dot */
MUST_USE Status draw_text(const View *view, Text *out, Diag *diag);
void draw_dot(const View *view, Text *out);

#endif

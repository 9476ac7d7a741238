/* derive.h: derivation of one row or entry: circuits, cutsets, projections, terms
 *
 * Each function fails with the errors of its equations. Rows and columns count from 0. */
#ifndef COTREE_PRESENT_DERIVE_H
#define COTREE_PRESENT_DERIVE_H

#include "present/narrative.h"
#include "present/show.h"

/* a constraint row, with the circuit that it was projected from */
MUST_USE Status derive_constraint(Narrative *story, int k, bool with_circuit, Diag *diag);
bool derive_goes_on(const View *view, int k); /* the row before has the same circuit */
/* equations of a joint that are valid in every position; `of` NULL: of all */
void derive_dropped(Narrative *story, const char *of);
MUST_USE Status derive_mass(Narrative *story, int row, int column, Diag *diag);
MUST_USE Status derive_force(Narrative *story, int row, Diag *diag);
MUST_USE Status derive_jacobian(Narrative *story, int row, int column, Diag *diag);
/* all of a row of motion */
MUST_USE Status derive_motion(Narrative *story, int row, Diag *diag);
/* an equation of a network, by its number among those printed */
void derive_network(Narrative *story, int equation);

/* --- of an edge alone: its circuits, its cutsets --- */

void derive_way(Text *out, const View *view, int chord);
void derive_turns(Text *out, const View *view, int chord);
void derive_cutset(Narrative *story, int branch, TreeKind kind);

#endif

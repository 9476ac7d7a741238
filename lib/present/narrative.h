/* narrative.h: words and steps of a derivation, in text and in LaTeX
 *
 * A step is a word followed by a line. A Story borrows its view and writes to `out`; it frees
 * collected equations after writing them. Words from the model are printed in the notation. */
#ifndef COTREE_PRESENT_NARRATIVE_H
#define COTREE_PRESENT_NARRATIVE_H

#include "formulate/expanded/derivation.h"
#include "formulate/network/network_steps.h"
#include "present/view.h"

typedef struct Reason {
    const char *why; /* borrowed */
    Text names;
} Reason;

typedef struct Narrative {
    const View *view;
    Text *out;
    LIST(Reason) reasons;   /* of what vanishes */
    EquationList equations; /* not yet written */
} Narrative;

bool narrative_is_typeset(const View *view);
void narrative_add_word(Text *out, const View *view, const char *word);
void narrative_add_formula(Text *out, const View *view, Expr e);
const char *narrative_edge(const View *view, int edge); /* names, borrowed */
const char *narrative_node(const View *view, int node);
/* `$`, which opens and closes a formula in LaTeX */
void narrative_add_mark(Text *out, const View *view);
/* a variable that edges have: its letter in text and in LaTeX */
typedef struct EdgeVariable {
    const char *text, *latex;
    bool is_vector;
} EdgeVariable;
/* "r(h9)" */
void narrative_add_variable(Text *out, const View *view, const EdgeVariable *variable, int edge);
/* "r(h9) = r(r6) - r(r7)", that of an edge by those of others in the order of narrative_order(); or
 * "r(h9) + r(r6) = 0", in the given order, where the edge is -1 */
void narrative_add_edge_sum(Text *out, const View *view, const EdgeVariable *variable, int edge,
                            const SignedEdge *terms, int count);
/* The order in which a person writes a sum: as it is, or from its end, or from the middle on, so
 * that it starts with a plus if there is one. */
typedef struct SumOrder {
    int first, step, count;
} SumOrder;
/* of signs at distances of `stride` bytes */
SumOrder narrative_order(const int *sign, int count, size_t stride);
static inline int narrative_at(const SumOrder *order, int k)
{
    return (order->first + order->step * k + order->count) % order->count;
}
/* "[L6, 0]": in a plane two components */
void narrative_add_vector(Text *out, const View *view, const Expr at[3]);
bool narrative_is_nothing(const Expr at[3]);
/* "x of ground", "[1, 2, 0] of m1" */
void narrative_add_direction(Text *out, const View *view, const NarrativeVector *v);

/* what the steps are of; frees the title */
void narrative_title(Narrative *story, Text *title);
/* a step: its word, then its text */
void narrative_add(Text *out, const View *view, const char *label, const char *words);
/* the same where there are words, which it frees */
void narrative_add_done(Text *out, const View *view, const char *label, Text *words);
/* `name` is 0 for that reason, */
void narrative_vanish(Narrative *story, const char *name, const char *why);
/* and a line for each reason so far */
void narrative_add_vanished(Narrative *story);
/* the equations that the steps led to; frees them */
void narrative_add_equations(Narrative *story);

#endif

/* narrative.h: words and steps of a derivation, in text and in LaTeX
 *
 * A step is a word followed by a line. A Story borrows its view and writes to `out`; it frees
 * collected equations after writing them. Words from the model are printed in the notation. */
#ifndef COTREE_PRESENT_NARRATIVE_H
#define COTREE_PRESENT_NARRATIVE_H

#include "formulate/expanded/derivation.h"
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
/* "r(h9)": a variable of an edge */
void narrative_add_variable(Text *out, const View *view, const char *letter, bool is_vector,
                            int edge);
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
/* before a term of a sum */
void narrative_add_sign(Text *out, int sign, bool first);
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

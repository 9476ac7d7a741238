/* story.h: words and steps of a derivation, in text and in LaTeX
 *
 * A step is a line behind a word. A Story borrows its view and writes to `out`; what it gathers it
 * frees when that is said. Words that come from the model go through the notation. */
#ifndef COTREE_PRESENT_STORY_H
#define COTREE_PRESENT_STORY_H

#include "formulate/written/derivation.h"
#include "present/view.h"

typedef struct Reason {
    const char *why; /* borrowed */
    Text names;
} Reason;

typedef struct Story {
    const View *view;
    Text *out;
    LIST(Reason) reasons;   /* of what vanishes */
    EquationList equations; /* to be said */
} Story;

bool story_is_typeset(const View *view);
void story_add_word(Text *out, const View *view, const char *word);
void story_add_formula(Text *out, const View *view, Expr e);
const char *story_edge(const View *view, int edge); /* names, borrowed */
const char *story_node(const View *view, int node);
/* "r(h9)": a variable of an edge */
void story_add_variable(Text *out, const View *view, const char *letter, bool is_vector, int edge);
/* The order in which a person writes a sum: as it comes, or from its end, or from the middle on, so
 * that it begins with a plus where there is one. */
typedef struct SumOrder {
    int first, step, count;
} SumOrder;
/* of signs that stand `stride` bytes apart */
SumOrder story_order(const int *sign, int count, size_t stride);
static inline int story_at(const SumOrder *order, int k)
{
    return (order->first + order->step * k + order->count) % order->count;
}
/* before a term of a sum */
void story_add_sign(Text *out, int sign, bool first);
/* "[L6, 0]": in a plane two components */
void story_add_vector(Text *out, const View *view, const Expr at[3]);
bool story_is_nothing(const Expr at[3]);
/* "x of ground", "[1, 2, 0] of m1" */
void story_add_direction(Text *out, const View *view, const ToldVector *v);

/* what the steps are of; frees the title */
void story_title(Story *story, Text *title);
/* a step: its word, then what it says */
void story_say(Text *out, const View *view, const char *label, const char *words);
/* the same where there are words, which it frees */
void story_say_done(Text *out, const View *view, const char *label, Text *words);
/* `name` is 0 for that reason, */
void story_vanish(Story *story, const char *name, const char *why);
/* and a line for each reason so far */
void story_say_vanished(Story *story);
/* the equations that the steps led to; frees them */
void story_say_equations(Story *story);

#endif

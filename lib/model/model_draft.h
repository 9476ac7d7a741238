/* model_draft.h: a component's statement while an instance is made from it */
#ifndef COTREE_MODEL_MODEL_DRAFT_H
#define COTREE_MODEL_MODEL_DRAFT_H

#include "model/model_impl.h"

typedef struct PartDraft {
    State *state;
    const Statement *statement;
    Instance *part; /* in the state's pool */
    Scope scope;
    int at;                 /* next operand */
    int first_value;        /* index of the first operand that is a value */
    const char **terminals; /* names, where the part has scalar edges; otherwise NULL */
    const Syntax *coordinate_names;
    Diag *diag;
} PartDraft;

/* a part of that row, not in the state yet; its values are set later */
Instance *part_new(State *state, const Component *row, bool is_virtual);
/* Adds a part that no statement makes, with the defaults of its row, between mechanical nodes (-1:
 * its own) or on a terminal (NULL: none) and the datum. */
Instance *part_add(State *state, const Component *row, const char *name, int tail, int head,
                   const char *terminal);
/* Adds it to the state, with its nodes and edges; its values must have been read. */
void part_draft_commit(PartDraft *draft, const char *text);
/* reads the name of the part, then what it connects (model_terminals.c) */
MUST_USE Status part_draft_read_name(PartDraft *draft);
MUST_USE Status part_draft_read_terminals(PartDraft *draft);
/* whether a part has a coordinate of that name, or is a joint */
bool state_names_joint(const State *state, const char *name);
/* the row of a statement: `row`, or its variant where its places are terminals */
const Component *row_at_places(const State *state, const Statement *statement,
                               const Component *row);
/* the start of the statement of such a part: "NAME TAIL TIP" */
void places_form(const Component *row, Text *out);
Place statement_end(const Statement *statement);
bool part_is_frame(const Instance *part);

#endif

/* session_code.h: the input of a model's functions: requested items, and the initial state */
#ifndef COTREE_SESSION_SESSION_CODE_H
#define COTREE_SESSION_SESSION_CODE_H

#include "export/write.h"
#include "session/session_impl.h"

typedef struct CodeItems {
    LIST(Expr) formulas; /* over the user's variables */
    LIST(char *) names;
    Inverse *inverse; /* to compute efforts of drivers from their motion; NULL: none */
} CodeItems;

MUST_USE Status session_code_item(ct_session *session, const Syntax *item, CodeItems *items,
                                  Diag *diag);
/* The equations, the start and the items, which `what` borrows. */
MUST_USE Status session_read_code(ct_session *session, CodeItems *items, bool is_inverse,
                                  Exported *what, Diag *diag);
void code_items_free(CodeItems *items); /* its arrays */

#endif

/* state_space.h: a linear network in symbols
 *
 *     x' = A x + B u + B1 u' + B2 u''
 *
 * x: its states, u: the values of its independent sources; derivatives of these occur where a
 * capacitor closes a circuit with sources, or an inductor a cutset. Entries contain parameters and
 * t. */
#ifndef COTREE_FORMULATE_REDUCED_STATE_SPACE_H
#define COTREE_FORMULATE_REDUCED_STATE_SPACE_H

#include "formulate/reduced/linear_network.h"

typedef struct StateSpace {
    int states, inputs;
    Expr *state;            /* symbols */
    Expr *input;            /* symbols that print as the names of the sources */
    Expr *a;                /* states x states, row by row */
    Expr *b[INPUT_ORDERS];  /* states x inputs; by order */
    bool has[INPUT_ORDERS]; /* whether any entry isn't 0 */
} StateSpace;

/* New; free with state_space_free(). Fails with E_MODEL, naming the part, where the network is not
 * linear, depends on the mechanism or has no states, and where so many of its equations are coupled
 * that their solution would be too long; the errors of system_new(). */
MUST_USE Status state_space_new(const Scene *scene, const CallMonitor *watch, StateSpace **out,
                                Diag *diag);
void state_space_free(StateSpace *space); /* NULL is fine */

#endif

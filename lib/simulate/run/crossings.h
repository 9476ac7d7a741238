/* crossings.h: the instants of a run at which its equations or its state jump, or may
 *
 * A run of smooth equations has none. Of each there is the state just before it, which the
 * equations before it lead to, and the state from which the run continues. */
#ifndef COTREE_SIMULATE_RUN_CROSSINGS_H
#define COTREE_SIMULATE_RUN_CROSSINGS_H

#include "base/memory.h"
#include "expr/expr.h"
#include "simulate/run/grid.h"

typedef enum CrossingKind {
    CROSSING_TIME,      /* conditions of t alone change their signs, */
    CROSSING_CONDITION, /* or one of the equations that depends on the state, */
    CROSSING_EVENT      /* or one of the model's events */
} CrossingKind;

typedef struct Crossing {
    CrossingKind kind;
    double before, after; /* s: the last instant before it, and the first after it */
    int condition;        /* of CROSSING_CONDITION: its number in the equations before; else -1 */
    Expr difference; /* of CROSSING_EVENT: what becomes 0, over its layout's symbols; else NULL */
    bool has_impact, has_new_values, has_samples; /* what gave the state other values */
} Crossing;

typedef struct Crossings {
    LIST(Crossing) list;
    Grid states; /* two rows of each: before and after */
} Crossings;

void crossings_append(Crossings *crossings, const Crossings *more);
void crossings_free(Crossings *crossings); /* its contents */

#endif

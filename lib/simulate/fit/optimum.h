/* optimum.h: what an optimisation found: parameters, the figure, and its constraints */
#ifndef COTREE_SIMULATE_FIT_OPTIMUM_H
#define COTREE_SIMULATE_FIT_OPTIMUM_H

#include "base/memory.h"

#include <stdbool.h>

typedef struct OptimumParameter {
    char *name;
    char *unit; /* "" where it isn't known, or for a number */
    double start, value;
    double low, high; /* infinite: no bound */
} OptimumParameter;

/* a side is compared with the other */
typedef struct OptimumConstraint {
    char *text; /* as written */
    char *unit; /* of both sides; "" likewise */
    double left, right;
    bool is_active; /* both sides are equal, to the tolerance of the search */
} OptimumConstraint;

typedef struct Optimum {
    LIST(OptimumParameter) parameters;
    LIST(OptimumConstraint) constraints;
    char *figure; /* as written */
    char *unit;   /* of it */
    bool is_maximum;
    double start, value; /* of the figure */
    int runs;
    bool is_feasible, is_converged, is_stopped;
    double wall; /* s */
} Optimum;

Optimum *optimum_new(void);          /* new, empty */
void optimum_free(Optimum *optimum); /* NULL is fine */
/* the parameter with that name; -1: there is none */
int optimum_find(const Optimum *optimum, const char *name);

#endif

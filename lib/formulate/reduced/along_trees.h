/* along_trees.h: accelerations eliminated speed by speed along the trees, written out */
#ifndef COTREE_FORMULATE_REDUCED_ALONG_TREES_H
#define COTREE_FORMULATE_REDUCED_ALONG_TREES_H

#include "formulate/reduced/groups.h"

/* when a speed's own row is eliminated */
typedef enum Delay {
    DELAY_NONE, /* where it is met, body by body (Featherstone 1983) */
    DELAY_RUN,  /* where turns about one axis begin */
    DELAY_ALL,  /* at the datum, where what is left is M (Walker and Orin 1982) */
} Delay;

/* one of the ways to the same accelerations, which differ in what they cost */
typedef struct EliminationOrder {
    Delay delay;
    bool merges;      /* what turns about one axis is resolved in the axes where that begins, */
    bool ends_merged; /* the last body too, though none beyond turns about that axis */
} EliminationOrder;

/* u' where `applied` is what pushes on each speed beside inertia and gravity, and what each pivot
 * of M is the rest of, over the pivot, at most. Arrays of nu. False: a speed moves nothing. */
bool accelerations_along(const System *system, const Groups *groups, const EliminationOrder *way,
                         const Expr *applied, Expr *acceleration, Expr *excess);

/* M u' less what inertia and gravity make of F, for u' that are given, outward and inward once
 * (Luh, Walker and Paul 1980). Of the way no delay counts. */
void efforts_along(const System *system, const Groups *groups, const EliminationOrder *way,
                   const Expr *acceleration, Expr *effort);

#endif

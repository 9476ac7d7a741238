/* along_trees.h: accelerations by elimination of one speed after the other along the trees, in
 * symbols */
#ifndef COTREE_FORMULATE_REDUCED_ALONG_TREES_H
#define COTREE_FORMULATE_REDUCED_ALONG_TREES_H

#include "formulate/reduced/groups.h"

/* when a speed's own row is eliminated */
typedef enum Delay {
    DELAY_NONE, /* at its joint, body by body (Featherstone 1983) */
    DELAY_RUN,  /* where a coaxial group begins */
    DELAY_ALL,  /* at the datum, where the remaining matrix is M (Walker and Orin 1982) */
} Delay;

/* one of the orders that give the same accelerations at different cost */
typedef struct EliminationOrder {
    Delay delay;
    /* turns about one axis are resolved in the axes at the start of their coaxial group, */
    bool merges;
    bool ends_merged; /* including the last body, though none beyond turns about that axis */
} EliminationOrder;

/* u', where `applied` is the load on each speed besides inertia and gravity, and excess: an upper
 * bound of the entry of M from which elimination leaves each pivot, divided by this pivot. Arrays
 * of nu. False: a speed moves no mass. */
bool accelerations_along(const System *system, const Groups *groups, const EliminationOrder *way,
                         const Expr *applied, Expr *acceleration, Expr *excess);

/* M u' minus the inertia and gravity terms of F, for given u', by one pass outward and one inward
 * (Luh, Walker and Paul 1980). The delay of `way` has no effect. */
void efforts_along(const System *system, const Groups *groups, const EliminationOrder *way,
                   const Expr *acceleration, Expr *effort);

#endif

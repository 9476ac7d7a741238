/* variable_index.h: the order of inputs of all programs over one system
 *
 * t, references of angles that count turns, q, u, x, signs on surfaces, x', z, u', lambda, efforts,
 * u''; a program's parameters come behind these. Programs are on the layout's sides of its surfaces
 * (formulate/system/surfaces.h). */
#ifndef COTREE_SIMULATE_EQUATIONS_VARIABLE_INDEX_H
#define COTREE_SIMULATE_EQUATIONS_VARIABLE_INDEX_H

#include "formulate/system/surfaces.h"
#include "formulate/system/system.h"

typedef struct VariableIndex {
    System *system;
    Expr *side;   /* one a switch: symbol of the side that it is on; NULL: that is no number here */
    bool *closed; /* one a switch: that side */
    int switches;
    uint64_t sides; /* counts changes of them: what was computed with others is outdated */
    int n, nu, m, nx, nz, ne, multi_turns, slides;
    int t, references, q, u, x, signs, rates, z, acceleration, multipliers, efforts,
        jerk; /* first */
    int count;
    Expr *symbols; /* count */
    Surface *surfaces;
    int surface_count; /* those that it slides along come first: `slides` of them */
} VariableIndex;

/* y of a run is q, u, x, references, work */
static inline int
variable_index_references(const VariableIndex *l) /* place of the first reference in it */
{
    return l->n + l->nu + l->nx;
}

VariableIndex *variable_index_new(
    System *system); /* new; free with variable_index_free(). Symbols of u'' are made. */
/* The same on sides of some of the system's surfaces, by number: -1 or 1; 0: it slides along. */
typedef struct OnSurface {
    int surface, side;
} OnSurface;
VariableIndex *variable_index_new_on(System *system, const OnSurface *on, int count);
/* x, x', z: 2 nx + nz symbols; new */
Expr *variable_index_network(const VariableIndex *layout);
/* e on the sides of the layout's surfaces */
Expr variable_index_on_surfaces(const VariableIndex *layout, Expr e);
/* of each symbol the outermost instance that it is of, from 1; 0: it is of none; new */
int *variable_index_blocks(const VariableIndex *layout);
/* A symbol that is a side of a switch in this layout: its number; -1: it is none */
int variable_index_side_of(const VariableIndex *layout, Expr symbol);
void variable_index_free(VariableIndex *layout);
/* Sides of switches that are numbers, from now on in all programs over the layout; one a
 * switch. */
void variable_index_set_sides(VariableIndex *layout, const bool *closed);
/* whether any of the roots changes with t alone, while no state does */
bool variable_index_follows_time(const VariableIndex *layout, const Expr *roots, int count);

#endif

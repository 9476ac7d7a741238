/* variable_index.h: the order of inputs of all programs over one system
 *
 * t, references of multi-turn angles, q, u, x, signs on surfaces, x', z, u', lambda, efforts, u'';
 * a program's parameters come after these. Programs read the signs of the layout's surfaces
 * (formulate/system/surfaces.h) in place of what jumps there. */
#ifndef COTREE_SIMULATE_EQUATIONS_VARIABLE_INDEX_H
#define COTREE_SIMULATE_EQUATIONS_VARIABLE_INDEX_H

#include "formulate/system/surfaces.h"
#include "formulate/system/system.h"

/* a side of one of the system's surfaces, by number: -1 or 1; 0: the motion slides along it */
typedef struct OnSurface {
    int surface, side;
    bool held; /* on a side, but parts that stick keep it on the surface: its sign tells nothing */
    double most; /* where it is held: its sign's size, the static over the kinetic bound or 0 */
} OnSurface;

static inline bool on_surface_is(const OnSurface *on, const OnSurface *other)
{
    return on->surface == other->surface && on->side == other->side && on->held == other->held &&
           (!on->held || on->most == other->most);
}

typedef struct VariableIndex {
    System *system;
    Expr *side;   /* one per switch: symbol of its state; NULL: it is no number here */
    bool *closed; /* one per switch: that state */
    int switches;
    uint64_t sides; /* counts changes of them: values computed with another count are outdated */
    int n, nu, m, nx, nz, ne, multi_turns, slides;
    int position_rows; /* the first of m: those after them are velocity rows */
    int t, references, q, u, x, signs, rates, z, acceleration, multipliers, efforts,
        jerk; /* index of the first */
    int count;
    Expr *symbols;     /* count */
    Surface *surfaces; /* whose signs are inputs; */
    int surface_count;
    int *
        first_part; /* index of the first sign of each one's components, after those of surfaces, */
    int sign_count; /* and the number of all signs */
    OnSurface *on;  /* the sides of these in the current mode: of those that are 0 */
    int *slid;      /* `slides` signs are unknown: their indices, */
    int *slid_surface;   /* and the surface of each; */
    double *sign_values; /* the current value of each sign */
} VariableIndex;

/* y of a run is q, u, x, references, work */
static inline int
variable_index_references(const VariableIndex *l) /* index of the first reference in it */
{
    return l->n + l->nu + l->nx;
}

VariableIndex *variable_index_new(
    System *system); /* new; free with variable_index_free(). Symbols of u'' are made. */
/* The same where the signs of some of the system's surfaces are inputs, which begins on these
 * sides. */
VariableIndex *variable_index_new_on(System *system, const OnSurface *on, int count);
/* whether these are its surfaces, in that order; whether it is on these sides of them */
bool variable_index_has_surfaces(const VariableIndex *layout, const OnSurface *on, int count);
bool variable_index_is_on(const VariableIndex *layout, const OnSurface *on);
/* Set the sides of its surfaces, for all programs over the layout. O(surfaces). */
void variable_index_set_on(VariableIndex *layout, const OnSurface *on);
/* x, x', z: 2 nx + nz symbols; new */
Expr *variable_index_network(const VariableIndex *layout);
/* e on the sides of the layout's surfaces */
Expr variable_index_on_surfaces(const VariableIndex *layout, Expr e);
/* for each symbol the outermost instance that it belongs to, from 1; 0: none; new */
int *variable_index_blocks(const VariableIndex *layout);
/* The switch whose side this symbol is in the layout: its number; -1: none */
int variable_index_side_of(const VariableIndex *layout, Expr symbol);
void variable_index_free(VariableIndex *layout);
/* Set the sides of switches that are numbers, for all programs over the layout; one per switch. */
void variable_index_set_sides(VariableIndex *layout, const bool *closed);
/* whether any of the roots changes with t alone, while no state does */
bool variable_index_follows_time(const VariableIndex *layout, const Expr *roots, int count);
/* the same of signs of surfaces that the motion slides along: what acts on it changes with t */
bool variable_index_signs_follow_time(const VariableIndex *layout);

#endif

/* initial.h: consistent positions, speeds and network states from what the user gave
 *
 * Three problems of least squares, one after the other: Phi = 0 with given positions, Phi_u u = nu
 * with given speeds, the network's equations with given states. Given coordinates are fixed; any
 * other given variable is one more equation. Guesses determine the initial point: first they are
 * equations too, then only given values are. */
#ifndef COTREE_SIMULATE_ASSEMBLE_INITIAL_H
#define COTREE_SIMULATE_ASSEMBLE_INITIAL_H

#include "simulate/assemble/kinematic_tree.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/remark.h"

typedef struct Assembled {
    double *y;       /* q, u, x, references of angles, 0 */
    double *network; /* x', z: initial guess of the first search for them */
    double *guess;   /* z: the user's guess, else 0 */
    int *rows;       /* independent constraint rows, ascending */
    int row_count;
    Remarks remarks;
} Assembled;

/* Fails with E_ASSEMBLE, naming the equations that can't be satisfied, and with the errors of
 * system_variable(). With `has_modes` the network's equations are solved later, once the states of
 * its switches are known. */
MUST_USE Status initial_find(const VariableIndex *layout, Parameters *parameters,
                             CompiledEquations *numbers, const SimulationInput *setting,
                             bool has_modes, Assembled *out, Diag *diag);
/* What a new assembly in the middle of a run starts from: borrowed. */
typedef struct NewPlaces {
    const VariableIndex *layout;
    Parameters *parameters;
    const Equations *equations;
    KinematicTree *kinematic_tree;
    double t;
    int count;
    const VariableReferent *referents;
    const double *values;
} NewPlaces;
/* Assemble coordinates and references of angles in y = (q, u, x, references): frames start from y,
 * except for new values, which are placed along the joints. Loops may be open. Fails as
 * tree_complete() does. */
MUST_USE Status initial_place_again(const NewPlaces *places, double *y, Diag *diag);

/* x' and z at y = (q, u, x, references of angles), for t = 0, from a guess [x'; z] (NULL: 0): into
 * `out`, unless NULL. Fails with E_SINGULAR where there is no solution, naming undetermined
 * unknowns. */
MUST_USE Status initial_solve(const VariableIndex *layout, const CompiledEquations *numbers,
                              const double *y, const double *guess, double *out, Diag *diag);
/* A hint where a network has no solution, if an ideal diode or switch may be the cause. */
void network_hint(System *system, Diag *diag);
void initial_free(Assembled *start); /* frees its contents */

#endif

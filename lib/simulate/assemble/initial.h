/* initial.h: consistent positions, speeds and network states from what the user gave
 *
 * Three problems of least squares, one after another: Phi = 0 with given positions, Phi_u u = nu
 * with given speeds, the network's equations with given states. Given coordinates are held; any
 * other given variable is one more equation. Guesses choose where to begin: they are equations at
 * first, then what was given decides alone. */
#ifndef COTREE_SIMULATE_ASSEMBLE_INITIAL_H
#define COTREE_SIMULATE_ASSEMBLE_INITIAL_H

#include "simulate/assemble/kinematic_tree.h"
#include "simulate/equations/compiled_equations.h"
#include "simulate/equations/remark.h"

typedef struct Assembled {
    double *y;       /* q, u, x, references of angles, 0 */
    double *network; /* x', z: where the first search for them begins */
    double *guess;   /* z as the user guesses it, else 0 */
    int *rows;       /* independent constraint rows, rising */
    int row_count;
    Remarks remarks;
} Assembled;

/* Fails with E_ASSEMBLE, naming what can't be met, and the errors of system_variable(). With
 * `has_modes` the network's equations are solved later, once the sides of its switches are known.
 */
MUST_USE Status initial_find(const VariableIndex *layout, Parameters *parameters,
                             CompiledEquations *numbers, const SimulationInput *setting,
                             bool has_modes, Assembled *out, Diag *diag);
/* What is put in place in the middle of a run: borrowed. */
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
/* Coordinates and references of angles in y = (q, u, x, references): frames stand as y has them,
 * but for what is put in place along the joints. Loops may be open. Fails as tree_complete() does.
 */
MUST_USE Status initial_place_again(const NewPlaces *places, double *y, Diag *diag);

/* x' and z at y = (q, u, x, references of angles), of t = 0, from a guess [x'; z] (NULL: 0): into
 * `out`, unless NULL. Fails with E_SINGULAR where there are none, naming what nothing determines.
 */
MUST_USE Status initial_solve(const VariableIndex *layout, const CompiledEquations *numbers,
                              const double *y, const double *guess, double *out, Diag *diag);
/* The way out where a network has no solution, if an ideal diode or switch may be why. */
void network_hint(System *system, Diag *diag);
void initial_free(Assembled *start); /* what it holds */

#endif

/* linearize.h: linear equations about a point of a result, and their modes
 *
 *     y' = A y + B w,   v = C y + D w
 *
 * y: deviations of independent coordinates, of their speeds, and of network states; w: of inputs;
 * v: of outputs. Where rotations are Euler parameters, y holds small turns about the axes in which
 * the speeds are. Every entry is exact to rounding: the equations M u' + Phi_u^T lambda = F,
 * Phi_u u' = gamma, A [x'; z] = r and their constraints are differentiated in symbols, and the
 * derivatives evaluated and put together along the constraints. */
#ifndef COTREE_SIMULATE_LINEARIZE_H
#define COTREE_SIMULATE_LINEARIZE_H

#include "simulate/run.h"

typedef struct LinearInput {
    const char *name;
    const char *source; /* component whose value it adds to; NULL: a parameter of the name */
} LinearInput;

typedef struct LinearOrder {
    Result *about;
    double at;          /* instant of it, s */
    const Model *model; /* of the result; asked where an input is a component's value */
    const LinearInput *inputs;
    int input_count;
    const Expr *outputs; /* over the user's variables */
    const char *const *output_names;
    int output_count;
    const char *const *independent; /* coordinates wanted as independent */
    int independent_count;
    const Watch *watch;
} LinearOrder;

typedef struct Linear {
    double at;
    int freedoms;                       /* the first of the states; as many speeds follow */
    int states, inputs, outputs, parts; /* parts: all coordinates, then network states */
    double *a, *b, *c, *d;              /* row by row */
    double *motion;                     /* parts x states: how each moves with y */
    bool is_shifted; /* states are less what jumps with the inputs, as voltages of capacitors in a
                        circuit with a source do: b and d count from there */
    char **state_names, **input_names, **output_names, **part_names;
} Linear;

/* New; free with linear_free(). Fails with E_SINGULAR where the equations are dependent, E_VALUE
 * for an instant outside the run, E_NAME and E_MODEL for inputs, the errors of system_resolve(). */
MUST_USE Status linearize(const LinearOrder *order, Linear **out, Diag *diag);
void linear_free(Linear *linear); /* NULL is fine */

/* A pair of conjugate eigenvalues, or a real one. */
typedef struct Mode {
    double real, imaginary; /* eigenvalue, 1/s; imaginary >= 0 */
    double omega;           /* its absolute value, rad/s */
    double damping;         /* -real / omega; 0 where omega is */
    double *amplitude;      /* parts: the largest is 1 */
    double *phase;          /* rad, in (-pi, pi], of the largest 0 */
} Mode;

typedef struct Modes {
    int count, parts;
    Mode *at; /* rising omega */
    char **part_names;
} Modes;

/* New; free with modes_free(). E_SOLVER where the eigenvalues can't be found. */
MUST_USE Status modes_find(const Linear *linear, Modes **out, Diag *diag);
void modes_free(Modes *modes); /* NULL is fine */

#endif

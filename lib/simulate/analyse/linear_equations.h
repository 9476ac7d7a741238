/* linear_equations.h: linear equations of deviations
 *
 *     y' = A y + B w,   v = C y + D w
 *
 * y: deviations of independent coordinates, of their speeds, and of network states; w: of inputs;
 * v: of outputs. Where rotations are Euler parameters, y holds small turns about the axes in which
 * the speeds are. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEAR_EQUATIONS_H
#define COTREE_SIMULATE_ANALYSE_LINEAR_EQUATIONS_H

#include <stdbool.h>

typedef struct Linear {
    double at;
    int freedoms;                       /* the first of the states; as many speeds follow */
    int states, inputs, outputs, parts; /* parts: all coordinates, then network states */
    double *a, *b, *c, *d;              /* row by row; what can't be distinguished from 0 is 0 */
    double *a_error, *b_error, *c_error, *d_error; /* how far each entry may be off */
    double *motion;                                /* parts x states: how each moves with y */
    /* the rows of speeds unsolved, M s'' = -[K C ..] y: freedoms square, freedoms x states. NULL
     * where networks act on accelerations, or rates of coordinates aren't their speeds alone. */
    double *mass, *mass_error, *force, *force_error;
    bool is_shifted; /* states are less what jumps with the inputs, as voltages of capacitors in a
                        circuit with a source do: b and d count from there */
    bool is_passing; /* mechanical coefficients change as it moves on: other coordinates have other
                        eigenvalues there */
    char **state_names, **input_names, **output_names, **part_names;
} Linear;

void linear_free(Linear *linear); /* NULL is fine */

#endif

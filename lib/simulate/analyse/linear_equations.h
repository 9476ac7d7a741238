/* linear_equations.h: linear equations of deviations from a point
 *
 *     y' = A y + B w,   v = C y + D w
 *
 * y: deviations of independent coordinates, of independent speeds, and of network states; w: of
 * inputs; v: of outputs. Where rotations are Euler parameters, y contains small rotations about the
 * axes in which the speeds are resolved. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEAR_EQUATIONS_H
#define COTREE_SIMULATE_ANALYSE_LINEAR_EQUATIONS_H

#include <stdbool.h>

typedef struct Linear {
    double at;
    /* the first of the states, and the number of speeds that come after them: as many, but less
     * the velocity rows, which take freedoms of motion alone */
    int places, freedoms;
    int states, inputs, outputs, parts; /* parts: all coordinates, then network states */
    double *a, *b, *c, *d;              /* row by row; an entry that is 0 within its error is 0 */
    double *a_error, *b_error, *c_error, *d_error; /* bound of each entry's error */
    double *motion;                                /* parts x states: derivative of each by y */
    /* Rows of speeds before solving, M s'' = -[K C ..] y: freedoms x freedoms, freedoms x states.
     * NULL where networks depend on accelerations, with velocity rows, or where rates of
     * coordinates aren't their speeds alone. */
    double *mass, *mass_error, *force, *force_error;
    bool is_shifted; /* states are without the part that jumps with the inputs, as for voltages of
                        capacitors in a loop with a source: b and d apply to these */
    bool is_passing; /* mechanical coefficients change along the motion: eigenvalues differ in other
                        coordinates */
    char *on_jump; /* parts whose law jumps at the point, as friction at rest: "f, g"; NULL: none */
    char **state_names, **input_names, **output_names, **part_names;
} Linear;

void linear_free(Linear *linear); /* NULL is fine */

#endif

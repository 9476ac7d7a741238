/* linearize.h: linear equations about a point of a result, and their modes
 *
 * The equations M u' + Phi_u^T lambda = F, Phi_u u' = gamma, A [x'; z] = r and their constraints
 * are compiled, differentiated along deviations through their program (compile/tangents.h), and put
 * together along the constraints. Every entry comes with a bound of what rounding, of the numbers
 * given and on the way, leaves open. One that its bound doesn't tell from 0 is 0, unless it comes
 * out the same with all numbers moved in their last places. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEARIZE_H
#define COTREE_SIMULATE_ANALYSE_LINEARIZE_H

#include "simulate/analyse/linear_equations.h"
#include "simulate/run/result_reader.h"

typedef struct LinearInput {
    const char *name;
    const char *source; /* component whose value it adds to; NULL: a parameter of the name */
} LinearInput;

typedef struct LinearOrder {
    ResultReader *about; /* of the result */
    double at;           /* instant of it, s */
    SceneSource scene;   /* of the result; asked where an input is a component's value */
    const LinearInput *inputs;
    int input_count;
    const Expr *outputs; /* over the user's variables */
    const char *const *output_names;
    int output_count;
    const char *const *independent; /* coordinates wanted as independent */
    int independent_count;
    const CallMonitor *watch;
} LinearOrder;

/* New; free with linear_free(). Fails with E_SINGULAR where the equations are dependent, E_VALUE
 * for an instant outside the run, E_NAME and E_MODEL for inputs, the errors of system_resolve(). */
MUST_USE Status linearize(const LinearOrder *order, Linear **out, Diag *diag);

/* A pair of conjugate eigenvalues, or a real one. */
typedef struct Mode {
    double real, imaginary; /* eigenvalue, 1/s; imaginary >= 0 */
    double omega;           /* its absolute value, rad/s */
    double damping;         /* -real / omega; 0 where omega is */
    double error;           /* the eigenvalue is known to, 1/s */
    bool is_doubtful;       /* whether it grows or fades can't be determined: real is 0 */
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

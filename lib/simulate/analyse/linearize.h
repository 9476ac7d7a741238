/* linearize.h: linear equations about a point of a result, and their modes
 *
 * The equations M u' + Phi_u^T lambda = F, Phi_u u' = gamma, A [x'; z] = r and their constraints
 * are compiled, differentiated along deviations by forward differentiation (compile/tangents.h),
 * and projected onto the constraints. Every entry has a bound of its error, from the rounding of
 * given numbers and of the computation. An entry that is 0 within its bound is set to 0, unless it
 * is nearly the same with all numbers perturbed in their last places. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEARIZE_H
#define COTREE_SIMULATE_ANALYSE_LINEARIZE_H

#include "simulate/analyse/linear_equations.h"
#include "simulate/run/result_reader.h"

typedef struct LinearInput {
    const char *name;
    const char *source; /* component to whose value it is added; NULL: a parameter of that name */
} LinearInput;

typedef struct LinearOrder {
    ResultReader *about; /* of the result */
    double at;           /* an instant of the run, s */
    SceneSource scene;   /* of the result; used where an input is a component's value */
    const LinearInput *inputs;
    int input_count;
    const Expr *outputs; /* expressions of the user's variables */
    const char *const *output_names;
    int output_count;
    const char *const *independent; /* coordinates that the user wants independent */
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
    double error;           /* bound of the eigenvalue's error, 1/s */
    bool is_doubtful;       /* whether it grows or decays can't be determined: real is 0 */
    double *amplitude;      /* parts: relative to the largest, which is 1 */
    double *phase;          /* rad, in (-pi, pi], relative to the largest, whose phase is 0 */
} Mode;

typedef struct Modes {
    int count, parts;
    Mode *at; /* ascending omega */
    char **part_names;
} Modes;

/* New; free with modes_free(). E_SOLVER where the eigenvalue iteration fails. */
MUST_USE Status modes_find(const Linear *linear, Modes **out, Diag *diag);
void modes_free(Modes *modes); /* NULL is fine */

#endif

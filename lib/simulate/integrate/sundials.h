/* sundials.h: shared by the multistep methods of SUNDIALS
 *
 * They run without projection: their history isn't on the manifold, and the reader of a step
 * projects its values. They restart at order 1 after a jump. */
#ifndef COTREE_SIMULATE_INTEGRATE_SUNDIALS_H
#define COTREE_SIMULATE_INTEGRATE_SUNDIALS_H

#include "base/memory.h"
#include "simulate/integrate/condensed.h"
#include "simulate/integrate/integrate_limits.h"
#include "simulate/integrate/ode.h"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_types.h>

/* functions with the same meaning in all of its solvers; they return 0 on success */
typedef struct SundialsCalls {
    void (*free)(void **memory);
    int (*set_stop_time)(void *memory, realtype t);
    int (*set_max_step)(void *memory, realtype h);
    int (*set_first_step)(void *memory, realtype h);
    int (*get_steps)(void *memory, long *count);
    int (*get_failures)(void *memory, long *count);
    int (*get_jacobians)(void *memory, long *count);
    int (*get_last_step)(void *memory, realtype *h);
    int (*get_next_step)(void *memory, realtype *h);
    int (*get_derivative)(void *memory, realtype t, int order, N_Vector out);
} SundialsCalls;

typedef struct Sundials {
    Stepper base;
    const SundialsCalls *calls;
    Cleanup cleanup;
    int all, n; /* entries of y; of the integrated unknowns, the first of which are y */
    SUNContext context;
    void *memory; /* the solver */
    N_Vector w, out;
    N_Vector rate; /* w', of implicit equations; NULL otherwise */
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
    Counts earlier;     /* of integrations before the last restart */
    bool is_new;        /* no step since the last restart */
    double jacobian_at; /* s */
    /* of explicit ones 1 - gamma J: J row by row, all x n, that of y first, and its partition;
     * NULL: none yet */
    double *jacobian;
    Condensed *condensed;
    double gamma;
    /* of Newton's method: its last correction, in tolerances, and the rate at which corrections
     * decrease */
    double corrected, becoming;
    double power; /* largest rate of a quadrature so far: scale of its errors */
    char reason[200];
} Sundials;

/* `s` is new and zeroed, the first member of what `method` calls a stepper; the caller creates its
 * memory next. */
void sundials_init(Sundials *s, const SundialsCalls *calls, const Method *method, const Ode *ode,
                   const Control *control, int n);
/* stores its message for our diag instead of printing it */
void sundials_store_reason(int code, const char *module, const char *function, char *message,
                           void *stepper);
/* Set y of a restart, and w; counts continue from those before. */
void sundials_place(Sundials *s, double t, const double *y);
/* The error that a step may have in a quadrature that is `value` and changes by `rate` now, in its
 * unit. Where all that it depends on is at rest or changes linearly, no error of that limits steps
 * for it. Example: the work of a brake that holds against a spring. */
double sundials_quadrature_error(Sundials *s, double value, double rate);
/* Limit the solver from here: no step beyond `end`, and none longer than allowed. */
int sundials_bound(Sundials *s, double end);
/* after a step: counts so far */
void sundials_count(Sundials *s);
/* after a failed step, with its solver's code: reports E_SOLVER */
MUST_USE Status sundials_failure(Sundials *s, int code, Diag *diag);
/* after a successful step, to `reached` */
MUST_USE Status sundials_arrive(Sundials *s, double reached, Diag *diag);

/* of a Method's row; the matrix and solvers that it was given are freed with it */
void sundials_destroy(Stepper *stepper);
void sundials_at(Stepper *stepper, double t, double *y);
MUST_USE Status sundials_shorten(Stepper *stepper, double t, Diag *diag);
bool sundials_slope(Stepper *stepper, double *rate);
extern const double sundials_nodes[1];

#define SUNDIALS_METHOD                                                                            \
    .at = sundials_at, .shorten = sundials_shorten, .slope = sundials_slope,                       \
    .nodes = sundials_nodes, .node_count = COUNT(sundials_nodes), .has_history = true,             \
    .sees_little = true, .pulse_steps = 24

#endif

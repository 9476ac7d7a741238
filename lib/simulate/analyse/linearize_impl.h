/* linearize_impl.h: declarations shared by the files of linearize()
 *
 * linearize.c sets up the equations, linearize_point.c evaluates them at the point, with bounds of
 * all errors, linearize_columns.c computes the deviations, linearize_settle.c decides which entries
 * are 0. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEARIZE_IMPL_H
#define COTREE_SIMULATE_ANALYSE_LINEARIZE_IMPL_H

#include "algebra/double_double.h"
#include "algebra/verified_solve.h"
#include "simulate/analyse/linearize.h"
#include "simulate/equations/partitioning.h"
#include "simulate/equations/rows.h"
#include "simulate/run/result_reader_impl.h"

/* indices of the symbols by which everything is differentiated */
typedef struct Columns {
    int q, u, x, acceleration, multipliers, rates, z, inputs, count;
    int *place; /* index of each among the inputs of the program of rows; -1: none */
} Columns;

/* first index of each kind of rows */
typedef struct RowPlaces {
    int balance, acceleration, network, velocity, phi, q_rate, outputs, count;
} RowPlaces;

/* a number and the bound of its error */
typedef struct LinearNumber {
    double value, error;
} LinearNumber;

/* add a product, with the rounding error of that */
static inline void number_add(LinearNumber *sum, LinearNumber a, LinearNumber b)
{
    const DoubleDouble product = dd_product(a.value, b.value);
    const DoubleDouble total = dd_sum(sum->value, product.high);

    sum->value = total.high;
    sum->error += fabs(product.low) + fabs(total.low) + fabs(a.value) * b.error +
                  a.error * (fabs(b.value) + b.error);
}

/* whether a value is 0 within its error */
static inline bool linear_is_undetermined(double value, double error)
{
    return value != 0 && fabs(value) <= error;
}

/* A choice of independent coordinates, or of speeds, and the constraint rows that determine the
 * others. */
typedef struct Dependence {
    int used, free; /* rows, and independent ones: nu - used */
    int *rows;      /* independent at the point */
    bool *is_independent;
    Partitioning *partitioning;
    double *matrix, *error; /* columns of Phi_u by dependent ones */
    VerifiedSolve *held;    /* its factors */
} Dependence;

typedef struct Work {
    const LinearOrder *order;
    Phase *phase;   /* of the result, at the point */
    System *varied; /* NULL: the result's own system is used */
    System *system;
    VariableIndex *l;
    Parameters parameters;
    Expr *inputs; /* symbols of inputs, then of their rates */
    Columns at;
    RowPlaces rows;
    Probe *derived;            /* computes the rows, */
    Probe *geometry;           /* computes Phi_u and N, */
    Tangents *along, *turning; /* and both along directions */
    double *y;
    double *follow;                       /* u', lambda, x', z */
    double *y_error;                      /* bounds of the errors of q, u, x */
    double *follow_error;                 /* likewise */
    LinearNumber *values;                 /* of rows, at the point */
    LinearNumber *phi_u, *map, *map_rate; /* Phi_u, N, N' */
    double *matrix, *matrix_error;        /* E_e over the rows in use */
    VerifiedSolve *equations;             /* its factors */
    Dependence speeds;                    /* over all rows in use, */
    Dependence own_places;                /* over those of positions, where there are others; */
    Dependence *places;                   /* that of coordinates: one of these */
    int unknowns;                         /* nu + rows in use + nx + nz */
    uint64_t perturbation; /* seed by which all numbers are perturbed; 0: none are, and errors are
                              bounded */
} Work;

/* let the symbol of a column move along the direction of a batch lane */
static inline void linear_move(const Work *w, int lane, int column, LinearNumber by)
{
    if (w->at.place[column] >= 0 && (by.value != 0 || by.error != 0))
        tangents_move(w->along, lane, w->at.place[column], by.value, by.error);
}

/* derivative of a row along it */
static inline LinearNumber linear_slope(const Work *w, int row, int lane)
{
    LinearNumber out;

    out.value = tangents_root(w->along, row, lane, &out.error);
    return out;
}

/* --- linearize_point.c --- */

/* Solve for the unknowns that the state determines, and evaluate everything there; choose
 * independent coordinates. E_SINGULAR where equations are dependent, E_MODEL, E_VALUE. */
MUST_USE Status linear_point(Work *w, Diag *diag);
int linear_equation(const Work *w, int r); /* row of the r-th of the equations in use */
int linear_unknown(const Work *w, int k);  /* column of the k-th unknown */
/* A coefficient of row r of the equations in use at the perturbed point. Coefficients are perturbed
 * like numbers: otherwise rounding errors would be the same where no number is an unknown. */
double linear_moved(const Work *w, int r, int column, double value);
/* Complete v, whose independent entries are set: Phi_u v + right = 0 in the dependent ones. */
void linear_complete(const Work *w, const Dependence *d, const LinearNumber *right,
                     LinearNumber *v);

/* Evaluate everything at a point perturbed by w->perturbation, for the same equations and
 * coordinates; false: it can't be evaluated. */
bool linear_perturbed(Work *w);

/* Whether coefficients of the mechanical equations change along the motion from the point; `linear`
 * contains the deviations there. If they don't, the eigenvalues of A are the same in all
 * coordinates. */
bool linear_is_passing(Work *w, const Linear *linear);

/* --- linearize_result.c --- */

/* New, all entries 0, names from the order and the system; linear_free(). */
Linear *linear_new(const Work *w);

/* --- linearize_columns.c --- */

/* All entries, with bounds of their errors; at the point, or at the perturbed one. */
MUST_USE Status linear_columns(const Work *w, Linear *out, Diag *diag);

/* --- linearize_settle.c --- */

/* New: the equations at the point, where entries that are 0 within their errors are 0;
 * linear_free(). E_SINGULAR where they have no derivatives. */
MUST_USE Status linear_settled(Work *w, Linear **out, Diag *diag);

#endif

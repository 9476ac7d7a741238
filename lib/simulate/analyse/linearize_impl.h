/* linearize_impl.h: what the files of linearize() share
 *
 * linearize.c puts the equations together, linearize_point.c evaluates them where they are wanted,
 * with what every number may be off by, linearize_columns.c goes through the deviations,
 * linearize_settle.c tells what is 0. */
#ifndef COTREE_SIMULATE_ANALYSE_LINEARIZE_IMPL_H
#define COTREE_SIMULATE_ANALYSE_LINEARIZE_IMPL_H

#include "algebra/double_double.h"
#include "algebra/verified_solve.h"
#include "simulate/analyse/linearize.h"
#include "simulate/equations/partitioning.h"
#include "simulate/equations/rows.h"
#include "simulate/run/result_reader_impl.h"

/* places of the symbols by which everything is differentiated */
typedef struct Columns {
    int q, u, x, acceleration, multipliers, rates, z, inputs, count;
    int *place; /* which input of the program of rows each is; -1: none */
} Columns;

/* and of the rows that are */
typedef struct RowPlaces {
    int balance, acceleration, network, velocity, phi, q_rate, outputs, count;
} RowPlaces;

/* a number and how far it may be off */
typedef struct LinearNumber {
    double value, error;
} LinearNumber;

/* add a product; what that rounds away is known */
static inline void number_add(LinearNumber *sum, LinearNumber a, LinearNumber b)
{
    const DoubleDouble product = dd_product(a.value, b.value);
    const DoubleDouble total = dd_sum(sum->value, product.high);

    sum->value = total.high;
    sum->error += fabs(product.low) + fabs(total.low) + fabs(a.value) * b.error +
                  a.error * (fabs(b.value) + b.error);
}

/* of 0, by what it may be off: whether that is all it is */
static inline bool linear_is_undetermined(double value, double error)
{
    return value != 0 && fabs(value) <= error;
}

typedef struct Work {
    const LinearOrder *order;
    Phase *phase;   /* of the result, at the point */
    System *varied; /* NULL: the result's own will do */
    System *system;
    VariableIndex *l;
    Parameters parameters;
    Expr *inputs; /* symbols, then of their rates */
    Columns at;
    RowPlaces rows;
    Probe *derived;            /* rows, */
    Probe *geometry;           /* Phi_u, N, */
    Tangents *along, *turning; /* and both along directions */
    double *y;
    double *follow;                       /* u', lambda, x', z */
    double *y_error;                      /* of q, u, x */
    double *follow_error;                 /* likewise */
    LinearNumber *values;                 /* of rows, at the point */
    LinearNumber *phi_u, *map, *map_rate; /* Phi_u, N, N' */
    double *matrix, *matrix_error;        /* E_e over the rows in use */
    VerifiedSolve *equations;             /* its factors */
    double *dependent, *dependent_error;
    VerifiedSolve *held; /* factors of Phi_u's dependent columns, over the rows in use */
    Partitioning *partitioning;
    int used, freedoms, unknowns; /* unknowns: nu + used + nx + nz */
    uint64_t beside;              /* seed by which all numbers are moved; 0: they aren't, and errors
                                     are told */
    int *in_use;                  /* constraint rows, so many as are used: independent there */
    bool *is_independent;         /* speeds */
} Work;

/* let the symbol of a column move along the direction of a lane */
static inline void linear_move(const Work *w, int lane, int column, LinearNumber by)
{
    if (w->at.place[column] >= 0 && (by.value != 0 || by.error != 0))
        tangents_move(w->along, lane, w->at.place[column], by.value, by.error);
}

/* how a row moves then */
static inline LinearNumber linear_slope(const Work *w, int row, int lane)
{
    LinearNumber out;

    out.value = tangents_root(w->along, row, lane, &out.error);
    return out;
}

/* --- linearize_point.c --- */

/* Solve for what follows from the state, and evaluate everything there; choose independent
 * coordinates. E_SINGULAR where equations are dependent, E_MODEL, E_VALUE. */
MUST_USE Status linear_point(Work *w, Diag *diag);
int linear_equation(const Work *w, int r); /* row of the r-th of the equations in use */
int linear_unknown(const Work *w, int k);  /* column of the k-th of what follows */
/* A coefficient of row r of them as it is beside the point: coefficients are moved as numbers are,
 * or what rounding leaves would be the same where none of the numbers is an unknown. */
double linear_moved(const Work *w, int r, int column, double value);
/* Complete v, whose independent entries are set: Phi_u v + right = 0 in the dependent ones. */
void linear_complete(const Work *w, const LinearNumber *right, LinearNumber *v);

/* Everything evaluated anew a little beside the point, by w->beside, for the same equations and
 * coordinates; false: it can't be. */
bool linear_perturbed(Work *w);

/* Whether coefficients of the mechanical equations change as it moves on from the point, whose
 * deviations `linear` tells of: what leaves them alone keeps the eigenvalues of A the same in all
 * coordinates. */
bool linear_is_passing(Work *w, const Linear *linear);

/* --- linearize_result.c --- */

/* New, all entries 0, names from the order and the system; linear_free(). */
Linear *linear_new(const Work *w);

/* --- linearize_columns.c --- */

/* All entries, with what each may be off by; at the point, or beside it. */
MUST_USE Status linear_columns(const Work *w, Linear *out, Diag *diag);

/* --- linearize_settle.c --- */

/* New: the equations at the point, what can't be distinguished from 0 there as 0; linear_free().
 * E_SINGULAR where they have no derivatives. */
MUST_USE Status linear_settled(Work *w, Linear **out, Diag *diag);

#endif

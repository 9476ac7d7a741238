/* siso.h: linear equations from one input to one output, and their resolvent
 *
 *     x' = A x + b u,   y = c x + d u
 *
 * Matrices are stored row by row. */
#ifndef COTREE_SIMULATE_ANALYSE_SISO_H
#define COTREE_SIMULATE_ANALYSE_SISO_H

#include "algebra/double_double.h"
#include "simulate/analyse/linear_equations.h"

typedef struct Siso {
    int n;
    double *a, *b, *c; /* n x n, n, n */
    double d;
    double *a_error, *b_error, *c_error; /* bounds of their errors */
    double d_error;
} Siso;

/* The states that are reachable from the input and affect the output, by the entries that aren't 0,
 * scaled by powers of 2 so that input, states and output balance. Free with siso_free(). */
Siso siso_new(const Linear *linear, int output, int input);
void siso_free(Siso *single);

/* c (s - A)^-1 b for any number of s, with A in Hessenberg form (Laub 1981). */
typedef struct Resolvent Resolvent;
Resolvent *resolvent_new(const DoubleDouble *a, const DoubleDouble *b, const DoubleDouble *c,
                         int n);           /* new; O(n^3) */
void resolvent_free(Resolvent *resolvent); /* NULL is fine */
/* Set s; false: s is an eigenvalue, and the smallest distinguishable difference replaces 0.
 * O(n^2) */
bool resolvent_at(Resolvent *resolvent, DoubleDoubleComplex s);
/* c (s - A)^-1 b; also its derivative by s, on request. O(n^2) */
DoubleDoubleComplex resolvent_value(Resolvent *resolvent);
DoubleDoubleComplex resolvent_slope(Resolvent *resolvent);
/* call after both: x = (s - A)^-1 b and y = (s - A)^-T c, rounded to double; O(n^2) */
void resolvent_vectors(const Resolvent *resolvent, double complex *x, double complex *y);

#endif

/* hessenberg_form.h: (s - A)^-1 b at many s, real and complex, in O(n^2) each
 *
 * A is balanced and brought to Hessenberg form once, D^-1 A D = Q H Q^T (Golub, Van Loan 2013, 7.4
 * and 7.5.7; Laub 1981); s - H has one diagonal below the main one, and elimination removes only
 * that. Matrices are stored row by row. */
#ifndef COTREE_ALGEBRA_HESSENBERG_FORM_H
#define COTREE_ALGEBRA_HESSENBERG_FORM_H

#include <stdbool.h>
#include <stddef.h>

/* the form of one matrix */
typedef struct HessenbergForm HessenbergForm;

/* New, of a (n x n, finite); free with hessenberg_form_free(). O(n^3). */
HessenbergForm *hessenberg_form_new(const double *a, int n);
void hessenberg_form_free(HessenbergForm *form);          /* NULL is fine */
size_t hessenberg_form_bytes(const HessenbergForm *form); /* of memory */

/* factors of s - A, and room to solve */
typedef struct ShiftedFactors ShiftedFactors;

/* New, for matrices of that size; free with shifted_factors_free(). */
ShiftedFactors *shifted_factors_new(int n);
void shifted_factors_free(ShiftedFactors *factors); /* NULL is fine */

/* Factor for a real s. False: singular. */
bool hessenberg_form_factor(const HessenbergForm *form, double s, ShiftedFactors *out);
/* Factor for s = re + i im. False: singular. */
bool hessenberg_form_factor_complex(const HessenbergForm *form, double re, double im,
                                    ShiftedFactors *out);
/* b becomes the solution. */
void hessenberg_form_solve(const HessenbergForm *form, ShiftedFactors *factors, double *b);
/* the same of b + i c, with factors of a complex s */
void hessenberg_form_solve_complex(const HessenbergForm *form, ShiftedFactors *factors, double *b,
                                   double *c);

#endif

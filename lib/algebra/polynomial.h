/* polynomial.h: polynomials over unbounded rationals (FLINT), as shapes of beams need them
 *
 * Products of the shape functions of a beam need a hundred bits at a dozen terms, and must not be
 * rounded before they become numbers of the simulation. Made between exact_open() and exact_close()
 * (base/exact_memory.h). */
#ifndef COTREE_ALGEBRA_POLYNOMIAL_H
#define COTREE_ALGEBRA_POLYNOMIAL_H

#include <flint/fmpq_poly.h>

/* orthogonal polynomials over 0..1; `out` is initialised, here and below */
void polynomial_legendre(int degree, fmpq_poly_t out);
void polynomial_chebyshev(int degree, fmpq_poly_t out);
/* of p q x^n from 0 to 1 */
void polynomial_integral(const fmpq_poly_t p, const fmpq_poly_t q, int n, fmpq_t out);
/* p's coefficients of Legendre's polynomials over 0..1, in the place of those of powers */
void polynomial_to_legendre(const fmpq_poly_t p, fmpq_poly_t out);
/* exact before it becomes a double */
double polynomial_value(const fmpq_poly_t p, double x);

#endif

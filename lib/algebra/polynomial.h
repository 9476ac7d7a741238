/* polynomial.h: polynomials whose coefficients are rationals without bounds (GMP)
 *
 * Products of the shape functions of a beam need a hundred bits at a dozen terms, and must not be
 * rounded before they become numbers of the simulation. */
#ifndef COTREE_ALGEBRA_POLYNOMIAL_H
#define COTREE_ALGEBRA_POLYNOMIAL_H

#include <gmp.h>

typedef struct Polynomial {
    int count; /* of coefficients, the constant first */
    mpq_t *at;
} Polynomial;

Polynomial polynomial_new(int count); /* zero */
void polynomial_free(Polynomial *p);
Polynomial polynomial_power(int n); /* x^n */
Polynomial polynomial_copy(const Polynomial *p);
Polynomial polynomial_times(const Polynomial *p, const Polynomial *q);
Polynomial polynomial_slope(const Polynomial *p);
Polynomial polynomial_primitive(const Polynomial *p); /* 0 at 0 */
/* of p q x^n from 0 to 1, into an initialised `out` */
void polynomial_integral(const Polynomial *p, const Polynomial *q, int n, mpq_t out);
/* its coefficients of Legendre's polynomials over 0..1, in the place of those of powers */
Polynomial legendre_of(const Polynomial *p);
/* with enough digits that cancellation loses none */
double polynomial_value(const Polynomial *p, double x);

#endif

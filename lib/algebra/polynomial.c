/* polynomial.c: polynomials over unbounded rationals */
#include "algebra/polynomial.h"

#include <gmp.h>

/* p(2 x - 1) */
static void move(fmpq_poly_t p)
{
    fmpq_poly_t z;

    fmpq_poly_init(z);
    fmpq_poly_set_coeff_si(z, 0, -1);
    fmpq_poly_set_coeff_si(z, 1, 2);
    fmpq_poly_compose(p, p, z);
    fmpq_poly_clear(z);
}

void polynomial_legendre(int degree, fmpq_poly_t out)
{
    fmpq_poly_legendre_p(out, (ulong)degree);
    move(out);
}

void polynomial_chebyshev(int degree, fmpq_poly_t out)
{
    fmpz_poly_t whole;

    fmpz_poly_init(whole);
    fmpz_poly_chebyshev_t(whole, (ulong)degree);
    fmpq_poly_set_fmpz_poly(out, whole);
    fmpz_poly_clear(whole);
    move(out);
}

void polynomial_integral(const fmpq_poly_t p, const fmpq_poly_t q, int n, fmpq_t out)
{
    fmpq_poly_t product;
    fmpz_t end;

    fmpq_poly_init(product);
    fmpz_init_set_ui(end, 1);
    fmpq_poly_mul(product, p, q);
    fmpq_poly_shift_left(product, product, n);
    fmpq_poly_integral(product, product);
    fmpq_poly_evaluate_fmpz(out, product, end);
    fmpz_clear(end);
    fmpq_poly_clear(product);
}

void polynomial_to_legendre(const fmpq_poly_t p, fmpq_poly_t out)
{
    fmpq_poly_t rest, legendre;
    fmpq_t factor, lead;

    fmpq_poly_init(rest);
    fmpq_poly_init(legendre);
    fmpq_init(factor);
    fmpq_init(lead);
    fmpq_poly_set(rest, p);
    fmpq_poly_zero(out);
    while (!fmpq_poly_is_zero(rest)) {
        const slong degree = fmpq_poly_degree(rest);

        polynomial_legendre((int)degree, legendre);
        fmpq_poly_get_coeff_fmpq(factor, rest, degree);
        fmpq_poly_get_coeff_fmpq(lead, legendre, degree);
        fmpq_div(factor, factor, lead);
        fmpq_poly_set_coeff_fmpq(out, degree, factor);
        fmpq_poly_scalar_mul_fmpq(legendre, legendre, factor);
        fmpq_poly_sub(rest, rest, legendre);
    }
    fmpq_clear(lead);
    fmpq_clear(factor);
    fmpq_poly_clear(legendre);
    fmpq_poly_clear(rest);
}

double polynomial_value(const fmpq_poly_t p, double x)
{
    fmpq_t at, sum;
    mpq_t exact;
    double value;

    fmpq_init(at);
    fmpq_init(sum);
    mpq_init(exact);
    mpq_set_d(exact, x);
    fmpq_set_mpq(at, exact);
    fmpq_poly_evaluate_fmpq(sum, p, at);
    value = fmpq_get_d(sum);
    mpq_clear(exact);
    fmpq_clear(sum);
    fmpq_clear(at);
    return value;
}

/* polynomial.c: polynomials over unbounded rationals */
#include "algebra/polynomial.h"

#include "base/memory.h"

enum { DIGITS = 512 }; /* bits: coefficients of 16 terms alternate and reach 60 bits */

Polynomial polynomial_new(int count)
{
    Polynomial p = {count, NEW_ARRAY(mpq_t, count > 0 ? count : 1)};

    for (int i = 0; i < count; i++)
        mpq_init(p.at[i]);
    return p;
}

void polynomial_free(Polynomial *p)
{
    for (int i = 0; i < p->count; i++)
        mpq_clear(p->at[i]);
    mem_free(p->at);
    *p = (Polynomial){0};
}

Polynomial polynomial_power(int n)
{
    Polynomial p = polynomial_new(n + 1);

    mpq_set_si(p.at[n], 1, 1);
    return p;
}

Polynomial polynomial_copy(const Polynomial *p)
{
    Polynomial copy = polynomial_new(p->count);

    for (int i = 0; i < p->count; i++)
        mpq_set(copy.at[i], p->at[i]);
    return copy;
}

Polynomial polynomial_times(const Polynomial *p, const Polynomial *q)
{
    Polynomial product = polynomial_new(p->count + q->count - 1);
    mpq_t term;

    mpq_init(term);
    for (int i = 0; i < p->count; i++)
        for (int j = 0; j < q->count; j++) {
            mpq_mul(term, p->at[i], q->at[j]);
            mpq_add(product.at[i + j], product.at[i + j], term);
        }
    mpq_clear(term);
    return product;
}

Polynomial polynomial_slope(const Polynomial *p)
{
    Polynomial slope = polynomial_new(p->count > 1 ? p->count - 1 : 1);
    mpq_t factor;

    mpq_init(factor);
    for (int i = 1; i < p->count; i++) {
        mpq_set_si(factor, i, 1);
        mpq_mul(slope.at[i - 1], p->at[i], factor);
    }
    mpq_clear(factor);
    return slope;
}

Polynomial polynomial_primitive(const Polynomial *p)
{
    Polynomial primitive = polynomial_new(p->count + 1);
    mpq_t factor;

    mpq_init(factor);
    for (int i = 0; i < p->count; i++) {
        mpq_set_si(factor, 1, (unsigned long)i + 1);
        mpq_mul(primitive.at[i + 1], p->at[i], factor);
    }
    mpq_clear(factor);
    return primitive;
}

void polynomial_integral(const Polynomial *p, const Polynomial *q, int n, mpq_t out)
{
    mpq_t term, factor;

    mpq_init(term);
    mpq_init(factor);
    mpq_set_si(out, 0, 1);
    for (int i = 0; i < p->count; i++)
        for (int j = 0; j < q->count; j++) {
            mpq_set_si(factor, 1, (unsigned long)(i + j + n) + 1);
            mpq_mul(term, p->at[i], q->at[j]);
            mpq_mul(term, term, factor);
            mpq_add(out, out, term);
        }
    mpq_clear(term);
    mpq_clear(factor);
}

/* x times a sum of Legendre's polynomials over 0..1, in place, which has room for one more:
 * x P_m = ((m + 1) P_(m+1) + m P_(m-1))/(4 m + 2) + P_m/2 */
static void legendre_shift(Polynomial *p)
{
    Polynomial own = polynomial_copy(p);
    mpq_t factor, term;

    mpq_init(factor);
    mpq_init(term);
    for (int m = 0; m < p->count; m++) {
        mpq_set_si(factor, 1, 2);
        mpq_mul(p->at[m], own.at[m], factor);
        for (int n = m - 1; n <= m + 1; n += 2) {
            if (n < 0 || n >= p->count)
                continue;
            mpq_set_si(factor, n < m ? m : m + 1, 4 * (unsigned long)n + 2);
            mpq_canonicalize(factor);
            mpq_mul(term, own.at[n], factor);
            mpq_add(p->at[m], p->at[m], term);
        }
    }
    mpq_clear(factor);
    mpq_clear(term);
    polynomial_free(&own);
}

Polynomial legendre_of(const Polynomial *p)
{
    Polynomial out = polynomial_new(p->count);

    for (int i = p->count - 1; i >= 0; i--) {
        legendre_shift(&out);
        mpq_add(out.at[0], out.at[0], p->at[i]);
    }
    return out;
}

double polynomial_value(const Polynomial *p, double x)
{
    mpf_t sum, at, term;
    double value;

    mpf_init2(sum, DIGITS);
    mpf_init2(term, DIGITS);
    mpf_init2(at, DIGITS);
    mpf_set_d(at, x);
    for (int i = p->count - 1; i >= 0; i--) {
        mpf_mul(sum, sum, at);
        mpf_set_q(term, p->at[i]);
        mpf_add(sum, sum, term);
    }
    value = mpf_get_d(sum);
    mpf_clears(sum, term, at, NULL);
    return value;
}

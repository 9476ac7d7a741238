/* double_double.h: numbers of twice the digits of a double, and complex ones of them
 *
 * A Wide is the sum of two doubles that don't overlap: some 31 digits in the range of a double.
 * Sums and products by Dekker (1971) and Knuth (1997), 4.2.2; Hida, Li and Bailey (2001). */
#ifndef COTREE_ALGEBRA_DOUBLE_DOUBLE_H
#define COTREE_ALGEBRA_DOUBLE_DOUBLE_H

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>

#define DOUBLE_DOUBLE_ROUNDING 0x1p-104 /* relative rounding error of an operation */

typedef struct DoubleDouble {
    double high, low;
} DoubleDouble;

static inline DoubleDouble dd_of(double x)
{
    return (DoubleDouble){x, 0};
}

static inline DoubleDouble dd_sum(double a, double b) /* exact */
{
    const double sum = a + b, other = sum - a;

    return (DoubleDouble){sum, (a - (sum - other)) + (b - other)};
}

static inline DoubleDouble dd_product(double a, double b) /* exact up to 1e290 */
{
    const double split = 134217729; /* 2^27 + 1 (Veltkamp) */
    const double p = a * b, at = split * a, bt = split * b;
    const double ah = at - (at - a), bh = bt - (bt - b), al = a - ah, bl = b - bh;

    return (DoubleDouble){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

static inline DoubleDouble dd_tidy(double high, double low)
{
    const double sum = high + low;

    return (DoubleDouble){sum, low - (sum - high)};
}

static inline DoubleDouble dd_neg(DoubleDouble a)
{
    return (DoubleDouble){-a.high, -a.low};
}

static inline DoubleDouble dd_add(DoubleDouble a, DoubleDouble b)
{
    DoubleDouble s = dd_sum(a.high, b.high), t = dd_sum(a.low, b.low);

    s = dd_tidy(s.high, s.low + t.high);
    return dd_tidy(s.high, s.low + t.low);
}

static inline DoubleDouble dd_sub(DoubleDouble a, DoubleDouble b)
{
    return dd_add(a, dd_neg(b));
}

static inline DoubleDouble dd_mul(DoubleDouble a, DoubleDouble b)
{
    const DoubleDouble p = dd_product(a.high, b.high);

    return dd_tidy(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static inline DoubleDouble dd_times(DoubleDouble a, double b)
{
    return dd_mul(a, dd_of(b));
}

static inline DoubleDouble dd_div(DoubleDouble a, DoubleDouble b)
{
    const double first = a.high / b.high;
    const DoubleDouble left = dd_sub(a, dd_times(b, first));
    const double second = left.high / b.high;
    const double third = dd_sub(left, dd_times(b, second)).high / b.high;

    return dd_add(dd_tidy(first, second), dd_of(third));
}

static inline DoubleDouble dd_sqrt(DoubleDouble a)
{
    const double root = sqrt(a.high);

    if (!(root > 0))
        return dd_of(0);
    return dd_add(dd_of(root), dd_of(dd_sub(a, dd_product(root, root)).high / (2 * root)));
}

static inline double dd_double(DoubleDouble a)
{
    return a.high + a.low;
}

/* --- complex --- */

typedef struct DoubleDoubleComplex {
    DoubleDouble re, im;
} DoubleDoubleComplex;

static inline DoubleDoubleComplex dd_complex(DoubleDouble re, DoubleDouble im)
{
    return (DoubleDoubleComplex){re, im};
}

static inline DoubleDoubleComplex dd_real(DoubleDouble re)
{
    return (DoubleDoubleComplex){re, dd_of(0)};
}

static inline DoubleDoubleComplex dd_from(double complex z)
{
    return (DoubleDoubleComplex){dd_of(creal(z)), dd_of(cimag(z))};
}

static inline double complex dd_to(DoubleDoubleComplex a)
{
    return CMPLX(dd_double(a.re), dd_double(a.im));
}

static inline DoubleDoubleComplex dd_cneg(DoubleDoubleComplex a)
{
    return (DoubleDoubleComplex){dd_neg(a.re), dd_neg(a.im)};
}

static inline DoubleDoubleComplex dd_conj(DoubleDoubleComplex a)
{
    return (DoubleDoubleComplex){a.re, dd_neg(a.im)};
}

static inline DoubleDoubleComplex dd_cadd(DoubleDoubleComplex a, DoubleDoubleComplex b)
{
    return (DoubleDoubleComplex){dd_add(a.re, b.re), dd_add(a.im, b.im)};
}

static inline DoubleDoubleComplex dd_csub(DoubleDoubleComplex a, DoubleDoubleComplex b)
{
    return (DoubleDoubleComplex){dd_sub(a.re, b.re), dd_sub(a.im, b.im)};
}

static inline DoubleDoubleComplex dd_cmul(DoubleDoubleComplex a, DoubleDoubleComplex b)
{
    return (DoubleDoubleComplex){dd_sub(dd_mul(a.re, b.re), dd_mul(a.im, b.im)),
                                 dd_add(dd_mul(a.re, b.im), dd_mul(a.im, b.re))};
}

static inline DoubleDoubleComplex dd_ctimes(DoubleDoubleComplex a, DoubleDouble b)
{
    return (DoubleDoubleComplex){dd_mul(a.re, b), dd_mul(a.im, b)};
}

/* the larger of both parts in size: within a factor of sqrt(2) of the absolute value */
static inline double dd_size(DoubleDoubleComplex a)
{
    return fmax(fabs(a.re.high), fabs(a.im.high));
}

static inline DoubleDoubleComplex dd_cdiv(DoubleDoubleComplex a, DoubleDoubleComplex b)
{
    const double size = dd_size(b); /* of a scaled b squares are in range */
    const double scale = size >= DBL_MIN && isfinite(size) ? ldexp(1, -ilogb(size)) : 1;
    const DoubleDoubleComplex c = dd_ctimes(b, dd_of(scale));
    const DoubleDouble square = dd_add(dd_mul(c.re, c.re), dd_mul(c.im, c.im));
    const DoubleDoubleComplex top = dd_ctimes(dd_cmul(a, dd_conj(c)), dd_of(scale));

    return (DoubleDoubleComplex){dd_div(top.re, square), dd_div(top.im, square)};
}

static inline DoubleDoubleComplex dd_csqrt(DoubleDoubleComplex a)
{
    const DoubleDoubleComplex root = dd_from(csqrt(dd_to(a)));

    if (dd_size(root) == 0)
        return root;
    return dd_ctimes(dd_cadd(root, dd_cdiv(a, root)), dd_of(0.5));
}

#endif

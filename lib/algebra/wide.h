/* wide.h: numbers of twice the digits of a double, and complex ones of them
 *
 * A Wide is the sum of two doubles that don't overlap: some 31 digits in the range of a double.
 * Sums and products by Dekker (1971) and Knuth (1997), 4.2.2; Hida, Li and Bailey (2001). */
#ifndef COTREE_ALGEBRA_WIDE_H
#define COTREE_ALGEBRA_WIDE_H

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>

#define WIDE_UNIT 0x1p-104 /* what an operation rounds away, relative */

typedef struct Wide {
    double high, low;
} Wide;

static inline Wide wide_of(double x)
{
    return (Wide){x, 0};
}

static inline Wide wide_sum(double a, double b) /* exact */
{
    const double sum = a + b, other = sum - a;

    return (Wide){sum, (a - (sum - other)) + (b - other)};
}

static inline Wide wide_product(double a, double b) /* exact up to 1e290 */
{
    const double split = 134217729; /* 2^27 + 1 (Veltkamp) */
    const double p = a * b, at = split * a, bt = split * b;
    const double ah = at - (at - a), bh = bt - (bt - b), al = a - ah, bl = b - bh;

    return (Wide){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

static inline Wide wide_tidy(double high, double low)
{
    const double sum = high + low;

    return (Wide){sum, low - (sum - high)};
}

static inline Wide wide_neg(Wide a)
{
    return (Wide){-a.high, -a.low};
}

static inline Wide wide_add(Wide a, Wide b)
{
    Wide s = wide_sum(a.high, b.high), t = wide_sum(a.low, b.low);

    s = wide_tidy(s.high, s.low + t.high);
    return wide_tidy(s.high, s.low + t.low);
}

static inline Wide wide_sub(Wide a, Wide b)
{
    return wide_add(a, wide_neg(b));
}

static inline Wide wide_mul(Wide a, Wide b)
{
    const Wide p = wide_product(a.high, b.high);

    return wide_tidy(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static inline Wide wide_times(Wide a, double b)
{
    return wide_mul(a, wide_of(b));
}

static inline Wide wide_div(Wide a, Wide b)
{
    const double first = a.high / b.high;
    const Wide left = wide_sub(a, wide_times(b, first));
    const double second = left.high / b.high;
    const double third = wide_sub(left, wide_times(b, second)).high / b.high;

    return wide_add(wide_tidy(first, second), wide_of(third));
}

static inline Wide wide_sqrt(Wide a)
{
    const double root = sqrt(a.high);

    if (!(root > 0))
        return wide_of(0);
    return wide_add(wide_of(root),
                    wide_of(wide_sub(a, wide_product(root, root)).high / (2 * root)));
}

static inline double wide_double(Wide a)
{
    return a.high + a.low;
}

/* --- complex --- */

typedef struct WideComplex {
    Wide re, im;
} WideComplex;

static inline WideComplex wide_complex(Wide re, Wide im)
{
    return (WideComplex){re, im};
}

static inline WideComplex wide_real(Wide re)
{
    return (WideComplex){re, wide_of(0)};
}

static inline WideComplex wide_from(double complex z)
{
    return (WideComplex){wide_of(creal(z)), wide_of(cimag(z))};
}

static inline double complex wide_to(WideComplex a)
{
    return CMPLX(wide_double(a.re), wide_double(a.im));
}

static inline WideComplex wide_cneg(WideComplex a)
{
    return (WideComplex){wide_neg(a.re), wide_neg(a.im)};
}

static inline WideComplex wide_conj(WideComplex a)
{
    return (WideComplex){a.re, wide_neg(a.im)};
}

static inline WideComplex wide_cadd(WideComplex a, WideComplex b)
{
    return (WideComplex){wide_add(a.re, b.re), wide_add(a.im, b.im)};
}

static inline WideComplex wide_csub(WideComplex a, WideComplex b)
{
    return (WideComplex){wide_sub(a.re, b.re), wide_sub(a.im, b.im)};
}

static inline WideComplex wide_cmul(WideComplex a, WideComplex b)
{
    return (WideComplex){wide_sub(wide_mul(a.re, b.re), wide_mul(a.im, b.im)),
                         wide_add(wide_mul(a.re, b.im), wide_mul(a.im, b.re))};
}

static inline WideComplex wide_ctimes(WideComplex a, Wide b)
{
    return (WideComplex){wide_mul(a.re, b), wide_mul(a.im, b)};
}

/* the larger of both parts in size: within a factor of sqrt(2) of the absolute value */
static inline double wide_size(WideComplex a)
{
    return fmax(fabs(a.re.high), fabs(a.im.high));
}

static inline WideComplex wide_cdiv(WideComplex a, WideComplex b)
{
    const double size = wide_size(b); /* of a scaled b squares are in range */
    const double scale = size >= DBL_MIN && isfinite(size) ? ldexp(1, -ilogb(size)) : 1;
    const WideComplex c = wide_ctimes(b, wide_of(scale));
    const Wide square = wide_add(wide_mul(c.re, c.re), wide_mul(c.im, c.im));
    const WideComplex top = wide_ctimes(wide_cmul(a, wide_conj(c)), wide_of(scale));

    return (WideComplex){wide_div(top.re, square), wide_div(top.im, square)};
}

static inline WideComplex wide_csqrt(WideComplex a)
{
    const WideComplex root = wide_from(csqrt(wide_to(a)));

    if (wide_size(root) == 0)
        return root;
    return wide_ctimes(wide_cadd(root, wide_cdiv(a, root)), wide_of(0.5));
}

#endif

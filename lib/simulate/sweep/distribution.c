/* distribution.c: normal, uniform, lognormal, triangular
 *
 * A truncated distribution is that of its values between the bounds: with the distribution function
 * F, x = F^-1(F(low) + u (F(high) - F(low))). Beyond the median the complement 1 - F takes its
 * place, which keeps the digits of a far tail. */
#include "simulate/sweep/distribution.h"

#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* share below x, or above it, and the inverses of both */
typedef struct DistributionRow {
    const char *name;
    int count;
    const char *arguments;
    const char *(*fault)(const double *at); /* NULL: none */
    double (*share)(const double *at, double x, bool above);
    double (*inverse)(const double *at, double share, bool above);
} DistributionRow;

/* --- normal --- */

static const char *check_normal(const double *at)
{
    return at[1] > 0 ? NULL : "the deviation has to be above 0";
}

static double normal_share(const double *at, double x, bool above)
{
    return above ? gsl_cdf_gaussian_Q(x - at[0], at[1]) : gsl_cdf_gaussian_P(x - at[0], at[1]);
}

static double normal_inverse(const double *at, double share, bool above)
{
    return at[0] +
           (above ? gsl_cdf_gaussian_Qinv(share, at[1]) : gsl_cdf_gaussian_Pinv(share, at[1]));
}

/* --- uniform --- */

static const char *check_uniform(const double *at)
{
    return at[1] > at[0] ? NULL : "the second bound has to be above the first";
}

static double uniform_share(const double *at, double x, bool above)
{
    const double share = fmin(fmax((x - at[0]) / (at[1] - at[0]), 0), 1);

    return above ? 1 - share : share;
}

static double uniform_inverse(const double *at, double share, bool above)
{
    const double u = above ? 1 - share : share;

    return at[0] * (1 - u) + at[1] * u;
}

/* --- lognormal: of the mean m and the deviation s of the value itself --- */

static const char *check_lognormal(const double *at)
{
    return !(at[0] > 0)   ? "the mean has to be above 0"
           : !(at[1] > 0) ? "the deviation has to be above 0"
                          : NULL;
}

/* mean and deviation of its logarithm: sigma^2 = ln(1 + s^2/m^2), mu = ln m - sigma^2/2 */
static void logarithm_of(const double *at, double out[2])
{
    const double variance = log1p(at[1] / at[0] * (at[1] / at[0]));

    out[0] = log(at[0]) - variance / 2;
    out[1] = sqrt(variance);
}

static double lognormal_share(const double *at, double x, bool above)
{
    double of[2];

    logarithm_of(at, of);
    return x > 0 ? normal_share(of, log(x), above) : above ? 1 : 0;
}

static double lognormal_inverse(const double *at, double share, bool above)
{
    double of[2];

    logarithm_of(at, of);
    return exp(normal_inverse(of, share, above));
}

/* --- triangular: a, mode c, b --- */

static const char *check_triangular(const double *at)
{
    return at[0] <= at[1] && at[1] <= at[2] && at[0] < at[2] ? NULL : "they rise: low, mode, high";
}

static double triangular_share(const double *at, double x, bool above)
{
    const double a = at[0], c = at[1], b = at[2];
    double below, over; /* both without cancellation where they are small */

    x = fmin(fmax(x, a), b);
    below = x < c ? (x - a) * (x - a) / ((b - a) * (c - a)) : NAN;
    over = x >= c && x < b ? (b - x) * (b - x) / ((b - a) * (b - c)) : x < c ? 1 - below : 0;
    return above ? over : x < c ? below : 1 - over;
}

static double triangular_inverse(const double *at, double share, bool above)
{
    const double a = at[0], c = at[1], b = at[2];
    const double below = above ? 1 - share : share, over = above ? share : 1 - share;

    return below * (b - a) < c - a ? a + sqrt(below * (b - a) * (c - a))
                                   : b - sqrt(over * (b - a) * (b - c));
}

/* --- the table --- */

/* clang-format off */
static const DistributionRow rows[] = {
    {"normal",     2, "MEAN, DEVIATION", check_normal,     normal_share,     normal_inverse},
    {"uniform",    2, "LOW, HIGH",       check_uniform,    uniform_share,    uniform_inverse},
    {"lognormal",  2, "MEAN, DEVIATION", check_lognormal,  lognormal_share,  lognormal_inverse},
    {"triangular", 3, "LOW, MODE, HIGH", check_triangular, triangular_share, triangular_inverse},
};
/* clang-format on */

enum { ROWS = (int)(sizeof rows / sizeof rows[0]) };

int distribution_find(const char *name)
{
    for (int i = 0; i < ROWS; i++)
        if (strcmp(rows[i].name, name) == 0)
            return i;
    return -1;
}

const char *distribution_name(int kind)
{
    return kind < ROWS ? rows[kind].name : NULL;
}

const char *distribution_arguments(int kind)
{
    return rows[kind].arguments;
}

int distribution_argument_count(int kind)
{
    return rows[kind].count;
}

static bool is_truncated(const Distribution *d)
{
    return d->low > -INFINITY || d->high < INFINITY;
}

/* the share between the bounds, from that side of the median where it keeps its digits */
static double share_between(const Distribution *d, bool above, double *outside)
{
    const DistributionRow *row = &rows[d->kind];
    const double low = row->share(d->at, d->low, above), high = row->share(d->at, d->high, above);

    *outside = above ? high : low;
    return above ? low - high : high - low;
}

/* whether the lower bound is above the median */
static bool is_above(const Distribution *d)
{
    return rows[d->kind].share(d->at, d->low, false) > 0.5;
}

Status distribution_check(const Distribution *d, Diag *diag)
{
    const DistributionRow *row = &rows[d->kind];
    const char *fault;
    double outside;

    for (int i = 0; i < row->count; i++)
        if (!isfinite(d->at[i]))
            return diag_set(diag, E_VALUE, "%s takes finite numbers", row->name);
    fault = row->fault(d->at);
    if (fault != NULL) {
        (void)diag_set(diag, E_VALUE, "%s: %s", row->name, fault);
        diag_hint(diag, "its arguments: %s(%s)", row->name, row->arguments);
        return E_VALUE;
    }
    if (!is_truncated(d))
        return OK;
    if (!(d->low < d->high)) {
        (void)diag_set(diag, E_VALUE, "the upper bound of truncated has to be above the lower one");
        diag_hint(diag, "truncated(%s(%s), LOW, HIGH)", row->name, row->arguments);
        return E_VALUE;
    }
    if (!(share_between(d, is_above(d), &outside) > 0))
        return diag_set(diag, E_VALUE, "%s has no values between %g and %g", row->name, d->low,
                        d->high);
    return OK;
}

double distribution_quantile(const Distribution *d, double u)
{
    const DistributionRow *row = &rows[d->kind];
    double outside, inside;
    bool above;

    if (!is_truncated(d))
        return u > 0.5 ? row->inverse(d->at, 1 - u, true) : row->inverse(d->at, u, false);
    above = is_above(d);
    inside = share_between(d, above, &outside);
    return fmin(fmax(row->inverse(d->at, outside + (above ? 1 - u : u) * inside, above), d->low),
                d->high);
}

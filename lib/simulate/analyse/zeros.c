/* zeros.c: zeros of one output for one input
 *
 * The steps are repeated until one of d, c b, c A b ... isn't 0, which is the gain (gain.h):
 * Householder's reflection turns the output into one state, which is then 0; its rate replaces the
 * output, and the state is removed. Zeros are the eigenvalues of the remaining A - b d^-1 c
 * (Emami-Naeini and Van Dooren 1982). They are enclosed in double precision (enclosure.h); or else
 * the matrix is perturbed a little so that multiple ones split, and single ones are refined to H(z)
 * = 0 by Newton's method. The error of a zero z is (|dH(z)| + |H(z)|)/|H'(z)|, or the bound from
 * its null vectors if that is less (zero_pencil.h). For a zero of multiplicity m it is the m-th
 * root of m s^(m-1) times that, where s is the distance of a split one from the mean. */
#include "simulate/analyse/zeros.h"

#include "algebra/algebra_limits.h"
#include "algebra/enclosure.h"
#include "algebra/schur.h"
#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/analyse/zero_pencil.h"

#include <stdlib.h>
#include <string.h>

enum {
    MOST_STEPS = 6,
    PLACES = 3 /* points of the check against the response: by sizes of roots */
};

/* in double-double */
typedef struct Wider {
    int n, stride;
    DoubleDouble *a, *b, *c;
    DoubleDouble d;
} Wider;

/* --- removal of one state --- */

/* Reflect the states so that c = [0 .. 0 r]. */
static void turn_output(Wider *s)
{
    const int n = s->n;
    DoubleDouble *v = NEW_ARRAY(DoubleDouble, n), square = dd_of(0), norm, beta;
    double largest = 0;

    for (int i = 0; i < n; i++)
        largest = fmax(largest, fabs(s->c[i].high));
    for (int i = 0; i < n && largest > 0; i++) {
        v[i] = dd_times(s->c[i], ldexp(1, -ilogb(largest)));
        square = dd_add(square, dd_mul(v[i], v[i]));
    }
    norm = dd_sqrt(square);
    if (v[n - 1].high < 0)
        norm = dd_neg(norm);
    /* v^T v = 2 norm (norm + v_n) */
    beta = dd_mul(norm, dd_add(norm, v[n - 1]));
    v[n - 1] = dd_add(v[n - 1], norm);
    if (beta.high > 0) {
        beta = dd_div(dd_of(1), beta);
        for (int i = 0; i < n; i++)
            dd_reflect(s->a + (ptrdiff_t)i * s->stride, n, 1, 0, v, beta);
        for (int j = 0; j < n; j++)
            dd_reflect(s->a + j, n, s->stride, 0, v, beta);
        dd_reflect(s->b, n, 1, 0, v, beta);
    }
    mem_free(v);
}

/* the last state is 0, its rate is the new output */
static void drop_last(Wider *s)
{
    const int n = --s->n;

    s->d = s->b[n];
    for (int j = 0; j < n; j++)
        s->c[j] = s->a[n * s->stride + j];
}

static double nearest_of(const double complex *value, int count, int k)
{
    double nearest = INFINITY;

    for (int i = 0; i < count; i++)
        if (i != k)
            nearest = fmin(nearest, cabs(value[i] - value[k]));
    return nearest;
}

/* Eigenvalues that double precision separates, accurate to rounding or enough for Newton's method;
 * false: there are others. */
static bool enclosed_values(const DoubleDouble *a, int n, double complex *value)
{
    Enclosure e;
    bool sound = enclosure_find(a, n, &e);

    for (int k = 0; k < n && sound; k++) {
        value[k] = e.value[k];
        sound = e.error[k] <= ZERO_DOUBLE * UNIT_ROUNDOFF * cabs(e.value[k]) ||
                e.error[k] <= ZERO_APART * nearest_of(e.value, n, k);
    }
    enclosure_free(&e);
    return sound;
}

/* with a perturbed by rounding */
static bool disturbed_values(DoubleDouble *a, int n, double complex *value)
{
    DoubleDoubleComplex *t = NEW_ARRAY(DoubleDoubleComplex, n * n);
    bool sound;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] = dd_add(a[i * n + j],
                                  dd_product(a[i * n + j].high, UNIT_ROUNDOFF * disturbance(i, j)));
    sound = schur(a, n, t, NULL);
    for (int i = 0; i < n; i++)
        value[i] = dd_to(t[i * n + i]);
    mem_free(t);
    return sound;
}

static double complex *reduced_roots(const Wider *s)
{
    const int n = s->n;
    double complex *value = mem_array((size_t)n, sizeof *value);
    DoubleDouble *a = NEW_ARRAY(DoubleDouble, n * n);
    double *size = NEW_ARRAY(double, n *n), *scale = NEW_ARRAY(double, n);

    for (int i = 0; i < n; i++) {
        const DoubleDouble factor = dd_div(s->b[i], s->d);

        for (int j = 0; j < n; j++) {
            DoubleDouble *entry = &a[i * n + j];

            *entry = dd_sub(s->a[i * s->stride + j], dd_mul(factor, s->c[j]));
            size[i * n + j] = fabs(entry->high);
        }
    }
    matrix_balance(size, n, scale);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            a[i * n + j] = dd_times(a[i * n + j], scale[i] / scale[j]);
    if (!enclosed_values(a, n, value) && !disturbed_values(a, n, value)) {
        mem_free(value);
        value = NULL;
    }
    MEM_FREE(a, size, scale);
    return value;
}

/* --- errors --- */

/* H at a point, with its vectors */
typedef struct ZerosTrial {
    const Siso *s;
    const Wider *wide;
    Resolvent *resolvent;
    double complex *x, *y; /* (z - A)^-1 b, (z - A)^-T c */
    double *x_size;        /* of x's entries */
    double complex value, slope;
    double error; /* bound of the value's error */
    double least; /* least scale: that of the smallest pole that isn't 0 */
} ZerosTrial;

static ZerosTrial trial_new(const Siso *s, const Wider *wide)
{
    return (ZerosTrial){.s = s,
                        .wide = wide,
                        .resolvent = resolvent_new(wide->a, wide->b, wide->c, s->n),
                        .x = mem_array((size_t)s->n, sizeof(double complex)),
                        .y = mem_array((size_t)s->n, sizeof(double complex)),
                        .x_size = NEW_ARRAY(double, s->n)};
}

static void trial_free(ZerosTrial *at)
{
    resolvent_free(at->resolvent);
    MEM_FREE(at->x, at->y, at->x_size);
}

static double least_error(double value, double error)
{
    return fmax(error, UNIT_ROUNDOFF * fabs(value));
}

/* |dH|: |y|^T |dA| |x| + |y|^T |db| + |dc| |x| + |dd| */
static double value_error(const ZerosTrial *at)
{
    const Siso *s = at->s;
    const int n = s->n;
    double sum = least_error(s->d, s->d_error);

    for (int i = 0; i < n; i++)
        at->x_size[i] = cabs(at->x[i]);
    for (int i = 0; i < n; i++) {
        double size = least_error(s->b[i], s->b_error[i]);

        for (int j = 0; j < n; j++)
            size += least_error(s->a[i * n + j], s->a_error[i * n + j]) * at->x_size[j];
        sum += cabs(at->y[i]) * size + least_error(s->c[i], s->c_error[i]) * at->x_size[i];
    }
    return sum;
}

/* the rounding error of the method, which starts from the whole scaled matrices */
static double method_error(const ZerosTrial *at)
{
    const Siso *s = at->s;
    const int n = s->n;
    double norm = fabs(s->d), right = 1, left = 1;

    for (int i = 0; i < n; i++) {
        norm = fmax(norm, fmax(fabs(s->b[i]), fabs(s->c[i])));
        for (int j = 0; j < n; j++)
            norm = fmax(norm, fabs(s->a[i * n + j]));
        right += cabs(at->x[i]);
        left += cabs(at->y[i]);
    }
    return n * DOUBLE_DOUBLE_ROUNDING * norm * right * left;
}

static void go_to(ZerosTrial *at, double complex z)
{
    (void)resolvent_at(at->resolvent, dd_from(z));
    at->value = dd_to(dd_cadd(resolvent_value(at->resolvent), dd_real(at->wide->d)));
    at->slope = dd_to(resolvent_slope(at->resolvent));
    resolvent_vectors(at->resolvent, at->x, at->y);
    at->error = value_error(at);
}

/* Where double precision doesn't show how equal ones split: on a circle, of their size or the least
 * pole's. */
static double complex split_of(const double complex *first, int count, int k, double least)
{
    const double size = fmax(cabs(first[k]), least);
    int equal = 0, before = 0;
    double angle;

    for (int i = 0; i < count; i++)
        if (cabs(first[i] - first[k]) <= ZERO_SPLIT * ZERO_SPLIT * size) {
            equal++;
            before += i < k;
        }
    angle = 2 * M_PI * before / equal;
    return equal > 1 ? ZERO_SPLIT * size * cexp(I * (cimag(first[k]) < 0 ? -angle : angle)) : 0;
}

/* Newton's method where others are far; returns the error afterwards */
static double improve(ZerosTrial *at, const double complex *first, double complex *value, int count,
                      int k)
{
    const double nearest = nearest_of(first, count, k);
    double noise, error;

    value[k] += split_of(first, count, k, at->least);
    go_to(at, value[k]);
    for (int step = 0; step < MOST_STEPS; step++) {
        const double complex by = at->value / at->slope;

        if (!(cabs(by) <= ZERO_ALONE * nearest) || cabs(at->value) <= ZERO_REACHED * at->error ||
            cabs(by) <= UNIT_ROUNDOFF * cabs(value[k]))
            break;
        value[k] -= cimag(value[k]) == 0 ? creal(by) : by;
        go_to(at, value[k]);
    }
    if (at->slope == 0)
        return INFINITY;
    noise = method_error(at) / cabs(at->slope);
    error = at->error / cabs(at->slope);
    value[k] = root_with_noise(value[k], noise, &error);
    return error > 0 ? error + cabs(at->value / at->slope) : 0;
}

/* The value as found first, if its bound is smaller and others are far: where it nearly equals a
 * pole, and where it is so far beyond all poles that H there is rounding error. */
static void take_from_pencil(const Siso *s, const double complex *first, int count, int k,
                             double complex *value, double *error)
{
    const double by_pencil = zero_pencil_error(s, first[k]);
    const bool is_lost = *value == 0 && by_pencil <= ZERO_ALONE * cabs(first[k]);

    if ((by_pencil < *error || is_lost) && by_pencil <= ZERO_ALONE * nearest_of(first, count, k)) {
        *value = first[k];
        *error = by_pencil;
    }
}

typedef struct Split {
    const double complex *value;
    const double *error;
} Split;

static double group_error(void *context, const int *members, int count, double complex mean)
{
    const Split *split = context;
    double largest = 0;

    for (int k = 0; k < count; k++) {
        const double off = cabs(split->value[members[k]] - mean);

        largest =
            fmax(largest, pow(count * split->error[members[k]] * pow(off, count - 1), 1.0 / count));
    }
    return largest;
}

static void bound_zeros(const Siso *s, const Wider *wide, double least, double complex *value,
                        int count, Root *zero)
{
    ZerosTrial at = trial_new(s, wide);
    double complex *first = mem_array((size_t)count, sizeof *first);
    double *error = NEW_ARRAY(double, count);
    Split split = {value, error};

    at.least = least;
    memcpy(first, value, (size_t)count * sizeof *first);
    for (int k = 0; k < count; k++) {
        /* one of a pair determines the other, unless they are about equal and have to split */
        if (k > 0 && -cimag(first[k]) > ZERO_SPLIT * cabs(first[k]) &&
            first[k] == conj(first[k - 1])) {
            value[k] = conj(value[k - 1]);
            error[k] = error[k - 1];
        } else {
            error[k] = improve(&at, first, value, count, k);
            if (!(error[k] <= ZERO_RELIABLE * cabs(first[k])) || value[k] == 0)
                take_from_pencil(s, first, count, k, &value[k], &error[k]);
        }
    }
    roots_join(value, error, count, group_error, &split, zero);
    trial_free(&at);
    MEM_FREE(first, error);
}

/* --- zeros --- */

static Wider wider_new(int n)
{
    return (Wider){n,
                   n,
                   NEW_ARRAY(DoubleDouble, n * n),
                   NEW_ARRAY(DoubleDouble, n),
                   NEW_ARRAY(DoubleDouble, n),
                   {0, 0}};
}

static void wider_free(Wider *wider)
{
    MEM_FREE(wider->a, wider->b, wider->c);
}

static void widen(const Siso *s, Wider *out)
{
    for (int i = 0; i < s->n; i++) {
        out->b[i] = dd_of(s->b[i]);
        out->c[i] = dd_of(s->c[i]);
        for (int j = 0; j < s->n; j++)
            out->a[i * s->n + j] = dd_of(s->a[i * s->n + j]);
    }
    out->d = dd_of(s->d);
}

static double least_of(const Root *root, int count)
{
    double least = 0;

    for (int i = 0; i < count; i++) {
        const double size = hypot(root[i].real, root[i].imaginary);

        least = size > 0 && (least == 0 || size < least) ? size : least;
    }
    return least > 0 ? least : 1;
}

bool zeros_find(const Siso *single, const Gain *gain, const Root *pole, Root *zero, int *count)
{
    const int n = single->n;
    Wider whole = wider_new(n), left = wider_new(n);
    double complex *value = NULL;
    bool sound = true;

    *count = gain->value != 0 ? n - gain->degree : 0;
    if (*count > 0) {
        widen(single, &whole);
        widen(single, &left);
        for (int k = 0; k < gain->degree; k++) {
            turn_output(&left);
            drop_last(&left);
        }
        value = reduced_roots(&left);
        sound = value != NULL;
    }
    if (sound && *count > 0)
        bound_zeros(single, &whole, least_of(pole, n), value, *count, zero);
    for (int k = 0; k < *count && sound; k++)
        sound = isfinite(zero[k].real) && isfinite(zero[k].imaginary);
    wider_free(&whole);
    wider_free(&left);
    mem_free(value);
    return sound;
}

/* --- check of the whole answer --- */

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* log of prod(z - root), and a bound of its error */
static double complex log_product(const Root *root, int count, double complex z, double *error)
{
    double complex sum = 0;

    for (int i = 0; i < count; i++) {
        const double complex by = z - CMPLX(root[i].real, root[i].imaginary);

        sum += clog(by);
        *error += root[i].error / cabs(by);
    }
    return sum;
}

/* at one point */
static bool agrees_at(ZerosTrial *at, const Answer *a, double complex z, double *largest)
{
    double error = 0, open;
    double complex log = log_product(a->zero, a->zeros, z, &error), product = 0;

    log -= log_product(a->pole, at->s->n, z, &error);
    if (a->gain->value != 0)
        product = cexp(log + clog(a->gain->value));
    go_to(at, z);
    open = at->error + method_error(at);
    if (isfinite(cabs(at->value) + open))
        *largest = fmax(*largest, cabs(at->value) + open);
    /* a value with a large error is not checked */
    return !(error < ZERO_ALONE) || !isfinite(cabs(product)) || !isfinite(cabs(at->value)) ||
           cabs(at->value - product) <=
               RESPONSE_SAME * cabs(at->value) + 2 * error * cabs(product) + open;
}

bool zeros_agree(const Siso *single, const Answer *answer, double *largest)
{
    const int n = single->n;
    Wider whole = wider_new(n);
    double *size = NEW_ARRAY(double, n + answer->zeros);
    bool agrees = true;
    int count = 0;
    ZerosTrial at;

    *largest = 0;
    for (int i = 0; i < n + answer->zeros; i++) {
        const Root *root = i < n ? &answer->pole[i] : &answer->zero[i - n];

        size[count] = hypot(root->real, root->imaginary);
        count += size[count] > 0;
    }
    qsort(size, (size_t)count, sizeof *size, by_value);
    widen(single, &whole);
    at = trial_new(single, &whole);
    for (int k = 0; k < PLACES && agrees; k++) {
        const double about = count == 0 ? 1 : size[k * (count - 1) / (PLACES - 1)];

        agrees = agrees_at(&at, answer, about * cexp(I * RESPONSE_ANGLE), largest);
    }
    trial_free(&at);
    wider_free(&whole);
    mem_free(size);
    return agrees;
}

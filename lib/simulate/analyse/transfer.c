/* transfer.c: poles, zeros and gain of one output for one input; frequency response
 *
 * States on no path from the input to the output are omitted first, by the entries of A, B, C that
 * aren't 0. Poles are eigenvalues of the rest (spectrum.h); for zeros see zeros.h. The response is
 * solved for at each frequency; roots only determine the turns of its phase. */
#include "simulate/analyse/transfer.h"

#include "base/memory.h"
#include "simulate/analyse/analyse_limits.h"
#include "simulate/analyse/siso.h"
#include "simulate/analyse/zeros.h"

#include <math.h>
#include <stdlib.h>

static const double LEAST_RESPONSE = 1e-200, MOST_RESPONSE = 1e200;

/* --- roots --- */

static double size_of(Root root)
{
    return hypot(root.real, root.imaginary);
}

static int by_size(const void *a, const void *b)
{
    const Root *x = a, *y = b;
    if (size_of(*x) != size_of(*y))
        return size_of(*x) < size_of(*y) ? -1 : 1;
    if (x->real != y->real)
        return x->real > y->real ? -1 : 1;
    return (x->imaginary < y->imaginary) - (x->imaginary > y->imaginary);
}

static void sort(Root *roots, int count)
{
    if (count > 0)
        qsort(roots, (size_t)count, sizeof *roots, by_size);
}

static bool find_poles(const Siso *s, Root *pole)
{
    Spectrum *spectrum = spectrum_new(s->a, s->a_error, s->n);
    const bool sound = spectrum != NULL;

    for (int i = 0; i < s->n && sound; i++)
        pole[i] = spectrum_roots(spectrum)[i];
    spectrum_free(spectrum);
    return sound;
}

static void remove_root(Root *roots, int *count, int which)
{
    for (int i = which; i + 1 < *count; i++)
        roots[i] = roots[i + 1];
    (*count)--;
}

/* whether a pole and a zero are within each other's errors, and these are small */
static bool is_same(const Root *pole, const Root *zero)
{
    const double apart = hypot(pole->real - zero->real, pole->imaginary - zero->imaginary);
    const double error = pole->error + zero->error;

    return apart <= error && (error <= TRANSFER_KNOWN * size_of(*pole) || size_of(*pole) == 0);
}

/* the closest pair of those, on or above the real axis */
static bool closest(const Transfer *t, int *pole, int *zero)
{
    double best = INFINITY;

    for (int p = 0; p < t->poles; p++)
        for (int z = 0; z < t->zeros; z++) {
            double apart = hypot(t->pole[p].real - t->zero[z].real,
                                 t->pole[p].imaginary - t->zero[z].imaginary);

            if (t->pole[p].imaginary < 0 || t->zero[z].imaginary < 0 ||
                (t->pole[p].imaginary > 0) != (t->zero[z].imaginary > 0) || apart >= best ||
                !is_same(&t->pole[p], &t->zero[z]))
                continue;
            best = apart;
            *pole = p;
            *zero = z;
        }
    return isfinite(best);
}

static void drop_pair(Root *roots, int *count, int which)
{
    Root root = roots[which];

    remove_root(roots, count, which);
    for (int i = 0; root.imaginary > 0 && i < *count; i++)
        if (roots[i].real == root.real && roots[i].imaginary == -root.imaginary) {
            remove_root(roots, count, i);
            break;
        }
}

/* Remove pairs of poles and zeros that are equal within their errors. */
static void cancel(Transfer *t)
{
    const int before = t->poles;
    int pole = 0, zero = 0;

    for (;;) {
        if (!closest(t, &pole, &zero))
            break;
        drop_pair(t->pole, &t->poles, pole);
        drop_pair(t->zero, &t->zeros, zero);
    }
    t->cancelled = before - t->poles;
}

/* --- polynomials --- */

/* gain times the product of (s - root), descending powers: new, count + 1 */
static double *expand(const Root *roots, int count, double gain)
{
    double *out = NEW_ARRAY(double, count + 1);
    int degree = 0;

    out[0] = gain;
    for (int i = 0; i < count; i++) {
        double linear = roots[i].imaginary > 0 ? -2 * roots[i].real : -roots[i].real;
        double constant = roots[i].imaginary > 0 ? size_of(roots[i]) * size_of(roots[i]) : 0;

        if (roots[i].imaginary < 0)
            continue;
        degree += roots[i].imaginary > 0 ? 2 : 1;
        for (int k = degree; k > 0; k--) /* beyond the old degree all are 0 */
            out[k] += linear * out[k - 1] + (k > 1 ? constant * out[k - 2] : 0);
    }
    for (int k = 0; k <= count; k++)
        out[k] += 0.0; /* avoids -0 */
    return out;
}

void transfer_free(Transfer *transfer)
{
    if (transfer == NULL)
        return;
    MEM_FREE(transfer->zero, transfer->pole, transfer->numerator, transfer->denominator, transfer);
}

static Status refuse_open(const Linear *linear, int output, int input, Diag *diag)
{
    (void)diag_set(diag, E_SOLVER,
                   "rounding leaves open which gain, poles and zeros %s against %s has",
                   linear->output_names[output], linear->input_names[input]);
    diag_hint(diag, "an output nearer to %s, or states less far apart in size, leave less open",
              linear->input_names[input]);
    return E_SOLVER;
}

Status transfer_new(const Linear *linear, int output, int input, Transfer **out, Diag *diag)
{
    Siso s = siso_new(linear, output, input);
    Transfer *t = NEW(Transfer);
    Gain gain;
    double largest;
    Status status = OK;

    t->pole = NEW_ARRAY(Root, s.n);
    t->zero = NEW_ARRAY(Root, s.n);
    t->idle = linear->states - s.n;
    if (!gain_find(&s, &gain))
        CHECK(refuse_open(linear, output, input, diag));
    if (!find_poles(&s, t->pole) || !isfinite(gain.value) ||
        !zeros_find(&s, &gain, t->pole, t->zero, &t->zeros))
        CHECK(diag_set(diag, E_SOLVER,
                       "the gain, poles and zeros of %s against %s are beyond what numbers hold",
                       linear->output_names[output], linear->input_names[input]));
    if (!zeros_agree(&s, &(Answer){&gain, t->pole, t->zero, t->zeros}, &largest))
        CHECK(refuse_open(linear, output, input, diag));
    t->within = gain.is_open ? largest : 0;
    t->gain = gain.value;
    t->poles = t->gain != 0 ? s.n : 0;
    sort(t->pole, t->poles);
    sort(t->zero, t->zeros);
    cancel(t);
    t->numerator = expand(t->zero, t->zeros, t->gain);
    t->denominator = expand(t->pole, t->poles, 1);
    *out = t;
    t = NULL;
done:
    transfer_free(t);
    siso_free(&s);
    return status;
}

/* --- frequency response --- */

/* argument of the product of (j omega - root), continuous in omega; `halves` becomes the number of
 * half turns at omega = 0 */
static double turns_of(const Root *roots, int count, double omega, int *halves)
{
    double sum = 0;

    for (int i = 0; i < count; i++) {
        const double turn = atan2(omega - roots[i].imaginary, fabs(roots[i].real));

        sum += roots[i].real > 0 ? -turn : turn;
        *halves += roots[i].real > 0 && roots[i].imaginary == 0;
    }
    return sum;
}

/* the phase from the roots; at omega = 0, without integrators, 0 or half a turn */
static double phase_by_roots(const Transfer *t, double omega)
{
    int above = t->gain < 0, below = 0;
    double phase = turns_of(t->zero, t->zeros, omega, &above);

    phase -= turns_of(t->pole, t->poles, omega, &below);
    if ((above + below) % 2 != 0)
        phase += below % 2 != 0 ? -M_PI : M_PI;
    return phase;
}

/* log10 of the product of |j omega - root| */
static double decades_of(const Root *roots, int count, double omega)
{
    double sum = 0;

    for (int i = 0; i < count; i++)
        sum += log10(hypot(roots[i].real, omega - roots[i].imaginary));
    return sum;
}

/* whether j omega is a zero within its error */
static bool is_zero(const Transfer *t, double omega)
{
    for (int i = 0; i < t->zeros; i++)
        if (hypot(t->zero[i].real, omega - t->zero[i].imaginary) <=
            t->zero[i].error + TRANSFER_AT_ZERO * size_of(t->zero[i]))
            return true;
    return false;
}

/* dB of gain prod(j omega - zero) / prod(j omega - pole), without overflow */
static double gain_by_roots(const Transfer *t, double omega)
{
    if (t->gain == 0 || is_zero(t, omega))
        return -INFINITY;
    return 20 * (log10(fabs(t->gain)) + decades_of(t->zero, t->zeros, omega) -
                 decades_of(t->pole, t->poles, omega));
}

static DoubleDouble *widen(const double *from, int count)
{
    DoubleDouble *out = NEW_ARRAY(DoubleDouble, count);

    for (int i = 0; i < count; i++)
        out[i] = dd_of(from[i]);
    return out;
}

/* d + c (s - A)^-1 b; INFINITY at a pole */
static double complex respond(const Siso *s, Resolvent *resolvent, double omega)
{
    if (!resolvent_at(resolvent, dd_complex(dd_of(0), dd_of(omega))))
        return INFINITY;
    return dd_to(dd_cadd(resolvent_value(resolvent), dd_real(dd_of(s->d))));
}

void transfer_response(const Linear *linear, int output, int input, const Transfer *transfer,
                       const double *omega, int count, double *gain, double *phase)
{
    Siso s = siso_new(linear, output, input);
    DoubleDouble *a = widen(s.a, s.n * s.n), *b = widen(s.b, s.n), *c = widen(s.c, s.n);
    Resolvent *resolvent = resolvent_new(a, b, c, s.n);

    for (int i = 0; i < count; i++) {
        double complex h = respond(&s, resolvent, omega[i]);
        double turns = phase_by_roots(transfer, omega[i]);

        /* far from all roots products may over- or underflow */
        gain[i] = cabs(h) > LEAST_RESPONSE && (cabs(h) < MOST_RESPONSE || isinf(cabs(h)))
                      ? 20 * log10(cabs(h))
                      : gain_by_roots(transfer, omega[i]);
        /* the response is as accurate as A; the roots determine its turn */
        if (transfer->gain == 0)
            phase[i] = 0;
        else if (!(cabs(h) > LEAST_RESPONSE && cabs(h) < MOST_RESPONSE))
            phase[i] = turns * 180 / M_PI;
        else
            phase[i] =
                (carg(h) + 2 * M_PI * nearbyint((turns - carg(h)) / (2 * M_PI))) * 180 / M_PI;
    }
    MEM_FREE(a, b, c);
    resolvent_free(resolvent);
    siso_free(&s);
}

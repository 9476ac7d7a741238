/* dop853_stiff.c: whether fast components that the solution doesn't follow limit the steps of
 * dop853, and by which eigenvalues
 *
 * With L an eigenvalue of largest size, the quotient h |f(a) - f(b)| / |a - b| of the two points at
 * the end of a step estimates h |L|. It is above 6.1 in step after step when stability limits them
 * (Hairer and Wanner, Solving ODE II, IV.2).
 *
 * With tight tolerances accuracy limits them before that. A component L (z - g(t)) that has decayed
 * has errors in proportion to powers of h L, not of h times the rate of g, so that h |L| remains at
 * 1 to 6. Then y' changes in a step by a small part of its size. The step that radau would take is
 * in proportion to rtol^(1/4) of the time in which y' changes, so that it needs fewer evaluations
 * where that part is below DOP853_SMOOTH rtol^(1/4).
 *
 * Products with the Jacobian show whether the limiting component decays or oscillates: backward
 * differentiation is no help against oscillation. */
#include "simulate/integrate/dop853_impl.h"

#include "base/four.h"
#include "simulate/integrate/integrate_limits.h"

#include <math.h>

/* J w by a difference along w, J the Jacobian at the new point */
static bool apply_jacobian(Dop853 *d, const double *w, double *out)
{
    double size = dop853_norm(d, w);
    double step = fmax(1, DOP853_DIFFERENCE / (DOP853_AIM * d->base.control.rtol)) / size;

    if (!(size > 0) || !isfinite(step))
        return false;
    for (int i = 0; i < d->all; i++)
        d->stage_point[i] = d->base.y[i] + (i < d->n ? step * w[i] : 0);
    if (!stepper_rate(&d->base, d->base.t, d->stage_point, out))
        return false;
    for (int i = 0; i < d->n; i++)
        out[i] = (out[i] - d->k[ROW_END][i]) / step;
    return true;
}

/* Whether the fastest component oscillates, rather than decays: J^(k+2) w = a J^(k+1) w + b J^k w
 * for k = 0, 1 by least squares, w the result of two products of J with a difference. The roots of
 * x^2 = a x + b are its eigenvalues; oscillating ones are further from the real axis than from the
 * imaginary one. */
static bool is_oscillatory(Dop853 *d)
{
    /* unused until dense output is computed */
    double **terms = d->dense[0].terms, *w[] = {terms[0], terms[1], terms[2], terms[3]};
    double p[4][4], power[4] = {1};
    double rate, a, b, d11, d12, d22, r1, r2, det;

    for (int i = 0; i < d->n; i++)
        w[0][i] = d->base.y[i] - d->stage_point[i];
    if (!apply_jacobian(d, w[0], w[1]) || !apply_jacobian(d, w[1], w[0]))
        return false;
    for (int k = 0; k < 3; k++)
        if (!apply_jacobian(d, w[k], w[k + 1]))
            return false;
    rate = dop853_norm(d, w[1]) / dop853_norm(d, w[0]);
    for (int k = 1; k < 4; k++)
        power[k] = power[k - 1] * rate;
    for (int j = 0; j < 4; j++)
        for (int k = 0; k < 4; k++)
            p[j][k] = dop853_product(d, w[j], w[k]) / (power[j] * power[k]);
    /* regularised by a small multiple of the trace: w may be a multiple of J w */
    d12 = p[0][1] + p[1][2];
    d11 = (p[1][1] + p[2][2]) * (1 + 1e-6);
    d22 = (p[0][0] + p[1][1]) * (1 + 1e-6);
    r1 = p[1][2] + p[2][3];
    r2 = p[0][2] + p[1][3];
    det = d11 * d22 - d12 * d12;
    a = (r1 * d22 - r2 * d12) / det;
    b = (d11 * r2 - d12 * r1) / det;
    return 0.25 * a * a + b < 0 && a * a < -2 * b;
}

/* h |L| of the step just taken */
static double fastest_rate(const Dop853 *d, double h)
{
    double rates = 0, points = 0;

    for (int i = 0; i < d->n; i++) {
        double dk = d->k[ROW_END][i] - d->k[ROW_END - 1][i];
        double dy = d->base.y[i] - d->stage_point[i];

        rates += dk * dk;
        points += dy * dy;
    }
    return points > 0 ? h * sqrt(rates / points) : 0;
}

/* The size of an entry of y' is the largest in recent steps, since it may pass through 0. */
AS_WIDE_AS_CAN_BE static void update_peaks(Dop853 *d)
{
    const FourTruths size = {INT64_MAX, INT64_MAX, INT64_MAX, INT64_MAX}; /* all but the sign */
    const double *const before = d->k[0], *const after = d->k[ROW_END];
    int i = 0;

    for (; i + 4 <= d->n; i += 4) {
        Four *const peak = (Four *)(d->peak + i);
        const Four one = (Four)((FourTruths)(*(const Four *)(before + i)) & size);
        const Four other = (Four)((FourTruths)(*(const Four *)(after + i)) & size);

        const FourTruths second = other > one;
        const Four larger = (Four)(((FourTruths)other & second) | ((FourTruths)one & ~second));
        const Four decayed = DOP853_PEAK_DECAY * *peak;
        const FourTruths grows = larger > decayed;

        *peak = (Four)(((FourTruths)larger & grows) | ((FourTruths)decayed & ~grows));
    }
    for (; i < d->n; i++)
        d->peak[i] = fmax(DOP853_PEAK_DECAY * d->peak[i], fmax(fabs(before[i]), fabs(after[i])));
}

/* Whether every entry of y' has changed in the step just taken by less than a part `most` of its
 * size, of those that this changes y by more than a tolerance. O(n), mostly less if it hasn't. */
static bool rates_hardly_change(const Dop853 *d, double h, double most)
{
    for (int i = 0; i < d->n; i++) {
        const double change = fabs(d->k[ROW_END][i] - d->k[0][i]);

        if (h * change > d->scale[i] && change / d->peak[i] >= most)
            return false;
    }
    return true;
}

static void count_stiff_step(Dop853 *d, double h, double error)
{
    const double fast = fastest_rate(d, h);

    update_peaks(d);
    if (fast > DOP853_STIFF_BOUNDARY)
        d->stiffness.steps++;
    else if (fast > DOP853_FAST && error > DOP853_LIMITED &&
             rates_hardly_change(d, h, DOP853_SMOOTH * sqrt(sqrt(d->base.control.rtol))))
        d->stiffness.sum += fast;
    else {
        if (++d->stiffness.calm >= DOP853_CALM_COUNT)
            d->stiffness = (Stiffness){0};
        return;
    }
    d->stiffness.calm = 0;
}

void dop853_watch_stiffness(Dop853 *d, double h, double error)
{
    count_stiff_step(d, h, error);
    if (d->stiffness.steps < DOP853_STIFF_COUNT && d->stiffness.sum < DOP853_FAST_SUM)
        return;
    d->base.found_stiff = true;
    d->base.is_oscillatory = is_oscillatory(d);
    d->stiffness = (Stiffness){0};
}

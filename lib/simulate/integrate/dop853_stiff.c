/* dop853_stiff.c: whether stability, not accuracy, limits the steps of dop853, and by which
 * eigenvalues
 *
 * The indicator is that of Hairer and Wanner (Solving ODE II, IV.2): h |f(a) - f(b)| / |a - b| for
 * the two points at the end of a step is above 6.1 in step after step when stability limits them.
 * Products with the Jacobian show whether the limiting component decays or oscillates: backward
 * differentiation is no help against oscillation. */
#include "simulate/integrate/dop853_impl.h"

#include <math.h>

#define STIFF_BOUNDARY 6.1
#define STIFF_COUNT    15
#define CALM_COUNT     6
#define DIFFERENCE     1e-7 /* of y, for a derivative */

/* J w by a difference along w, J the Jacobian at the new point */
static bool apply_jacobian(Dop853 *d, const double *w, double *out)
{
    double size = dop853_norm(d, w);
    double step = fmax(1, DIFFERENCE / (DOP853_AIM * d->base.control.rtol)) / size;

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

void dop853_watch_stiffness(Dop853 *d, double h)
{
    double rates = 0, points = 0;

    for (int i = 0; i < d->n; i++) {
        double dk = d->k[ROW_END][i] - d->k[ROW_END - 1][i];
        double dy = d->base.y[i] - d->stage_point[i];

        rates += dk * dk;
        points += dy * dy;
    }
    if (points > 0 && h * sqrt(rates / points) > STIFF_BOUNDARY) {
        d->calm = 0;
        if (++d->stiff >= STIFF_COUNT) {
            d->base.is_stiff = true;
            d->base.is_oscillatory = is_oscillatory(d);
            d->stiff = 0;
        }
    } else if (++d->calm >= CALM_COUNT) {
        d->stiff = 0;
    }
}

/* jacobians.c: Richardson's extrapolation of central differences, through programs of a run alone
 */
#include "jacobians.h"

#include "../unit/simulate_script.h"
#include "simulate/run/result_reader_impl.h"

enum { MOST_STATES = 100, MOST_UNKNOWNS = 250 };

/* (y'(y_j + h) - y'(y_j - h)) / 2h */
static bool difference(const Ode *ode, double t, double *y, int j, double h, double *out)
{
    const int all = ode->n + ode->quadratures;
    const double was = y[j];
    double back[MOST_STATES + 1] = {0};
    bool sound;

    y[j] = was + h;
    sound = ode->rate(ode->context, t, y, out);
    y[j] = was - h;
    sound = sound && ode->rate(ode->context, t, y, back);
    y[j] = was;
    for (int i = 0; i < all; i++)
        out[i] = (out[i] - back[i]) / (2 * h);
    return sound;
}

/* Two of them extrapolated (Richardson 1911), and how far apart two such are. */
static bool extrapolate(const Ode *ode, double t, double *y, int j, double *value, double *apart)
{
    const double h = 2e-4 * fmax(0.1, fabs(y[j]));
    double d[3][MOST_STATES + 1];

    for (int k = 0; k < 3; k++)
        if (!difference(ode, t, y, j, ldexp(h, -k), d[k]))
            return false;
    for (int i = 0; i < ode->n + ode->quadratures; i++) {
        value[i] = (4 * d[2][i] - d[1][i]) / 3;
        apart[i] = fabs(value[i] - (4 * d[1][i] - d[0][i]) / 3);
    }
    return true;
}

/* The worst entry: off by rounding of the rates, which differences enlarge, at most. */
static double compare(const Ode *ode, double t, double *y)
{
    const int n = ode->n, all = n + ode->quadratures;
    double *exact = NEW_ARRAY(double, n *all), *rate = NEW_ARRAY(double, all);
    double value[MOST_STATES + 1] = {0}, apart[MOST_STATES + 1] = {0}, worst = 0;
    bool sound = ode->jacobian.at != NULL && ode->rate(ode->context, t, y, rate) &&
                 ode->jacobian.at(ode->jacobian.context, t, y, exact);

    for (int j = 0; j < n && sound; j++) {
        double largest = 0;

        sound = extrapolate(ode, t, y, j, value, apart);
        for (int i = 0; i < all; i++)
            largest = fmax(largest, fmax(fabs(value[i]), fabs(rate[i])));
        for (int i = 0; i < all && sound; i++)
            worst =
                fmax(worst, fabs(value[i] - exact[i * n + j]) / (4 * apart[i] + 1e-6 * largest));
    }
    MEM_FREE(exact, rate);
    return sound ? worst : NAN;
}

/* --- implicit equations --- */

/* F with unknown j moved by h, and its rate by c h */
static bool moved(const Dae *dae, double t, double c, const double *w, const double *rate, int j,
                  double h, double *out)
{
    double near[MOST_UNKNOWNS], near_rate[MOST_UNKNOWNS];

    memcpy(near, w, (size_t)dae->n * sizeof(double));
    memcpy(near_rate, rate, (size_t)dae->n * sizeof(double));
    near[j] += h;
    near_rate[j] += c * h;
    return dae->residual(dae->context, t, near, near_rate, out);
}

static double step_of(double w)
{
    return 2e-4 * fmax(0.1, fabs(w));
}

/* two central differences extrapolated */
static bool extrapolate_implicit(const Dae *dae, double t, double c, const double *w,
                                 const double *rate, int j, double *value, double *apart)
{
    const double h = step_of(w[j]);
    double d[3][MOST_UNKNOWNS], back[MOST_UNKNOWNS] = {0};

    for (int k = 0; k < 3; k++) {
        const double step = ldexp(h, -k);

        if (!moved(dae, t, c, w, rate, j, step, d[k]) || !moved(dae, t, c, w, rate, j, -step, back))
            return false;
        for (int i = 0; i < dae->n; i++)
            d[k][i] = (d[k][i] - back[i]) / (2 * step);
    }
    for (int i = 0; i < dae->n; i++) {
        value[i] = (4 * d[2][i] - d[1][i]) / 3;
        apart[i] = fabs(value[i] - (4 * d[1][i] - d[0][i]) / 3);
    }
    return true;
}

/* dF/dw + c dF/dw' column by column; false: it isn't told */
static bool fill_implicit(const Dae *dae, double t, double c, const double *w, const double *rate,
                          double *out)
{
    const int *row, *column;
    const int count = dae->pattern != NULL ? dae->pattern(dae->context, &row, &column) : -1;
    double *values;
    bool sound;

    if (count < 0)
        return dae->full != NULL && dae->full(dae->context, t, c, w, rate, out);
    values = NEW_ARRAY(double, count);
    sound = dae->jacobian(dae->context, t, c, w, rate, values);
    for (int k = 0; k < count; k++)
        out[column[k] * dae->n + row[k]] = values[k];
    mem_free(values);
    return sound;
}

/* Near what a solver starts with: all rates are off, but for those that are 0 on any solution. What
 * work follows from isn't told. */
static double compare_implicit(JacobianTrial *trial, const Ode *ode, const double *y)
{
    const Dae *dae = &ode->dae;
    const double c = exp(test_uniform(&trial->random, 0, 4));
    double w[MOST_UNKNOWNS], rate[MOST_UNKNOWNS], value[MOST_UNKNOWNS] = {0},
                                                  apart[MOST_UNKNOWNS] = {0}, *exact, worst = 0;
    bool sound;

    if (dae->n > MOST_UNKNOWNS || !dae->start(dae->context, trial->at, y, w, rate))
        return NAN;
    for (int i = 0; i < dae->n; i++)
        if (rate[i] != 0)
            rate[i] *= 1 + 1e-2 * test_uniform(&trial->random, -1, 1);
    exact = NEW_ARRAY(double, dae->n * dae->n);
    sound = fill_implicit(dae, trial->at, c, w, rate, exact);
    for (int j = 0; j < dae->n && sound; j++) {
        /* what a large rate leaves of the least step of its own */
        const double coarse = 8 * DBL_EPSILON * fabs(rate[j]) / (c * step_of(w[j]));
        double largest = 0;

        sound = extrapolate_implicit(dae, trial->at, c, w, rate, j, value, apart);
        for (int i = 0; i < dae->n; i++)
            largest = fmax(largest, fabs(value[i]));
        for (int i = 0; i < dae->n && sound; i++)
            if (i != ode->n)
                worst = fmax(worst, fabs(value[i] - exact[j * dae->n + i]) /
                                        (4 * apart[i] + (1e-6 + coarse) * fmax(1, largest)));
    }
    mem_free(exact);
    return sound ? worst : NAN;
}

/* off the manifold, as stages of a step are */
static void try_near(JacobianTrial *trial, const Phase *phase, const double *y)
{
    double near[MOST_STATES + 1];

    if (phase->length > MOST_STATES)
        return;
    for (int i = 0; i < phase->length; i++)
        near[i] = y[i] + 1e-3 * test_uniform(&trial->random, -1, 1);
    trial->worst = compare(motion_ode(phase->motion), trial->at, near);
    trial->implicit = compare_implicit(trial, motion_ode(phase->motion), near);
}

void jacobian_try(JacobianTrial *trial)
{
    const double *y, *driven;
    Script script;
    Diag diag = {0};
    Phase *phase;

    trial->worst = trial->implicit = NAN;
    script_open(&script, trial->text, &(Changes){.method = trial->method});
    if (script.status == OK && script.reader != NULL &&
        result_reader_at(script.reader, trial->at, &phase, &y, &driven, &diag) == OK)
        try_near(trial, phase, y);
    (void)snprintf(trial->reason, sizeof trial->reason, "%s%s", script.diag.message, diag.message);
    script_close(&script);
}

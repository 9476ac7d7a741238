/* jacobians.c: Richardson's extrapolation of central differences, through programs of a run alone
 */
#include "jacobians.h"

#include "../unit/simulate_script.h"
#include "simulate/run/result_reader_impl.h"

enum { MOST_STATES = 100 };

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

/* off the manifold, as stages of a step are */
static double try_near(JacobianTrial *trial, const Phase *phase, const double *y)
{
    double near[MOST_STATES + 1];

    if (phase->length > MOST_STATES)
        return NAN;
    for (int i = 0; i < phase->length; i++)
        near[i] = y[i] + 1e-3 * test_uniform(&trial->random, -1, 1);
    return compare(motion_ode(phase->motion), trial->at, near);
}

void jacobian_try(JacobianTrial *trial)
{
    ResultReader *reader = NULL;
    const double *y, *driven;
    Script script;
    Diag diag = {0};
    Phase *phase;

    trial->worst = NAN;
    script_open(&script, trial->text, &(Changes){.method = trial->method});
    if (script.status == OK && result_reader_new(script.result, &reader, &diag) == OK &&
        result_reader_at(reader, trial->at, &phase, &y, &driven, &diag) == OK)
        trial->worst = try_near(trial, phase, y);
    (void)snprintf(trial->reason, sizeof trial->reason, "%s%s", script.diag.message, diag.message);
    result_reader_free(reader);
    script_close(&script);
}

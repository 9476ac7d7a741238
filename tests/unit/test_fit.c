/* test_fit.c: least squares and other losses, held against closed forms and certified values */
#include "simulate/fit/fit_solve.h"

#include "simulate/sweep/distribution.h"
#include "simulate/sweep/random_stream.h"

#include "test.h"

#include <math.h>
#include <string.h>

enum { MOST = 200, UNKNOWNS = 4 };

/* data, and a model of them */
typedef struct Case {
    int count, unknowns;
    double x[MOST], y[MOST];
    double (*model)(const double *p, double x);
    double limit; /* the model has no values where p[0] is above; 0: it always has */
    int calls, stops_at;
} Case;

static Status residuals(void *context, int count, const double *points, double *out, Diag *diag)
{
    Case *c = context;

    for (int k = 0; k < count; k++, points += c->unknowns, out += c->count) {
        if (++c->calls == c->stops_at)
            return diag_set(diag, E_STOPPED, "stopped");
        for (int i = 0; i < c->count; i++)
            out[i] = c->model(points, c->x[i]) - c->y[i];
        if (c->limit > 0 && points[0] > c->limit)
            out[0] = NAN;
    }
    return OK;
}

static double line(const double *p, double x)
{
    return p[0] + p[1] * x;
}

/* Misra1a */
static double saturation(const double *p, double x)
{
    return p[0] * (1 - exp(-p[1] * x));
}

static double oscillation(const double *p, double x)
{
    const double decay = p[1] / 2, omega = sqrt(p[0] - decay * decay);

    return p[2] * exp(-decay * x) * (cos(omega * x) + decay / omega * sin(omega * x));
}

/* k/m alone matters, and p[2] not at all */
static double ratio(const double *p, double x)
{
    return cos(sqrt(p[0] / p[1]) * x);
}

static FitSolution *solve(Case *c, int unknowns, const double *start, const double *low,
                          const double *high, Loss loss, Status expected)
{
    static const double below[UNKNOWNS] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY};
    static const double above[UNKNOWNS] = {INFINITY, INFINITY, INFINITY, INFINITY};
    const FitProblem problem = {.unknowns = unknowns,
                                .residuals = c->count,
                                .start = start,
                                .low = low != NULL ? low : below,
                                .high = high != NULL ? high : above,
                                .loss = loss,
                                .step = 1e-5,
                                .noise = 1e-14,
                                .function = residuals,
                                .context = c};
    FitSolution *out = NULL;
    Diag diag = {0};

    c->unknowns = unknowns;
    EXPECT(fit_solve(&problem, &out, &diag) == expected);
    return out;
}

static double noise(uint64_t seed, int i)
{
    const Distribution normal = {distribution_find("normal"), {0, 1}, -INFINITY, INFINITY};

    return distribution_quantile(&normal, random_uniform(seed, (uint64_t)i, 0, 0));
}

/* With S = sum (x - mean)^2: slope = sum (x - mean) y/S, its error s/sqrt(S), that of the
 * intercept s sqrt(1/n + mean^2/S), their covariance -s^2 mean/S. */
static void a_line_has_the_values_and_errors_of_its_formulas(void)
{
    static const double start[] = {1, 1};
    Case c = {.count = 50, .model = line};
    double mean = 0, spread = 0, slope = 0, height = 0, squares = 0, variance;
    FitSolution *fit;

    for (int i = 0; i < c.count; i++) {
        c.x[i] = 0.1 * i * i + 2;
        c.y[i] = 3 - 0.7 * c.x[i] + 0.5 * noise(1, i);
        mean += c.x[i] / c.count;
        height += c.y[i] / c.count;
    }
    for (int i = 0; i < c.count; i++) {
        spread += (c.x[i] - mean) * (c.x[i] - mean);
        slope += (c.x[i] - mean) * c.y[i];
    }
    slope /= spread;
    for (int i = 0; i < c.count; i++)
        squares += pow(c.y[i] - height - slope * (c.x[i] - mean), 2);
    variance = squares / (c.count - 2);
    fit = solve(&c, 2, start, NULL, NULL, LOSS_SQUARES, OK);
    EXPECT(fit->is_converged && fit->undetermined_count == 0);
    EXPECT_NEAR(fit->x[1], slope, 1e-9 * fabs(slope));
    EXPECT_NEAR(fit->x[0], height - slope * mean, 1e-8);
    EXPECT_NEAR(fit->squares, squares, 1e-10 * squares);
    EXPECT_NEAR(fit->errors[1], sqrt(variance / spread), 1e-8);
    EXPECT_NEAR(fit->errors[0], sqrt(variance * (1.0 / c.count + mean * mean / spread)), 1e-8);
    EXPECT_NEAR(fit->covariance[1], -variance * mean / spread, 1e-8);
    fit_solution_free(fit);
}

/* NIST StRD, Misra1a: certified values, standard deviations and residual sum of squares */
static void misra1a_is_as_certified(void)
{
    static const double x[] = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                               378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
    static const double y[] = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                               44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
    static const double starts[2][2] = {{500, 0.0001}, {250, 0.0005}};
    Case c = {.count = 14, .model = saturation};

    memcpy(c.x, x, sizeof x);
    memcpy(c.y, y, sizeof y);
    for (int i = 0; i < 2; i++) {
        FitSolution *fit = solve(&c, 2, starts[i], NULL, NULL, LOSS_SQUARES, OK);

        EXPECT(fit->is_converged);
        EXPECT_NEAR(fit->x[0], 2.3894212918e2, 1e-7 * 239);
        EXPECT_NEAR(fit->x[1], 5.5015643181e-4, 1e-7 * 5.5e-4);
        EXPECT_NEAR(fit->errors[0], 2.7070075241, 1e-6 * 2.7);
        EXPECT_NEAR(fit->errors[1], 7.2668688436e-6, 1e-6 * 7.3e-6);
        EXPECT_NEAR(fit->squares, 1.2455138894e-1, 1e-9);
        fit_solution_free(fit);
    }
}

/* the standard errors are those of repeated experiments: 300 values in units of their errors have
 * the mean 0 +- 0.058 and the deviation 1 +- 0.041 (at 1 sigma each) */
static void errors_are_those_of_repeated_experiments(void)
{
    enum { REPEATED = 300 };
    static const double truth[] = {40, 1, 0.8}, start[] = {35, 0.5, 1};
    double mean[3] = {0}, squares[3] = {0};

    for (int seed = 0; seed < REPEATED; seed++) {
        Case c = {.count = 60, .model = oscillation};
        FitSolution *fit;

        for (int i = 0; i < c.count; i++) {
            c.x[i] = 0.05 * i;
            c.y[i] = oscillation(truth, c.x[i]) + 0.02 * noise(seed, i);
        }
        fit = solve(&c, 3, start, NULL, NULL, LOSS_SQUARES, OK);
        EXPECT(fit->is_converged);
        for (int k = 0; k < 3; k++) {
            const double z = (fit->x[k] - truth[k]) / fit->errors[k];

            mean[k] += z / REPEATED;
            squares[k] += z * z / REPEATED;
        }
        fit_solution_free(fit);
    }
    for (int k = 0; k < 3; k++) {
        EXPECT(fabs(mean[k]) < 3.5 * 0.058);
        EXPECT(fabs(sqrt(squares[k] - mean[k] * mean[k]) - 1) < 3.5 * 0.041);
    }
}

/* of data of which one in ten is far off */
static void outliers_count_less_by_other_losses(void)
{
    static const double start[] = {1, 1};
    Case c = {.count = 100, .model = line};

    for (int i = 0; i < c.count; i++) {
        c.x[i] = 0.1 * i;
        c.y[i] = 2 + 0.5 * c.x[i] + 0.05 * noise(3, i) + (i % 10 == 3 ? 5 + 0.1 * i : 0);
    }
    for (Loss loss = LOSS_SQUARES; loss < LOSSES; loss++) {
        FitSolution *fit = solve(&c, 2, start, NULL, NULL, loss, OK);
        const double off = fabs(fit->x[1] - 0.5);

        EXPECT(fit->is_converged);
        EXPECT(loss == LOSS_SQUARES ? off > 0.05 : off < 0.01);
        EXPECT(fit->errors[1] < (loss == LOSS_SQUARES ? 0.2 : 0.01));
        fit_solution_free(fit);
    }
}

/* bounds hold: p[1] ends at 0.2, and p[0] is the best beside it */
static void bounds_hold(void)
{
    static const double start[] = {1, 0.1}, low[] = {-INFINITY, 0}, high[] = {INFINITY, 0.2};
    Case c = {.count = 11, .model = line};
    FitSolution *fit;

    for (int i = 0; i < c.count; i++) {
        c.x[i] = i;
        c.y[i] = 2 + 0.5 * i;
    }
    fit = solve(&c, 2, start, low, high, LOSS_SQUARES, OK);
    EXPECT(fit->is_converged && fit->is_held[1] && !fit->is_held[0]);
    EXPECT(fit->x[1] == 0.2);
    EXPECT_NEAR(fit->x[0], 2 + 0.3 * 5, 1e-8);
    EXPECT(isnan(fit->errors[1]) && isfinite(fit->errors[0]));
    fit_solution_free(fit);
}

/* k and m alone as k/m, and a third one not at all */
static void what_data_leave_open_is_named(void)
{
    static const double start[] = {30, 2, 5};
    Case c = {.count = 60, .model = ratio};
    FitSolution *fit;

    for (int i = 0; i < c.count; i++) {
        c.x[i] = 0.02 * i;
        c.y[i] = cos(sqrt(20) * c.x[i]) + 0.01 * noise(4, i);
    }
    fit = solve(&c, 3, start, NULL, NULL, LOSS_SQUARES, OK);
    EXPECT(fit->is_converged && fit->undetermined_count == 2);
    EXPECT_NEAR(fit->x[0] / fit->x[1], 20, 0.2);
    EXPECT(fit->x[2] == 5);
    EXPECT(fit->undetermined[2] == 1 && fit->undetermined[0] == 0);
    EXPECT_NEAR(fit->undetermined[3] / fit->undetermined[4], 1, 1e-3);
    EXPECT(isnan(fit->errors[0]) && isnan(fit->errors[1]) && isnan(fit->errors[2]));
    fit_solution_free(fit);
}

/* points without values are stepped back from; where they are in the way there is no minimum */
static void failing_models_are_avoided(void)
{
    static const double start[] = {10, 0.5, 1}, truth[] = {40, 1, 0.8};
    Case c = {.count = 60, .model = oscillation, .limit = 45};
    FitSolution *fit;

    for (int i = 0; i < c.count; i++) {
        c.x[i] = 0.02 * i;
        c.y[i] = oscillation(truth, c.x[i]);
    }
    fit = solve(&c, 3, start, NULL, NULL, LOSS_SQUARES, OK);
    EXPECT(fit->is_converged);
    for (int k = 0; k < 3; k++)
        EXPECT_NEAR(fit->x[k], truth[k], 1e-6 * truth[k]);
    fit_solution_free(fit);
    c.limit = 30;
    fit = solve(&c, 3, start, NULL, NULL, LOSS_SQUARES, OK);
    EXPECT(!fit->is_converged && fit->x[0] <= 30);
    fit_solution_free(fit);
}

/* a stop leaves the best values so far, and before the first one none */
static void a_stop_leaves_the_best_so_far(void)
{
    static const double start[] = {500, 0.0001};
    Case c = {.count = 14, .model = saturation, .stops_at = 12};
    FitSolution *fit;
    double squares = 0;

    for (int i = 0; i < c.count; i++) {
        c.x[i] = 50 * i;
        c.y[i] = 239 * (1 - exp(-5.5e-4 * c.x[i]));
        squares += pow(saturation(start, c.x[i]) - c.y[i], 2);
    }
    fit = solve(&c, 2, start, NULL, NULL, LOSS_SQUARES, E_STOPPED);
    EXPECT(fit != NULL && fit->squares < squares && isnan(fit->errors[0]));
    fit_solution_free(fit);
    c.calls = 0;
    c.stops_at = 1;
    EXPECT(solve(&c, 2, start, NULL, NULL, LOSS_SQUARES, E_STOPPED) == NULL);
    c.stops_at = 0;
    c.limit = 400;
    EXPECT(solve(&c, 2, start, NULL, NULL, LOSS_SQUARES, E_SOLVER) == NULL);
}

/* rho' and rho'' are the derivatives of rho */
static void losses_have_their_derivatives(void)
{
    for (Loss loss = LOSS_SQUARES; loss < LOSSES; loss++)
        for (int i = 1; i < 40; i++) {
            const double u = 0.11 * i, h = 1e-5;

            EXPECT_NEAR((loss_value(loss, u + h) - loss_value(loss, u - h)) / (2 * h),
                        loss_slope(loss, u), 1e-8);
            EXPECT_NEAR((loss_slope(loss, u + h) - loss_slope(loss, u - h)) / (2 * h),
                        loss_curvature(loss, u), 1e-8);
        }
}

int main(void)
{
    RUN(a_line_has_the_values_and_errors_of_its_formulas);
    RUN(misra1a_is_as_certified);
    RUN(errors_are_those_of_repeated_experiments);
    RUN(outliers_count_less_by_other_losses);
    RUN(bounds_hold);
    RUN(what_data_leave_open_is_named);
    RUN(failing_models_are_avoided);
    RUN(a_stop_leaves_the_best_so_far);
    RUN(losses_have_their_derivatives);
    return test_end();
}

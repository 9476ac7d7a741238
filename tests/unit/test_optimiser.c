/* test_optimiser.c: minima between bounds and subject to constraints, held against published ones
 */
#include "simulate/fit/optimiser.h"

#include "base/memory.h"

#include "test.h"

#include <math.h>

enum { MOST = 4 };

/* value to be minimised and constraints at x; NAN in out[0]: none */
typedef void Values(const double *x, double *out);

typedef struct Case {
    Values *values;
    int unknowns, constraints;
    int calls, stops_at;
} Case;

static Status evaluate(void *context, int count, const double *points, double *out, Diag *diag)
{
    Case *c = context;

    for (int i = 0; i < count; i++, points += c->unknowns, out += 1 + c->constraints) {
        if (++c->calls == c->stops_at)
            return diag_set(diag, E_STOPPED, "stopped");
        c->values(points, out);
    }
    return OK;
}

static OptimiserSolution *minimise(Case *c, const double *start, const double *low,
                                   const double *high, const bool *is_equality,
                                   OptimiserMethod method, Status expected)
{
    static const double below[MOST] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY};
    static const double above[MOST] = {INFINITY, INFINITY, INFINITY, INFINITY};
    static const double scales[1 + MOST] = {1, 1, 1, 1, 1};
    static const bool inequalities[MOST] = {false};
    const OptimiserProblem problem = {.unknowns = c->unknowns,
                                      .constraints = c->constraints,
                                      .start = start,
                                      .low = low != NULL ? low : below,
                                      .high = high != NULL ? high : above,
                                      .is_equality =
                                          is_equality != NULL ? is_equality : inequalities,
                                      .scales = scales,
                                      .step = 1e-4,
                                      .tolerance = 1e-8,
                                      .most_evaluations = 5000,
                                      .method = method,
                                      .function = evaluate,
                                      .context = c};
    OptimiserSolution *out = NULL;
    Diag diag = {0};

    EXPECT(optimiser_solve(&problem, &out, &diag) == expected);
    return out;
}

static void expect_point(const OptimiserSolution *solution, const double *x, int count, double off)
{
    for (int i = 0; i < count; i++)
        EXPECT_NEAR(solution->x[i], x[i], off);
}

static void valley(const double *x, double *out)
{
    out[0] = 100 * pow(x[1] - x[0] * x[0], 2) + pow(1 - x[0], 2);
}

/* Rosenbrock (1960) */
static void a_curved_valley_is_followed(void)
{
    static const double start[] = {-1.2, 1}, minimum[] = {1, 1};

    for (OptimiserMethod method = OPTIMISER_BOTH; method <= OPTIMISER_SLSQP; method++) {
        Case c = {.values = valley, .unknowns = 2};
        OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, method, OK);

        EXPECT(found->is_converged && found->violation == 0 && found->evaluations == c.calls);
        expect_point(found, minimum, 2, 1e-5);
        optimiser_solution_free(found);
    }
}

/* at x = 2 of the same valley y = 4 is the least */
static void a_bound_is_kept(void)
{
    static const double start[] = {3, 3}, low[] = {2, -INFINITY}, high[] = {5, 10};
    static const double minimum[] = {2, 4};
    Case c = {.values = valley, .unknowns = 2};
    OptimiserSolution *found = minimise(&c, start, low, high, NULL, OPTIMISER_BOTH, OK);

    EXPECT(found->is_converged && found->x[0] == 2);
    expect_point(found, minimum, 2, 1e-6);
    optimiser_solution_free(found);
}

/* Hock and Schittkowski (1981), problem 71 */
static void product_and_sphere(const double *x, double *out)
{
    out[0] = x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2];
    out[1] = 25 - x[0] * x[1] * x[2] * x[3];
    out[2] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] - 40;
}

static void bounds_inequalities_and_equations_are_met(void)
{
    static const double start[] = {1, 5, 5, 1}, low[] = {1, 1, 1, 1}, high[] = {5, 5, 5, 5};
    static const double minimum[] = {1, 4.7429994, 3.8211503, 1.3794082};
    static const bool is_equality[] = {false, true};

    for (OptimiserMethod method = 0; method < OPTIMISER_METHODS; method++) {
        Case c = {.values = product_and_sphere, .unknowns = 4, .constraints = 2};
        OptimiserSolution *found = minimise(&c, start, low, high, is_equality, method, OK);

        EXPECT(found->is_converged && found->violation <= 1e-8);
        EXPECT_NEAR(found->values[0], 17.0140173, 1e-6);
        expect_point(found, minimum, 4, 1e-4);
        optimiser_solution_free(found);
    }
}

/* the same, problem 43 (Rosen and Suzuki) */
static void three_surfaces(const double *x, double *out)
{
    const double a = x[0], b = x[1], c = x[2], d = x[3];

    out[0] = a * a + b * b + 2 * c * c + d * d - 5 * a - 5 * b - 21 * c + 7 * d;
    out[1] = a * a + b * b + c * c + d * d + a - b + c - d - 8;
    out[2] = a * a + 2 * b * b + c * c + 2 * d * d - a - d - 10;
    out[3] = 2 * a * a + b * b + c * c + 2 * a - b - d - 5;
}

static void active_constraints_are_found(void)
{
    static const double start[] = {0, 0, 0, 0}, minimum[] = {0, 1, 2, -1};
    Case c = {.values = three_surfaces, .unknowns = 4, .constraints = 3};
    OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, OPTIMISER_BOTH, OK);

    EXPECT(found->is_converged && found->violation <= 1e-8);
    EXPECT_NEAR(found->values[0], -44, 1e-6);
    expect_point(found, minimum, 4, 1e-4);
    optimiser_solution_free(found);
}

static void kinks(const double *x, double *out)
{
    out[0] = fmax(fabs(x[0] - 1), fabs(x[0] + x[1] - 4)) + fabs(x[1] - 3);
}

static void a_minimum_at_a_kink_is_found(void)
{
    static const double start[] = {-2, 7}, minimum[] = {1, 3};
    Case c = {.values = kinks, .unknowns = 2};
    OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, OPTIMISER_BOTH, OK);

    EXPECT(found->is_converged);
    expect_point(found, minimum, 2, 1e-5);
    optimiser_solution_free(found);
}

/* x^2 + 1 <= 0 */
static void impossible(const double *x, double *out)
{
    out[0] = x[0];
    out[1] = x[0] * x[0] + 1;
}

static void a_constraint_that_nothing_meets_is_named_at_the_nearest_point(void)
{
    static const double start[] = {3};
    Case c = {.values = impossible, .unknowns = 1, .constraints = 1};
    OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, OPTIMISER_BOTH, OK);

    EXPECT(!found->is_converged && found->worst == 0);
    EXPECT_NEAR(found->violation, 1, 1e-3);
    optimiser_solution_free(found);
}

/* the model has no values above 2, beyond the minimum */
static void limited(const double *x, double *out)
{
    out[0] = x[0] > 2 ? (double)NAN : pow(x[0] - 1.9, 2);
}

static void nowhere(const double *x, double *out)
{
    (void)x;
    out[0] = NAN;
}

static void points_without_values_are_avoided(void)
{
    static const double start[] = {-5}, minimum[] = {1.9};

    for (OptimiserMethod method = 0; method < OPTIMISER_METHODS; method++) {
        Case c = {.values = limited, .unknowns = 1};
        OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, method, OK);

        expect_point(found, minimum, 1, 1e-5);
        optimiser_solution_free(found);
    }

    Case c = {.values = nowhere, .unknowns = 1};

    EXPECT(minimise(&c, start, NULL, NULL, NULL, OPTIMISER_BOTH, E_SOLVER) == NULL);
}

static void a_stop_leaves_the_best_point(void)
{
    static const double start[] = {-1.2, 1};

    for (int stops_at = 2; stops_at < 60; stops_at += 7) {
        Case c = {.values = valley, .unknowns = 2, .stops_at = stops_at};
        OptimiserSolution *found = minimise(&c, start, NULL, NULL, NULL, OPTIMISER_BOTH, E_STOPPED);

        EXPECT(found->values[0] <= 24.2 && !found->is_converged);
        optimiser_solution_free(found);
    }
}

/* a call that is left while the method waits for values leaves neither its thread nor its memory */
static Status leave(void *context, int count, const double *points, double *out, Diag *diag)
{
    Case *c = context;

    if (c->calls + count >= c->stops_at)
        transaction_fail();
    return evaluate(context, count, points, out, diag);
}

static Status minimise_and_leave(int stops_at)
{
    TRANSACTION(E_MEMORY);
    static const double start[] = {-1.2, 1}, low[] = {-5, -5}, high[] = {5, 5};
    static const double scales[] = {1};
    Case c = {.values = valley, .unknowns = 2, .stops_at = stops_at};
    const OptimiserProblem problem = {.unknowns = 2,
                                      .start = start,
                                      .low = low,
                                      .high = high,
                                      .scales = scales,
                                      .step = 1e-4,
                                      .most_evaluations = 5000,
                                      .function = leave,
                                      .context = &c};
    OptimiserSolution *found = NULL;
    Diag diag = {0};
    Status status = optimiser_solve(&problem, &found, &diag);

    optimiser_solution_free(found);
    return status;
}

static void a_call_may_be_left_at_any_point(void)
{
    for (int stops_at = 1; stops_at < 40; stops_at += 3)
        EXPECT(minimise_and_leave(stops_at) == E_MEMORY);
    EXPECT(minimise_and_leave(100000) == OK);
}

int main(void)
{
    RUN(a_curved_valley_is_followed);
    RUN(a_bound_is_kept);
    RUN(bounds_inequalities_and_equations_are_met);
    RUN(active_constraints_are_found);
    RUN(a_minimum_at_a_kink_is_found);
    RUN(a_constraint_that_nothing_meets_is_named_at_the_nearest_point);
    RUN(points_without_values_are_avoided);
    RUN(a_stop_leaves_the_best_point);
    RUN(a_call_may_be_left_at_any_point);
    return test_end();
}

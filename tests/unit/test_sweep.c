/* test_sweep.c: random numbers, distributions and points of many runs, held against closed forms */
#include "simulate/sweep/correlation.h"
#include "simulate/sweep/distribution.h"
#include "simulate/sweep/random_stream.h"
#include "simulate/sweep/sampling.h"
#include "simulate/sweep/sweep_table.h"

#include "test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RUNS = 4096 };

/* the known answers of the authors' test suite */
static void blocks_are_those_of_philox(void)
{
    static const uint32_t counters[3][4] = {{0, 0, 0, 0},
                                            {0xffffffffU, 0xffffffffU, 0xffffffffU, 0xffffffffU},
                                            {0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U}};
    static const uint32_t keys[3][2] = {
        {0, 0}, {0xffffffffU, 0xffffffffU}, {0xa4093822U, 0x299f31d0U}};
    static const uint32_t answers[3][4] = {{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U},
                                           {0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU},
                                           {0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}};

    for (int i = 0; i < 3; i++) {
        uint32_t out[4];

        random_block(counters[i], keys[i], out);
        EXPECT(memcmp(out, answers[i], sizeof out) == 0);
    }
}

static Distribution distribution_of(const char *name, double a, double b, double c)
{
    return (Distribution){distribution_find(name), {a, b, c}, -INFINITY, INFINITY};
}

static double normal_below(double x)
{
    return erfc(-x / sqrt(2)) / 2;
}

static double uniform_below(double x)
{
    return (x - 2) / 3;
}

/* mean 2, deviation 0.5: the logarithm has variance ln(1 + 1/16) */
static double lognormal_below(double x)
{
    const double variance = log(1.0625);

    return normal_below((log(x) - log(2) + variance / 2) / sqrt(variance));
}

static double triangular_below(double x)
{
    return x < 1 ? x * x / 3 : 1 - (3 - x) * (3 - x) / 6;
}

static double tail_below(double x)
{
    return (normal_below(-5) - normal_below(-x)) / (normal_below(-5) - normal_below(-6));
}

static int compare(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

/* the largest distance of Kolmogorov and Smirnov, times the root of the number of values */
static double distance(const Distribution *d, double (*below)(double), Sampling sampling)
{
    double points[RUNS], values[RUNS], most = 0;
    Diag diag = {0};

    EXPECT(distribution_check(d, &diag) == OK);
    EXPECT(sampling_fill(sampling, 1, RUNS, 1, points, &diag) == OK);
    for (int i = 0; i < RUNS; i++)
        values[i] = distribution_quantile(d, points[i]);
    qsort(values, RUNS, sizeof *values, compare);
    for (int i = 0; i < RUNS; i++)
        most = fmax(most,
                    fmax((i + 1.0) / RUNS - below(values[i]), below(values[i]) - (double)i / RUNS));
    return most * sqrt(RUNS);
}

/* 1.63: one per cent of random samples are further away; a sample with a point in each of RUNS
 * intervals is nearer than 1/RUNS */
static void values_have_their_distribution(void)
{
    Distribution tail = distribution_of("normal", 0, 1, 0);
    Distribution cases[5] = {
        distribution_of("normal", 0, 1, 0), distribution_of("uniform", 2, 5, 0),
        distribution_of("lognormal", 2, 0.5, 0), distribution_of("triangular", 0, 1, 3)};
    double (*const below[5])(double) = {normal_below, uniform_below, lognormal_below,
                                        triangular_below, tail_below};

    tail.low = 5;
    tail.high = 6;
    cases[4] = tail;
    for (int i = 0; i < 5; i++) {
        EXPECT(distance(&cases[i], below[i], SAMPLING_RANDOM) < 1.63);
        EXPECT(distance(&cases[i], below[i], SAMPLING_LATIN) < 1.001 / sqrt(RUNS));
        EXPECT(distance(&cases[i], below[i], SAMPLING_SOBOL) < 2 / sqrt(RUNS));
    }
}

/* a quantile is where the distribution function has that share, to rounding */
static void quantiles_invert_the_share(void)
{
    const Distribution d = distribution_of("triangular", 0, 1, 3);

    for (int i = 1; i < 100; i++)
        EXPECT_NEAR(triangular_below(distribution_quantile(&d, i / 100.0)), i / 100.0, 1e-14);
}

static void wrong_arguments_are_refused(void)
{
    Distribution cases[] = {
        distribution_of("normal", 0, 0, 0),     distribution_of("uniform", 2, 2, 0),
        distribution_of("lognormal", -1, 1, 0), distribution_of("triangular", 0, 4, 3),
        distribution_of("uniform", 0, 1, 0),    distribution_of("uniform", 0, 1, 0),
        distribution_of("normal", 0, NAN, 0)};
    Diag diag = {0};

    cases[4].low = 2;
    cases[4].high = 3;
    cases[5].low = 0.5;
    cases[5].high = 0.5;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        EXPECT(distribution_check(&cases[i], &diag) == E_VALUE);
}

/* f = sin x + 7 sin^2 y + z^4 sin(x)/10 over [-pi, pi]^3 has the mean 7/2 and the variance
 * 49/8 + pi^4/50 + pi^8/1800 + 1/2 (Ishigami and Homma 1990) */
static void moments_are_those_of_ishigami(void)
{
    static const double bounds[SAMPLINGS] = {4, 0.4, 0.1}; /* of the mean's standard error */
    static double points[3 * RUNS];
    const double variance = 49.0 / 8 + pow(M_PI, 4) / 50 + pow(M_PI, 8) / 1800 + 0.5;

    for (Sampling sampling = 0; sampling < SAMPLINGS; sampling++) {
        SweepTable *table = sweep_table_new(RUNS);
        SweepStatistics s;
        Diag diag = {0};

        sweep_table_column(table, "f", "");
        sweep_table_open(table, 0);
        EXPECT(sampling_fill(sampling, 1, RUNS, 3, points, &diag) == OK);
        for (int i = 0; i < RUNS; i++) {
            const double *u = points + (size_t)3 * (size_t)i;
            const double x = M_PI * (2 * u[0] - 1), y = M_PI * (2 * u[1] - 1);
            const double z = M_PI * (2 * u[2] - 1);

            sweep_table_row(table, i)[0] = sin(x) + 7 * pow(sin(y), 2) + pow(z, 4) * sin(x) / 10;
        }
        table->rows = RUNS;
        s = sweep_statistics(table, 0);
        EXPECT(fabs(s.mean - 3.5) < bounds[sampling] * sqrt(variance / RUNS));
        EXPECT(fabs(s.deviation / sqrt(variance) - 1) < 0.03);
        sweep_table_free(table);
    }
}

/* the numbers of a run don't depend on how many runs there are, nor on those of other columns */
static void streams_are_counted(void)
{
    static double few[2 * 10], many[2 * RUNS];
    Diag diag = {0};

    EXPECT(sampling_fill(SAMPLING_RANDOM, 7, 10, 2, few, &diag) == OK);
    EXPECT(sampling_fill(SAMPLING_RANDOM, 7, RUNS, 2, many, &diag) == OK);
    for (int i = 0; i < 2 * 10; i++)
        EXPECT(few[i] == many[i]);
    EXPECT(random_uniform(7, 3, 1, 0) == many[2 * 3 + 1]);
    EXPECT(random_uniform(8, 3, 1, 0) != many[2 * 3 + 1]);
    EXPECT(sampling_fill(SAMPLING_SOBOL, 7, 10, 41, few, &diag) == E_VALUE);
    EXPECT(strstr(diag.message, "40") != NULL);
}

/* type 7 of Hyndman and Fan: 1 2 4 8 at 1/4 is 1.75; failed runs don't count */
static void quantiles_leave_out_failures(void)
{
    static const double values[] = {8, NAN, 1, 4, NAN, 2}, shares[] = {0, 0.25, 0.5, 1};
    static const double answers[] = {1, 1.75, 3, 8};
    SweepTable *table = sweep_table_new(6);
    SweepStatistics s;
    double out[4];

    sweep_table_column(table, "f", "m");
    sweep_table_open(table, 0);
    for (int i = 0; i < 6; i++)
        sweep_table_row(table, i)[0] = values[i];
    table->rows = 6;
    s = sweep_statistics(table, 0);
    EXPECT(s.count == 4 && s.mean == 3.75 && s.least == 1 && s.most == 8);
    EXPECT_NEAR(s.deviation, sqrt(28.75 / 3), 1e-14);
    sweep_quantiles(table, 0, shares, 4, out);
    for (int i = 0; i < 4; i++)
        EXPECT(out[i] == answers[i]);
    sweep_table_free(table);
}

static double deviate_of(double u)
{
    const Distribution normal = distribution_of("normal", 0, 1, 0);

    return distribution_quantile(&normal, u);
}

/* products of the deviates have the matrix as their means, up to 4 standard errors; the share below
 * each value stays uniform */
static void points_have_their_correlation(void)
{
    static const double wanted[9] = {1, 0.8, -0.3, 0.8, 1, 0.1, -0.3, 0.1, 1};
    static double points[3 * RUNS];
    double factor[9], sums[9] = {0}, shares[3] = {0};
    Diag diag = {0};

    memcpy(factor, wanted, sizeof factor);
    EXPECT(correlation_factor(factor, 3, &diag) == OK);
    EXPECT(sampling_fill(SAMPLING_RANDOM, 1, RUNS, 3, points, &diag) == OK);
    for (int r = 0; r < RUNS; r++) {
        double *u = points + (size_t)3 * (size_t)r;

        correlation_apply(factor, 3, u);
        for (int i = 0; i < 3; i++) {
            shares[i] += u[i] / RUNS;
            for (int k = 0; k < 3; k++)
                sums[3 * i + k] += deviate_of(u[i]) * deviate_of(u[k]) / RUNS;
        }
    }
    for (int i = 0; i < 9; i++)
        EXPECT_NEAR(sums[i], wanted[i], 4 * sqrt((1 + wanted[i] * wanted[i]) / RUNS));
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(shares[i], 0.5, 4 / sqrt(12.0 * RUNS));
}

static void no_correlation_changes_nothing(void)
{
    double factor[4] = {1, 0, 0, 1}, point[2] = {1e-300, 0.75};
    Diag diag = {0};

    EXPECT(correlation_factor(factor, 2, &diag) == OK);
    correlation_apply(factor, 2, point);
    EXPECT_NEAR(point[0] / 1e-300, 1, 1e-9);
    EXPECT_NEAR(point[1], 0.75, 1e-14);
}

static void wrong_correlations_are_refused(void)
{
    double cases[3][4] = {{1, 0.5, 0.4, 1}, {1, 0.5, 0.5, 2}, {1, -1, -1, 1}};
    static const char *const messages[] = {"symmetric", "diagonal", "positive definite"};
    Diag diag = {0};

    for (int i = 0; i < 3; i++) {
        EXPECT(correlation_factor(cases[i], 2, &diag) == E_VALUE);
        EXPECT(strstr(diag.message, messages[i]) != NULL);
    }
}

int main(void)
{
    RUN(blocks_are_those_of_philox);
    RUN(values_have_their_distribution);
    RUN(quantiles_invert_the_share);
    RUN(wrong_arguments_are_refused);
    RUN(moments_are_those_of_ishigami);
    RUN(streams_are_counted);
    RUN(quantiles_leave_out_failures);
    RUN(points_have_their_correlation);
    RUN(no_correlation_changes_nothing);
    RUN(wrong_correlations_are_refused);
    return test_end();
}

/* test_hessenberg_form.c: (s - A)^-1 b of random matrices, by what is left of (s - A) x - b */
#include "algebra/hessenberg_form.h"
#include "base/memory.h"

#include "../random.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define LARGEST 40

/* Entries over `decades` of size; every third one is 0. */
static void fill(double *a, int n, double decades, uint64_t *seed)
{
    for (int i = 0; i < n * n; i++)
        a[i] = i % 3 == 1
                   ? 0
                   : test_uniform(seed, -1, 1) * pow(10, decades * test_uniform(seed, -1, 1));
}

/* largest of |s| |x_i| + sum |a_ik| |x_k|: what rounding of row i is measured by */
static double size_of(const double *a, int n, int i, double s, const double *x, const double *y)
{
    double size = s * (fabs(x[i]) + fabs(y[i]));

    for (int k = 0; k < n; k++)
        size += fabs(a[i * n + k]) * (fabs(x[k]) + fabs(y[k]));
    return size;
}

static void solutions_meet_their_equations(void)
{
    uint64_t seed = 7;
    double a[LARGEST * LARGEST], b[LARGEST] = {0}, c[LARGEST], x[LARGEST], y[LARGEST];

    for (int turn = 0; turn < 200; turn++) {
        int n = 1 + turn % LARGEST;
        double re = 3 * test_uniform(&seed, -1, 1), im = 3 * test_uniform(&seed, -1, 1) + 4;
        HessenbergForm *form;
        ShiftedFactors *factors = shifted_factors_new(n);

        fill(a, n, 1, &seed);
        form = hessenberg_form_new(a, n);
        for (int i = 0; i < n; i++) {
            b[i] = x[i] = test_uniform(&seed, -1, 1);
            c[i] = y[i] = test_uniform(&seed, -1, 1);
        }
        EXPECT(hessenberg_form_factor_complex(form, re, im, factors));
        hessenberg_form_solve_complex(form, factors, x, y);
        for (int i = 0; i < n; i++) {
            double left_re = re * x[i] - im * y[i] - b[i];
            double left_im = re * y[i] + im * x[i] - c[i];
            double size = size_of(a, n, i, fabs(re) + fabs(im), x, y);

            for (int k = 0; k < n; k++) {
                left_re -= a[i * n + k] * x[k];
                left_im -= a[i * n + k] * y[k];
            }
            EXPECT(fabs(left_re) + fabs(left_im) < 1e-11 * (1 + size));
        }
        memcpy(x, b, sizeof x);
        memset(y, 0, sizeof y);
        EXPECT(hessenberg_form_factor(form, 60 + re, factors));
        hessenberg_form_solve(form, factors, x);
        for (int i = 0; i < n; i++) {
            double left = (60 + re) * x[i] - b[i];

            for (int k = 0; k < n; k++)
                left -= a[i * n + k] * x[k];
            EXPECT(fabs(left) < 1e-11 * (1 + size_of(a, n, i, 60 + fabs(re), x, y)));
        }
        shifted_factors_free(factors);
        hessenberg_form_free(form);
    }
}

/* states in units that differ by many decades: as many digits of each as without */
static void units_of_states_cost_no_digits(void)
{
    uint64_t seed = 11;
    int n = 20;
    double a[LARGEST * LARGEST], scaled[LARGEST * LARGEST], unit[LARGEST];
    double x[LARGEST], y[LARGEST];
    HessenbergForm *form, *other;
    ShiftedFactors *factors = shifted_factors_new(n);

    fill(a, n, 0, &seed);
    for (int i = 0; i < n; i++)
        unit[i] = pow(10, 9 * test_uniform(&seed, -1, 1));
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            scaled[i * n + k] = a[i * n + k] * unit[k] / unit[i];
    for (int i = 0; i < n; i++) {
        x[i] = test_uniform(&seed, -1, 1);
        y[i] = x[i] / unit[i];
    }
    form = hessenberg_form_new(a, n);
    other = hessenberg_form_new(scaled, n);
    EXPECT(hessenberg_form_factor(form, 30, factors));
    hessenberg_form_solve(form, factors, x);
    EXPECT(hessenberg_form_factor(other, 30, factors));
    hessenberg_form_solve(other, factors, y);
    for (int i = 0; i < n; i++)
        EXPECT_NEAR(y[i] * unit[i], x[i], 1e-13);
    hessenberg_form_free(form);
    hessenberg_form_free(other);
    shifted_factors_free(factors);
}

static void an_eigenvalue_is_refused(void)
{
    static const double a[4] = {1, 0, 0, 1};
    HessenbergForm *form = hessenberg_form_new(a, 2);
    ShiftedFactors *factors = shifted_factors_new(2);

    EXPECT(!hessenberg_form_factor(form, 1, factors));
    EXPECT(!hessenberg_form_factor_complex(form, 1, 0, factors));
    EXPECT(hessenberg_form_factor(form, 2, factors));
    hessenberg_form_free(form);
    shifted_factors_free(factors);
}

int main(void)
{
    RUN(solutions_meet_their_equations);
    RUN(units_of_states_cost_no_digits);
    RUN(an_eigenvalue_is_refused);
    return test_end();
}

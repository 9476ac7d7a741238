/* correlation.c: z = L Phi^-1(u) has the correlation L L^T, and Phi(z) is uniform */
#include "simulate/sweep/correlation.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

#define SYMMETRIC  1e-12 /* entries of a correlation matrix that differ by less are equal */
#define INDEFINITE 1e-12 /* least square of a pivot */

static Status check_entries(const double *matrix, int n, Diag *diag)
{
    for (int i = 0; i < n; i++)
        for (int k = 0; k <= i; k++) {
            const double below = matrix[i * n + k], above = matrix[k * n + i];

            if (!(fabs(below - above) <= SYMMETRIC))
                return diag_set(
                    diag, E_VALUE,
                    "the correlation matrix is not symmetric: (%d, %d) is %g and (%d, %d) %g",
                    i + 1, k + 1, below, k + 1, i + 1, above);
            if (i == k && !(fabs(below - 1) <= SYMMETRIC))
                return diag_set(diag, E_VALUE,
                                "the diagonal of the correlation matrix is 1, not %g", below);
        }
    return OK;
}

Status correlation_factor(double *matrix, int n, Diag *diag)
{
    TRY(check_entries(matrix, n, diag));
    for (int i = 0; i < n; i++)
        for (int k = 0; k <= i; k++) {
            double rest = matrix[i * n + k];

            for (int j = 0; j < k; j++)
                rest -= matrix[i * n + j] * matrix[k * n + j];
            if (k < i) {
                matrix[i * n + k] = rest / matrix[k * n + k];
                continue;
            }
            if (!(rest > INDEFINITE))
                return diag_set(diag, E_VALUE, "the correlation matrix is not positive definite");
            matrix[i * n + i] = sqrt(rest);
        }
    return OK;
}

/* a normal deviate and back, from that side of the median where it keeps its digits */
static double deviate(double u)
{
    return u > 0.5 ? gsl_cdf_ugaussian_Qinv(1 - u) : gsl_cdf_ugaussian_Pinv(u);
}

static double share_below(double z)
{
    return fmin(fmax(gsl_cdf_ugaussian_P(z), 0x1p-1022), 1 - 0x1p-53);
}

void correlation_apply(const double *factor, int n, double *point)
{
    for (int i = 0; i < n; i++)
        point[i] = deviate(point[i]);
    for (int i = n - 1; i >= 0; i--) { /* those before it are still independent */
        double z = 0;

        for (int k = 0; k <= i; k++)
            z += factor[i * n + k] * point[k];
        point[i] = share_below(z);
    }
}

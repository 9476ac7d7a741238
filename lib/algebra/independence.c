/* independence.c: J J^T - shift 1 is positive definite where J's singular values are beyond the
 * root of the shift
 *
 * Factors without exchanges are as sparse as their order allows. Pivoting by size, which determines
 * a lower rank as well, causes fill-in. The shift is several times the rounding error, which is
 * small for sparse factors: a chain of n bodies with all speeds given has singular values of
 * 1/n^2. */
#include "algebra/independence.h"

#include "algebra/algebra_limits.h"
#include "algebra/gram.h"
#include "base/memory.h"

#include <math.h>

/* whether norms are those of rows of which none is as good as 0, or can't be squared */
static bool are_sound(const double *norm, int m)
{
    double least = INFINITY, largest = 0;

    for (int i = 0; i < m; i++) {
        least = fmin(least, norm[i]);
        largest = fmax(largest, norm[i]);
        if (!(norm[i] < INDEPENDENCE_LARGEST))
            return false;
    }
    return least > 1 / INDEPENDENCE_LARGEST && least > INDEPENDENCE_ZERO_ROW * largest;
}

static double norm_of(const double *row, int count)
{
    double square = 0;

    for (int j = 0; j < count; j++)
        square += row[j] * row[j];
    return sqrt(square);
}

/* the caller passes `gram`, of rows of unit size */
static bool is_definite(Gram *gram, double threshold, const CallMonitor *watch)
{
    const double shift = fmax(INDEPENDENCE_SHIFT * gram_rounding(gram), 4 * threshold * threshold);
    const bool is = gram_factor(gram, -shift, 0, watch);

    gram_free(gram);
    return is;
}

bool rows_are_independent(const double *matrix, int m, int nu, double threshold,
                          const CallMonitor *watch)
{
    double *norm = NEW_ARRAY(double, m);
    bool independent = m <= nu;

    for (int i = 0; i < m && independent; i++)
        norm[i] = norm_of(matrix + (ptrdiff_t)i * nu, nu);
    independent = independent && are_sound(norm, m) &&
                  is_definite(gram_new(matrix, m, nu, norm), threshold, watch);
    mem_free(norm);
    return independent;
}

bool columns_are_independent(const Pattern *pattern, const double *values, double threshold,
                             const CallMonitor *watch)
{
    const int m = pattern->columns;
    double *norm = NEW_ARRAY(double, m);
    bool independent = m <= pattern->rows;

    for (int i = 0; i < m && independent; i++)
        norm[i] = norm_of(values + pattern->start[i], pattern->start[i + 1] - pattern->start[i]);
    independent = independent && are_sound(norm, m) &&
                  is_definite(gram_of_columns(pattern, values, norm), threshold, watch);
    mem_free(norm);
    return independent;
}

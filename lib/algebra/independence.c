/* independence.c: J J^T - shift 1 is positive definite where J's singular values are beyond the
 * root of the shift
 *
 * Its factors without exchange stay as sparse as their order allows, while pivots by size, which
 * tell a rank that is less, fill in. The shift is several times what rounding can do to it, which
 * is little where factors are sparse: a chain of n bodies whose speeds all are given has singular
 * values of 1/n^2. */
#include "algebra/independence.h"

#include "algebra/gram.h"
#include "base/memory.h"

#include <math.h>

#define SAFE    4     /* times what rounding may do */
#define NOTHING 1e-10 /* of the largest row: rounding alone */
#define LARGE   1e100 /* squares of more, or less than its inverse, lose digits or are none */

/* norms of rows; false when one is as good as 0, or can't be squared */
static bool find_norms(const double *matrix, int m, int nu, double *norm)
{
    double least = INFINITY, largest = 0;

    for (int i = 0; i < m; i++) {
        const double *row = matrix + (ptrdiff_t)i * nu;
        double square = 0;

        for (int j = 0; j < nu; j++)
            square += row[j] * row[j];
        norm[i] = sqrt(square);
        least = fmin(least, norm[i]);
        largest = fmax(largest, norm[i]);
        if (!(norm[i] < LARGE))
            return false;
    }
    return least > 1 / LARGE && least > NOTHING * largest;
}

bool rows_are_independent(const double *matrix, int m, int nu, double threshold, const Watch *watch)
{
    double *norm = NEW_ARRAY(double, m);
    bool independent = m <= nu && find_norms(matrix, m, nu, norm);

    if (independent) {
        Gram *gram = gram_new(matrix, m, nu, norm);

        const double shift = fmax(SAFE * gram_rounding(gram), 4 * threshold * threshold);

        independent = gram_factor(gram, -shift, 0, watch);
        gram_free(gram);
    }
    mem_free(norm);
    return independent;
}

/* independence.c: J J^T - shift 1 is positive definite where J's singular values are beyond the
 * root of the shift
 *
 * Its factors without exchange stay as sparse as their order allows, while pivots by size, which
 * tell a rank that is less, fill in. Rounding moves its eigenvalues by no more than some m^2 units
 * in the last place (Higham 2002, 10.1), far less than SHIFT for some thousand rows. */
#include "algebra/independence.h"

#include "algebra/gram.h"
#include "base/memory.h"

#include <math.h>

#define SHIFT   1e-8  /* at least: of singular values of 1e-4 */
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

        independent = gram_factor(gram, -fmax(SHIFT, 4 * threshold * threshold), 0, watch);
        gram_free(gram);
    }
    mem_free(norm);
    return independent;
}

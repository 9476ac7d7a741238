/* perron.c: Collatz's quotients (A v)_i / v_i, whose largest bounds the radius for any v > 0 */
#include "algebra/perron.h"

#include "base/memory.h"

#include <math.h>

enum { ROUNDS = 12 }; /* each gives an upper bound; a few rounds come close */

double perron_bound(PerronApply *apply, const void *context, int n)
{
    double *v = NEW_ARRAY(double, n), *w = NEW_ARRAY(double, n);
    double bound = 0;

    for (int i = 0; i < n; i++)
        v[i] = 1;
    for (int round = 0; round < ROUNDS; round++) {
        double largest = 0;

        bound = 0;
        apply(context, v, w);
        for (int i = 0; i < n; i++) {
            if (!(w[i] / v[i] <= bound))
                bound = w[i] / v[i];
            largest = fmax(largest, w[i]);
        }
        if (!isfinite(bound) || largest == 0)
            break;
        /* a small part of the old v makes all components positive */
        for (int i = 0; i < n; i++)
            v[i] = w[i] / largest + 1e-3 * v[i];
    }
    MEM_FREE(v, w);
    return bound;
}

/* implicit_euler.h: stiff y' = f(y) in long double, by extrapolated linearly implicit Euler steps
 *
 * Deuflhard (1985): with h = H/n and J = df/dy at the start, (1 - h J) (y_{k+1} - y_k) = h f(y_k).
 * The end of a step H has errors in powers of 1/n, which are extrapolated (Aitken, Neville). An
 * oracle's own integrator: it shares neither method nor precision with what it is held against. */
#ifndef COTREE_TESTS_IMPLICIT_EULER_H
#define COTREE_TESTS_IMPLICIT_EULER_H

#include "neville.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { STIFF_STATES = 6, STIFF_COLUMNS = 10, STIFF_STEPS = 20000 };

typedef struct StiffProblem {
    void (*rates)(const void *context, const Real *y, Real *rates); /* t is a state with rate 1 */
    const void *context;
    int count;
    Real enough; /* what the last column may change, of 1 + |y| */
} StiffProblem;

static void stiff_jacobian(const StiffProblem *p, const Real *y, Real j[STIFF_STATES][STIFF_STATES])
{
    Real at[STIFF_STATES], low[STIFF_STATES], high[STIFF_STATES];

    memcpy(at, y, sizeof at);
    for (int c = 0; c < p->count; c++) {
        const Real step = 1e-6L * (1 + fabsl(y[c]));

        at[c] = y[c] + step;
        p->rates(p->context, at, high);
        at[c] = y[c] - step;
        p->rates(p->context, at, low);
        at[c] = y[c];
        for (int r = 0; r < p->count; r++)
            j[r][c] = (high[r] - low[r]) / (2 * step);
    }
}

/* x = a^-1 x by elimination with row exchanges; a is overwritten */
static void stiff_solve(int n, Real a[STIFF_STATES][STIFF_STATES], Real *x)
{
    for (int k = 0; k < n; k++) {
        int most = k;

        for (int r = k + 1; r < n; r++)
            most = fabsl(a[r][k]) > fabsl(a[most][k]) ? r : most;
        for (int c = 0; c < n; c++) {
            const Real swap = a[k][c];

            a[k][c] = a[most][c];
            a[most][c] = swap;
        }
        const Real swap = x[k];

        x[k] = x[most];
        x[most] = swap;
        for (int r = k + 1; r < n; r++) {
            const Real factor = a[r][k] / a[k][k];

            for (int c = k; c < n; c++)
                a[r][c] -= factor * a[k][c];
            x[r] -= factor * x[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int c = k + 1; c < n; c++)
            x[k] -= a[k][c] * x[c];
        x[k] /= a[k][k];
    }
}

/* One step, extrapolated; the largest change that the last column made, of 1 + |y|. */
static Real stiff_step(const StiffProblem *p, Real step, const Real *y, Real *out)
{
    Real j[STIFF_STATES][STIFF_STATES], a[STIFF_STATES][STIFF_STATES];
    Real table[STIFF_COLUMNS][STIFF_STATES], last = 0;

    stiff_jacobian(p, y, j);
    for (int i = 0; i < STIFF_COLUMNS; i++) {
        Real *row = table[i];
        const Real h = step / (i + 1);

        memcpy(row, y, sizeof table[i]);
        for (int k = 0; k <= i; k++) {
            Real rates[STIFF_STATES];

            p->rates(p->context, row, rates);
            for (int r = 0; r < p->count; r++) {
                for (int c = 0; c < p->count; c++)
                    a[r][c] = (r == c) - h * j[r][c];
                rates[r] *= h;
            }
            stiff_solve(p->count, a, rates);
            for (int r = 0; r < p->count; r++)
                row[r] += rates[r];
        }
        last = 0;
        for (int k = i - 1; k >= 0; k--)
            for (int c = 0; c < p->count; c++) {
                const Real change =
                    neville((Real)(i + 1) / (Real)(k + 1), table[k + 1][c], &table[k][c]);

                if (k == 0)
                    last = fmaxl(last, fabsl(change) / (1 + fabsl(y[c])));
            }
    }
    memcpy(out, table[0], sizeof table[0]);
    return last;
}

/* y from 0 on over `span`; false: that takes too many steps */
static bool stiff_run(const StiffProblem *p, Real span, Real *step, Real *y)
{
    Real done = 0, next[STIFF_STATES];

    for (int i = 0; done < span * (1 - 1e-15L); i++) {
        const Real tried = fminl(*step, span - done);
        const Real change = stiff_step(p, tried, y, next);

        if (i == STIFF_STEPS)
            return false;
        if (!(change <= p->enough)) {
            *step = tried / 2;
            continue;
        }
        memcpy(y, next, (size_t)p->count * sizeof(Real));
        done += tried;
        if (change < p->enough / 100)
            *step = fmaxl(*step, tried * 1.4L);
    }
    return true;
}

#endif

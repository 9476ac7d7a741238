/* extrapolated.h: y' = f(y) in long double, by extrapolated midpoint steps (Gragg 1965)
 *
 * An oracle's own integrator: it shares neither method nor precision with what it is held
 * against. */
#ifndef COTREE_TESTS_EXTRAPOLATED_H
#define COTREE_TESTS_EXTRAPOLATED_H

#include "neville.h"

#include <math.h>
#include <string.h>

enum { MOST_STATES = 400 };
typedef struct Extrapolation {
    void (*rates)(const void *context, const Real *y, Real *rates);
    const void *context;
    int count;
    Real enough; /* what the last column may change, of 1 + |y| */
} Extrapolation;

/* n midpoint steps over `step`, smoothed at the end: errors in even powers of 1/n */
static void midpoint(const Extrapolation *by, const Real *y, Real step, int n, Real *out)
{
    const size_t size = (size_t)by->count * sizeof(Real);
    const Real h = step / n;
    Real before[MOST_STATES], now[MOST_STATES], rates[MOST_STATES];

    memcpy(before, y, size);
    by->rates(by->context, y, rates);
    for (int i = 0; i < by->count; i++)
        now[i] = y[i] + h * rates[i];
    for (int k = 1; k < n; k++) {
        by->rates(by->context, now, rates);
        for (int i = 0; i < by->count; i++) {
            const Real next = before[i] + 2 * h * rates[i];

            before[i] = now[i];
            now[i] = next;
        }
    }
    by->rates(by->context, now, rates);
    for (int i = 0; i < by->count; i++)
        out[i] = (now[i] + before[i] + h * rates[i]) / 2;
}

/* One step, extrapolated; the largest difference that the last column made. */
static Real extrapolate(const Extrapolation *by, Real step, Real *y)
{
    enum { ROWS = 8 };
    static Real table[ROWS][MOST_STATES];
    Real last = 0;

    for (int i = 0; i < ROWS; i++) {
        midpoint(by, y, step, 2 * (i + 1), table[i]);
        for (int k = i - 1; k >= 0; k--) {
            const Real ratio = (Real)(i + 1) * (i + 1) / ((Real)(k + 1) * (k + 1));

            for (int c = 0; c < by->count; c++) {
                const Real change = neville(ratio, table[k + 1][c], &table[k][c]);

                if (k == 0 && i == ROWS - 1 && !(fabsl(change) <= last * (1 + fabsl(table[0][c]))))
                    last = isfinite(change) ? fabsl(change) / (1 + fabsl(table[0][c])) : 1;
            }
        }
    }
    memcpy(y, table[0], (size_t)by->count * sizeof(Real));
    return last;
}

/* A step of at most `left`, tried with *step, which becomes that of the next try; how far it went,
 * 0 where it was too long. */
static Real extrapolated_step(const Extrapolation *by, Real left, Real *step, Real *y)
{
    Real tried[MOST_STATES], error;
    const Real size = fminl(*step, left);

    memcpy(tried, y, (size_t)by->count * sizeof(Real));
    error = extrapolate(by, size, tried);
    *step = size * fminl(2, fmaxl(0.2L, 0.8L * powl(by->enough / (error + 1e-30L), 1.0L / 15)));
    if (!(error <= by->enough))
        return 0;
    memcpy(y, tried, (size_t)by->count * sizeof(Real));
    return size;
}

#endif

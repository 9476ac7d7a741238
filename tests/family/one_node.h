/* one_node.h: the voltage of a node that isn't a state, for oracles of networks */
#ifndef COTREE_TESTS_ONE_NODE_H
#define COTREE_TESTS_ONE_NODE_H

#include <math.h>

/* through a diode at v, of the law Is (exp(v/scale) - 1) and a conductance beside, with its slope;
 * straight on where the exponential function is out of bounds */
static inline double diode_current(double Is, double scale, double leakage, double v, double *slope)
{
    const double x = v / scale;
    const double e = x < 100 ? exp(x) : exp(100) * (1 + x - 100);

    *slope = Is * (x < 100 ? e : exp(100)) / scale + leakage;
    return Is * (e - 1) + leakage * v;
}

/* what flows away from the node at v, and its slope; x: the states */
typedef double (*Node)(const void *of, double t, const double *x, double v, double *slope);

/* Newton's method between bounds that close in; the residual rises in v */
static inline double solve_node(Node node, const void *of, double t, const double *x, double reach,
                                double v)
{
    double low = -reach, high = reach;

    for (int k = 0; k < 400; k++) {
        double slope, next;
        const double r = node(of, t, x, v, &slope);

        if (r > 0)
            high = v;
        else
            low = v;
        next = v - r / slope;
        if (!(next > low && next < high) || k % 3 == 2)
            next = low + (high - low) / 2;
        if (fabs(next - v) <= 3e-14 * (1 + fabs(v)))
            return next;
        v = next;
    }
    return v;
}

#endif

/* curve.h: data as a function: a natural cubic spline through points
 *
 * Between the points value, slope and curvature are continuous; outside, the value is that of the
 * end point, and the slope is 0.
 *
 * A law that formulas call by name, C(s), is a function without points. Its numbers are those of
 * some smooth function of this name alone, so that sums vanish at them only if they vanish for any
 * law. */
#ifndef COTREE_EXPR_CURVE_H
#define COTREE_EXPR_CURVE_H

#include <stdbool.h>

typedef struct Curve {
    int count;    /* of points, at least 2; 0: of a law */
    double *data; /* 3 x count: x, which grows, y, and y'' at the points */
    char *file;   /* as the user calls it; the name of a law */
    char *column; /* its name or number; "" if none was given; the name of a law's argument */
} Curve;

enum { CURVE_ORDERS = 4 }; /* value, and derivatives that needn't be 0 */

/* New; copies. curve_free(). O(count). */
Curve *curve_new(const char *file, const char *column, const double *x, const double *y, int count);
Curve *curve_new_law(const char *name, const char *argument); /* new; copies */
static inline bool curve_is_law(const Curve *table)
{
    return table->count == 0;
}
Curve *curve_copy(const Curve *table);
void curve_free(Curve *table); /* NULL is fine */
/* the derivative of that order, 0 its value; 0 beyond the last. O(log count). */
double curve_value(const Curve *table, double x, int order);

#endif

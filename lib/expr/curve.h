/* curve.h: data as a function: a natural cubic spline through points
 *
 * Between the points value, slope and curvature are continuous; outside, the value is that of the
 * end point, and the slope is 0. */
#ifndef COTREE_EXPR_CURVE_H
#define COTREE_EXPR_CURVE_H

typedef struct Curve {
    int count;    /* of points, at least 2 */
    double *data; /* 3 x count: x, which grows, y, and y'' at the points */
    char *file;   /* as the user calls it */
    char *column; /* its name or number; "" if none was given */
} Curve;

enum { CURVE_ORDERS = 4 }; /* value, and derivatives that needn't be 0 */

/* New; copies. curve_free(). O(count). */
Curve *curve_new(const char *file, const char *column, const double *x, const double *y, int count);
Curve *curve_copy(const Curve *table);
void curve_free(Curve *table); /* NULL is fine */
/* the derivative of that order, 0 its value; 0 beyond the last. O(log count). */
double curve_value(const Curve *table, double x, int order);

#endif

/* levenberg_marquardt.h: nonlinear least squares near a start: Levenberg-Marquardt with few moves
 *
 * Residuals r(v) are scaled, as told or by the size of their gradients at the start. A step is
 * d = -J^T (J J^T + mu |r| 1)^-1 r: near the start, short where rows are redundant, and without
 * damping once r is small (Fan and Yuan 2005). */
#ifndef COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H
#define COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H

#include "base/watch.h"

#include <stdbool.h>

typedef struct Rows {
    int rows, columns; /* residuals; directions of motion */
    int length;        /* of v */
    void *context;
    /* residual (rows) and, unless NULL, jacobian (rows x columns) at v */
    void (*evaluate)(void *context, const double *v, double *residual, double *jacobian);
    /* v moved by `step` (columns); NULL: v += step, length == columns */
    void (*move)(void *context, double *v, const double *step);
    const Watch *watch; /* NULL: never stops */
} Rows;

/* Improve v until every scaled residual is below `tolerance`, and then until rounding stops it.
 * held (columns, may be NULL): directions that don't move. scale (rows): what a residual is
 * multiplied by; NULL: one over its gradient. True when the tolerance was met; v is the best point
 * found either way, `residual` (rows, may be NULL) its residuals, unscaled. The watch ends it
 * early. */
bool levenberg_marquardt_solve(const Rows *rows, const bool *held, const double *scale,
                               double tolerance, double *v, double *residual);

#endif

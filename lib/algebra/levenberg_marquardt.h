/* levenberg_marquardt.h: nonlinear least squares near a start: Levenberg-Marquardt with few moves
 *
 * Residuals r(v) are scaled, as told or by the size of their gradients at the start. A step is
 * d = -J^T (J J^T + mu |r| 1)^-1 r: near the start, short where rows are redundant, and without
 * damping once r is small (Fan and Yuan 2005). */
#ifndef COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H
#define COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

typedef struct Rows {
    int rows, columns; /* residuals; directions of motion */
    int length;        /* of v */
    void *context;
    /* where entries of the Jacobian may stand, a column each row; NULL: anywhere. Borrowed */
    const Pattern *pattern;
    /* residual (rows) and, unless NULL, jacobian at v: by places of the pattern, or rows x columns
     */
    void (*evaluate)(void *context, const double *v, double *residual, double *jacobian);
    /* v moved by `step` (columns); NULL: v += step, length == columns */
    void (*move)(void *context, double *v, const double *step);
    const CallMonitor *watch; /* NULL: never stops */
} Rows;

/* The same with the jacobian in full, rows x columns. */
void rows_evaluate_full(const Rows *rows, const double *v, double *residual, double *jacobian);

/* Improve v until every scaled residual is below `tolerance`, and then until rounding stops it.
 * held (columns, may be NULL): directions that don't move. scale (rows): what a residual is
 * multiplied by; NULL: one over its gradient. True when the tolerance was met; v is the best point
 * found either way, `residual` (rows, may be NULL) its residuals, unscaled. The watch ends it
 * early. */
bool levenberg_marquardt_solve(const Rows *rows, const bool *held, const double *scale,
                               double tolerance, double *v, double *residual);

#endif

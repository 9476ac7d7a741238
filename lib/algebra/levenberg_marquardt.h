/* levenberg_marquardt.h: nonlinear least squares near an initial point, by Levenberg-Marquardt
 *
 * Solves r(v) = 0 for residuals r (rows x 1) with Jacobian J (rows x columns). Residuals are scaled
 * by the caller's factors or by the sizes of their gradients at the initial point. A step is d =
 * -J^T (J J^T + mu |r| 1)^-1 r (columns x 1): it remains near the initial point, is short where
 * rows are redundant, and undamped once r is small (Fan and Yuan 2005). */
#ifndef COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H
#define COTREE_ALGEBRA_LEVENBERG_MARQUARDT_H

#include "algebra/pattern.h"
#include "base/call_monitor.h"

#include <stdbool.h>

typedef struct Rows {
    int rows, columns; /* residuals; directions of motion */
    int length;        /* of v */
    void *context;
    /* positions of the Jacobian's entries, one column for each row; NULL: all. Borrowed */
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

/* Improve v until every scaled residual is below `tolerance`, and then down to rounding. held
 * (columns, may be NULL): directions that don't move. scale (rows): factors of the residuals; NULL:
 * one over the size of the gradient. True when the tolerance was met. In either case v becomes the
 * best point found, and `residual` (rows, may be NULL) its unscaled residuals. The watch can end
 * the iteration early. */
bool levenberg_marquardt_solve(const Rows *rows, const bool *held, const double *scale,
                               double tolerance, double *v, double *residual);

#endif

/* response.h: what a linear network answers to its sources: ratios of polynomials in s, in symbols
 *
 * The network's equations with s in the place of d/dt, from rest, solved by elimination without
 * fractions (Bareiss 1968) over polynomials in s and the parameters; common factors are cancelled.
 */
#ifndef COTREE_FORMULATE_REDUCED_RESPONSE_H
#define COTREE_FORMULATE_REDUCED_RESPONSE_H

#include "formulate/reduced/linear_network.h"
#include "formulate/reduced/ratio.h"

typedef struct Response {
    int count; /* of sources */
    Expr *source;
    PolynomialRatio *ratio; /* output over source */
    Expr s;                 /* symbol; of no name that a parameter has */
} Response;

/* The response of an expression of the user's to a source (its name), or to all (NULL). New; free
 * with response_free(). `about` is what a message calls the output. Fails with E_NAME for no
 * independent source, E_MODEL, naming the part, where the network isn't linear, hangs on the
 * mechanism, varies in time or determines nothing, and E_VALUE where the answer would be too long;
 * the errors of system_new(). */
MUST_USE Status response_new(const Scene *scene, Expr output, const char *about, const char *source,
                             const CallMonitor *watch, Response **out, Diag *diag);
void response_free(Response *response); /* NULL is fine */

#endif

/* response.h: transfer functions of a linear network: ratios of polynomials in s, in symbols
 *
 * The network's equations with s for d/dt, from rest, solved by fraction-free elimination (Bareiss
 * 1968) over polynomials in s and the parameters; common factors are cancelled. */
#ifndef COTREE_FORMULATE_REDUCED_RESPONSE_H
#define COTREE_FORMULATE_REDUCED_RESPONSE_H

#include "formulate/reduced/linear_network.h"
#include "formulate/reduced/ratio.h"

typedef struct Response {
    int count; /* of sources */
    Expr *source;
    PolynomialRatio *ratio; /* output over source */
    Expr s;                 /* symbol; its name differs from all parameters */
} Response;

/* The response of a user's expression to a source (its name), or to all (NULL). New; free with
 * response_free(). `about` is the name of the output in a message. Fails with E_NAME if there is no
 * such independent source, with E_MODEL, naming the part, where the network isn't linear, depends
 * on the mechanism, varies in time or leaves the output undetermined, and with E_VALUE where the
 * answer would be too long; the errors of system_new(). */
MUST_USE Status response_new(const Scene *scene, Expr output, const char *about, const char *source,
                             const CallMonitor *watch, Response **out, Diag *diag);
void response_free(Response *response); /* NULL is fine */

#endif

/* linear_network.h: the equations of a linear network, and their coefficients
 *
 *     A w = sum_j right_j c_j,   w = [x'; z],   c = [x; u, u', u'' of each source]
 *
 * x: its states; u: the values of its independent sources, where symbols replace the user's values.
 * Coefficients contain parameters and t. */
#ifndef COTREE_FORMULATE_REDUCED_LINEAR_NETWORK_H
#define COTREE_FORMULATE_REDUCED_LINEAR_NETWORK_H

#include "base/memory.h"
#include "formulate/system/system.h"

enum { INPUT_ORDERS = 3 }; /* u, u', u'' */

typedef struct LinearNetwork {
    const Scene *scene;
    const CallMonitor *watch;
    Arena *arena;
    const System *system;
    LIST(const Instance *) sources;
    LIST(Expr)
    symbols;            /* of sources: INPUT_ORDERS each; the first prints as the source's name */
    bool names_numbers; /* numbers of parts are symbols of their own: no rounding in between */
    LIST(Expr) parameters, values; /* symbols that are replaced by their values */
    Expr t, start;                 /* the time about which a source's value is expanded */
    int n, columns;                /* equations; columns of the right sides */
    Expr *right;                   /* n x columns */
    int *row_start;                /* entries of a row of A are entry[row_start[r]] .. */
    Entry *entry;
} LinearNetwork;

/* Finds the sources and forms the equations, but reads no coefficients yet; end with
 * linear_network_free() in any case. Fails with the errors of system_new(), and E_MODEL for sampled
 * parts. */
MUST_USE Status linear_network_form(const Scene *scene, bool names_numbers,
                                    const CallMonitor *watch, LinearNetwork *out, Diag *diag);
/* the value of a number's symbol; NULL: it is none */
Expr linear_network_number(const LinearNetwork *network, Expr symbol);
/* Reads the coefficients. Fails with E_MODEL, naming the part, where the network isn't linear or
 * depends on the mechanism. */
MUST_USE Status linear_network_read(LinearNetwork *network, Diag *diag);
/* The coefficients of an expression over w, x and sources: n + columns of them. `about` is its name
 * in a message. */
MUST_USE Status linear_network_slopes(const LinearNetwork *network, Expr e, const char *about,
                                      Expr *out, Diag *diag);
/* the part that an equation belongs to */
const char *linear_network_part(const LinearNetwork *network, int row);
void linear_network_free(LinearNetwork *network);

/* most terms of an expression that is multiplied out */
enum { LINEAR_TERMS = 4000 };

#endif

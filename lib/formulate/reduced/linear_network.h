/* linear_network.h: the equations of a linear network, their coefficients read off
 *
 *     A w = sum_j right_j c_j,   w = [x'; z],   c = [x; u, u', u'' of each source]
 *
 * x: its states; u: the values of its independent sources, symbols in the place of what the user
 * gave them. Coefficients hold parameters and t. */
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
    symbols; /* of sources: INPUT_ORDERS each; the first prints as the source is called */
    bool names_numbers; /* numbers of parts are symbols of their own: nothing is rounded on the way
                         */
    LIST(Expr) literals, numbers; /* these, and what they stand for */
    Expr t, start;                /* the instant about which a source's value is developed */
    int n, columns;               /* equations; columns of the right sides */
    Expr *right;                  /* n x columns */
    int *row_start;               /* entries of a row of A are entry[row_start[r]] .. */
    Entry *entry;
} LinearNetwork;

/* Sources found and equations formed, none read yet; end with linear_network_free() in any case.
 * Fails with the errors of system_new(), E_MODEL for what is sampled. */
MUST_USE Status linear_network_form(const Scene *scene, bool names_numbers,
                                    const CallMonitor *watch, LinearNetwork *out, Diag *diag);
/* what a symbol of a number stands for; NULL: it is none */
Expr linear_network_number(const LinearNetwork *network, Expr symbol);
/* The coefficients. Fails with E_MODEL, naming the part, where the network isn't linear or hangs on
 * the mechanism. */
MUST_USE Status linear_network_read(LinearNetwork *network, Diag *diag);
/* Those of an expression over w, x and sources: n + columns of them. `about` is what it is called
 * in a message. */
MUST_USE Status linear_network_slopes(const LinearNetwork *network, Expr e, const char *about,
                                      Expr *out, Diag *diag);
/* the part that an equation belongs to */
const char *linear_network_part(const LinearNetwork *network, int row);
void linear_network_free(LinearNetwork *network);

/* terms that are multiplied out at most */
enum { LINEAR_TERMS = 4000 };

#endif

/* port.h: what a mechanism is at frames: forces and moments against accelerations
 *
 *     Norton:    F = F0 - L a       F: forces and moments of the mechanism on what is attached
 *     Thevenin:  a = a0 + Y F       F: forces and moments on the mechanism
 *
 * a: accelerations of the frames, in components that are named, as "m1.ax" and "m1.alphaz". Both
 * follow from
 *
 *     M u' + Phi_u^T lambda = F(q, u, x, z, t) + J^T (forces at the frames)
 *     Phi_u u' = gamma,   a = J u' + b
 *
 * (McPhee, Schmitke and Redmond's generalisation of the theorems of Norton and Thevenin; theory
 * 10). */
#ifndef COTREE_FORMULATE_REDUCED_PORT_H
#define COTREE_FORMULATE_REDUCED_PORT_H

#include "formulate/system/system.h"

typedef struct PortOptions {
    const char *const *components; /* accelerations in the order of F and a */
    int count;
    /* of frames that move as the rest of a model does: accelerations that are symbols of the user's
     * with these names in F0 and a0 */
    const char *const *given;
    int given_count;
    bool is_norton;
    bool is_numeric;     /* for port_numbers(): equations by shared definitions */
    bool keeps_networks; /* unknowns of networks remain; otherwise linear networks are solved */
    const CallMonitor *watch;
} PortOptions;

/* The equations above; `rest` is b. */
typedef struct PortEquations {
    Arena *arena;
    System *system;
    PortOptions options; /* borrowed */
    int nu, m;
    int ends; /* options.count + options.given_count */
    Expr *mass, *phi_u, *force, *gamma;
    Expr *slope, *rest;    /* of accelerations: ends x nu, ends */
    const char *nonlinear; /* the part for which a network was kept; NULL: none */
} PortEquations;

/* Why there is no such relation. */
typedef struct PortFault {
    const char *unknown; /* a speed that nothing determines; NULL: not known */
    const char *driver;  /* a driver of the mechanism; NULL: none */
} PortFault;

/* New; free with port_free(). `view` is borrowed. Fails with E_MODEL, naming the part, where a
 * force depends on reactions or on unknown sides. */
MUST_USE Status port_new(System *view, const PortOptions *options, PortEquations **out, Diag *diag);
void port_free(PortEquations *port); /* NULL is fine */

/* F0 or a0 (count) and L or Y (count x count) in symbols. E_SINGULAR without a message, with
 * *fault, where there is none for any numbers. */
MUST_USE Status port_symbols(const PortEquations *port, Expr *constant, Expr *matrix,
                             PortFault *fault);
/* The same in numbers, by the values of symbols; dependent constraints count once. E_VALUE without
 * a message where a number isn't finite. */
MUST_USE Status port_numbers(const PortEquations *port, SymbolValue value, void *context,
                             double *constant, double *matrix, PortFault *fault);
/* The number in the place of each sum that is 0, 1 or -1 as Euler parameters are of size 1. */
void port_fold_units(const PortEquations *port, Expr *e, int count);
/* The symbols that occur: new, mem_free(). */
int port_symbols_of(const PortEquations *port, Expr **out);

#endif

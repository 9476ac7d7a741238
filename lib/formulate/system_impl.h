/* system_impl.h: a System and its parts, which the files of formulation share */
#ifndef COTREE_FORMULATE_SYSTEM_IMPL_H
#define COTREE_FORMULATE_SYSTEM_IMPL_H

#include "formulate/constraints.h"
#include "formulate/dynamics.h"
#include "formulate/kinematics.h"
#include "formulate/network.h"
#include "formulate/origin.h"
#include "formulate/sample.h"
#include "formulate/shown.h"

struct System {
    Arena *arena;
    Pool *pool;         /* names and small arrays */
    const Scene *scene; /* while it is made; NULL afterwards */
    const Watch *watch; /* likewise */

    Origin *origin;
    Kinematics *kinematics;
    Constraints *constraints;
    Dynamics *dynamics;
    Network *network;
    Reading definitions; /* by recursion, whatever the size */
    Reading run;         /* these, or the shorter equations as shown */
    LIST(const char *) remarks;

    LIST(System *) modes; /* of those whose sides are open, made so far */
    System *sided;        /* the same whose sides are looked for; it or one of the modes */
    System *whole;        /* that it was made for, and which owns it; NULL: none */

    bool is_early;    /* reactions aren't there yet */
    bool asked_early; /* and were asked for */
    Shown *shown;
    /* how a name becomes an expression: system_variable(), which all that tells one stands before
     */
    Status (*variable)(System *system, const char *path, int primes, Expr *out, Diag *diag);
};

/* before something of a finished System changes */
static inline void system_touch(System *system)
{
    mem_keep(system);
    mem_keep(system->network);
    mem_keep(system->shown);
}

/* text in the pool */
const char *system_keep(System *system, const char *format, ...) PRINTF(2, 3);

/* value of a coordinate and its first and second derivatives, branch or chord */
MUST_USE Status coordinate_value(System *system, const Instance *owner, int coordinate, int primes,
                                 Expr *out, Diag *diag);
/* derivative along the motion: q -> q', u -> u', x -> x', t -> 1 */
MUST_USE Status system_rate_of(System *system, Expr e, Expr *out, Diag *diag);
/* derivative of e(q) per unit of a speed */
Expr speed_partial(System *system, Expr e, int speed);
/* E_MISSING while reactions, multipliers and entries of M can't be told yet */
MUST_USE Status system_wait_for_motion(System *system, Diag *diag);
/* e over user's variables to e over the system's */
MUST_USE Status variables_resolve(System *system, Expr user, Expr *out, Diag *diag);

/* --- the cheaper reading (reading.c) --- */

MUST_USE Status reading_choose(System *system, Diag *diag);

#endif

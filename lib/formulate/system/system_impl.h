/* system_impl.h: a System and its parts, each with a header of its own */
#ifndef COTREE_FORMULATE_SYSTEM_SYSTEM_IMPL_H
#define COTREE_FORMULATE_SYSTEM_SYSTEM_IMPL_H

#include "base/memory.h"
#include "formulate/system/system.h"

typedef struct IsomorphicSubsystems IsomorphicSubsystems;
typedef struct Constraints Constraints;
typedef struct Dynamics Dynamics;
typedef struct Kinematics Kinematics;
typedef struct Network Network;
typedef struct Origin Origin;
typedef struct Shown Shown;

struct System {
    Arena *arena;
    Pool *pool;                  /* names and small arrays; of a view: of what is formed for it */
    const Scene *scene;          /* while it is made; NULL afterwards */
    const CallMonitor *watch;    /* likewise, or set by system_set_watch() */
    IsomorphicSubsystems *alike; /* likewise, or where no definition has instances */

    /* parts: a view borrows them */
    Origin *origin;
    Kinematics *kinematics;
    Constraints *constraints;
    Dynamics *dynamics;
    Network *network;
    EquationForm definitions; /* by recursion, whatever the size */
    EquationForm run;         /* these, or the shorter equations as shown */
    LIST(const char *) remarks;

    bool is_early;    /* while it is made: reactions aren't there yet */
    bool asked_early; /* and were asked for */

    const System *formed; /* of a view: what it is a view on; NULL: it is no view */
    bool owns_formed;
    Shown *shown;         /* of a view, or while it is made */
    LIST(System *) modes; /* views: of those whose sides are open, made so far */
    System *numbered;     /* all those that keep the states, by numbers for sides; NULL: not made */
    System *sided;        /* the same whose sides are looked for; it or one of the modes */
    System *whole;        /* that it was made for, and which owns it; NULL: none */
    /* how a name becomes an expression: system_variable(), which all that tells one stands before
     */
    Status (*variable)(System *system, const char *path, int primes, Expr *out, Diag *diag);
};

/* before a view forms something: all else is as it was made */
static inline void system_touch(System *view)
{
    mem_keep(view);
    mem_keep(view->shown);
}

/* texts in the pool: two joined, or as printf() does it */
const char *system_join(const System *system, const char *one, const char *other);
const char *system_retain(const System *system, const char *format, ...) PRINTF(2, 3);

#endif

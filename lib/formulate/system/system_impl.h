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
    Pool *pool;                  /* names and small arrays; of a view: for what it forms */
    const Scene *scene;          /* while it is built; NULL afterwards */
    const CallMonitor *watch;    /* likewise, or set by system_set_watch() */
    IsomorphicSubsystems *alike; /* likewise; NULL where no definition has instances */

    /* parts: a view borrows them */
    Origin *origin;
    Kinematics *kinematics;
    Constraints *constraints;
    Dynamics *dynamics;
    Network *network;
    EquationForm definitions; /* recursive definitions, whatever the size */
    EquationForm run; /* the definitions, or the expanded equations where those are shorter */
    LIST(const char *) remarks;

    bool is_early;    /* while it is built: reactions don't exist yet */
    bool asked_early; /* and were needed */

    const System *formed; /* of a view: its System; NULL: it is no view */
    bool owns_formed;
    Shown *shown;         /* of a view, or while it is built */
    LIST(System *) modes; /* views of the modes, built so far */
    /* the hybrid system with numbers for sides, for all modes with the same states; NULL: not
     * built */
    System *numbered;
    System *sided; /* the system in which sides are searched; this one or one of the modes */
    System *whole; /* the hybrid system that owns it; NULL: none */
    /* returns the expression of a name: system_variable(). A pointer, as files before variables.c
     * need it */
    Status (*variable)(System *system, const char *path, int primes, Expr *out, Diag *diag);
};

/* call before a view forms something: all else is unchanged since it was built */
static inline void system_touch(System *view)
{
    mem_keep(view);
    mem_keep(view->shown);
}

/* texts in the pool: two joined, or formatted as by printf() */
const char *system_join(const System *system, const char *one, const char *other);
const char *system_retain(const System *system, const char *format, ...) PRINTF(2, 3);

#endif

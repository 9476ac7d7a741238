/* rests.h: the positions at which events that happen ever faster come to rest */
#ifndef COTREE_FORMULATE_DYNAMICS_RESTS_H
#define COTREE_FORMULATE_DYNAMICS_RESTS_H

#include "formulate/system/system.h"

/* The effort that may hold the guard of origin->rests[i], along it; *guard NULL: it has none. */
MUST_USE Status rest_effort(System *system, int i, Expr *guard, Expr *effort, Diag *diag);

#endif

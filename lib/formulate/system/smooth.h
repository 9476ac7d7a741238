/* smooth.h: expressions that are differentiated in time must not jump */
#ifndef COTREE_FORMULATE_SYSTEM_SMOOTH_H
#define COTREE_FORMULATE_SYSTEM_SMOOTH_H

#include "formulate/system/system.h"

/* e is differentiated in time for the part `who`: E_MODEL where it jumps */
MUST_USE Status system_need_smooth(const System *system, const char *who, Expr e, Diag *diag);

#endif

/* laws.h: efforts of parts as functions of the motion, and the inertia in them */
#ifndef COTREE_FORMULATE_DYNAMICS_LAWS_H
#define COTREE_FORMULATE_DYNAMICS_LAWS_H

#include "formulate/system/system.h"

/* Which part of a law is meant: all of it, its value at u' = 0, or (the number of a speed) its
 * derivative by that entry of u'. That is E_MODEL where the law is not linear in u'. */
enum { TAKE_ALL = -2, TAKE_AT_REST = -1 };

/* the law of an instance in the system's variables */
MUST_USE Status law_read(System *system, const Instance *instance, Expr law, Expr *out, Diag *diag);
MUST_USE Status law_add(const System *system, const Instance *instance, int take, Expr *law,
                        Diag *diag);
bool law_is_inertial(Expr law); /* it contains u' */

#endif

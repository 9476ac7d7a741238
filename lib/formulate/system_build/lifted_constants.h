/* lifted_constants.h: numbers given for parts, as parameters of the equations
 *
 * An edit of a large model most often changes a number: a mass, a length, an axis. Where symbols
 * replace such numbers, the equations remain the same after the edit, and so do the programs made
 * from them; only values differ. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_LIFTED_CONSTANTS_H
#define COTREE_FORMULATE_SYSTEM_BUILD_LIFTED_CONSTANTS_H

#include "formulate/system/system.h"

/* Replaces numbers in the values of parts by symbols, and adds these and the numbers to the
 * parameters of a System that is being built. The scene is borrowed and unchanged. */
void lifted_constants_set(System *system, const Scene *scene);

#endif

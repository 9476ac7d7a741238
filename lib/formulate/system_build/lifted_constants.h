/* lifted_constants.h: numbers that a part was given, as parameters of the equations
 *
 * An edit of a large model is most often of a number: a mass, a length, an axis. Where such numbers
 * stand in the equations as symbols, these are the same equations after it, and so are the programs
 * made from them; only values are others. */
#ifndef COTREE_FORMULATE_SYSTEM_BUILD_LIFTED_CONSTANTS_H
#define COTREE_FORMULATE_SYSTEM_BUILD_LIFTED_CONSTANTS_H

#include "formulate/system/system.h"

/* Puts them into a System that is made. */
void lifted_constants_set(System *system, const Scene *scene);

#endif

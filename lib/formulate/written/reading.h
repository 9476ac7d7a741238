/* reading.h: the reading that programs are made from */
#ifndef COTREE_FORMULATE_WRITTEN_READING_H
#define COTREE_FORMULATE_WRITTEN_READING_H

#include "formulate/system/system.h"

/* which form a run takes: the recursive, or the expanded where that is shorter */
MUST_USE Status reading_choose(System *system, Diag *diag);

#endif

/* equation_form.h: the equation form that programs are made from */
#ifndef COTREE_FORMULATE_EXPANDED_EQUATION_FORM_H
#define COTREE_FORMULATE_EXPANDED_EQUATION_FORM_H

#include "formulate/system/system.h"

/* chooses the form that a run uses: the recursive, or the expanded where that is shorter */
MUST_USE Status equation_form_choose(System *system, Diag *diag);

#endif

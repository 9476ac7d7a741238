/* sections.h: forces and moments in the sections of beams */
#ifndef COTREE_FORMULATE_DYNAMICS_SECTIONS_H
#define COTREE_FORMULATE_DYNAMICS_SECTIONS_H

#include "formulate/system/system.h"

/* a component of what the part beyond the place `at` exerts on the part before it */
MUST_USE Status section_force(System *system, const Instance *part, const SectionPart *wanted,
                              Expr at, Expr *out, Diag *diag);

#endif

/* compiled_equations.h: the recursive form of a System compiled to numeric Equations
 *
 * The layout determines on which sides of its surfaces they are. */
#ifndef COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_H
#define COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_H

#include "simulate/equations/probe.h"

typedef struct CompiledEquations CompiledEquations;
/* Compile the recursive form. `layout` and `parameters` outlive it. */
MUST_USE Status compiled_new(const VariableIndex *layout, Parameters *parameters,
                             CompiledEquations **out, Diag *diag);
void compiled_free(CompiledEquations *numbers); /* NULL is fine */
const Equations *compiled_equations(const CompiledEquations *numbers);
/* Prepare for modes that slide along the layout's surfaces where `on` does. E_MISSING: how one of
 * them is left can't be determined. */
MUST_USE Status compiled_slide(CompiledEquations *numbers, const OnSurface *on, Diag *diag);
/* The expression that remains 0 while the motion slides along a surface, which determines its k-th
 * unknown sign, in the layout's mode; it is of the level of that sign: of u', x' or z. Fails as
 * system_rate() does. */
MUST_USE Status compiled_slip(const VariableIndex *layout, int k, Expr *out, Diag *diag);
/* What becomes 0 where the k-th sign reaches its lower or upper bound (end: -1, 1), over the
 * layout's symbols; NULL: it is one of a vector, or has no such bound. */
Expr compiled_bound(const VariableIndex *layout, int k, int end);
/* Set conditions and surfaces to the layout's mode, when that has changed. */
void compiled_enter_mode(CompiledEquations *numbers);
/* Set a parameter in all of its programs that contain it. */
void compiled_set(CompiledEquations *numbers, Expr parameter, double value);
/* The programs of a run: first the equations, with M and F where these are requested. */
typedef enum CompiledPart {
    COMPILED_EQUATIONS,
    COMPILED_NETWORK,
    COMPILED_CONDITIONS,
    COMPILED_DRIFT,
    COMPILED_MASS,
    COMPILED_RATES, /* once constraints are eliminated: what a run evaluates most often */
    COMPILED_PARTS
} CompiledPart;
/* NULL: there is none; borrowed */
const Program *compiled_program(const CompiledEquations *numbers, CompiledPart part);
/* The expression that condition i of the equations compares with 0. NULL: the condition is whether
 * a diode keeps its switch state. */
Expr compiled_condition(const CompiledEquations *numbers, int i);
/* where that is NULL: the switch, of system_ideal(), whose margin the condition is */
int compiled_margin(const CompiledEquations *numbers, int condition);

#endif

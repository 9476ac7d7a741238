/* compiled_equations.h: the recursive form of a System as Equations in numbers
 *
 * On the layout's sides of its surfaces. */
#ifndef COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_H
#define COTREE_SIMULATE_EQUATIONS_COMPILED_EQUATIONS_H

#include "simulate/equations/probe.h"

typedef struct CompiledEquations CompiledEquations;
/* Compile the recursive form. `layout` and `parameters` outlive it. */
MUST_USE Status compiled_new(const VariableIndex *layout, Parameters *parameters,
                             CompiledEquations **out, Diag *diag);
void compiled_free(CompiledEquations *numbers); /* NULL is fine */
const Equations *compiled_equations(const CompiledEquations *numbers);
/* Another value of a parameter in all of its programs, where they hold it. */
void compiled_set(CompiledEquations *numbers, Expr parameter, double value);
/* what is run: the equations first, and with them M and F where they are asked for */
typedef enum CompiledPart {
    COMPILED_EQUATIONS,
    COMPILED_NETWORK,
    COMPILED_CONDITIONS,
    COMPILED_DRIFT,
    COMPILED_MASS,
    COMPILED_RATES, /* once constraints are eliminated: what a run asks for most of all */
    COMPILED_PARTS
} CompiledPart;
/* NULL: there is none; borrowed */
const Program *compiled_program(const CompiledEquations *numbers, CompiledPart part);
/* what condition i of the equations compares with 0; NULL: it is whether a diode stays on its side
 */
Expr compiled_condition(const CompiledEquations *numbers, int i);
/* the switch, of system_ideal(), that a condition is the margin of, where that gives NULL */
int compiled_margin(const CompiledEquations *numbers, int condition);

#endif

/* numbers.h: the recursive form of a System as Equations in numbers
 *
 * On the layout's sides of its surfaces. */
#ifndef COTREE_SIMULATE_EQUATIONS_NUMBERS_H
#define COTREE_SIMULATE_EQUATIONS_NUMBERS_H

#include "simulate/equations/probe.h"

typedef struct Numbers Numbers;
/* Compile the recursive form. `layout` and `parameters` outlive it. */
MUST_USE Status numbers_new(const Layout *layout, Parameters *parameters, Numbers **out,
                            Diag *diag);
void numbers_free(Numbers *numbers); /* NULL is fine */
const Equations *numbers_equations(const Numbers *numbers);
/* Another value of a parameter in all of its programs, where they hold it. */
void numbers_set(Numbers *numbers, Expr parameter, double value);
/* what is run: the equations first, and with them M and F where they are asked for */
typedef enum NumbersPart {
    NUMBERS_EQUATIONS,
    NUMBERS_NETWORK,
    NUMBERS_CONDITIONS,
    NUMBERS_SLIP,
    NUMBERS_MASS,
    NUMBERS_RATES, /* once constraints are eliminated: what a run asks for most of all */
    NUMBERS_PARTS
} NumbersPart;
/* NULL: there is none; borrowed */
const Program *numbers_program(const Numbers *numbers, NumbersPart part);
/* what condition i of the equations compares with 0; NULL: it is whether a diode stays on its side
 */
Expr numbers_condition(const Numbers *numbers, int i);
/* the switch, of system_ideal(), that a condition is the margin of, where that gives NULL */
int numbers_margin(const Numbers *numbers, int condition);

#endif

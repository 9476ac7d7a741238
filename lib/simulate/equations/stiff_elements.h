/* stiff_elements.h: stiff functions and sources, the parts of a system's equations that can act
 * briefly
 *
 *     y' = f(t, y, N(a(y, w)), s(t)),   w = [x'; z]
 *
 * Elements are calls of functions N that rise by orders of magnitude over a short way of their
 * argument a, which holds variables: a diode's exponential, a contact's tanh. Sources are the
 * maximal subexpressions of t alone. StiffElements predicts the arguments while elements that don't
 * conduct have no current: about a point, a is affine in sources and quadratic in time,
 *
 *     a(x) = a + rate (x - t) + bend (x - t)^2 + sum_j by_source[j] (s_j(x) - s_j(t))
 *
 * with the slopes at the point for elements that conduct. */
#ifndef COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_H
#define COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_H

#include "expr/range.h"
#include "simulate/equations/compiled_equations.h"

typedef struct StiffElements StiffElements;

/* New; free with stiff_elements_free(). NULL where the equations have no such elements or sources.
 * Borrows all. O(nodes of the equations). */
MUST_USE Status stiff_elements_new(const VariableIndex *layout, Parameters *parameters,
                                   Motion *motion, const Equations *equations, StiffElements **out,
                                   Diag *diag);
void stiff_elements_free(StiffElements *stiff_elements); /* NULL is fine */
int stiff_elements_element_count(const StiffElements *stiff_elements);
int stiff_elements_source_count(const StiffElements *stiff_elements);
/* name of the first variable of an element's argument, borrowed */
const char *stiff_elements_variable(const StiffElements *stiff_elements, int element);

/* ranges of the sources, or of their second derivatives, over an interval; borrowed, until the next
 * call */
const Range *stiff_elements_sources_over(StiffElements *stiff_elements, Range over);
const Range *stiff_elements_bends_over(StiffElements *stiff_elements, Range over);
/* Tighter ranges of the sources, where terms cancel: s(m) + s' (x - m) about the middle m. Three
 * times the cost. */
const Range *stiff_elements_sources_close(StiffElements *stiff_elements, Range over);
/* The same of one source, at the cost of its own expression. */
Range stiff_elements_source_over(StiffElements *stiff_elements, int source, Range over);
Range stiff_elements_source_close(StiffElements *stiff_elements, int source, Range over);
/* Number of ranges of expressions computed so far. */
int64_t stiff_elements_visits(const StiffElements *stiff_elements);

/* A run goes from..to, s: from here on the sizes of sources are their ranges in it. */
void stiff_elements_span(StiffElements *stiff_elements, double from, double to);
double stiff_elements_source_size(const StiffElements *stiff_elements,
                                  int source); /* 0: not known */

/* The logarithm of an element's value, over a range of its argument. */
Range stiff_elements_size(const StiffElements *stiff_elements, int element, Range argument);

/* Arguments at (t, y), into a[elements]. False: the equations have no solution there. */
bool stiff_elements_arguments(StiffElements *stiff_elements, double t, const double *y, double *a);

/* coefficients of a about (t, y), see above: arrays of elements, and elements x sources */
typedef struct Affine {
    double *a, *rate, *bend, *by_source;
} Affine;
/* `slope` is y' along the interval of interest, `h` its length, s. leaks[k] is the slope of an
 * element that doesn't conduct; NAN: it conducts and has the slope of its law. False: there is no
 * solution. O(sources) solutions of the network's linear equations. */
bool stiff_elements_linearise(StiffElements *stiff_elements, double t, const double *y,
                              const double *slope, double h, const double *leaks, Affine *out);
/* Changes of arguments[elements] and of the network's x' when y moves by `off`, where each element
 * has the slope `leak`, or its least slope if that is more. False: there is no solution. */
bool stiff_elements_answers(StiffElements *stiff_elements, double t, const double *y,
                            const double *off, double leak, double *arguments, double *rates);
/* Change of the rates of y by element k's value, or by source k's, each over `scale` of its entry;
 * returns the largest. About the point of stiff_elements_linearise(), or about (t, y) where there
 * was none. */
double stiff_elements_effect_of_element(StiffElements *stiff_elements, int k, const double *scale);
double stiff_elements_effect_of_source(StiffElements *stiff_elements, int k, double t,
                                       const double *y, const double *scale);

#endif

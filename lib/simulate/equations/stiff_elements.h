/* stiff_elements.h: what in a system's equations can act for a short time
 *
 *     y' = f(t, y, N(a(y, w)), s(t)),   w = [x'; z]
 *
 * Elements are calls of functions N that rise by orders of magnitude over a short way of their
 * argument a, which holds variables: a diode's exponential, a contact's tanh. Sources are what the
 * equations hold of t alone, each as large a part as there is. Steep tells how arguments move while
 * elements that don't conduct let nothing through: about a point, a is affine in sources and
 * quadratic in time,
 *
 *     a(x) = a + rate (x - t) + bend (x - t)^2 + sum_j by_source[j] (s_j(x) - s_j(t))
 *
 * with the slopes of those that conduct as they are at the point. */
#ifndef COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_H
#define COTREE_SIMULATE_EQUATIONS_STIFF_ELEMENTS_H

#include "expr/range.h"
#include "simulate/equations/compiled_equations.h"

typedef struct StiffElements StiffElements;

/* New, or NULL where the equations hold no such thing; stiff_elements_free(). Borrows all. O(nodes
 * of the equations). */
MUST_USE Status stiff_elements_new(const VariableIndex *layout, Parameters *parameters,
                                   Motion *motion, const Equations *equations, StiffElements **out,
                                   Diag *diag);
void stiff_elements_free(StiffElements *stiff_elements); /* NULL is fine */
int stiff_elements_elements(const StiffElements *stiff_elements);
int stiff_elements_sources(const StiffElements *stiff_elements);
/* the first variable of an element's argument, borrowed */
const char *stiff_elements_variable(const StiffElements *stiff_elements, int element);

/* ranges of the sources, or of their second derivatives, over an interval; borrowed, until the next
 * call */
const Range *stiff_elements_sources_over(StiffElements *stiff_elements, Range over);
const Range *stiff_elements_bends_over(StiffElements *stiff_elements, Range over);
/* the ranges of the sources once more, where terms cancel much closer: s(m) + s' (x - m) about the
 * middle. Three times the work. */
const Range *stiff_elements_sources_close(StiffElements *stiff_elements, Range over);
/* The same of one source: the work is that of its own expression. */
Range stiff_elements_source_over(StiffElements *stiff_elements, int source, Range over);
Range stiff_elements_source_close(StiffElements *stiff_elements, int source, Range over);
/* How many ranges of expressions all this has taken so far. */
int64_t stiff_elements_visits(const StiffElements *stiff_elements);

/* A run goes from..to, s: from here on sources are as large as their ranges in it. */
void stiff_elements_span(StiffElements *stiff_elements, double from, double to);
double stiff_elements_source_size(const StiffElements *stiff_elements,
                                  int source); /* 0: not known */

/* How strongly an element acts, as the logarithm of its size, over a range of its argument. */
Range stiff_elements_size(const StiffElements *stiff_elements, int element, Range argument);

/* Arguments at (t, y), into a[elements]. False: the equations have no solution there. */
bool stiff_elements_arguments(StiffElements *stiff_elements, double t, const double *y, double *a);

/* how arguments move about (t, y), see above: arrays of elements, and elements x sources */
typedef struct Affine {
    double *a, *rate, *bend, *by_source;
} Affine;
/* `slope` is y' along the way that is looked at, `h` how far that goes, s; leaks[k] is the slope of
 * an element that doesn't conduct, NAN: it conducts and has its own. False: there is no solution.
 * O(sources) solutions of the network's linear equations. */
bool stiff_elements_linearise(StiffElements *stiff_elements, double t, const double *y,
                              const double *slope, double h, const double *leaks, Affine *out);
/* How arguments[elements] and the network's x' answer to a y moved by `off`, where each element has
 * the slope `leak`, or the least that it ever has if that is more. False: there is no solution. */
bool stiff_elements_answers(StiffElements *stiff_elements, double t, const double *y,
                            const double *off, double leak, double *arguments, double *rates);
/* Rates of y by element k's value, or by source k's, each over `scale` of its entry, the largest of
 * them: about the point of stiff_elements_linearise(), or (t, y) where there was none. */
double stiff_elements_effect_of_element(StiffElements *stiff_elements, int k, const double *scale);
double stiff_elements_effect_of_source(StiffElements *stiff_elements, int k, double t,
                                       const double *y, const double *scale);

#endif

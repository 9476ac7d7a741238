/* steep.h: what in a system's equations can act for a short time
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
#ifndef COTREE_SIMULATE_EQUATIONS_STEEP_H
#define COTREE_SIMULATE_EQUATIONS_STEEP_H

#include "expr/range.h"
#include "simulate/equations/numbers.h"

typedef struct Steep Steep;

/* New, or NULL where the equations hold no such thing; steep_free(). Borrows all. O(nodes of the
 * equations). */
MUST_USE Status steep_new(const Layout *layout, Parameters *parameters, Motion *motion,
                          const Equations *equations, Steep **out, Diag *diag);
void steep_free(Steep *steep); /* NULL is fine */
int steep_elements(const Steep *steep);
int steep_sources(const Steep *steep);
/* the first variable of an element's argument, borrowed */
const char *steep_variable(const Steep *steep, int element);

/* ranges of the sources, or of their second derivatives, over an interval; borrowed, until the next
 * call */
const Range *steep_sources_over(Steep *steep, Range over);
const Range *steep_bends_over(Steep *steep, Range over);
/* the ranges of the sources once more, where terms cancel much closer: s(m) + s' (x - m) about the
 * middle. Three times the work. */
const Range *steep_sources_close(Steep *steep, Range over);
/* The same of one source: the work is that of its own expression. */
Range steep_source_over(Steep *steep, int source, Range over);
Range steep_source_close(Steep *steep, int source, Range over);
/* How many ranges of expressions all this has taken so far. */
int64_t steep_visits(const Steep *steep);

/* A run goes from..to, s: from here on sources are as large as their ranges in it. */
void steep_span(Steep *steep, double from, double to);
double steep_source_size(const Steep *steep, int source); /* 0: not known */

/* How strongly an element acts, as the logarithm of its size, over a range of its argument. */
Range steep_size(const Steep *steep, int element, Range argument);

/* Arguments at (t, y), into a[elements]. False: the equations have no solution there. */
bool steep_arguments(Steep *steep, double t, const double *y, double *a);

/* how arguments move about (t, y), see above: arrays of elements, and elements x sources */
typedef struct Affine {
    double *a, *rate, *bend, *by_source;
} Affine;
/* `slope` is y' along the way that is looked at, `h` how far that goes, s; leaks[k] is the slope of
 * an element that doesn't conduct, NAN: it conducts and has its own. False: there is no solution.
 * O(sources) solutions of the network's linear equations. */
bool steep_linearise(Steep *steep, double t, const double *y, const double *slope, double h,
                     const double *leaks, Affine *out);
/* How arguments[elements] and the network's x' answer to a y moved by `off`, where each element has
 * the slope `leak`, or the least that it ever has if that is more. False: there is no solution. */
bool steep_answers(Steep *steep, double t, const double *y, const double *off, double leak,
                   double *arguments, double *rates);
/* Rates of y by element k's value, or by source k's, each over `scale` of its entry, the largest of
 * them: about the point of steep_linearise(), or (t, y) where there was none. */
double steep_effect_of_element(Steep *steep, int k, const double *scale);
double steep_effect_of_source(Steep *steep, int k, double t, const double *y, const double *scale);

#endif

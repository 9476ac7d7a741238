/* neville.h: numbers of the oracles' own integrators, and their extrapolation (Aitken, Neville) */
#ifndef COTREE_TESTS_NEVILLE_H
#define COTREE_TESTS_NEVILLE_H

typedef long double Real;

/* Replaces *coarse by the limit for h = 0 of the line through two values whose errors are in
 * proportion to h; `ratio` is h of *coarse over h of `fine`. Returns the limit less `fine`. */
static inline Real neville(Real ratio, Real fine, Real *coarse)
{
    const Real change = (fine - *coarse) / (ratio - 1);

    *coarse = fine + change;
    return change;
}

#endif

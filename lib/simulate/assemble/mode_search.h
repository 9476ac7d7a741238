/* mode_search.h: which ideal switches are closed just behind an instant
 *
 * A step of vanishing length by the implicit Euler rule, G((x - x0)/h, z; x, t + h) = 0, in which
 * each ideal switch is on one of its sides: such that all closed diodes carry a current forwards
 * and all open ones a voltage backwards, and other switches are as their conditions say. Where x
 * can't go on steadily it jumps in that step, and the sides are those behind the jump.
 * Camlibel, Heemels, Schumacher (2002) for networks; the exchange of sides is Murty's (1974). */
#ifndef COTREE_SIMULATE_ASSEMBLE_MODE_SEARCH_H
#define COTREE_SIMULATE_ASSEMBLE_MODE_SEARCH_H

#include "simulate/equations/compiled_equations.h"

typedef struct ModeSearch ModeSearch;

/* New; free with mode_search_free(). Borrows all. `system` is that of system_sided(). Fails as
 * probe_new() and system_ideal() do. */
MUST_USE Status mode_search_new(System *system, Parameters *parameters, ModeSearch **out,
                                Diag *diag);
void mode_search_free(ModeSearch *search); /* NULL is fine */

/* the instant; arrays by the layout of the whole */
typedef struct ModeSearchAt {
    double t;    /* s */
    double step; /* h, s: short against all that happens, long against rounding of t */
    double when; /* s: the time that conditions of switches read, t + h or t */
    const double *q, *u, *references;         /* at t + h; references of angles */
    const double *x;                          /* at t */
    const double *x_behind;                   /* at t + h, where sides stay as they are */
    const double *acceleration, *multipliers; /* at t + h; NULL: not known, taken for 0 */
} ModeSearchAt;

/* The sides behind t from those before it, one an ideal switch. Fails with E_SOLVER where there are
 * none; `closed` is as it was then. */
MUST_USE Status mode_search_find(ModeSearch *search, const ModeSearchAt *at, bool *closed,
                                 Diag *diag);

/* Behind a surge: what was largest lately no longer counts. */
void mode_search_calm(ModeSearch *search);
/* What becomes of states at the instant that sides were looked for last, while that stands, with
 * these sides: where a step from `from` of the whole leads, as its length vanishes, and what is
 * stored changes by what flows. `size` tells for each state what counts as nothing. False: it leads
 * nowhere. */
bool mode_search_jump(ModeSearch *search, const double *from, const double *size, double *x);
/* Behind mode_search_jump() that began at `from` with the sides `before`: the work of all that
 * neither stores nor switches, J. */
double mode_search_work(ModeSearch *search, const double *from, const bool *before);
/* the name of a source that would have to give an impulse there; NULL: none */
const char *mode_search_source(ModeSearch *search, double step);

/* the largest across or through variable of a domain's edges lately */
double mode_search_largest(const ModeSearch *search, Domain domain, bool through);

#endif

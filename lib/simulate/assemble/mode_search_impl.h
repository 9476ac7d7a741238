/* mode_search_impl.h: what the files share that look for sides of ideal switches, and for jumps */
#ifndef COTREE_SIMULATE_ASSEMBLE_MODE_SEARCH_IMPL_H
#define COTREE_SIMULATE_ASSEMBLE_MODE_SEARCH_IMPL_H

#include "simulate/assemble/mode_search.h"

#include "algebra/pattern.h"
#include "base/memory.h"
#include "simulate/equations/netsolve.h"

#define OPEN_LEAK   1e-13 /* S: shares voltages that nothing else tells; too small to be seen, */
#define CLOSED_LEAK 1e-9  /* ohm: likewise currents; and large enough against rounding */

typedef enum When { ALWAYS, OPEN, CLOSED } When;

/* an equation, or one side of it: row of the probe */
typedef struct ResidualRow {
    int row; /* of the network */
    int ideal;
    When when;
    bool averaged; /* it holds rates: what is stored changes by them along the whole step */
} ResidualRow;

enum { THROUGH, ACROSS, WHEN, ON, LOOKS }; /* at each switch */

struct ModeSearch {
    VariableIndex *l; /* of the system in which sides are open or numbers */
    int n, count;     /* unknowns [x'; z]; switches */
    LIST(ResidualRow) rows;
    Pattern pattern;
    int *place;   /* in it, of a slope */
    Equations eq; /* for the solver */
    double *network, *residual, *rhs, *zeros;
    bool is_linear;
    NetSolve *solve;
    Probe *equations; /* rows by x, x', z */
    Probe *looks;     /* LOOKS at each; then through and across of all edges */
    bool *has_when;
    int edges;
    Domain *domain;      /* of each, then of all edges */
    const char **source; /* of each edge across and through: the part that gives it; NULL: none */
    bool *gives;         /* each edge: it neither stores nor switches */
    const ModeSearchAt *at;
    const double *from; /* x before the step: at->x, or what it might be */
    double step;
    Expr closed_leak, open_leak; /* symbols */
    bool averages;
    double noise; /* of the largest current or voltage */
    bool *closed;
    double *x;                       /* behind the step */
    double *through, *across;        /* behind where its sides meet, */
    double *on;                      /* and its resistance when it is closed */
    double largest[DOMAIN_COUNT][2]; /* across and through variable of any edge, by domain, */
    double known[DOMAIN_COUNT][2];   /* and what they have been lately */
};

/* x behind a step from `from` with the sides as they are, [x'; z] the solver's; false: none */
bool mode_search_solve(ModeSearch *s);
/* Leaks of closed and open switches from now on, in CLOSED_LEAK and OPEN_LEAK. */
void mode_search_leak(ModeSearch *s, double closed, double open);
/* what is known behind that step, for probes */
RowValues mode_search_row(const ModeSearch *s, const double *w);

#endif

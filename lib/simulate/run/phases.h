/* phases.h: what solves the equations of a run, phase by phase, and what is computed with it
 *
 * What integrates has one, and hands it on to the reader of its result. */
#ifndef COTREE_SIMULATE_RUN_PHASES_H
#define COTREE_SIMULATE_RUN_PHASES_H

#include "base/names.h"
#include "simulate/run/grid.h"
#include "simulate/run/integration.h"
#include "simulate/run/phase.h"

/* The first is of the whole, and where there are ideal switches no row's. */
typedef struct Phases {
    System *system; /* the whole */
    Parameters parameters;
    double tolerance; /* of the run: bounds what a projection may leave */
    int count, room;
    Phase **at;
    Names *sides; /* of switches in a mode, and which phase has them; NULL: none yet */
    LIST(int) by_sides;
} Phases;

/* What is known at the rows of a driven run beside (q, u, x), one block a row: x', z, u', lambda,
 * efforts. */
typedef struct Driven {
    int length;
    double *values; /* rows x length; NULL: rows are solved when asked for */
} Driven;

/* how equations are solved */
typedef struct Manner {
    bool embedded;
    const char *const *independent; /* coordinates whose speeds are to be independent */
    int independent_count;
    const int *rows; /* constraints in use */
    int row_count;
    const CallMonitor *watch;
    Host *host; /* NULL: nobody */
} Manner;

void phases_free(Phases *phases);              /* NULL is fine */
void phases_add(Phases *phases, Phase *phase); /* a given phase */
/* the phase with `count` switches on these sides, and on no sides of surfaces; NULL: there is none
 */
Phase *phases_find(const Phases *phases, const bool *closed, int count);
/* What solves the equations of a phase; once. Fails with E_NAME for an independent coordinate that
 * the trees don't have, and as phase_open() does. */
MUST_USE Status phases_open(Phases *phases, Phase *phase, const Manner *manner, Diag *diag);
/* for all phases, also those that come later */
void phases_tolerance(Phases *phases, double tolerance);
/* the phase of the whole: the only one where there are no ideal switches */
Phase *phases_whole(const Phases *phases);
/* the segment of a phase */
Segment phases_segment(const Phase *phase, Events *events);

/* a row's block of a driven run; NULL: the equations are to be solved */
const double *driven_row(const Driven *driven, int row);
/* A probe of a phase for expressions over user's variables; probe_free(). Fails as system_resolve()
 * and probe_new() do. */
MUST_USE Status phases_probe(Phases *phases, const Phase *phase, const Expr *items, int count,
                             Probe **out, Diag *diag);

/* what is asked at every row, in the equations of its phase, which others may share */
typedef Status (*Ask)(Phases *phases, const Phase *phase, const void *context, Probe **out,
                      Diag *diag);
/* The values at every row, rows x count; where there is none the question is put all the same, to
 * the phase `first`: it may be wrong. */
MUST_USE Status phases_ask(Phases *phases, const Grid *grid, const Driven *driven, int first,
                           Ask ask, const void *context, int count, double *out, Diag *diag);

#endif

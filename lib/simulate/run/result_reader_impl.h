/* result_reader_impl.h: internals of a reader, for callers that need more than values: linear
 * equations, restarts */
#ifndef COTREE_SIMULATE_RUN_RESULT_READER_IMPL_H
#define COTREE_SIMULATE_RUN_RESULT_READER_IMPL_H

#include "simulate/run/phases.h"
#include "simulate/run/result_impl.h"
#include "simulate/run/result_reader.h"

struct ResultReader {
    const Result *result;
    Phases *phases;
    Grid asked; /* rows between those of the result, from the last query, */
    Driven asked_driven;
};

/* New, with the phases of the run, which it then owns. */
ResultReader *result_reader_of_run(const Result *result, Phases *phases);
/* the phase of the start */
Phase *result_reader_first(const ResultReader *reader);
/* The state of the run at t: y, its phase, and the block of a driven run (NULL: the equations have
 * to be solved), all borrowed until the next call. Between rows, that part of the run is integrated
 * again. Fails with E_VALUE outside the run, and with E_SOLVER where the equations have no
 * solution. */
MUST_USE Status result_reader_at(ResultReader *reader, double t, Phase **phase, const double **y,
                                 const double **driven, Diag *diag);

#endif

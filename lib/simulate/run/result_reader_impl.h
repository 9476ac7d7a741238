/* result_reader_impl.h: a reader inside, for what asks more than values: linear equations, starts
 */
#ifndef COTREE_SIMULATE_RUN_RESULT_READER_IMPL_H
#define COTREE_SIMULATE_RUN_RESULT_READER_IMPL_H

#include "simulate/run/phases.h"
#include "simulate/run/result_impl.h"
#include "simulate/run/result_reader.h"

struct ResultReader {
    const Result *result;
    Phases *phases;
    Grid asked; /* rows between those of the result, where they were asked for last, */
    Driven asked_driven;
};

/* New, with the phases of the run, which are given. */
ResultReader *result_reader_of_run(const Result *result, Phases *phases);
/* the phase that the run starts in */
Phase *result_reader_first(const ResultReader *reader);
/* What the run was at t: y, its phase, and the block of a driven run (NULL: the equations are to be
 * solved), all borrowed until the next call. Between rows, that part of the run is taken again.
 * Fails with E_VALUE outside the run, and with E_SOLVER where the equations have no solution. */
MUST_USE Status result_reader_at(ResultReader *reader, double t, Phase **phase, const double **y,
                                 const double **driven, Diag *diag);

#endif

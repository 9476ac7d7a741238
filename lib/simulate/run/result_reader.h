/* result_reader.h: any variable of a result, at its rows and between them
 *
 * A result contains coordinates, speeds and network states; everything else is solved for on
 * demand. A reader, which the run returns with its result, has the programs of the run, a workspace
 * and the rows between those of the result that it computed last. So a result never changes. */
#ifndef COTREE_SIMULATE_RUN_RESULT_READER_H
#define COTREE_SIMULATE_RUN_RESULT_READER_H

#include "simulate/run/result.h"

/* before the result, which it borrows; NULL is fine */
void result_reader_free(ResultReader *reader);
const Result *result_reader_result(const ResultReader *reader);
/* whether a switch of the system is closed at the start of the result */
bool result_reader_side(const ResultReader *reader, int which);
/* Values of expressions over variables (SYMBOL_VARIABLEs; system_resolve() is done here) at every
 * row: out is rows x count. `t` is the row's time. */
MUST_USE Status result_reader_values(ResultReader *reader, const Expr *items, int count,
                                     double *out, Diag *diag);
/* Compute the rows at these ascending instants, which later calls read. Where that fails, or an
 * instant is outside the run, the later call reports it. Fails with E_STOPPED. */
MUST_USE Status result_reader_prepare(ResultReader *reader, const double *times, int count,
                                      const CallMonitor *watch, Diag *diag);
/* The same as result_reader_values() at one instant of the run. Between rows that part of the run
 * is integrated again, with its own steps and tolerance. E_VALUE outside the run. */
MUST_USE Status result_reader_values_at(ResultReader *reader, const Expr *items, int count,
                                        double at, double *out, Diag *diag);

/* The same at several instants, ascending: values[i] of one expression. */
MUST_USE Status result_reader_values_along(ResultReader *reader, Expr item, const double *times,
                                           int count, const CallMonitor *watch, double *values,
                                           Diag *diag);

/* Integrals of expressions from the start of the run to each of these instants: out is time_count x
 * count. The course between rows is taken as above, once for all instants. E_VALUE outside the run.
 */
MUST_USE Status result_reader_integrals(ResultReader *reader, const Expr *items, int count,
                                        const double *times, int time_count,
                                        const CallMonitor *watch, double *out, Diag *diag);
/* Which of these parts with dry friction share a load at t, so that only the sum of their efforts
 * is determined: shares[i*count + k]. O(surfaces^3). */
MUST_USE Status result_reader_shares(ResultReader *reader, double t, const char *const *parts,
                                     int count, bool *shares, Diag *diag);
/* Change of an item at several instants when states and time have rounding errors, those of the
 * largest state of a kind in the run: smaller values are 0 within rounding. 0 for driven runs. */
MUST_USE Status result_reader_rounding(ResultReader *reader, Expr item, const double *times,
                                       int count, double *open, Diag *diag);

#endif

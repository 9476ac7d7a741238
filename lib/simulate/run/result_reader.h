/* result_reader.h: any variable of a result, at its rows and between them
 *
 * A result holds coordinates, speeds and network states; all else is solved for where it is asked.
 * A reader has what that takes: programs, places to solve in, and what it found last between rows.
 * So a result stays as it is, and each thread reads it with a reader of its own. */
#ifndef COTREE_SIMULATE_RUN_RESULT_READER_H
#define COTREE_SIMULATE_RUN_RESULT_READER_H

#include "simulate/run/result.h"

/* New; result_reader_free(), before the result. Borrows the result. Compiles its equations; the
 * reader that a run hands out has them from there. Fails as program_new() does. */
MUST_USE Status result_reader_new(const Result *result, ResultReader **out, Diag *diag);
void result_reader_free(ResultReader *reader); /* NULL is fine */
const Result *result_reader_result(const ResultReader *reader);
/* whether a switch of the system is closed where the result begins */
bool result_reader_side(const ResultReader *reader, int which);
/* Values of expressions over variables (SYMBOL_VARIABLEs; system_resolve() is done here) at every
 * row: out is rows x count. `t` is the row's time. */
MUST_USE Status result_reader_values(ResultReader *reader, const Expr *items, int count,
                                     double *out, Diag *diag);
/* What is asked for next are these instants, rising: found in one go. Where that fails, or there is
 * no such instant, asking for it tells. Fails with E_STOPPED. */
MUST_USE Status result_reader_prepare(ResultReader *reader, const double *times, int count,
                                      const CallMonitor *watch, Diag *diag);
/* The same as result_reader_values() at one instant of the run. Between rows that part of the run
 * is taken again, with its own steps and tolerance. E_VALUE outside the run. */
MUST_USE Status result_reader_values_at(ResultReader *reader, const Expr *items, int count,
                                        double at, double *out, Diag *diag);

/* The same at several instants, rising: values[i] of one expression. */
MUST_USE Status result_reader_values_along(ResultReader *reader, Expr item, const double *times,
                                           int count, const CallMonitor *watch, double *values,
                                           Diag *diag);

/* How far an item moves at several instants where states and time are off by a rounding, that of
 * the largest state of a kind in the run: what is no larger tells nothing. 0 of driven runs. */
MUST_USE Status result_reader_rounding(ResultReader *reader, Expr item, const double *times,
                                       int count, double *open, Diag *diag);

/* Both for one question alone, with a reader of its own. */
MUST_USE Status result_values(const Result *result, const Expr *items, int count, double *out,
                              Diag *diag);
MUST_USE Status result_values_at(const Result *result, const Expr *items, int count, double at,
                                 double *out, Diag *diag);

#endif

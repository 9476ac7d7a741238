/* run.h: runs of a system: assembly, forward dynamics, kinematics, inverse
 *
 * Each hands out a new Result, and a new ResultReader of it unless `reader` is NULL: with the
 * programs of the run, so that what is asked afterwards compiles nothing anew. */
#ifndef COTREE_SIMULATE_RUN_RUN_H
#define COTREE_SIMULATE_RUN_RUN_H

#include "simulate/run/result_reader.h"

#define RUN_LEAST_RTOL 1e-13 /* between what rounding leaves and what numbers can't hold */

typedef struct RunOptions {
    double duration;    /* s */
    double every;       /* output step, s; 0: duration / 500 */
    double rtol;        /* 0: 1e-8 */
    double atol;        /* times 1 m, 1 rad, 1 m/s, 1 A; 0: as rtol */
    double step;        /* fixed or largest step, s; 0: free */
    double most;        /* largest step, s, of all methods; 0: free */
    const char *method; /* a row of methods.def; NULL: auto */
    bool check;         /* run again, finer, and report the global error (global_error.h) */
    bool realtime;      /* forward: wait for the clock behind each step, which are fixed */
} RunOptions;

/* Solve Phi = 0 and the velocity constraints from initial values and guesses (any variables, in
 * whatever tree), network states and algebraic unknowns too: a result of one row at t = 0. Text
 * about what was solved for, redundant constraints by joint, singular starts: result_remarks().
 * Fails with E_ASSEMBLE: the residual of each equation that can't be met, by joint and given value.
 */
MUST_USE Status run_assemble(System *system, const SimulationInput *setting, Result **out,
                             ResultReader **reader, Diag *diag);

/* Where everything rests, with sources and drivers as at t = 0, or, as the setting has it, at
 * another instant, or against what is driven, which moves: a result of one row like that of
 * run_assemble(), from whose start the search goes out. Fails with E_SOLVER, telling what stays out
 * of balance by part, and as run_assemble() does. */
MUST_USE Status run_equilibrium(System *system, const SimulationInput *setting, Result **out,
                                ResultReader **reader, Diag *diag);

/* Forward dynamics from the assembled start. E_STOPPED and E_SOLVER still hand out what was
 * computed (*out is NULL only when nothing was). */
MUST_USE Status run_simulate(System *system, const SimulationInput *setting,
                             const RunOptions *options, Result **out, ResultReader **reader,
                             Diag *diag);
/* Driven motion: positions, speeds, accelerations. E_MODEL when drivers leave freedoms (said how
 * many). */
MUST_USE Status run_kinematics(System *system, const SimulationInput *setting,
                               const RunOptions *options, Result **out, ResultReader **reader,
                               Diag *diag);
/* Kinematics, and the efforts (or sources) that the drivers need. */
MUST_USE Status run_inverse(System *system, const SimulationInput *setting,
                            const RunOptions *options, Result **out, ResultReader **reader,
                            Diag *diag);
/* Go on from the end of a run, whose result stays as it is: its rows are the first of the new one.
 */
MUST_USE Status run_resume(const Result *old, const SimulationInput *setting,
                           const RunOptions *options, Result **out, ResultReader **reader,
                           Diag *diag);

/* the rows of methods.def, for help and completion: name and one line; NULL at the end */
const char *run_method(int i, const char **brief);
/* the name as it stands there; E_NAME where none is called so */
MUST_USE Status run_method_find(const char *name, const char **out, Diag *diag);

#endif

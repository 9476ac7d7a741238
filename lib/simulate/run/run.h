/* run.h: runs of a system: assembly, forward dynamics, kinematics, inverse
 *
 * Each returns a new Result, and the ResultReader of it unless `reader` is NULL: with the programs
 * of the run, so that queries compile nothing. */
#ifndef COTREE_SIMULATE_RUN_RUN_H
#define COTREE_SIMULATE_RUN_RUN_H

#include "simulate/run/result_reader.h"
#include "simulate/run/run_limits.h"

typedef struct RunOptions {
    double duration;     /* s */
    double every;        /* output step, s; 0: duration / 500 */
    double rtol;         /* 0: that of the next member */
    double default_rtol; /* of many runs that are compared; 0: 1e-8 */
    double atol;         /* times 1 m, 1 rad, 1 m/s, 1 A; 0: as rtol */
    double step;         /* fixed or largest step, s; 0: free */
    double most;         /* largest step, s, of all methods; 0: free */
    const char *method;  /* a row of methods.def; NULL: auto */
    bool check;          /* run again, finer, and report the global error (global_error.h) */
    bool realtime;       /* forward: wait for the clock after each step; steps are fixed */
} RunOptions;

/* Solve Phi = 0 and the velocity constraints from initial values and guesses (any variables, in
 * whatever tree), and for network states and algebraic unknowns: a result of one row at t = 0.
 * result_remarks() reports what was solved for, redundant constraints by joint, and singular
 * initial positions. Fails with E_ASSEMBLE, with the residual of each equation that can't be
 * satisfied, by joint and given value. */
MUST_USE Status run_assemble(System *system, const SimulationInput *setting, Result **out,
                             ResultReader **reader, Diag *diag);

/* Static equilibrium, with sources and drivers at their values at t = 0 or, by the setting, at
 * another instant; or relative equilibrium, where driven parts move. A result of one row like that
 * of run_assemble(), from whose state the search starts. Fails with E_SOLVER, which reports the
 * parts that remain out of balance, and as run_assemble() does. */
MUST_USE Status run_equilibrium(System *system, const SimulationInput *setting, Result **out,
                                ResultReader **reader, Diag *diag);

/* Forward dynamics from the assembled initial state. E_STOPPED and E_SOLVER still return what was
 * computed (*out is NULL only when nothing was). */
MUST_USE Status run_simulate(System *system, const SimulationInput *setting,
                             const RunOptions *options, Result **out, ResultReader **reader,
                             Diag *diag);
/* Driven motion: positions, speeds, accelerations. E_MODEL when drivers leave freedoms (the message
 * has their number). */
MUST_USE Status run_kinematics(System *system, const SimulationInput *setting,
                               const RunOptions *options, Result **out, ResultReader **reader,
                               Diag *diag);
/* Kinematics, and the efforts (or sources) that the drivers need. */
MUST_USE Status run_inverse(System *system, const SimulationInput *setting,
                            const RunOptions *options, Result **out, ResultReader **reader,
                            Diag *diag);
/* Continue from the end of a run, whose result is unchanged: its rows are the first of the new
 * one. */
MUST_USE Status run_resume(const Result *old, const SimulationInput *setting,
                           const RunOptions *options, Result **out, ResultReader **reader,
                           Diag *diag);

/* the rows of methods.def, for help and completion: name and one line; NULL at the end */
const char *run_method(int i, const char **brief);
/* the name as in methods.def; E_NAME where no method has it */
MUST_USE Status run_method_find(const char *name, const char **out, Diag *diag);

#endif

/* simulation_input.h: what a run gets from the session: values of parameters, initial values,
 * events
 *
 * Everything is borrowed during the call, except for what a result reads later. */
#ifndef COTREE_SIMULATE_EQUATIONS_SIMULATION_INPUT_H
#define COTREE_SIMULATE_EQUATIONS_SIMULATION_INPUT_H

#include "base/memory.h"
#include "compile/program.h"
#include "formulate/system/system.h"
#include "model/event.h"

/* Initial values in force: lists of the model, as numbers. */
typedef struct StartValue {
    const char *name; /* variable */
    int primes;
    double value;
    bool is_guess;
} StartValue;
typedef struct StartValues {
    int count;
    StartValue *at;
} StartValues;

typedef struct Result Result;             /* simulate/run/result.h */
typedef struct ResultReader ResultReader; /* simulate/run/result_reader.h */

/* Value of a parameter, read once a run. Results store the values; they read further parameters
 * that only a later query needs, so `context` outlives them. */
typedef double (*ParameterValue)(void *context, Expr symbol);
/* The program that runs a model: it reads output rows and sets inputs. The values that it set are
 * stored, for repeated evaluation of a part of the run. */
typedef struct HostValue {
    double t;
    int instance; /* of the input */
    double value;
} HostValue;
typedef struct Host {
    const Expr *items; /* expressions that it receives: over the user's variables */
    int item_count;
    /* Both return whether to stop. NULL: the program wants no call, or the run is over. */
    bool (*row)(void *context, double t, const double *values);
    bool (*input)(void *context, const char *name, double t, const double *values, double *value);
    void *context;
    LIST(HostValue) values; /* rising in t */
} Host;

typedef struct SimulationInput {
    ParameterValue parameter;
    void *context;
    SceneSource scene; /* of the system: its ideal switches make further systems from it */
    Form form;
    Evaluator evaluator;
    Threads *threads; /* borrowed as long as what is made with it; NULL: the caller's */
    const char *const *independent; /* names; borrowed during the call */
    int independent_count;
    const Event *const *events; /* borrowed during the call; what a result needs it copies */
    int event_count;
    const StartValues *start;
    Host *host;               /* NULL: none. It outlives results, as `context` does */
    bool keeps_rates;         /* of an equilibrium: driven parts move as at `at` */
    double at;                /* s: time at which an equilibrium evaluates sources and drivers */
    const CallMonitor *watch; /* borrowed as long as what is made with it */
} SimulationInput;

#endif

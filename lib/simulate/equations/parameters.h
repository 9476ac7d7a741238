/* parameters.h: values of parameters, fixed when a run first reads them */
#ifndef COTREE_SIMULATE_EQUATIONS_PARAMETERS_H
#define COTREE_SIMULATE_EQUATIONS_PARAMETERS_H

#include "formulate/system/system.h"
#include "simulate/equations/simulation_input.h"

/* Values of parameters, stored from the start of a run on. */
typedef struct Parameters {
    ParameterValue value;
    void *context;
    Evaluator evaluator; /* of everything that is made with them */
    Threads *threads;    /* that evaluate it; borrowed. NULL: the caller's thread alone */
    int count, room;
    Expr *symbols;
    double *values;
    int *places; /* place_count, by number of symbol: index plus 1; 0 where no value is stored */
    int place_count;
} Parameters;

/* with the stored values of others, and the same source of further ones */
Parameters parameters_like(const Parameters *others);
double parameters_value(Parameters *parameters, Expr symbol); /* stored, else read and stored */
/* whether one is stored, and which */
bool parameters_kept(const Parameters *parameters, Expr symbol, double *out);
void parameters_set(Parameters *parameters, Expr symbol, double value); /* stored from now on */
/* Whole turns of sums of angles become 0 where no value is stored. */
void parameters_begin_turns(Parameters *parameters, const System *system);
/* the value of an expression of parameters alone */
double parameters_evaluate(Parameters *parameters, Expr e);
void parameters_free(Parameters *parameters);

/* for expr_evaluate() and the like; the context is the Parameters */
double parameters_value_in(void *context, Expr symbol);

#endif

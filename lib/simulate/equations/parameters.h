/* parameters.h: values of parameters, as they were when a run asked for them */
#ifndef COTREE_SIMULATE_EQUATIONS_PARAMETERS_H
#define COTREE_SIMULATE_EQUATIONS_PARAMETERS_H

#include "formulate/system/system.h"
#include "simulate/equations/simulation_input.h"

/* Values of parameters, kept from the start of a run on. */
typedef struct Parameters {
    ParameterValue value;
    void *context;
    Evaluator evaluator; /* of whatever is made with them */
    Threads *threads;    /* that compute it; borrowed. NULL: the caller's alone */
    int count, room;
    Expr *symbols;
    double *values;
    int *places; /* by numbers of symbols: plus 1; 0 where none is kept */
    int numbers;
} Parameters;

/* with the values that are kept of others, and what they are asked of */
Parameters parameters_like(const Parameters *others);
double parameters_value(Parameters *parameters, Expr symbol); /* kept, else asked and kept */
/* whether one is kept, and which */
bool parameters_kept(const Parameters *parameters, Expr symbol, double *out);
void parameters_set(Parameters *parameters, Expr symbol, double value); /* kept from now on */
/* Whole turns of sums of angles are 0 where no others are kept. */
void parameters_begin_turns(Parameters *parameters, const System *system);
/* the number of an expression of parameters alone */
double parameters_evaluate(Parameters *parameters, Expr e);
void parameters_free(Parameters *parameters);

/* for expr_evaluate() and the like; the context is the Parameters */
double parameters_value_in(void *parameters, Expr symbol);

#endif

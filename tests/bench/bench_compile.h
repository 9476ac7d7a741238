/* bench_compile.h: the programs that a run steps with, for benchmarks */
#ifndef COTREE_TESTS_BENCH_COMPILE_H
#define COTREE_TESTS_BENCH_COMPILE_H

#include "base/clock.h"
#include "model/model.h"
#include "simulate/equations/compiled_equations.h"

#include <stdio.h>

static double bench_parameter(void *model, Expr symbol)
{
    return model_number(model, symbol);
}

/* seconds until they are made, of equations that are there; a line about it where it fails */
static double bench_compile(const Model *model, System *system)
{
    const double began = clock_now();
    VariableIndex *layout = variable_index_new(system);
    Parameters parameters = {.value = bench_parameter, .context = (void *)model};
    CompiledEquations *numbers = NULL;
    Diag diag = {0};
    const Status status = compiled_new(layout, &parameters, &numbers, &diag);
    const double took = clock_now() - began;

    if (status != OK)
        printf("# %s\n", diag.message);
    compiled_free(numbers);
    parameters_free(&parameters);
    variable_index_free(layout);
    return took;
}

#endif

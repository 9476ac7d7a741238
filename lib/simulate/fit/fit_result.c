/* fit_result.c: the result of a fit */
#include "simulate/fit/fit_result.h"

#include <string.h>

FitResult *fit_result_new(void)
{
    return NEW(FitResult);
}

static void free_later(void *object)
{
    fit_result_free(object);
}

void fit_result_free(FitResult *result)
{
    if (result == NULL || mem_frees_later(result, free_later))
        return;
    for (int i = 0; i < result->parameters.count; i++)
        MEM_FREE(result->parameters.at[i].name, result->parameters.at[i].unit);
    for (int i = 0; i < result->signals.count; i++) {
        FitSignal *signal = &result->signals.at[i];

        MEM_FREE(signal->name, signal->data, signal->unit, signal->times, signal->measured,
                 signal->model);
    }
    for (int i = 0; i < result->notes.count; i++)
        mem_free(result->notes.at[i]);
    LIST_FREE(result->parameters);
    LIST_FREE(result->signals);
    LIST_FREE(result->notes);
    MEM_FREE(result->correlations, result);
}

int fit_result_find(const FitResult *result, const char *name)
{
    for (int i = 0; i < result->parameters.count; i++)
        if (strcmp(result->parameters.at[i].name, name) == 0)
            return i;
    return -1;
}

/* optimum.c: the result of an optimisation */
#include "simulate/fit/optimum.h"

#include <string.h>

Optimum *optimum_new(void)
{
    return NEW(Optimum);
}

static void free_later(void *object)
{
    optimum_free(object);
}

void optimum_free(Optimum *optimum)
{
    if (optimum == NULL || mem_frees_later(optimum, free_later))
        return;
    for (int i = 0; i < optimum->parameters.count; i++)
        MEM_FREE(optimum->parameters.at[i].name, optimum->parameters.at[i].unit);
    for (int i = 0; i < optimum->constraints.count; i++)
        MEM_FREE(optimum->constraints.at[i].text, optimum->constraints.at[i].unit);
    LIST_FREE(optimum->parameters);
    LIST_FREE(optimum->constraints);
    MEM_FREE(optimum->figure, optimum->unit, optimum);
}

int optimum_find(const Optimum *optimum, const char *name)
{
    for (int i = 0; i < optimum->parameters.count; i++)
        if (strcmp(optimum->parameters.at[i].name, name) == 0)
            return i;
    return -1;
}

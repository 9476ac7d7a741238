/* model_override.c: values that replace those of parameters' definitions
 *
 * Statements, and so what `save` writes, are unchanged. Of several overrides of a name the last one
 * applies. Those of the command line precede the statement that defines their parameter. */
#include "model/model_impl.h"

#include <string.h>

Overrides *overrides_new(void)
{
    return NEW(Overrides);
}

void overrides_drop(Overrides *overrides, int count)
{
    mem_keep(overrides);
    for (int i = count; i < overrides->list.count; i++)
        mem_free(overrides->list.at[i].name);
    overrides->list.count = count;
}

void overrides_free(Overrides *overrides)
{
    if (overrides == NULL)
        return;
    overrides_drop(overrides, 0);
    LIST_FREE(overrides->list);
    mem_free(overrides);
}

void overrides_add(Overrides *overrides, const char *name, double value, Measure measure)
{
    const Override override = {mem_text(name, strlen(name)), value, measure};

    mem_keep(overrides);
    LIST_PUSH(overrides->list, override);
}

const Override *override_find(const State *state, const char *name)
{
    const Overrides *overrides = state->overrides;

    for (int i = overrides->list.count - 1; i >= 0; i--)
        if (strcmp(overrides->list.at[i].name, name) == 0)
            return &overrides->list.at[i];
    return NULL;
}

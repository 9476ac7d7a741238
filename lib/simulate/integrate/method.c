/* method.c: the table of integrators */
#include "simulate/integrate/ode.h"

#include "base/memory.h"

#include <string.h>

static const Method *const rows[] = {
#define METHOD(row) &row,
#include "simulate/integrate/methods.def"
#undef METHOD
};

const Method *method_row(int i)
{
    return i >= 0 && i < COUNT(rows) ? rows[i] : NULL;
}

const Method *method_find(const char *name)
{
    for (int i = 0; i < COUNT(rows); i++)
        if (strcmp(rows[i]->name, name) == 0)
            return rows[i];
    return NULL;
}

const Method *method_for(MethodNeed need)
{
    for (int i = 0; i < COUNT(rows); i++)
        if (rows[i]->suits_stiff == need.stiff && rows[i]->has_history == need.history &&
            rows[i]->solves_dae == need.dae && rows[i]->has_fixed_step == need.fixed)
            return rows[i];
    return NULL;
}

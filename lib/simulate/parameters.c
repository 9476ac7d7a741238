/* parameters.c: values of parameters, as they were when a run asked for them */
#include "simulate/numbers.h"

#include "base/memory.h"

#include <math.h>

double parameters_value(Parameters *p, Expr symbol)
{
    for (int i = 0; i < p->count; i++)
        if (p->symbols[i] == symbol)
            return p->values[i];
    if (p->count == p->room) {
        p->room = p->room < 16 ? 32 : 2 * p->room;
        p->symbols = mem_grow(p->symbols, (size_t)p->room, sizeof(Expr));
        p->values = mem_grow(p->values, (size_t)p->room, sizeof(double));
    }
    p->symbols[p->count] = symbol;
    p->values[p->count] = p->value != NULL ? p->value(p->context, symbol) : NAN;
    return p->values[p->count++];
}

double parameters_value_in(void *context, Expr symbol)
{
    return parameters_value(context, symbol);
}

double parameters_evaluate(Parameters *p, Expr e)
{
    return expr_evaluate(e, parameters_value_in, p);
}

void parameters_free(Parameters *p)
{
    mem_free(p->symbols);
    mem_free(p->values);
    *p = (Parameters){0};
}

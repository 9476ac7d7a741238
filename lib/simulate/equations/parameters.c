/* parameters.c: values of parameters, as they were when a run asked for them */
#include "simulate/equations/parameters.h"

#include "base/memory.h"

#include <math.h>

void parameters_set(Parameters *p, Expr symbol, double value)
{
    int at = 0;

    while (at < p->count && p->symbols[at] != symbol)
        at++;
    if (at == p->room) {
        p->room = p->room < 16 ? 32 : 2 * p->room;
        p->symbols = mem_grow(p->symbols, (size_t)p->room, sizeof(Expr));
        p->values = mem_grow(p->values, (size_t)p->room, sizeof(double));
    }
    p->count += at == p->count;
    p->symbols[at] = symbol;
    p->values[at] = value;
}

bool parameters_kept(const Parameters *p, Expr symbol, double *out)
{
    for (int i = 0; i < p->count; i++)
        if (p->symbols[i] == symbol) {
            *out = p->values[i];
            return true;
        }
    return false;
}

double parameters_value(Parameters *p, Expr symbol)
{
    double value;

    if (parameters_kept(p, symbol, &value))
        return value;
    parameters_set(p, symbol, p->value != NULL ? p->value(p->context, symbol) : NAN);
    return p->values[p->count - 1];
}

void parameters_begin_turns(Parameters *p, const System *system)
{
    for (int i = 0; i < system_whole_turns_count(system); i++) {
        Expr whole = system_whole_turns(system, i)->symbol;
        double value;

        if (!parameters_kept(p, whole, &value))
            parameters_set(p, whole, 0);
    }
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
    MEM_FREE(p->symbols, p->values);
    *p = (Parameters){0};
}

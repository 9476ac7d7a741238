/* parameters.c: values of parameters, fixed when a run first reads them */
#include "simulate/equations/parameters.h"

#include "base/memory.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static int number_of(Expr symbol)
{
    const int number = expr_symbol_number(symbol);

    assert(number >= 0);
    return number;
}

/* its index; -1: no value is stored */
static int find(const Parameters *p, Expr symbol)
{
    const int number = number_of(symbol);
    const int at = number < p->place_count ? p->places[number] - 1 : -1;

    return at >= 0 && p->symbols[at] == symbol ? at : -1;
}

static int add(Parameters *p, Expr symbol)
{
    const int number = number_of(symbol);

    if (p->count == p->room) {
        p->room = p->room < 16 ? 32 : 2 * p->room;
        p->symbols = mem_grow(p->symbols, (size_t)p->room, sizeof(Expr));
        p->values = mem_grow(p->values, (size_t)p->room, sizeof(double));
    }
    if (number >= p->place_count) {
        p->places = mem_grow(p->places, (size_t)number + 64, sizeof(int));
        memset(p->places + p->place_count, 0, (size_t)(number + 64 - p->place_count) * sizeof(int));
        p->place_count = number + 64;
    }
    p->places[number] = ++p->count;
    return p->count - 1;
}

void parameters_set(Parameters *p, Expr symbol, double value)
{
    int at = find(p, symbol);

    if (at < 0)
        at = add(p, symbol);
    p->symbols[at] = symbol;
    p->values[at] = value;
}

bool parameters_kept(const Parameters *p, Expr symbol, double *out)
{
    const int at = find(p, symbol);

    if (at >= 0)
        *out = p->values[at];
    return at >= 0;
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

Parameters parameters_like(const Parameters *others)
{
    Parameters p = {.value = others->value,
                    .context = others->context,
                    .evaluator = others->evaluator,
                    .threads = others->threads};

    for (int i = 0; i < others->count; i++)
        parameters_set(&p, others->symbols[i], others->values[i]);
    return p;
}

void parameters_free(Parameters *p)
{
    MEM_FREE(p->symbols, p->values, p->places);
    *p = (Parameters){0};
}

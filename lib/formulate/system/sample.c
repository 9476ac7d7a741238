/* sample.c: numbers of expressions at a random position
 *
 * An expression with the same value at a few random positions is taken to have it at all: this
 * finds zeros that rounding hides from symbols. */
#include "formulate/system/sample.h"
#include "base/random.h"
#include "formulate/system/constraints.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/network.h"
#include "formulate/system/origin.h"
#include "formulate/system/system_impl.h"

#include <math.h>

static int larger(int count, Expr symbol)
{
    return expr_symbol_number(symbol) < count ? count : expr_symbol_number(symbol) + 1;
}

/* for the symbols that have values */
static void make_room(Sample *sample)
{
    const System *system = sample->system;

    for (int i = 0; i < system->kinematics->q.count; i++)
        sample->count = larger(sample->count, system->kinematics->q.at[i].symbol);
    for (int i = 0; i < system->origin->parameters.count; i++)
        sample->count = larger(sample->count, system->origin->parameters.at[i].symbol);
    sample->value = pool_alloc(system->pool, (size_t)sample->count * sizeof(double));
    for (int i = 0; i < sample->count; i++)
        sample->value[i] = NAN;
}

static void put(Sample *sample, Expr symbol, double value)
{
    sample->value[expr_symbol_number(symbol)] = value;
}

Sample *sample_new(const System *system, uint64_t seed, bool vary)
{
    Sample *sample = pool_alloc(system->pool, sizeof *sample);
    int n = system->kinematics->q.count;

    sample->system = system;
    sample->q = pool_alloc(system->pool, (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++)
        sample->q[i] = random_unit(&seed);
    for (int i = 0; i < system->kinematics->quaternions.count; i++) {
        double *p = sample->q + system->kinematics->quaternions.at[i];
        double size = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);

        for (int k = 0; k < 4; k++)
            p[k] /= size;
    }
    make_room(sample);
    for (int i = 0; i < n; i++)
        put(sample, system->kinematics->q.at[i].symbol, sample->q[i]);
    for (int i = 0; i < system->origin->parameters.count; i++) {
        double value = system->origin->parameters.at[i].value;

        if (vary)
            value = value * (1 + 0.1 * random_unit(&seed)) + 0.1 * random_unit(&seed);
        put(sample, system->origin->parameters.at[i].symbol, value);
    }
    return sample;
}

void sample_keep_data(Sample *sample)
{
    const Origin *origin = sample->system->origin;

    for (int i = 0; i < origin->parameters.count; i++)
        if (expr_name(origin->parameters.at[i].symbol)[0] == '#')
            put(sample, origin->parameters.at[i].symbol, origin->parameters.at[i].value);
}

static double some_value(void *context, Expr symbol)
{
    uint32_t x = (uint32_t)expr_symbol_number(symbol) * 2654435761U + *(const uint32_t *)context;

    x ^= x >> 15;
    x *= 2246822519U;
    x ^= x >> 13;
    return 0.7 + 0.6 * (double)x / 4294967296.0;
}

static double symbol_value(void *context, Expr symbol)
{
    Sample *sample = context;
    const System *system = sample->system;

    if (expr_symbol_number(symbol) < sample->count &&
        !isnan(sample->value[expr_symbol_number(symbol)]))
        return sample->value[expr_symbol_number(symbol)];
    for (int i = 0; i < system->constraints->counted.count; i++)
        if (system->constraints->counted.at[i].reported.symbol == symbol)
            return 0;
    return sample->others != 0 ? some_value(&sample->others, symbol) : NAN;
}

void sample_remember(Sample *sample)
{
    sample->evaluation = evaluation_new(symbol_value, sample);
}

void sample_forget(Sample *sample)
{
    evaluation_free(sample->evaluation);
    sample->evaluation = NULL;
}

double sample_number(Sample *sample, Expr e)
{
    return sample->evaluation != NULL ? evaluation_of(sample->evaluation, e)
                                      : expr_evaluate(e, symbol_value, sample);
}

double expr_value_somewhere(Expr e, uint32_t seed)
{
    return expr_evaluate(e, some_value, &seed);
}

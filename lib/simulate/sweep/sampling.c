/* sampling.c: random points, a Latin hypercube, Sobol' points */
#include "simulate/sweep/sampling.h"

#include "base/memory.h"
#include "simulate/sweep/random_stream.h"

#include <gsl/gsl_qrng.h>

/* purposes of random_uniform() */
enum { STREAM_POINT = 0, STREAM_ORDER = 1 };

static const char *const names[SAMPLINGS] = {"random", "latin", "sobol"};

const char *sampling_name(Sampling sampling)
{
    return names[sampling];
}

static void fill_random(uint64_t seed, int runs, int columns, double *out)
{
    for (int r = 0; r < runs; r++)
        for (int c = 0; c < columns; c++)
            *out++ = random_uniform(seed, (uint64_t)r, (uint32_t)c, STREAM_POINT);
}

/* in each column the intervals in a random order (Fisher and Yates) */
static void fill_latin(uint64_t seed, int runs, int columns, double *out)
{
    int *order = NEW_ARRAY(int, runs);

    for (int c = 0; c < columns; c++) {
        for (int r = 0; r < runs; r++)
            order[r] = r;
        for (int r = runs - 1; r > 0; r--) {
            const double u = random_uniform(seed, (uint64_t)r, (uint32_t)c, STREAM_ORDER);
            const int other = (int)(u * (r + 1)), held = order[r];

            order[r] = order[other];
            order[other] = held;
        }
        for (int r = 0; r < runs; r++)
            out[(ptrdiff_t)r * columns + c] =
                (order[r] + random_uniform(seed, (uint64_t)r, (uint32_t)c, STREAM_POINT)) / runs;
    }
    mem_free(order);
}

static Status fill_sobol(int runs, int columns, double *out, Diag *diag)
{
    const int most = (int)gsl_qrng_sobol->max_dimension;
    gsl_qrng *generator;

    if (columns > most) {
        (void)diag_set(diag, E_VALUE, "Sobol' points have up to %d parameters, not %d", most,
                       columns);
        diag_hint(diag, "points=latin takes any number");
        return E_VALUE;
    }
    generator = MEM_GIVEN(gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)columns));
    for (int r = 0; r < runs; r++)
        (void)gsl_qrng_get(generator, out + (ptrdiff_t)r * columns);
    gsl_qrng_free(generator);
    return OK;
}

Status sampling_fill(Sampling sampling, uint64_t seed, int runs, int columns, double *out,
                     Diag *diag)
{
    if (columns == 0)
        return OK;
    if (sampling == SAMPLING_SOBOL)
        return fill_sobol(runs, columns, out, diag);
    if (sampling == SAMPLING_LATIN)
        fill_latin(seed, runs, columns, out);
    else
        fill_random(seed, runs, columns, out);
    return OK;
}

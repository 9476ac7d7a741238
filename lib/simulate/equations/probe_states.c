/* probe_states.c: evaluates a probe at many states, in SIMD batches */
#include "simulate/equations/probe.h"

#include "compile/simd_batch.h"

enum {
    LANES = 8,
    FEW = 2 * LANES /* states that are computed one by one: a batch has a cost of its own */
};

typedef struct ProbeStates {
    const double *times, *y;
    int length, count;
} ProbeStates;

static void put_parameters(const Probe *probe, SimdBatch *lanes)
{
    const int all = program_input_count(residual_program(probe->residual));
    double values[LANES];

    for (int i = probe->layout->count; i < all; i++) {
        for (int k = 0; k < LANES; k++)
            values[k] = probe->inputs[i];
        simd_batch_set(lanes, i, STAGE_PARAMETER, values);
    }
}

/* signs of surfaces on whose sides all states are */
static void put_signs(const VariableIndex *l, SimdBatch *lanes)
{
    double values[LANES];

    for (int i = 0; i < l->sign_count; i++) {
        for (int k = 0; k < LANES; k++)
            values[k] = l->sign_values[i];
        simd_batch_set(lanes, l->signs + i, STAGE_VELOCITY, values);
    }
}

/* Set one part of these states, from index `place` of y on. */
static void put_part(const double *const y[LANES], int place, int count, int input, Stage stage,
                     SimdBatch *lanes)
{
    for (int i = place; i < place + count; i++) {
        double values[LANES];

        for (int k = 0; k < LANES; k++)
            values[k] = y[k][i];
        simd_batch_set(lanes, input + i - place, stage, values);
    }
}

/* Set the states from `first` on; a batch that is not full repeats the last state. */
static void put_states(const VariableIndex *l, const ProbeStates *s, int first, SimdBatch *lanes)
{
    const int last = s->count - 1;
    const double *y[LANES];
    double times[LANES];

    for (int k = 0; k < LANES; k++) {
        const int at = first + k < last ? first + k : last;

        times[k] = s->times[at];
        y[k] = s->y + (ptrdiff_t)at * s->length;
    }
    simd_batch_set(lanes, l->t, STAGE_TIME, times);
    put_part(y, variable_index_references(l), l->multi_turns, l->references, STAGE_POSITION, lanes);
    put_part(y, 0, l->n, l->q, STAGE_POSITION, lanes);
    put_part(y, l->n, l->nu, l->u, STAGE_VELOCITY, lanes);
    put_part(y, l->n + l->nu, l->nx, l->x, STAGE_VELOCITY, lanes);
}

static void by_lanes(Probe *probe, Evaluator evaluator, const ProbeStates *s, int roots,
                     double *out)
{
    const Program *program = residual_program(probe->residual);
    const int blocks = (s->count + LANES - 1) / LANES;
    Native *native = simd_batch_native_if_it_pays(program, LANES, evaluator, blocks);
    SimdBatch *lanes = simd_batch_new(program, native, LANES);

    (void)probe_inputs(probe); /* brings sides of switches up to date */
    put_parameters(probe, lanes);
    put_signs(probe->layout, lanes);
    for (int first = 0; first < s->count; first += LANES) {
        const int count = s->count - first < LANES ? s->count - first : LANES;

        put_states(probe->layout, s, first, lanes);
        simd_batch_run(lanes);
        for (int i = 0; i < roots; i++) {
            double values[LANES];

            simd_batch_get(lanes, i, values);
            for (int k = 0; k < count; k++)
                out[(ptrdiff_t)(first + k) * roots + i] = values[k];
        }
    }
    simd_batch_free(lanes);
    native_free(native);
}

void probe_values_of_states(Probe *probe, Evaluator evaluator, const double *times, const double *y,
                            int length, int count, int roots, double *out)
{
    if (count > FEW) {
        by_lanes(probe, evaluator, &(ProbeStates){times, y, length, count}, roots, out);
        return;
    }
    for (int i = 0; i < count; i++) {
        const RowValues row = row_of_state(probe->layout, times[i], y + (ptrdiff_t)i * length);

        memcpy(out + (ptrdiff_t)i * roots, probe_values(probe, &row),
               (size_t)roots * sizeof(double));
    }
}

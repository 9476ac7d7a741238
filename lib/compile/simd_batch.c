/* simd_batch.c: a program at several inputs at once, in blocks as wide as the native code is */
#include "compile/simd_batch.h"

#include "compile/program_impl.h"

#include <string.h>

struct SimdBatch {
    const Program *program;
    const Native *native;
    NativeFrame *frame;
    double *slots; /* of each block: slots, then roots, `width` numbers each */
    int count, width, stride;
    Stage changed; /* the first to run; STAGE_COUNT: none */
};

static int width_of(int lanes, Evaluator evaluator, NativeTarget *target)
{
    const bool has = evaluator != EVALUATOR_INTERPRETER &&
                     native_target(lanes, evaluator == EVALUATOR_NATIVE, target);

    return has && target->width > 0 ? target->width : 0;
}

Native *simd_batch_native(const Program *program, int lanes, Evaluator evaluator)
{
    NativeTarget target;

    return width_of(lanes, evaluator, &target) > 0 ? native_new(program, &target) : NULL;
}

Native *simd_batch_native_if_it_pays(const Program *program, int lanes, Evaluator evaluator,
                                     long runs)
{
    const long once = program_interpreting(program, STAGE_TIME, STAGE_COUNT - 1);

    return program_has_paid(program, runs * once) ? simd_batch_native(program, lanes, evaluator)
                                                  : NULL;
}

SimdBatch *simd_batch_new(const Program *program, const Native *native, int lanes)
{
    NativeTarget target;
    SimdBatch *out = NEW(SimdBatch);
    int blocks;

    out->program = program;
    out->native = native;
    out->count = lanes;
    out->width = native != NULL ? width_of(lanes, EVALUATOR_NATIVE, &target) : 0;
    if (out->width == 0)
        out->width = lanes == ABREAST ? ABREAST : 1;
    out->stride = (program->slot_count + program->root_count) * out->width;
    blocks = lanes / out->width;
    out->slots = NEW_ARRAY(double, out->stride *blocks);
    if (native != NULL)
        out->frame = native_frame_new(native);
    for (int b = 0; b < blocks; b++)
        for (int i = 0; i < program->constants.count * out->width; i++)
            out->slots[b * out->stride + program->input_count * out->width + i] =
                program->constants.at[i / out->width];
    return out;
}

void simd_batch_free(SimdBatch *lanes)
{
    if (lanes == NULL)
        return;
    native_frame_free(lanes->frame);
    MEM_FREE(lanes->slots, lanes);
}

void simd_batch_set(SimdBatch *lanes, int input, Stage stage, const double *values)
{
    for (int first = 0, block = 0; first < lanes->count; first += lanes->width, block++) {
        double *at = lanes->slots + block * lanes->stride + input * lanes->width;
        uint64_t changed = 0;

        /* one by one: values just stored so would have to wait to be read as one */
        for (int k = 0; k < lanes->width; k++) {
            uint64_t old, new;

            memcpy(&old, at + k, sizeof old);
            memcpy(&new, values + first + k, sizeof new);
            memcpy(at + k, &new, sizeof new);
            changed |= old ^ new;
        }
        if (changed != 0 && stage < lanes->changed)
            lanes->changed = stage;
    }
}

void simd_batch_run(SimdBatch *lanes)
{
    const Program *program = lanes->program;

    for (int first = 0, block = 0; first < lanes->count && lanes->changed < STAGE_COUNT;
         first += lanes->width, block++) {
        double *slots = lanes->slots + block * lanes->stride;

        if (lanes->native != NULL) {
            native_run(lanes->native, lanes->changed, STAGE_COUNT - 1, slots, lanes->frame);
            continue;
        }
        if (lanes->width == ABREAST) {
            program_interpret_abreast(program, lanes->changed, STAGE_COUNT - 1, slots);
            continue;
        }
        program_interpret(program, lanes->changed, STAGE_COUNT - 1, slots);
        program_hand_over(program, lanes->changed, STAGE_COUNT - 1, slots,
                          slots + program->slot_count);
    }
    lanes->changed = STAGE_COUNT;
}

void simd_batch_get(const SimdBatch *lanes, int root, double *out)
{
    for (int first = 0, block = 0; first < lanes->count; first += lanes->width, block++)
        memcpy(out + first,
               lanes->slots + block * lanes->stride +
                   (lanes->program->slot_count + root) * lanes->width,
               (size_t)lanes->width * sizeof(double));
}

double simd_batch_root(const SimdBatch *lanes, int root, int lane)
{
    const int block = lane / lanes->width;

    return lanes->slots[block * lanes->stride + (lanes->program->slot_count + root) * lanes->width +
                        lane % lanes->width];
}

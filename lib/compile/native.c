/* native.c: a program as instructions of the processor that runs: made, kept, run */
#include "compile/native.h"

#include "base/code_memory.h"
#include "compile/native_impl.h"

#include <string.h>

#ifdef __x86_64__

enum { ALIGNED = 64 /* bytes: what the processor moves between memories */ };

typedef void StageFunction(double *slots, double *frame);

struct Native {
    CodeMemory *memory;
    StageFunction *stages[STAGE_COUNT]; /* NULL: nothing to do */
    int width;
    size_t frame; /* bytes */
};

bool native_has(Isa isa)
{
    switch (isa) {
    case ISA_AVX512:
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl") && native_has(ISA_AVX2);
    case ISA_AVX2:
        return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    default:
        return true;
    }
}

bool native_target(int width, bool fused, NativeTarget *out)
{
    static const int registers[] = {16, 16, 32}, widest[] = {2, 4, 8};
    Isa isa = ISA_AVX512;

    while (!native_has(isa))
        isa--;
    *out = (NativeTarget){.isa = isa,
                          .width = width < widest[isa] ? width : widest[isa],
                          .registers = registers[isa],
                          .fused = fused && isa != ISA_SSE2};
    return true;
}

Native *native_new(const Program *program, const NativeTarget *target)
{
    X86Code code = {.isa = target->isa, .width = target->width};
    StageSteps steps = {0};
    StepMaker *maker = step_maker_new(program, target);
    Native *native = NEW(Native);
    int begin[STAGE_COUNT];
    uint32_t frame = 0;

    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        begin[stage] = -1;
        if (target->joined && stage != NATIVE_JOINED)
            continue;
        step_maker_stage(maker, (Stage)stage, &steps);
        if (steps.steps.count > 0) {
            uint32_t own;

            begin[stage] = code.bytes.count;
            own = native_emit(&code, target, program, &steps,
                              step_maker_first_slot(maker, (Stage)stage));
            frame = own > frame ? own : frame;
        }
    }
    native->width = target->width;
    native->frame = (size_t)home_operand(target->width, FRAME | frame).offset;
    if (code.bytes.count > 0)
        native->memory = code_memory_new(code.bytes.at, (size_t)code.bytes.count);
    for (int stage = 0; stage < STAGE_COUNT && native->memory != NULL; stage++)
        if (begin[stage] >= 0) {
            const unsigned char *at = code_memory_at(native->memory);
            const void *function = at + begin[stage];

            memcpy(&native->stages[stage], &function, sizeof function);
        }
    if (code.bytes.count > 0 && native->memory == NULL) {
        mem_free(native);
        native = NULL;
    }
    LIST_FREE(code.bytes);
    stage_steps_free(&steps);
    step_maker_free(maker);
    return native;
}

void native_free(Native *native)
{
    if (native == NULL)
        return;
    code_memory_free(native->memory);
    mem_free(native);
}

static double *aligned(void *memory)
{
    unsigned char *at = memory;

    return (double *)(void *)(at + (ALIGNED - (uintptr_t)at % ALIGNED) % ALIGNED);
}

NativeFrame *native_frame_new(const Native *native)
{
    static const double fixed[] = {[FIXED_SIGN] = -0.0, [FIXED_ONE] = 1};
    const uint64_t size = INT64_MAX; /* all bits but the sign's */
    NativeFrame *frame = mem_new(native->frame + ALIGNED);

    for (int i = 0; i < FIXED_COUNT; i++)
        for (int lane = 0; lane < (native->width < 2 ? 2 : native->width); lane++) {
            const Home place = FIXED | (Home)i;
            double *at = aligned(frame) + home_operand(native->width, place).offset / 8 + lane;

            if (i == FIXED_SIZE)
                memcpy(at, &size, sizeof size);
            else
                *at = i < COUNT(fixed) ? fixed[i] : 0;
        }
    return frame;
}

void native_frame_free(NativeFrame *frame)
{
    mem_free(frame);
}

void native_run(const Native *native, Stage from, Stage to, double *slots, NativeFrame *frame)
{
    for (int stage = (int)from; stage <= (int)to; stage++)
        if (native->stages[stage] != NULL)
            native->stages[stage](slots, aligned(frame));
}

#else

bool native_target(int width, bool fused, NativeTarget *out)
{
    (void)width, (void)fused, (void)out;
    return false;
}

bool native_has(Isa isa)
{
    (void)isa;
    return false;
}

Native *native_new(const Program *program, const NativeTarget *target)
{
    (void)program, (void)target;
    return NULL;
}

void native_free(Native *native)
{
    (void)native;
}

NativeFrame *native_frame_new(const Native *native)
{
    (void)native;
    return NULL;
}

void native_frame_free(NativeFrame *frame)
{
    (void)frame;
}

void native_run(const Native *native, Stage from, Stage to, double *slots, NativeFrame *frame)
{
    (void)native, (void)from, (void)to, (void)slots, (void)frame;
}

#endif

/* native.c: a program as instructions of the present processor: generated, stored, run */
#include "compile/native.h"

#include "base/code_memory.h"
#include "compile/native_impl.h"

#include <string.h>

#ifdef __x86_64__

enum { ALIGNED = 64 /* bytes: what the processor moves between memories */ };

typedef void SectionFunction(double *slots, double *frame);

struct Native {
    CodeMemory *memory;
    SectionFunction **sections; /* NULL: empty */
    const int *first_section;   /* of each stage; the program's */
    SectionFunction *joined;    /* where stages are one function: it */
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
    SectionSteps steps = {0};
    StepMaker *maker = step_maker_new(program, target);
    Native *native = NEW(Native);
    const int sections = program->sections.count;
    int *begin = NEW_ARRAY(int, sections);
    uint32_t frame = 0;

    native->sections = mem_array((size_t)sections, sizeof(SectionFunction *));
    native->first_section = program->first_section;
    for (int s = 0; s < sections; s++) {
        begin[s] = -1;
        if (target->joined && s != NATIVE_JOINED)
            continue;
        step_maker_section(maker, s, &steps);
        if (steps.steps.count > 0) {
            uint32_t own;

            begin[s] = code.bytes.count;
            own = native_emit(&code, target, program, &steps,
                              (uint32_t)program->sections.at[s].first_slot);
            frame = own > frame ? own : frame;
        }
    }
    native->width = target->width;
    native->frame = (size_t)home_operand(target->width, FRAME | frame).offset;
    if (code.bytes.count > 0)
        native->memory = code_memory_new(code.bytes.at, (size_t)code.bytes.count);
    for (int s = 0; s < sections && native->memory != NULL; s++)
        if (begin[s] >= 0) {
            const unsigned char *at = code_memory_at(native->memory);
            const void *function = at + begin[s];

            memcpy(&native->sections[s], &function, sizeof function);
        }
    if (code.bytes.count > 0 && native->memory == NULL) {
        MEM_FREE(native->sections, native);
        native = NULL;
    }
    if (native != NULL && target->joined)
        native->joined = native->sections[NATIVE_JOINED];
    mem_free(begin);
    LIST_FREE(code.bytes);
    section_steps_free(&steps);
    step_maker_free(maker);
    return native;
}

void native_free(Native *native)
{
    if (native == NULL)
        return;
    code_memory_free(native->memory);
    MEM_FREE(native->sections, native);
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
    for (int s = native->first_section[from]; s < native->first_section[to + 1]; s++)
        native_run_section(native, s, slots, frame);
}

void native_run_joined(const Native *native, double *slots, NativeFrame *frame)
{
    if (native->joined != NULL)
        native->joined(slots, aligned(frame));
}

void native_run_section(const Native *native, int section, double *slots, NativeFrame *frame)
{
    if (native->sections[section] != NULL)
        native->sections[section](slots, aligned(frame));
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

void native_run_joined(const Native *native, double *slots, NativeFrame *frame)
{
    (void)native, (void)slots, (void)frame;
}

void native_run_section(const Native *native, int section, double *slots, NativeFrame *frame)
{
    (void)native, (void)section, (void)slots, (void)frame;
}

#endif

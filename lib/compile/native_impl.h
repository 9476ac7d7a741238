/* native_impl.h: shared parts of the files that generate native code
 *
 * The instructions of a stage are ordered so that results are used soon and calls are gathered
 * (native_steps.c). Then registers are allocated and bytes emitted (native_registers.c). */
#ifndef COTREE_COMPILE_NATIVE_IMPL_H
#define COTREE_COMPILE_NATIVE_IMPL_H

#include "compile/native.h"
#include "compile/program_impl.h"

#ifdef __x86_64__

/* the location of a value in memory: a slot, or a place in the frame, or one of its fixed
 * numbers */
typedef uint32_t Home;
#define FRAME   0x80000000U
#define FIXED   0xC0000000U
#define NO_HOME UINT32_MAX

/* Constants that instructions need, first in each frame; as values they are numbered after the
 * slots. */
typedef enum FixedValue { FIXED_SIGN, FIXED_SIZE, FIXED_ONE, FIXED_ZERO, FIXED_COUNT } FixedValue;

typedef enum StepCode {
    STEP_ADD, /* of two: as X86Op up to X86_AND */
    STEP_SUB,
    STEP_MUL,
    STEP_DIV,
    STEP_MIN,
    STEP_MAX,
    STEP_SQRT, /* of one */
    STEP_XOR,
    STEP_AND,
    STEP_MULADD, /* of three, a * b + c, rounded once */
    STEP_MULSUB,
    STEP_SUBMUL,
    STEP_COMPARE, /* + X86Compare: 1 or 0 */
    STEP_SELECT = STEP_COMPARE + 5,
    STEP_STORE, /* result: a place */
    STEP_CALL   /* result: number of the call */
} StepCode;

typedef struct NativeStep {
    uint8_t code;
    uint8_t operands;
    uint32_t result; /* a value, but for the last two */
    uint32_t args[MOST_OPERANDS];
} NativeStep;

/* functions of one kind, whose arguments are consecutive in memory */
typedef struct StepCall {
    Opcode code; /* CODE_SINCOS, or another function */
    int count;
    Home arguments, results; /* all sines, then all cosines */
    int first_result;        /* in `results` of the steps; SINCOS has two each */
} StepCall;

typedef struct SectionSteps {
    LIST(NativeStep) steps;
    LIST(StepCall) calls;
    LIST(uint32_t) results; /* values, NO_HOME where nobody needs one */
    uint32_t value_count;   /* slots, fixed ones, what is new here */
    uint32_t frame;         /* places used by calls */
} SectionSteps;

typedef struct StepMaker StepMaker;
StepMaker *step_maker_new(const Program *program, const NativeTarget *target);
void step_maker_free(StepMaker *maker);
/* the steps of a section, of the first of those that are joined, in `out`, which is emptied first
 */
void step_maker_section(StepMaker *maker, int section, SectionSteps *out);
void section_steps_free(SectionSteps *steps);

/* Append the function of a section; the frame's places that it needs. */
uint32_t native_emit(X86Code *code, const NativeTarget *target, const Program *program,
                     const SectionSteps *steps, uint32_t first_slot);

/* offset of a place in bytes from the start of the slots or the frame */
X86Operand home_operand(int width, Home place);

#endif
#endif

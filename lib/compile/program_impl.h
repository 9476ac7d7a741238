/* program_impl.h: what the files of lib/compile share
 *
 * Roots are lowered to values (lower.c), values are put into stages and runs
 * (schedule.c). A workspace (workspace.c) runs through them (interpret.c), or has native code made
 * (native.h).
 *
 * Slots of a workspace: inputs, constants, then results in the order of the tape.
 * So an instruction tells its operands only; a run knows the slot of its first
 * result. */
#ifndef COTREE_COMPILE_PROGRAM_IMPL_H
#define COTREE_COMPILE_PROGRAM_IMPL_H

#include "base/memory.h"
#include "compile/program.h"

enum { MOST_OPERANDS = 3 };

typedef enum Opcode {
#define OPCODE(id, ...) CODE_##id,
#include "compile/opcodes.def"
#undef OPCODE
    CODE_SINCOS, /* two results, one behind the other */
    CODE_CALL,   /* and the functions of ops.def behind it */
    CODES = CODE_CALL + OP_COUNT,
    CODE_INPUT,    /* what follows is a value without an instruction; args[0]: which */
    CODE_CONSTANT, /* args[0], args[1]: the bits of the double */
    CODE_COSINE,   /* the second result of the SINCOS args[0] */
    CODE_ABSORBED  /* a product that became part of an instruction */
} Opcode;

/* --- lower.c: values, each once, operands before users --- */

typedef struct LoweredValue {
    uint8_t code;
    uint8_t stage;
    uint32_t args[MOST_OPERANDS]; /* numbers of values; unused ones 0 */
} LoweredValue;

typedef struct Lowered {
    LIST(LoweredValue) values;  /* inputs first */
    LIST(const Curve *) tables; /* borrowed; what data is as a value is its place here */
    int input_count;
    uint32_t *roots; /* values */
    int root_count;
} Lowered;

int code_operands(Opcode code);
double value_constant(const LoweredValue *constant);
MUST_USE Status lowered_make(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                             Lowered *out, Diag *diag);
void lowered_free(Lowered *lowered);

/* --- schedule.c --- */

/* instructions of one opcode */
typedef struct OpcodeRun {
    Opcode code;
    int count;
    int operands; /* where they begin in the tape, those of one instruction together */
    int result;   /* slot of the first */
} OpcodeRun;

typedef struct Handover {
    int root;
    int slot;
} Handover;

struct Program {
    int input_count;
    int root_count;
    int slot_count;
    const char **input_names;
    LIST(double) constants;
    LIST(Curve *) tables;
    LIST(OpcodeRun) runs;
    LIST(uint32_t) tape;
    LIST(uint32_t) derived;         /* slots of results in the order of the expressions */
    Handover *roots;                /* by stage */
    int first_run[STAGE_COUNT + 1]; /* of each stage */
    int first_root[STAGE_COUNT + 1];
    Pool *texts;
};

/* Fill everything but names and counts of inputs and roots. Changes `lowered`. */
void program_schedule(Program *program, Lowered *lowered);

/* --- interpret.c --- */

void program_interpret(const Program *program, Stage from, Stage to, double *slots);
void program_hand_over(const Program *program, Stage from, Stage to, const double *slots,
                       double *roots);

/* --- rounding.c --- */

void program_bound(const Program *program, const double *slots, const double *input_errors,
                   double *root_errors);

#endif

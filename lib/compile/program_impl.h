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

#include "compile/lower.h"
#include "compile/program.h"

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
    int work[STAGE_COUNT + 1]; /* instructions of the stages before */
    Pool *texts;
};

/* Fill everything but names and counts of inputs and roots. Changes `lowered`. */
void program_schedule(Program *program, Lowered *lowered);

/* --- interpret.c --- */

void program_interpret(const Program *program, Stage from, Stage to, double *slots);
void program_hand_over(const Program *program, Stage from, Stage to, const double *slots,
                       double *roots);

/* --- rounding.c --- */

/* errors of all slots; and of roots */
void program_bound_slots(const Program *program, const double *slots, const double *input_errors,
                         double *errors);
void program_bound(const Program *program, const double *slots, const double *input_errors,
                   double *root_errors);

#endif

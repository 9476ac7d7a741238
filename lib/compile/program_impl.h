/* program_impl.h: shared parts of the files of lib/compile
 *
 * Roots are lowered to values (lower.c), values are put into stages and runs
 * (schedule.c). A workspace (workspace.c) runs through them (interpret.c), or has native code made
 * (native.h).
 *
 * Slots of a workspace: inputs, constants, then results in the order of the tape. So an instruction
 * stores only its operands; a run stores the slot of its first result. */
#ifndef COTREE_COMPILE_PROGRAM_IMPL_H
#define COTREE_COMPILE_PROGRAM_IMPL_H

#include "compile/lower.h"
#include "compile/program.h"

/* --- schedule.c --- */

/* instructions of one opcode */
typedef struct OpcodeRun {
    Opcode code;
    int count;
    int operands; /* index of the first in the tape, those of one instruction together */
    int result;   /* slot of the first */
} OpcodeRun;

/* Consecutive sections of a stage: `together` of them, this one first, may run at the same time. */
typedef struct Section {
    int first_run;
    int first_slot;
    int together;
} Section;

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
    LIST(Section) sections; /* one for each stage that isn't separated */
    LIST(uint32_t) tape;
    LIST(uint32_t) derived;         /* slots of results in the order of the expressions */
    Handover *roots;                /* by stage */
    int first_run[STAGE_COUNT + 1]; /* of each stage */
    int first_section[STAGE_COUNT + 1];
    int first_root[STAGE_COUNT + 1];
    int work[STAGE_COUNT + 1]; /* instructions of the stages before */
    Pool *texts;
};

/* Fill everything but names and counts of inputs and roots. Changes `lowered`. */
void program_schedule(Program *program, Lowered *lowered, const ProgramBlocks *blocks);

/* --- program.c --- */

/* Make the program of a lowering and free the lowering; new, program_free(). */
Program *program_of(Lowered *lowered, const ProgramBlocks *blocks);

/* the value whose instruction computes this one */
static inline uint32_t maker_of(const LoweredValue *values, uint32_t value)
{
    return values[value].code == CODE_COSINE ? values[value].args[0] : value;
}
static inline bool is_instruction(const LoweredValue *value)
{
    return value->code < CODES;
}
/* the run after a section's last */
static inline int section_end(const Program *program, int section)
{
    return section + 1 < program->sections.count ? program->sections.at[section + 1].first_run
                                                 : program->runs.count;
}

/* --- independent_blocks.c --- */

/* How the values of a stage are separated: first those of no block, alone, then parts, then those
 * that combine them, alone, and so on (independent_blocks.c). */
enum { PHASES = 5 };
typedef struct IndependentBlocks {
    int parts;
    uint8_t *phase, *part; /* of each value; phases 1 and 3 are in parts */
    bool is_split[STAGE_COUNT];
} IndependentBlocks;
/* Find it, from values that are fused already; free with independent_blocks_free(). */
IndependentBlocks independent_blocks_find(const Lowered *lowered, const ProgramBlocks *blocks);
void independent_blocks_free(IndependentBlocks *apart);

/* --- interpret.c --- */

void program_interpret(const Program *program, Stage from, Stage to, double *slots);
void program_interpret_section(const Program *program, int section, double *slots);
void program_hand_over(const Program *program, Stage from, Stage to, const double *slots,
                       double *roots);
/* ABREAST evaluations at once, of slots and then roots that are as many numbers each: to the bits
 * of one by one. */
enum { ABREAST = 8 };
void program_interpret_abreast(const Program *program, Stage from, Stage to, double *slots);

/* --- workspace.c --- */

/* Instructions that interpreting these stages counts as, with the call. */
long program_interpreting(const Program *program, Stage from, Stage to);
/* Whether so many runs took about as long as generating native code. */
bool program_has_paid(const Program *program, long interpreted);

/* --- rounding.c --- */

/* errors of all slots; and of roots */
void program_bound_slots(const Program *program, const double *slots, const double *input_errors,
                         double *errors);
void program_bound(const Program *program, const double *slots, const double *input_errors,
                   double *root_errors);

#endif

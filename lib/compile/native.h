/* native.h: a program as instructions of the present processor
 *
 * One function for each stage, or section of one, over the slots of a workspace and a frame of its
 * own. Results for later stages are in the same slots as with the interpreter, so either may
 * continue after the other. A Native is const once made. */
#ifndef COTREE_COMPILE_NATIVE_H
#define COTREE_COMPILE_NATIVE_H

#include "compile/program.h"
#include "compile/x86.h"

typedef struct NativeTarget {
    Isa isa;
    int width;     /* evaluations at once: 1, up to 2, 4, 8 as the instructions have it */
    int registers; /* of those there are, FEWEST_REGISTERS at least */
    bool fused;    /* a product and sum is rounded once where the processor does so */
    bool joined;   /* one function, of the stages from NATIVE_JOINED to NATIVE_JOINED_END alone */
} NativeTarget;

enum { FEWEST_REGISTERS = 6, WIDEST = 8 };
/* Along a kinematic chain each sum depends on the one before. If positions and speeds are in one
 * stage, their sums are adjacent and the latencies overlap. */
#define NATIVE_JOINED     STAGE_TIME
#define NATIVE_JOINED_END STAGE_NETWORK

/* the best instruction set of this processor, for up to `width` evaluations at once; false: none */
bool native_target(int width, bool fused, NativeTarget *out);
bool native_has(Isa isa);

typedef struct Native Native;
/* New; borrows the program. NULL: the system refuses memory for it. O(instructions * registers). */
Native *native_new(const Program *program, const NativeTarget *target);
void native_free(Native *native); /* NULL is fine */
/* memory in addition to the slots while stages run; new, one for each thread that runs them */
typedef void NativeFrame;
NativeFrame *native_frame_new(const Native *native);
void native_frame_free(NativeFrame *frame);
/* Stages from..to, both included; all that are joined, or none of them. Slots, then roots, each of
 * `width` numbers. */
void native_run(const Native *native, Stage from, Stage to, double *slots, NativeFrame *frame);
/* All that are joined, where they are one function. */
void native_run_joined(const Native *native, double *slots, NativeFrame *frame);
/* one section (program_impl.h); those that run at the same time have a frame each */
void native_run_section(const Native *native, int section, double *slots, NativeFrame *frame);

#endif

/* program.h: expressions to straight-line programs in stages
 *
 * A Program is made once from roots and const ever after. A Workspace contains the numbers of one
 * evaluation and belongs to one thread. A stage consists of the operations that depend on inputs up
 * to a kind: run again from the first stage whose inputs changed.
 *
 * The interpreter executes a tape in which equal operations form runs, with one loop for each run.
 * Results are bitwise those of expr_evaluate(): sums and products from left to right, every
 * operation rounded. The branch of an if that isn't chosen is computed but doesn't affect the
 * result. Native code is generated for workspaces that are run often. */
#ifndef COTREE_COMPILE_PROGRAM_H
#define COTREE_COMPILE_PROGRAM_H

#include "base/code_memory.h"
#include "base/threads.h"
#include "expr/expr.h"

typedef enum Stage {
    STAGE_PARAMETER,    /* parameters and numbers */
    STAGE_TIME,         /* t */
    STAGE_POSITION,     /* q */
    STAGE_VELOCITY,     /* u, x */
    STAGE_NETWORK,      /* x', z */
    STAGE_ACCELERATION, /* u', lambda, efforts, u'' */
    STAGE_COUNT
} Stage;

Stage stage_of_symbol(SymbolKind kind); /* VARIABLE and ARGUMENT have none: assert */
Stage stage_of(Expr e);                 /* the latest of its symbols' */

typedef struct Program Program;
typedef struct Workspace Workspace;

/* Compile roots to a program.
 *
 * roots   expressions to compute, borrowed from an arena that may be freed afterwards
 * inputs  the symbols that the caller sets, in any order, each once
 * out     new; free with program_free(). It computes only what the roots need.
 *
 * Fails with E_NAME when a root holds a symbol that is no input, naming it. O(nodes) and no
 * recursion. */
MUST_USE Status program_new(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                            Program **out, Diag *diag);
/* Which inputs belong together, as those of an instance: operations of one block don't depend on
 * those of another. In stages where that pays, blocks are separated into at most `parts` parts that
 * may run at the same time. Each number is the same as otherwise, to the last bit. */
typedef struct ProgramBlocks {
    const int *block; /* of each input, from 1; 0: of none. Borrowed during the call */
    int parts;        /* 1 or less: no separate parts */
} ProgramBlocks;
MUST_USE Status program_new_in_blocks(const Expr *roots, int root_count, const Expr *inputs,
                                      int input_count, const ProgramBlocks *blocks, Program **out,
                                      Diag *diag);
/* Operations of some stages that may run at the same time, in so many parts at most; 1: none may.
 */
int program_parts(const Program *program, int *operations);
void program_free(Program *program); /* NULL is fine */

int program_input_count(const Program *program);
int program_root_count(const Program *program);
/* instructions of one stage: a fused product and sum is one, a sine with its cosine too */
int program_operations(const Program *program, Stage stage);
/* the last stage that a root needs */
Stage program_last_stage(const Program *program);
/* operations carried out, all stages, by the rule of expr.h */
OpCount program_count(const Program *program);
/* one line an instruction, for `show program`: "v7 = v3 * v5" */
void program_print(Text *text, const Program *program);

/* New; borrows the program; all inputs 0. The interpreter computes. */
Workspace *workspace_new(const Program *program);
void workspace_free(Workspace *workspace); /* NULL is fine */
/* Before the first run. Code is made when it has paid: after some hundred evaluations, more of a
 * short program. */
void workspace_choose(Workspace *workspace, Evaluator evaluator);
/* threads for parts that may run at the same time, borrowed; NULL: the caller's alone */
void workspace_share(Workspace *workspace, Threads *threads);
/* The caller expects so many runs of all stages: if they pay for native code, it is generated in
 * the first. */
void workspace_foresee(Workspace *workspace, int runs);
/* The numbers of the inputs, in the order given to program_new(): write here. */
double *workspace_inputs(Workspace *workspace);
/* Compute stages from..to, both included. No failure; NaN travels. */
void workspace_run(Workspace *workspace, Stage from, Stage to);
/* STAGE_TIME to STAGE_NETWORK in one call, which is faster than one by one. A later run starts with
 * one of these again, with STAGE_TIME, or after them. */
void workspace_run_joined(Workspace *workspace);
/* The values of the roots, in order; a root's is current once its stage was run. Borrowed. */
const double *workspace_roots(const Workspace *workspace);
/* Error bounds of the roots of the last run, with every stage current: from rounding, and from
 * errors of the inputs up to `input_errors`. No bound: INFINITY or NAN. */
void workspace_errors(const Workspace *workspace, const double *input_errors, double *root_errors);
/* how far a number may be from the one that was meant: half a unit in its last place, 0 for one of
 * few digits in binary */
double number_error(double value);

#endif

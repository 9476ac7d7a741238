/* workspace.c: the numbers of one evaluation, and the choice of how to compute them */
#include "compile/native.h"
#include "compile/program_impl.h"

#include "base/clock.h"

#include <math.h>
#include <string.h>

/* Native code is generated as soon as interpretation has taken about as long as generating it
 * would: so the total cost is at most twice the better of both, however long a run is. Costs in
 * interpreted instructions (make bench: program.eval_*, make_native_*): MAKING to generate one
 * instruction, MEMORY to allocate memory for code, CALLING for a call of the interpreter, which
 * changes opcode a dozen times. None of it may depend on the number of parts: results of fused code
 * differ in the last bits. */
#if defined COTREE_SMALL || defined COTREE_FAULTS
enum { MAKING = 0, MEMORY = 1, CALLING = 1 };
#else
enum { MAKING = 100, MEMORY = 20000, CALLING = 100 };
#endif

long program_interpreting(const Program *program, Stage from, Stage to)
{
    return CALLING + program->work[to + 1] - program->work[from];
}

bool program_has_paid(const Program *program, long interpreted)
{
    return interpreted > MEMORY + (long)MAKING * program->work[STAGE_COUNT];
}

/* Several threads are used where they are measured to be faster, because moving numbers between
 * processors may take longer than computing them. TRIES runs alternate between one and several
 * threads; then the faster way is used for PATIENCE runs. */
enum { TRIES = 16, PATIENCE = 10000 };
#define FASTER 0.95

/* of the stages from one to another */
typedef struct ThreadTrial {
    int runs;
    double alone, together; /* s: of the tries, but for the longest of each */
    double longest[2];
    bool by_threads;
} ThreadTrial;

typedef struct NativePart {
    long interpreted;     /* instructions, until they have paid for native code; -1: they have */
    Native *native;       /* NULL: not yet, or there is none */
    NativeFrame **frames; /* one for each section that may run at the same time */
} NativePart;

struct Workspace {
    const Program *program;
    double *slots; /* then roots */
    Evaluator evaluator;
    Threads *threads;
    int parts; /* sections that may run at the same time, at most */
    NativePart single, joined;
    ThreadTrial (*trials)[STAGE_COUNT]; /* of stages from and to; NULL: there is one part */
};

Workspace *workspace_new(const Program *program)
{
    const bool was_scratch = mem_scratch(true); /* numbers that each evaluation finds anew */
    Workspace *workspace = NEW(Workspace);
    int operations;

    workspace->program = program;
    workspace->slots = NEW_ARRAY(double, program->slot_count + program->root_count);
    workspace->evaluator = EVALUATOR_INTERPRETER;
    workspace->parts = program_parts(program, &operations);
    if (workspace->parts > 1)
        workspace->trials = mem_array(STAGE_COUNT, sizeof *workspace->trials);
    for (int i = 0; i < program->constants.count; i++)
        workspace->slots[program->input_count + i] = program->constants.at[i];
    (void)mem_scratch(was_scratch);
    return workspace;
}

static void free_part(NativePart *part, int frames)
{
    for (int i = 0; part->frames != NULL && i < frames; i++)
        native_frame_free(part->frames[i]);
    mem_free(part->frames);
    native_free(part->native);
}

void workspace_free(Workspace *workspace)
{
    if (workspace == NULL)
        return;
    free_part(&workspace->single, workspace->parts);
    free_part(&workspace->joined, workspace->parts);
    MEM_FREE(workspace->trials, workspace->slots, workspace);
}

void workspace_choose(Workspace *workspace, Evaluator evaluator)
{
    workspace->evaluator = evaluator;
}

void workspace_share(Workspace *workspace, Threads *threads)
{
    workspace->threads = threads;
}

void workspace_foresee(Workspace *workspace, int runs)
{
    if (workspace->single.interpreted >= 0)
        workspace->single.interpreted +=
            runs * program_interpreting(workspace->program, STAGE_PARAMETER, STAGE_COUNT - 1);
}

double *workspace_inputs(Workspace *workspace)
{
    return workspace->slots;
}

const double *workspace_roots(const Workspace *workspace)
{
    return workspace->slots + workspace->program->slot_count;
}

/* Without native code the interpreter continues. */
static void make_native(Workspace *workspace, NativePart *part)
{
    NativeTarget target;
    bool was_scratch;

    if (!native_target(1, workspace->evaluator == EVALUATOR_NATIVE, &target))
        return;
    target.joined = part == &workspace->joined && workspace->parts == 1;
    mem_keep(workspace);
    was_scratch = mem_scratch(true);
    part->native = native_new(workspace->program, &target);
    if (workspace->trials != NULL)
        memset(workspace->trials, 0, STAGE_COUNT * sizeof *workspace->trials);
    if (part->native != NULL) {
        part->frames = mem_array((size_t)workspace->parts, sizeof *part->frames);
        for (int i = 0; i < workspace->parts; i++)
            part->frames[i] = native_frame_new(part->native);
    }
    (void)mem_scratch(was_scratch);
}

/* sections that run at the same time, from `first` on */
typedef struct Together {
    const Workspace *workspace;
    const NativePart *part;
    int first;
} Together;

static void run_section(void *context, int which)
{
    const Together *t = context;
    const NativePart *part = t->part;

    if (part->native != NULL)
        native_run_section(part->native, t->first + which, t->workspace->slots,
                           part->frames[which]);
    else
        program_interpret_section(t->workspace->program, t->first + which, t->workspace->slots);
}

/* on one thread: NULL */
static void run_sections(const Workspace *workspace, const NativePart *part, Threads *threads,
                         Stage from, Stage to)
{
    const Program *program = workspace->program;
    Together now = {.workspace = workspace, .part = part, .first = program->first_section[from]};

    while (now.first < program->first_section[to + 1]) {
        const int together = program->sections.at[now.first].together;

        threads_do(threads, together, run_section, &now);
        now.first += together;
    }
}

static void take_time(ThreadTrial *trial, bool by_threads, double took)
{
    double *sum = by_threads ? &trial->together : &trial->alone;
    double *longest = &trial->longest[by_threads];

    *sum += fmin(took, *longest);
    *longest = fmax(took, *longest);
    if (trial->runs == TRIES)
        trial->by_threads = trial->together < FASTER * trial->alone;
}

static void run_independent_blocks(Workspace *workspace, const NativePart *part, Stage from,
                                   Stage to)
{
    ThreadTrial *trial = &workspace->trials[from][to];
    const bool by_threads = trial->runs < TRIES ? trial->runs % 2 == 1 : trial->by_threads;
    const double began = trial->runs < TRIES ? clock_now() : 0;

    run_sections(workspace, part, by_threads ? workspace->threads : NULL, from, to);
    trial->runs++;
    if (trial->runs <= TRIES)
        take_time(trial, by_threads, clock_now() - began);
    else if (trial->runs > PATIENCE)
        *trial = (ThreadTrial){0};
}

static void run(Workspace *workspace, NativePart *part, Stage from, Stage to)
{
    const Program *program = workspace->program;
    double *slots = workspace->slots;

    if (workspace->parts > 1)
        run_independent_blocks(workspace, part, from, to);
    else if (part->native != NULL)
        native_run(part->native, from, to, slots, part->frames[0]);
    else
        program_interpret(program, from, to, slots);
    if (part->native != NULL)
        return;
    program_hand_over(program, from, to, slots, slots + program->slot_count);
    if (workspace->evaluator == EVALUATOR_INTERPRETER || part->interpreted < 0)
        return;
    part->interpreted += program_interpreting(program, from, to);
    if (program_has_paid(program, part->interpreted)) {
        part->interpreted = -1;
        make_native(workspace, part);
    }
}

void workspace_run(Workspace *workspace, Stage from, Stage to)
{
    run(workspace, &workspace->single, from, to);
}

void workspace_run_joined(Workspace *workspace)
{
    const NativePart *joined = &workspace->joined;

    if (joined->native != NULL && workspace->parts == 1) {
        native_run_joined(joined->native, workspace->slots, joined->frames[0]);
        return;
    }
    run(workspace, &workspace->joined, NATIVE_JOINED, NATIVE_JOINED_END);
}

void workspace_errors(const Workspace *workspace, const double *input_errors, double *root_errors)
{
    /* native code stores only what later stages need */
    if (workspace->single.native != NULL || workspace->joined.native != NULL)
        program_interpret(workspace->program, STAGE_PARAMETER, STAGE_COUNT - 1, workspace->slots);
    program_bound(workspace->program, workspace->slots, input_errors, root_errors);
}

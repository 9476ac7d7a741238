/* workspace.c: the numbers of one evaluation, and by what they are computed */
#include "compile/native.h"
#include "compile/program_impl.h"

/* Native code is made as soon as what was interpreted took about as long as making it does: so it
 * costs twice the better of both at most, however long a run is. In instructions interpreted
 * (make bench: program.eval_*, make_native_*): one takes MAKING to make, memory for code as much
 * as 40 000, and a call of the interpreter CALLING. */
#if defined COTREE_SMALL || defined COTREE_FAULTS
enum { MAKING = 0, MEMORY = 1, CALLING = 1 };
#else
enum { MAKING = 100, MEMORY = 40000, CALLING = 10 };
#endif

struct Workspace {
    const Program *program;
    double *slots; /* then roots */
    Evaluator evaluator;
    long interpreted; /* instructions, until they have paid for native code */
    Native *native;
    NativeFrame *frame;
};

Workspace *workspace_new(const Program *program)
{
    const bool was_scratch = mem_scratch(true); /* numbers that each evaluation finds anew */
    Workspace *workspace = NEW(Workspace);

    workspace->program = program;
    workspace->slots = NEW_ARRAY(double, program->slot_count + program->root_count);
    workspace->evaluator = EVALUATOR_INTERPRETER;
    for (int i = 0; i < program->constants.count; i++)
        workspace->slots[program->input_count + i] = program->constants.at[i];
    (void)mem_scratch(was_scratch);
    return workspace;
}

void workspace_free(Workspace *workspace)
{
    if (workspace == NULL)
        return;
    native_frame_free(workspace->frame);
    native_free(workspace->native);
    MEM_FREE(workspace->slots, workspace);
}

void workspace_choose(Workspace *workspace, Evaluator evaluator)
{
    workspace->evaluator = evaluator;
}

double *workspace_inputs(Workspace *workspace)
{
    return workspace->slots;
}

const double *workspace_roots(const Workspace *workspace)
{
    return workspace->slots + workspace->program->slot_count;
}

/* Where there is no native code the interpreter goes on. */
static void make_native(Workspace *workspace)
{
    NativeTarget target;
    bool was_scratch;

    if (!native_target(1, workspace->evaluator == EVALUATOR_NATIVE, &target))
        return;
    mem_keep(workspace);
    was_scratch = mem_scratch(true);
    workspace->native = native_new(workspace->program, &target);
    if (workspace->native != NULL)
        workspace->frame = native_frame_new(workspace->native);
    (void)mem_scratch(was_scratch);
}

void workspace_run(Workspace *workspace, Stage from, Stage to)
{
    const Program *program = workspace->program;
    double *slots = workspace->slots;

    if (workspace->native != NULL) {
        native_run(workspace->native, from, to, slots, workspace->frame);
        return;
    }
    program_interpret(program, from, to, slots);
    program_hand_over(program, from, to, slots, slots + program->slot_count);
    if (workspace->evaluator == EVALUATOR_INTERPRETER || workspace->interpreted < 0)
        return;
    workspace->interpreted += CALLING + program->work[to + 1] - program->work[from];
    if (workspace->interpreted > MEMORY + (long)MAKING * program->work[STAGE_COUNT]) {
        workspace->interpreted = -1;
        make_native(workspace);
    }
}

void workspace_errors(const Workspace *workspace, const double *input_errors, double *root_errors)
{
    /* native code keeps but what later stages need */
    if (workspace->native != NULL)
        program_interpret(workspace->program, STAGE_PARAMETER, STAGE_COUNT - 1, workspace->slots);
    program_bound(workspace->program, workspace->slots, input_errors, root_errors);
}

/* interpret.c: a workspace, and the loops that run through a tape
 *
 * One loop an opcode, made from its row: the branch that finds the loop is paid once a
 * run, not once an operation. */
#include "compile/program_impl.h"

#include "algebra/elementary.h"

#include <math.h>

struct Workspace {
    const Program *program;
    double *slots;
    double *roots;
};

Workspace *workspace_new(const Program *program)
{
    const bool was_scratch = mem_scratch(true); /* numbers that each evaluation finds anew */
    Workspace *workspace = NEW(Workspace);

    workspace->program = program;
    workspace->slots = NEW_ARRAY(double, program->slot_count);
    workspace->roots = NEW_ARRAY(double, program->root_count);
    for (int i = 0; i < program->constants.count; i++)
        workspace->slots[program->input_count + i] = program->constants.at[i];
    (void)mem_scratch(was_scratch);
    return workspace;
}

void workspace_free(Workspace *workspace)
{
    if (workspace == NULL)
        return;
    mem_free(workspace->slots);
    mem_free(workspace->roots);
    mem_free(workspace);
}

double *workspace_inputs(Workspace *workspace)
{
    return workspace->slots;
}

const double *workspace_roots(const Workspace *workspace)
{
    return workspace->roots;
}

static void run_calls(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    Op op = (Op)(run->code - CODE_CALL);
    int operands = code_operands(run->code);
    double *result = slots + run->result;

    for (int i = 0; i < run->count; i++) {
        double args[MOST_OPERANDS];

        for (int k = 0; k < operands; k++)
            args[k] = slots[*operand++];
        result[i] = op_value(op, args);
    }
}

/* operands: which table, x, the order of the derivative */
static void run_tables(const OpcodeRun *run, const uint32_t *operand, Curve *const *tables,
                       double *slots)
{
    double *result = slots + run->result;

    for (int i = 0; i < run->count; i++, operand += 3)
        result[i] =
            curve_value(tables[(int)slots[operand[0]]], slots[operand[1]], (int)slots[operand[2]]);
}

static void run_sines(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    double *result = slots + run->result;

    for (int i = 0; i < run->count; i++) {
        elementary_sincos(slots[operand[i]], &result[2 * i], &result[2 * i + 1]);
    }
}

/* Operands of later instructions of a run may be results of earlier ones. */
static void run_one(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    double *result = slots + run->result;

    switch (run->code) {
#define OPCODE(id, operands, adds, muls, functions, ...)                                           \
    case CODE_##id:                                                                                \
        for (int i = 0; i < run->count; i++, operand += (operands)) {                              \
            double a = slots[operand[0]];                                                          \
            double b = (operands) > 1 ? slots[operand[1]] : 0;                                     \
            double c = (operands) > 2 ? slots[operand[2]] : 0;                                     \
                                                                                                   \
            (void)b;                                                                               \
            (void)c;                                                                               \
            result[i] = __VA_ARGS__;                                                               \
        }                                                                                          \
        break;
#include "compile/opcodes.def"
#undef OPCODE
    case CODE_SINCOS:
        run_sines(run, operand, slots);
        break;
    default:
        run_calls(run, operand, slots);
        break;
    }
}

void workspace_run(Workspace *workspace, Stage from, Stage to)
{
    const Program *program = workspace->program;
    const uint32_t *tape = program->tape.at;

    for (int r = program->first_run[from]; r < program->first_run[to + 1]; r++) {
        const OpcodeRun *run = &program->runs.at[r];

        if (run->code == CODE_CALL + OP_TABLE)
            run_tables(run, tape + run->operands, program->tables.at, workspace->slots);
        else
            run_one(run, tape + run->operands, workspace->slots);
    }
    for (int i = program->first_root[from]; i < program->first_root[to + 1]; i++)
        workspace->roots[program->roots[i].root] = workspace->slots[program->roots[i].slot];
}

void workspace_errors(const Workspace *workspace, const double *input_errors, double *root_errors)
{
    program_bound(workspace->program, workspace->slots, input_errors, root_errors);
}

/* interpret.c: the loops that run through a tape
 *
 * One loop an opcode, made from its row: the branch that finds the loop is paid once a
 * run, not once an operation. */
#include "compile/program_impl.h"

#include "algebra/elementary.h"

#include <math.h>

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

/* several at once, up to one whose operand is a result of these */
static void run_sines(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    enum { TOGETHER = 16 };

    for (int i = 0; i < run->count;) {
        double x[TOGETHER], sine[TOGETHER], cosine[TOGETHER];
        double *result = slots + run->result + 2 * i;
        const int most = run->count - i < TOGETHER ? run->count - i : TOGETHER;
        int n = 0;

        for (; n < most && slots + operand[i + n] < result; n++)
            x[n] = slots[operand[i + n]];
        elementary_sincos_all(x, sine, cosine, n);
        for (int k = 0; k < n; k++) {
            result[2 * k] = sine[k];
            result[2 * k + 1] = cosine[k];
        }
        i += n;
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

static void interpret(const Program *program, int first, int end, double *slots)
{
    const uint32_t *tape = program->tape.at;

    for (int r = first; r < end; r++) {
        const OpcodeRun *run = &program->runs.at[r];

        if (run->code == CODE_CALL + OP_TABLE)
            run_tables(run, tape + run->operands, program->tables.at, slots);
        else
            run_one(run, tape + run->operands, slots);
    }
}

void program_interpret(const Program *program, Stage from, Stage to, double *slots)
{
    interpret(program, program->first_run[from], program->first_run[to + 1], slots);
}

void program_interpret_section(const Program *program, int section, double *slots)
{
    interpret(program, program->sections.at[section].first_run, section_end(program, section),
              slots);
}

void program_hand_over(const Program *program, Stage from, Stage to, const double *slots,
                       double *roots)
{
    for (int i = program->first_root[from]; i < program->first_root[to + 1]; i++)
        roots[program->roots[i].root] = slots[program->roots[i].slot];
}

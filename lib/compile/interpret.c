/* interpret.c: the loops that run through a tape
 *
 * One loop an opcode, made from its row: the branch that finds the loop is paid once a
 * run, not once an operation. */
#include "compile/program_impl.h"

#include "algebra/elementary.h"
#include "base/four.h"

#include <math.h>
#include <string.h>

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

/* --- several at once: a slot is ABREAST consecutive numbers --- */

typedef double Eight __attribute__((vector_size(ABREAST * sizeof(double)), aligned(8), may_alias));

static void run_calls_abreast(const OpcodeRun *run, const uint32_t *operand, Curve *const *tables,
                              double *slots)
{
    const int operands = code_operands(run->code);
    double *result = slots + (ptrdiff_t)run->result * ABREAST;

    for (int i = 0; i < run->count; i++, operand += operands)
        for (int lane = 0; lane < ABREAST; lane++) {
            double args[MOST_OPERANDS] = {0};

            for (int k = 0; k < operands; k++)
                args[k] = slots[(ptrdiff_t)operand[k] * ABREAST + lane];
            *result++ = run->code == CODE_CALL + OP_TABLE
                            ? curve_value(tables[(int)args[0]], args[1], (int)args[2])
                            : op_value((Op)(run->code - CODE_CALL), args);
        }
}

static void run_sines_abreast(const OpcodeRun *run, const uint32_t *operand, double *slots)
{
    double *result = slots + (ptrdiff_t)run->result * ABREAST;

    for (int i = 0; i < run->count; i++, result += 2 * ABREAST)
        elementary_sincos_all(slots + (ptrdiff_t)operand[i] * ABREAST, result, result + ABREAST,
                              ABREAST);
}

/* the operation of a row of opcodes.def: sums and products all at once, functions one by one */
#define ABREAST_0(...)                                                                             \
    do {                                                                                           \
        const Eight a = at[operand[0]], b = at[operand[second]], c = at[operand[third]];           \
                                                                                                   \
        (void)b;                                                                                   \
        (void)c;                                                                                   \
        at[result] = __VA_ARGS__;                                                                  \
    } while (0)
#define ABREAST_1(...)                                                                             \
    for (int lane = 0; lane < ABREAST; lane++) {                                                   \
        const double a = at[operand[0]][lane], b = at[operand[second]][lane],                      \
                     c = at[operand[third]][lane];                                                 \
                                                                                                   \
        (void)b;                                                                                   \
        (void)c;                                                                                   \
        at[result][lane] = __VA_ARGS__;                                                            \
    }

AS_WIDE_AS_CAN_BE static void run_one_abreast(const OpcodeRun *run, const uint32_t *operand,
                                              Eight *at)
{
    int result = run->result;
    const int end = result + run->count;

    switch (run->code) {
#define OPCODE(id, operands, adds, muls, functions, ...)                                           \
    case CODE_##id: {                                                                              \
        enum { second = (operands) > 1, third = (operands) > 2 ? 2 : 0 };                          \
                                                                                                   \
        for (; result < end; result++, operand += (operands))                                      \
            ABREAST_##functions(__VA_ARGS__);                                                      \
        break;                                                                                     \
    }
#include "compile/opcodes.def"
#undef OPCODE
    default:
        break;
    }
}

void program_interpret_abreast(const Program *program, Stage from, Stage to, double *slots)
{
    for (int r = program->first_run[from]; r < program->first_run[to + 1]; r++) {
        const OpcodeRun *run = &program->runs.at[r];
        const uint32_t *operand = program->tape.at + run->operands;

        if (run->code == CODE_SINCOS)
            run_sines_abreast(run, operand, slots);
        else if (run->code >= CODE_CALL)
            run_calls_abreast(run, operand, program->tables.at, slots);
        else
            run_one_abreast(run, operand, (Eight *)slots);
    }
    for (int i = program->first_root[from]; i < program->first_root[to + 1]; i++)
        memcpy(slots + (ptrdiff_t)(program->slot_count + program->roots[i].root) * ABREAST,
               slots + (ptrdiff_t)program->roots[i].slot * ABREAST, ABREAST * sizeof(double));
}

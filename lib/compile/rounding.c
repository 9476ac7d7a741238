/* rounding.c: error bounds of the roots of a program
 *
 * Each number has an error bound: the rounding error of its operation, plus the change of the
 * result when the operands change by their bounds. The rounding error of a sum or a product is
 * computed exactly (Knuth 1997, 4.2.2), so that exact results have the bound 0. That of a function
 * is assumed to be one unit in the last place. Conditions are assumed to be decided correctly.
 * Higham (2002), 3.3. */
#include "compile/program_impl.h"

#include "algebra/elementary.h"

#include <math.h>

#define UNIT 0x1p-52

typedef double Operation(int code, const double *args);

/* --- single operations --- */

static double opcode_value(int code, const double *args)
{
    const double a = args[0], b = args[1], c = args[2];

    (void)c;
    switch (code) {
#define OPCODE(id, operands, adds, muls, functions, ...)                                           \
    case CODE_##id:                                                                                \
        return __VA_ARGS__;
#include "compile/opcodes.def"
#undef OPCODE
    default:
        return op_value((Op)(code - CODE_CALL), args);
    }
}

static double sum_rounding(double a, double b)
{
    const double sum = a + b, other = sum - a;

    return fabs((a - (sum - other)) + (b - other));
}

static double product_rounding(double a, double b)
{
    return fabs(fma(a, b, -(a * b)));
}

static double rounding(int code, const double *args, double value)
{
    const double a = args[0], b = args[1], c = args[2];

    switch (code) {
    case CODE_ADD:
        return sum_rounding(a, b);
    case CODE_SUB:
        return sum_rounding(a, -b);
    case CODE_MUL:
        return product_rounding(a, b);
    case CODE_RECIP:
        return fabs(fma(a, value, -1) / a);
    case CODE_MULADD:
        return product_rounding(a, b) + sum_rounding(a * b, c);
    case CODE_MULSUB:
    case CODE_SUBMUL:
        return product_rounding(a, b) + sum_rounding(a * b, -c);
    case CODE_NEG:
    case CODE_SELECT:
    case CODE_CALL + OP_ABS:
    case CODE_CALL + OP_MIN:
    case CODE_CALL + OP_MAX:
    case CODE_CALL + OP_RAMP:
    case CODE_CALL + OP_HOLD:
        return 0;
    default:
        return UNIT * fabs(value);
    }
}

/* its value is one of a few, and jumps */
static bool is_decision(int code)
{
    switch (code - CODE_CALL) {
    case OP_SIGN:
    case OP_STICK:
    case OP_UNILATERAL:
    case OP_STEP:
    case OP_FLOOR:
    case OP_LT:
    case OP_LE:
    case OP_EQ:
    case OP_NE:
    case OP_AND:
    case OP_OR:
    case OP_NOT:
        return true;
    default:
        return false;
    }
}

/* how far the value moves with one operand; where one side has no value, as the other */
static double moves(Operation *operation, int code, double *args, int which, double by,
                    double value)
{
    const double kept = args[which];
    double above, below;

    args[which] = kept + by;
    above = fabs(operation(code, args) - value);
    args[which] = kept - by;
    below = fabs(operation(code, args) - value);
    args[which] = kept;
    return fmax(above, below); /* of a NaN and a number the number */
}

static double error_of(Operation *operation, int code, int operands, const uint32_t *operand,
                       const double *slots, const double *errors, double value)
{
    double args[MOST_OPERANDS] = {0}, sum;

    if (is_decision(code))
        return 0;
    for (int k = 0; k < operands; k++)
        args[k] = slots[operand[k]];
    sum = rounding(code, args, value);
    for (int k = 0; k < operands; k++)
        if (errors[operand[k]] > 0)
            sum += moves(operation, code, args, k, errors[operand[k]], value);
    return sum;
}

/* --- runs --- */

static double sine(int code, const double *args)
{
    return code == CODE_SINCOS ? elementary_sin(args[0]) : elementary_cos(args[0]);
}

static void bound_sines(const OpcodeRun *run, const uint32_t *operand, const double *slots,
                        double *errors)
{
    for (int i = 0; i < 2 * run->count; i++) {
        const int slot = run->result + i;

        errors[slot] = error_of(sine, i % 2 == 0 ? CODE_SINCOS : CODE_COSINE, 1, operand + i / 2,
                                slots, errors, slots[slot]);
    }
}

static void bound_tables(const OpcodeRun *run, const uint32_t *operand, Curve *const *tables,
                         const double *slots, double *errors)
{
    for (int i = 0; i < run->count; i++, operand += 3) {
        const Curve *curve = tables[(int)slots[operand[0]]];
        const double x = slots[operand[1]], by = errors[operand[1]], value = slots[run->result + i];
        const int order = (int)slots[operand[2]];

        errors[run->result + i] =
            UNIT * fabs(value) + fmax(fabs(curve_value(curve, x + by, order) - value),
                                      fabs(curve_value(curve, x - by, order) - value));
    }
}

static void bound_run(const Program *program, const OpcodeRun *run, const double *slots,
                      double *errors)
{
    const uint32_t *operand = program->tape.at + run->operands;
    const int operands = code_operands(run->code);

    if (run->code == CODE_CALL + OP_TABLE)
        bound_tables(run, operand, program->tables.at, slots, errors);
    else if (run->code == CODE_SINCOS)
        bound_sines(run, operand, slots, errors);
    else
        for (int i = 0; i < run->count; i++, operand += operands)
            errors[run->result + i] = error_of(opcode_value, (int)run->code, operands, operand,
                                               slots, errors, slots[run->result + i]);
}

double number_error(double value)
{
    /* a number with few binary digits is assumed to be exact */
    return value * 0x1p20 == rint(value * 0x1p20) && fabs(value) < 0x1p32 ? 0
                                                                          : UNIT / 2 * fabs(value);
}

void program_bound_slots(const Program *program, const double *slots, const double *input_errors,
                         double *errors)
{
    for (int i = 0; i < program->input_count; i++)
        errors[i] = input_errors[i];
    for (int i = 0; i < program->constants.count; i++)
        errors[program->input_count + i] = number_error(program->constants.at[i]);
    for (int r = 0; r < program->first_run[STAGE_COUNT]; r++)
        bound_run(program, &program->runs.at[r], slots, errors);
}

void program_bound(const Program *program, const double *slots, const double *input_errors,
                   double *root_errors)
{
    double *errors = NEW_ARRAY(double, program->slot_count);

    program_bound_slots(program, slots, input_errors, errors);
    for (int i = 0; i < program->root_count; i++)
        root_errors[program->roots[i].root] = errors[program->roots[i].slot];
    mem_free(errors);
}

/* tangents.c: partial derivatives of instructions, and forward propagation of directions
 *
 * An instruction z = f(a, b, c) has z' = f_a a' + f_b b' + f_c c'. Partial derivatives of functions
 * follow from their rules (ops.def), compiled once for each function that occurs. The error bound
 * of a derivative is of the same kind as that of a value (rounding.c), and starts from the bounds
 * of values. */
#include "compile/tangents.h"

#include "algebra/double_double.h"
#include "compile/program_impl.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { LANES = TANGENT_BATCH };

/* the derivatives of a function by its arguments, as a program of these */
typedef struct Rule {
    Program *program;
    Workspace *workspace;
} Rule;

struct Tangents {
    const Program *program;
    Rule rules[CODES];
    int *root;                       /* slots of roots */
    double *slots, *errors;          /* of values */
    double *partial, *partial_error; /* in the order of the tape's operands */
    double *moves, *moves_error;     /* z' of slots, by lanes */
    uint8_t *moved;                  /* slots: lanes in which they change, one bit each */
    bool is_bounded;
};

/* --- rules --- */

static Expr rule_value(Arena *arena, Opcode code, const Expr *args)
{
    switch (code) {
    case CODE_POW:
        return expr_pow(arena, args[0], args[1]);
    case CODE_SQRT:
        return expr_call(arena, OP_SQRT, args);
    case CODE_SIN:
        return expr_call(arena, OP_SIN, args);
    case CODE_COS:
        return expr_call(arena, OP_COS, args);
    default:
        return expr_call(arena, (Op)(code - CODE_CALL), args);
    }
}

static bool has_rule(Opcode code)
{
    return code == CODE_POW || code == CODE_SQRT || code == CODE_SIN || code == CODE_COS ||
           (code >= CODE_CALL && code != CODE_CALL + OP_TABLE);
}

static void make_rule(Rule *rule, Opcode code)
{
    static const char *const names[MOST_OPERANDS] = {"a", "b", "c"};
    const int operands = code_operands(code);
    Arena *arena = arena_new();
    Expr args[MOST_OPERANDS], partial[MOST_OPERANDS], value;
    Status status;

    for (int k = 0; k < MOST_OPERANDS; k++)
        args[k] = expr_symbol(arena, names[k], SYMBOL_PARAMETER);
    value = rule_value(arena, code, args);
    for (int k = 0; k < MOST_OPERANDS; k++)
        partial[k] = expr_diff(arena, value, args[k]);
    status = program_new(partial, operands, args, operands, &rule->program, NULL);
    arena_free(arena);
    if (status == OK)
        rule->workspace = workspace_new(rule->program);
}

/* --- life --- */

Tangents *tangents_new(const Program *program)
{
    const bool was_scratch = mem_scratch(true); /* numbers that each evaluation finds anew */
    Tangents *out = NEW(Tangents);
    const int slots = program->slot_count, operands = program->tape.count;

    out->program = program;
    for (int r = 0; r < program->runs.count; r++) {
        const Opcode code = program->runs.at[r].code;

        if (has_rule(code) && out->rules[code].program == NULL)
            make_rule(&out->rules[code], code);
    }
    out->root = NEW_ARRAY(int, program->root_count);
    for (int i = 0; i < program->root_count; i++)
        out->root[program->roots[i].root] = program->roots[i].slot;
    out->slots = NEW_ARRAY(double, slots);
    out->errors = NEW_ARRAY(double, slots);
    out->partial = NEW_ARRAY(double, operands);
    out->partial_error = NEW_ARRAY(double, operands);
    out->moves = NEW_ARRAY(double, slots *LANES);
    out->moves_error = NEW_ARRAY(double, slots *LANES);
    out->moved = NEW_ARRAY(uint8_t, slots);
    for (int i = 0; i < program->constants.count; i++)
        out->slots[program->input_count + i] = program->constants.at[i];
    (void)mem_scratch(was_scratch);
    return out;
}

void tangents_free(Tangents *tangents)
{
    if (tangents == NULL)
        return;
    for (int code = 0; code < CODES; code++) {
        workspace_free(tangents->rules[code].workspace);
        program_free(tangents->rules[code].program);
    }
    MEM_FREE(tangents->root, tangents->slots, tangents->errors, tangents->partial,
             tangents->partial_error, tangents->moves, tangents->moves_error, tangents->moved,
             tangents);
}

/* --- partial derivatives --- */

/* one operand's */
typedef struct Partial {
    double *at, *error;
} Partial;

static void put(const Partial *partial, int k, double value, double error)
{
    partial->at[k] = value;
    partial->error[k] = error;
}

static void by_rule(Tangents *tangents, Opcode code, const uint32_t *operand, Partial partial)
{
    const Rule *rule = &tangents->rules[code];
    const int operands = code_operands(code);
    double errors[MOST_OPERANDS];

    for (int k = 0; k < operands; k++) {
        workspace_inputs(rule->workspace)[k] = tangents->slots[operand[k]];
        errors[k] = tangents->errors[operand[k]];
    }
    workspace_run(rule->workspace, STAGE_PARAMETER, STAGE_COUNT - 1);
    memcpy(partial.at, workspace_roots(rule->workspace), (size_t)operands * sizeof(double));
    if (tangents->is_bounded)
        workspace_errors(rule->workspace, errors, partial.error);
}

static void by_table(const Tangents *tangents, const uint32_t *operand, Partial partial)
{
    const double *slots = tangents->slots;
    const Curve *curve = tangents->program->tables.at[(int)slots[operand[0]]];
    const double x = slots[operand[1]], by = tangents->errors[operand[1]];
    const int order = (int)slots[operand[2]] + 1;
    const double value = curve_value(curve, x, order);

    put(&partial, 0, 0, 0);
    put(&partial, 1, value,
        DBL_EPSILON * fabs(value) + fmax(fabs(curve_value(curve, x + by, order) - value),
                                         fabs(curve_value(curve, x - by, order) - value)));
    put(&partial, 2, 0, 0);
}

static void find_partials(Tangents *tangents, const OpcodeRun *run, const uint32_t *operand,
                          int result, Partial partial)
{
    const double *slots = tangents->slots, *errors = tangents->errors;
    const double value = slots[result];
    const int a = (int)operand[0];

    switch ((int)run->code) {
    case CODE_ADD:
    case CODE_SUB:
        put(&partial, 0, 1, 0);
        put(&partial, 1, run->code == CODE_ADD ? 1 : -1, 0);
        break;
    case CODE_NEG:
        put(&partial, 0, -1, 0);
        break;
    case CODE_MUL:
    case CODE_MULADD:
    case CODE_MULSUB:
        put(&partial, 0, slots[operand[1]], errors[operand[1]]);
        put(&partial, 1, slots[a], errors[a]);
        if (run->code != CODE_MUL)
            put(&partial, 2, run->code == CODE_MULADD ? 1 : -1, 0);
        break;
    case CODE_SUBMUL:
        put(&partial, 0, -slots[operand[1]], errors[operand[1]]);
        put(&partial, 1, -slots[a], errors[a]);
        put(&partial, 2, 1, 0);
        break;
    case CODE_RECIP:
        put(&partial, 0, -value * value,
            errors[result] * (2 * fabs(value) + errors[result]) +
                fabs(fma(value, value, -(value * value))));
        break;
    case CODE_SELECT:
        put(&partial, 0, 0, 0);
        put(&partial, 1, slots[a] != 0, 0);
        put(&partial, 2, slots[a] == 0, 0);
        break;
    case CODE_CALL + OP_TABLE:
        by_table(tangents, operand, partial);
        break;
    default:
        by_rule(tangents, run->code, operand, partial);
        break;
    }
}

static void find_all_partials(Tangents *tangents)
{
    const Program *program = tangents->program;

    for (int r = 0; r < program->runs.count; r++) {
        const OpcodeRun *run = &program->runs.at[r];
        const int operands = code_operands(run->code);

        if (run->code == CODE_SINCOS)
            continue; /* each is the other's */
        for (int i = 0; i < run->count; i++) {
            const int at = run->operands + i * operands;

            find_partials(tangents, run, program->tape.at + at, run->result + i,
                          (Partial){tangents->partial + at, tangents->partial_error + at});
        }
    }
}

void tangents_at(Tangents *tangents, const double *inputs, const double *errors)
{
    const Program *program = tangents->program;

    memcpy(tangents->slots, inputs, (size_t)program->input_count * sizeof(double));
    program_interpret(program, STAGE_PARAMETER, STAGE_COUNT - 1, tangents->slots);
    tangents->is_bounded = errors != NULL;
    if (errors != NULL)
        program_bound_slots(program, tangents->slots, errors, tangents->errors);
    else
        memset(tangents->errors, 0, (size_t)program->slot_count * sizeof(double));
    find_all_partials(tangents);
    tangents_clear(tangents);
}

double tangents_value(const Tangents *tangents, int root, double *error)
{
    if (error != NULL)
        *error = tangents->errors[tangents->root[root]];
    return tangents->slots[tangents->root[root]];
}

/* --- directions --- */

void tangents_clear(Tangents *tangents)
{
    memset(tangents->moved, 0, (size_t)tangents->program->input_count);
}

void tangents_move(Tangents *tangents, int lane, int input, double by, double error)
{
    double *moves = tangents->moves + (size_t)input * LANES;
    double *errors = tangents->moves_error + (size_t)input * LANES;

    if (tangents->moved[input] == 0) {
        memset(moves, 0, LANES * sizeof(double));
        memset(errors, 0, LANES * sizeof(double));
    }
    tangents->moved[input] |= (uint8_t)(1U << lane);
    moves[lane] = by;
    errors[lane] = error;
}

static inline void add(double partial, double partial_error, double by, double by_error,
                       double *out, double *error)
{
    const DoubleDouble product = dd_product(partial, by);
    const DoubleDouble total = dd_sum(*out, product.high);

    *out = total.high;
    *error += fabs(product.low) + fabs(total.low) + fabs(partial) * by_error +
              partial_error * (fabs(by) + by_error);
}

/* The contribution of an operand to a result. A partial derivative that is certainly 0 contributes
 * nothing, as for the branch that an if doesn't choose. One without bounds contributes only in
 * lanes in which the operand changes. */
static void carry(Tangents *tangents, uint32_t from, double partial, double partial_error,
                  int result)
{
    double *restrict out = tangents->moves + (size_t)result * LANES;
    double *restrict error = tangents->moves_error + (size_t)result * LANES;
    const double *restrict by = tangents->moves + (size_t)from * LANES;
    const double *restrict by_error = tangents->moves_error + (size_t)from * LANES;
    const uint8_t moved = tangents->moved[from];

    if (moved == 0 || (partial == 0 && partial_error == 0))
        return;
    if (tangents->moved[result] == 0) {
        memset(out, 0, LANES * sizeof(double));
        memset(error, 0, LANES * sizeof(double));
    }
    tangents->moved[result] |= moved;
    if (!isfinite(partial + partial_error)) {
        for (int lane = 0; lane < LANES; lane++)
            if ((moved >> lane & 1) != 0)
                add(partial, partial_error, by[lane], by_error[lane], &out[lane], &error[lane]);
    } else if (tangents->is_bounded) {
        for (int lane = 0; lane < LANES; lane++)
            add(partial, partial_error, by[lane], by_error[lane], &out[lane], &error[lane]);
    } else {
        for (int lane = 0; lane < LANES; lane++)
            out[lane] += partial * by[lane];
    }
}

static void carry_sines(Tangents *tangents, const OpcodeRun *run)
{
    const uint32_t *operand = tangents->program->tape.at + run->operands;

    for (int i = 0; i < run->count; i++) {
        const int sine = run->result + 2 * i, cosine = sine + 1;

        tangents->moved[sine] = tangents->moved[cosine] = 0;
        carry(tangents, operand[i], tangents->slots[cosine], tangents->errors[cosine], sine);
        carry(tangents, operand[i], -tangents->slots[sine], tangents->errors[sine], cosine);
    }
}

static void carry_run(Tangents *tangents, const OpcodeRun *run)
{
    const int operands = code_operands(run->code);
    const uint32_t *operand = tangents->program->tape.at + run->operands;
    const double *partial = tangents->partial + run->operands;
    const double *error = tangents->partial_error + run->operands;

    for (int i = 0; i < run->count; i++) {
        tangents->moved[run->result + i] = 0;
        for (int k = 0; k < operands; k++)
            carry(tangents, *operand++, *partial++, *error++, run->result + i);
    }
}

void tangents_run(Tangents *tangents)
{
    const Program *program = tangents->program;

    for (int r = 0; r < program->runs.count; r++)
        if (program->runs.at[r].code == CODE_SINCOS)
            carry_sines(tangents, &program->runs.at[r]);
        else
            carry_run(tangents, &program->runs.at[r]);
}

double tangents_root(const Tangents *tangents, int root, int lane, double *error)
{
    const size_t at = (size_t)tangents->root[root] * LANES + (size_t)lane;
    const bool is_moved = (tangents->moved[tangents->root[root]] >> lane & 1) != 0;

    if (error != NULL)
        *error = is_moved ? tangents->moves_error[at] : 0;
    return is_moved ? tangents->moves[at] : 0;
}

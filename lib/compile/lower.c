/* lower.c: expressions to binary operations
 *
 * Sums and products become binary operations from left to right, integer powers become products, so
 * that each value equals that of expr_evaluate() to the last bit. Signs are propagated (a Signed is
 * a value or its negative) until a subtraction absorbs them: both are exact. Equal operations are
 * one value, whatever expression they come from. */
#include "compile/lower_impl.h"
#include "compile/program.h"

#include <math.h>
#include <string.h>

/* An expression on its way: arguments before `next` are lowered. */
typedef struct LowerLevel {
    Expr e;
    int next;
} LowerLevel;

/* The opcode of a function of ops.def; without a row: CODE_CALL + op. */
static const struct {
    Op op;
    Opcode code;
} own_codes[] = {
    {OP_SQRT, CODE_SQRT}, {OP_SIN, CODE_SIN}, {OP_COS, CODE_COS}, {OP_IF, CODE_SELECT}};

/* a higher whole power is left to pow(), as expr_evaluate() does */
enum { HIGHEST_POWER = 64 };

const uint8_t code_operand_counts[] = {
#define OPCODE(id, count, ...) count,
#include "compile/opcodes.def"
#undef OPCODE
    [CODE_SINCOS] = 1,
    [CODE_CALL] =
#define OP(id, name, count, ...) count,
#include "expr/ops.def"
#undef OP
        [CODE_INPUT] = 0,
    [CODE_CONSTANT] = 0,
    [CODE_COSINE] = 1,
    [CODE_ABSORBED] = 0,
};

double value_constant(const LoweredValue *constant)
{
    double value;

    memcpy(&value, constant->args, sizeof value);
    return value;
}

/* --- values --- */

uint32_t lowering_slot(const Lowering *low, const LoweredValue *wanted)
{
    uint32_t hash = wanted->code * 0x9E3779B1U;
    uint32_t slot;

    transaction_worked(VALUE_WORK);
    for (int i = 0; i < MOST_OPERANDS; i++) {
        hash = (hash ^ wanted->args[i]) * 0x85EBCA6BU;
        hash ^= hash >> 15;
    }
    slot = hash & (low->table_size - 1);
    while (low->table[slot] != 0) {
        const LoweredValue *value = &low->values.at[low->table[slot] - 1];

        if (value->code == wanted->code &&
            memcmp(value->args, wanted->args, sizeof value->args) == 0)
            break;
        slot = (slot + 1) & (low->table_size - 1);
    }
    return slot;
}

/* room for so many values, most likely more */
static uint32_t first_size(int values)
{
    uint32_t size = 256;

    while (size < (uint32_t)values)
        size *= 2;
    return size;
}

static void resize_table(Lowering *low, uint32_t size)
{
    mem_free(low->table);
    low->table = NEW_ARRAY(uint32_t, size);
    low->table_size = size;
    for (int i = 0; i < low->values.count; i++)
        low->table[lowering_slot(low, &low->values.at[i])] = (uint32_t)i + 1;
}

/* the value, found or made */
static uint32_t add_value(Lowering *low, LoweredValue value)
{
    uint32_t slot;

    if ((uint32_t)low->values.count >= low->table_size / 2)
        resize_table(low, 4 * low->table_size);
    slot = lowering_slot(low, &value);
    if (low->table[slot] == 0) {
        LIST_PUSH(low->values, value);
        low->table[slot] = (uint32_t)low->values.count;
    }
    return low->table[slot] - 1;
}

static uint32_t add_operation(Lowering *low, Opcode code, const uint32_t args[MOST_OPERANDS])
{
    LoweredValue value = {.code = (uint8_t)code, .stage = STAGE_PARAMETER};

    for (int i = 0; i < code_operands(code); i++) {
        uint8_t stage = low->values.at[args[i]].stage;

        value.args[i] = args[i];
        if (stage > value.stage)
            value.stage = stage;
    }
    if ((code == CODE_ADD || code == CODE_MUL) && args[0] > args[1]) {
        value.args[0] = args[1];
        value.args[1] = args[0];
    }
    return add_value(low, value);
}

static uint32_t add_unary(Lowering *low, Opcode code, uint32_t a)
{
    return add_operation(low, code, (uint32_t[MOST_OPERANDS]){a});
}

static uint32_t add_binary(Lowering *low, Opcode code, uint32_t a, uint32_t b)
{
    return add_operation(low, code, (uint32_t[MOST_OPERANDS]){a, b});
}

static uint32_t add_constant(Lowering *low, double number)
{
    LoweredValue value = {.code = CODE_CONSTANT, .stage = STAGE_PARAMETER};

    memcpy(value.args, &number, sizeof number);
    return add_value(low, value);
}

/* --- signs --- */

static Signed positive(uint32_t value)
{
    return 2 * value;
}

static Signed negative_if(bool negative, Signed a)
{
    return a ^ (Signed)negative;
}

static bool is_negative(Signed a)
{
    return a & 1;
}

/* the value with its sign carried out */
static uint32_t settle(Lowering *low, Signed a)
{
    uint32_t value = a / 2;

    if (!is_negative(a))
        return value;
    if (low->values.at[value].code == CODE_CONSTANT)
        return add_constant(low, -value_constant(&low->values.at[value]));
    return add_unary(low, CODE_NEG, value);
}

static Signed lower_number(Lowering *low, Expr number)
{
    double value = expr_value(number);

    return negative_if(value < 0, positive(add_constant(low, fabs(value))));
}

/* --- expressions, whose arguments are known --- */

static Signed known(const Lowering *low, Expr e)
{
    return low->known[expr_number(e)] - 1;
}

static Signed lower_sum(Lowering *low, Expr sum)
{
    Signed total = known(low, expr_arg(sum, 0));

    for (int i = 1; i < expr_arg_count(sum); i++) {
        Signed term = known(low, expr_arg(sum, i));
        uint32_t value;

        if (is_negative(total) && !is_negative(term))
            value = add_binary(low, CODE_SUB, term / 2, total / 2);
        else if (is_negative(term))
            value = add_binary(low, CODE_SUB, settle(low, total), term / 2);
        else
            value = add_binary(low, CODE_ADD, total / 2, term / 2);
        total = positive(value);
    }
    return total;
}

static Signed lower_product(Lowering *low, Expr product)
{
    Signed first = known(low, expr_arg(product, 0));
    bool negative = is_negative(first);
    uint32_t value = first / 2;
    int next = 1;

    /* the number -1 is its sign and no factor */
    if (expr_is(expr_arg(product, 0), -1)) {
        first = known(low, expr_arg(product, next++));
        negative = negative != is_negative(first);
        value = first / 2;
    }
    for (; next < expr_arg_count(product); next++) {
        Signed factor = known(low, expr_arg(product, next));

        negative = negative != is_negative(factor);
        value = add_binary(low, CODE_MUL, value, factor / 2);
    }
    return negative_if(negative, positive(value));
}

/* a small whole exponent */
static bool is_whole(Expr exponent, int *k)
{
    int64_t num;
    int64_t den;

    if (!expr_rational_parts(exponent, &num, &den) || den != 1 || num > HIGHEST_POWER ||
        num < -HIGHEST_POWER)
        return false;
    *k = (int)num;
    return true;
}

static Signed lower_power(Lowering *low, Expr power)
{
    Signed base = known(low, expr_arg(power, 0));
    uint32_t value = base / 2;
    int k;

    if (!is_whole(expr_arg(power, 1), &k))
        return positive(add_binary(low, CODE_POW, settle(low, base),
                                   settle(low, known(low, expr_arg(power, 1)))));
    for (int i = 1; i < (k < 0 ? -k : k); i++)
        value = add_binary(low, CODE_MUL, value, base / 2);
    if (k < 0)
        value = add_unary(low, CODE_RECIP, value);
    return negative_if(is_negative(base) && k % 2 != 0, positive(value));
}

static Signed lower_call(Lowering *low, Expr call)
{
    uint32_t args[MOST_OPERANDS] = {0};
    Op op = expr_op(call);
    Opcode code = (Opcode)(CODE_CALL + op);

    if (op == OP_HOLD)
        return known(low, expr_arg(call, 0));
    for (int i = 0; i < COUNT(own_codes); i++) {
        if (own_codes[i].op == op)
            code = own_codes[i].code;
    }
    for (int i = 0; i < expr_arg_count(call); i++)
        args[i] = settle(low, known(low, expr_arg(call, i)));
    return positive(add_operation(low, code, args));
}

static Signed lower_symbol(Lowering *low, Expr symbol)
{
    LoweredValue input = {.code = CODE_INPUT, .args = {(uint32_t)low->symbols.count}};

    if (expr_data(symbol) != NULL) {
        LIST_PUSH(low->tables, expr_data(symbol));
        return positive(add_constant(low, low->tables.count - 1));
    }
    /* a symbol that can't be an input has no value; roots that need it fail */
    if (expr_symbol_kind(symbol) < SYMBOL_VARIABLE)
        input.stage = (uint8_t)stage_of_symbol(expr_symbol_kind(symbol));
    LIST_PUSH(low->symbols, symbol);
    return positive(add_value(low, input));
}

static void lower_node(Lowering *low, Expr e)
{
    Signed value = 0;

    switch (expr_kind(e)) {
    case EXPR_RATIONAL:
    case EXPR_REAL:
        value = lower_number(low, e);
        break;
    case EXPR_SYMBOL:
        value = lower_symbol(low, e);
        break;
    case EXPR_POWER:
        value = lower_power(low, e);
        break;
    case EXPR_CALL:
        value = lower_call(low, e);
        break;
    case EXPR_PRODUCT:
        value = lower_product(low, e);
        break;
    case EXPR_SUM:
        value = lower_sum(low, e);
        break;
    case EXPR_TUPLE: /* in no other expression */
        break;
    }
    low->known[expr_number(e)] = value + 1;
}

/* `root` and what is below it, with a stack of its own: expressions may be deep */
static void lower_below(Lowering *low, Expr root)
{
    LIST(LowerLevel) stack = {0};

    if (low->known[expr_number(root)] != 0)
        return;
    LIST_PUSH(stack, (LowerLevel){root, 0});
    while (stack.count > 0) {
        LowerLevel *level = &stack.at[stack.count - 1];

        if (low->known[expr_number(level->e)] != 0) {
            stack.count--;
        } else if (level->next < expr_arg_count(level->e)) {
            Expr child = expr_arg(level->e, level->next++);

            if (low->known[expr_number(child)] == 0)
                LIST_PUSH(stack, (LowerLevel){child, 0});
        } else {
            lower_node(low, level->e);
        }
    }
    LIST_FREE(stack);
}

/* earlier values remain known */
static void make_known(Lowering *low, uint32_t count)
{
    Signed *known;

    if (count <= low->known_count)
        return;
    known = NEW_ARRAY(Signed, count);
    if (low->known_count > 0)
        memcpy(known, low->known, low->known_count * sizeof *known);
    mem_free(low->known);
    low->known = known;
    low->known_count = count;
}

uint32_t *lowering_add(Lowering *low, const Expr *roots, int count)
{
    uint32_t *values = NEW_ARRAY(uint32_t, count);
    uint32_t highest = 0;

    for (int i = 0; i < count; i++)
        if (expr_number(roots[i]) > highest)
            highest = expr_number(roots[i]);
    make_known(low, highest + 1);
    if (low->table_size == 0)
        resize_table(low, first_size(count));
    for (int i = 0; i < count; i++) {
        lower_below(low, roots[i]);
        values[i] = settle(low, known(low, roots[i]));
    }
    return values;
}

/* lower.c: expressions to binary operations
 *
 * Sums and products become chains from left to right, whole powers become products,
 * so that each value is what expr_evaluate() finds, to the last bit. Signs are carried
 * along (a Signed is a value or its negative) until a subtraction swallows them: both
 * are exact. Equal operations are one value, whatever expression they come from. */
#include "compile/lower.h"
#include "compile/program.h"

#include <math.h>
#include <string.h>

/* a value times two, plus one where its negative is meant */
typedef uint32_t Signed;

/* An expression on its way: arguments before `next` are lowered. */
typedef struct LowerLevel {
    Expr e;
    int next;
} LowerLevel;

typedef struct Lowering {
    Lowered *out;
    Signed *known;       /* by creation number: plus 1; 0 where not lowered */
    uint32_t *table;     /* hash table of values: plus 1; 0 where free */
    uint32_t table_size; /* a power of two */
} Lowering;

/* What a function of ops.def is done by; without a row: CODE_CALL + op. */
static const struct {
    Op op;
    Opcode code;
} own_codes[] = {
    {OP_SQRT, CODE_SQRT}, {OP_SIN, CODE_SIN}, {OP_COS, CODE_COS}, {OP_IF, CODE_SELECT}};

/* a higher whole power is left to pow(), as expr_evaluate() does */
enum { HIGHEST_POWER = 64 };

int code_operands(Opcode code)
{
    static const int operands[] = {
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
    return operands[code];
}

double value_constant(const LoweredValue *constant)
{
    double value;

    memcpy(&value, constant->args, sizeof value);
    return value;
}

/* --- values --- */

static uint32_t slot_of(const Lowering *low, const LoweredValue *wanted)
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
        const LoweredValue *value = &low->out->values.at[low->table[slot] - 1];

        if (value->code == wanted->code &&
            memcmp(value->args, wanted->args, sizeof value->args) == 0)
            break;
        slot = (slot + 1) & (low->table_size - 1);
    }
    return slot;
}

static void resize_table(Lowering *low, uint32_t size)
{
    mem_free(low->table);
    low->table = NEW_ARRAY(uint32_t, size);
    low->table_size = size;
    for (int i = 0; i < low->out->values.count; i++)
        low->table[slot_of(low, &low->out->values.at[i])] = (uint32_t)i + 1;
}

/* the value, found or made */
static uint32_t add_value(Lowering *low, LoweredValue value)
{
    uint32_t slot;

    if ((uint32_t)low->out->values.count >= low->table_size / 2)
        resize_table(low, 4 * low->table_size);
    slot = slot_of(low, &value);
    if (low->table[slot] == 0) {
        LIST_PUSH(low->out->values, value);
        low->table[slot] = (uint32_t)low->out->values.count;
    }
    return low->table[slot] - 1;
}

static uint32_t add_operation(Lowering *low, Opcode code, const uint32_t args[MOST_OPERANDS])
{
    LoweredValue value = {.code = (uint8_t)code, .stage = STAGE_PARAMETER};

    for (int i = 0; i < code_operands(code); i++) {
        uint8_t stage = low->out->values.at[args[i]].stage;

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
    if (low->out->values.at[value].code == CODE_CONSTANT)
        return add_constant(low, -value_constant(&low->out->values.at[value]));
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

static Status lower_node(Lowering *low, Expr e, Diag *diag)
{
    Signed value = 0;

    switch (expr_kind(e)) {
    case EXPR_RATIONAL:
    case EXPR_REAL:
        value = lower_number(low, e);
        break;
    case EXPR_SYMBOL:
        if (expr_data(e) != NULL) {
            value = positive(add_constant(low, low->out->tables.count));
            LIST_PUSH(low->out->tables, expr_data(e));
            break;
        }
        (void)diag_set(diag, E_NAME, "%s has no value here", expr_name(e));
        diag_hint(diag, "it is needed and is none of the inputs");
        return E_NAME;
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
    return OK;
}

/* `root` and what is below it, with a stack of its own: expressions may be deep */
static Status lower_below(Lowering *low, Expr root, Diag *diag)
{
    Status status = OK;
    LIST(LowerLevel) stack = {0};

    if (low->known[expr_number(root)] != 0)
        return OK;
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
            CHECK(lower_node(low, level->e, diag));
        }
    }
done:
    LIST_FREE(stack);
    return status;
}

/* A sine and a cosine of one thing are computed together: the cosine becomes the second result. */
static void pair_sines(Lowering *low)
{
    for (int i = 0; i < low->out->values.count; i++) {
        LoweredValue *value = &low->out->values.at[i];
        LoweredValue wanted = *value;
        uint32_t slot;

        if (value->code != CODE_COS)
            continue;
        wanted.code = CODE_SIN;
        slot = slot_of(low, &wanted);
        if (low->table[slot] == 0)
            continue;
        low->out->values.at[low->table[slot] - 1].code = CODE_SINCOS;
        *value = (LoweredValue){
            .code = CODE_COSINE, .stage = value->stage, .args = {low->table[slot] - 1}};
    }
}

static uint32_t highest_number(const Expr *roots, int count, uint32_t highest)
{
    for (int i = 0; i < count; i++) {
        if (expr_number(roots[i]) > highest)
            highest = expr_number(roots[i]);
    }
    return highest;
}

Status lowered_make(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                    Lowered *out, Diag *diag)
{
    Status status = OK;
    uint32_t highest = highest_number(inputs, input_count, highest_number(roots, root_count, 0));
    Lowering low = {.out = out};

    *out = (Lowered){.input_count = input_count, .root_count = root_count};
    out->roots = NEW_ARRAY(uint32_t, root_count);
    low.known = NEW_ARRAY(Signed, (size_t)highest + 1);
    resize_table(&low, 256);

    for (int i = 0; i < input_count; i++) {
        uint8_t stage = (uint8_t)stage_of_symbol(expr_symbol_kind(inputs[i]));
        LoweredValue input = {.code = CODE_INPUT, .stage = stage, .args = {(uint32_t)i}};

        low.known[expr_number(inputs[i])] = positive(add_value(&low, input)) + 1;
    }
    for (int i = 0; i < root_count; i++) {
        CHECK(lower_below(&low, roots[i], diag));
        out->roots[i] = settle(&low, known(&low, roots[i]));
    }
    pair_sines(&low);
done:
    MEM_FREE(low.known, low.table);
    if (status != OK)
        lowered_free(out);
    return status;
}

void lowered_free(Lowered *lowered)
{
    LIST_FREE(lowered->values);
    LIST_FREE(lowered->tables);
    mem_free(lowered->roots);
    *lowered = (Lowered){.input_count = 0};
}

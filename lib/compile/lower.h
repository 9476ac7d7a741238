/* lower.h: expressions as a list of binary operations
 *
 * Programs are scheduled, and code for other programs is written, from this list: each value once,
 * operands before users. So both compute the same. */
#ifndef COTREE_COMPILE_LOWER_H
#define COTREE_COMPILE_LOWER_H

#include "base/memory.h"
#include "expr/expr.h"

enum { MOST_OPERANDS = 3 };
enum { VALUE_WORK = 128 }; /* of a value or an instruction, for transaction_worked() */

typedef enum Opcode {
#define OPCODE(id, ...) CODE_##id,
#include "compile/opcodes.def"
#undef OPCODE
    CODE_SINCOS, /* two consecutive results */
    CODE_CALL,   /* followed by the functions of ops.def */
    CODES = CODE_CALL + OP_COUNT,
    CODE_INPUT,    /* the following are values without an instruction; args[0]: which */
    CODE_CONSTANT, /* args[0], args[1]: the bits of the double */
    CODE_COSINE,   /* the second result of the SINCOS args[0] */
    CODE_ABSORBED  /* a product that became part of an instruction */
} Opcode;

typedef struct LoweredValue {
    uint8_t code;
    uint8_t stage;
    uint32_t args[MOST_OPERANDS]; /* numbers of values; unused ones 0 */
} LoweredValue;

typedef struct Lowered {
    LIST(LoweredValue) values;  /* inputs first */
    LIST(const Curve *) tables; /* borrowed; the value of data is its index here */
    Expr *inputs;               /* the caller's, then the parameters that were found */
    int input_count;
    uint32_t *roots; /* values */
    int root_count;
} Lowered;

extern const uint8_t code_operand_counts[];
static inline int code_operands(Opcode code)
{
    return code_operand_counts[code];
}
double value_constant(const LoweredValue *constant);
/* Fails as program_new() does. O(nodes) */
MUST_USE Status lowered_make(const Expr *roots, int root_count, const Expr *inputs, int input_count,
                             Lowered *out, Diag *diag);
/* The same; parameters that aren't among the inputs are appended to these, in the order in which
 * their symbols were made. The arena stores the last large lowering, and parts of it that occur in
 * these roots aren't lowered again: O(new nodes + operations). */
MUST_USE Status lowered_make_again(Arena *arena, const Expr *roots, int root_count,
                                   const Expr *inputs, int input_count, Lowered *out, Diag *diag);
void lowered_free(Lowered *lowered);

#endif

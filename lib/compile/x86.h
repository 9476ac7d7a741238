/* x86.h: instructions of x86-64 on doubles, as bytes
 *
 * Registers 0 to 15 are xmm, ymm or zmm as the width has it, up to 31 with AVX-512. A memory
 * operand is an offset in bytes from one of two bases. Forms and opcodes: Intel (2023), volume
 * 2. */
#ifndef COTREE_COMPILE_X86_H
#define COTREE_COMPILE_X86_H

#include "base/memory.h"

typedef enum Isa { ISA_SSE2, ISA_AVX2, ISA_AVX512 } Isa;

typedef struct X86Code {
    LIST(uint8_t) bytes;
    Isa isa;
    int width;    /* doubles in a register that count */
    bool is_leaf; /* calls nothing: bases may be in registers that a call would destroy */
} X86Code;

typedef enum X86Base { BASE_SLOTS, BASE_FRAME } X86Base;

/* a register, or memory */
typedef struct X86Operand {
    int reg; /* -1: memory */
    X86Base base;
    int64_t offset; /* bytes */
} X86Operand;

typedef enum X86Op {
    X86_ADD,
    X86_SUB,
    X86_MUL,
    X86_DIV,
    X86_MIN, /* second where they are equal or one is NaN, as MAX */
    X86_MAX,
    X86_SQRT, /* of the second; the first only fills what doesn't count */
    X86_XOR,  /* 16 bytes at least are read of memory; so of the following */
    X86_AND,
    X86_ANDNOT, /* not first, and second */
    X86_OR
} X86Op;
/* to = first op second; without AVX `to` is `first` */
void x86_binary(X86Code *code, X86Op op, int to, int first, X86Operand second);

/* to = to * third + second, second * to + third, second * third + to: its digits, as Intel has them
 */
typedef enum X86Tie { TIE_132, TIE_213, TIE_231 } X86Tie;
typedef enum X86Fused { FUSED_ADD, FUSED_SUB, FUSED_NEGATED /* - product + addend */ } X86Fused;
void x86_fused(X86Code *code, X86Fused kind, X86Tie tie, int to, int second, X86Operand third);

typedef enum X86Compare {
    IS_EQUAL = 0,
    IS_LESS = 1,
    IS_LESS_EQUAL = 2,
    IS_NOT_EQUAL = 4
} X86Compare;
/* all bits of `to`, or none; without AVX `to` is `first`. Not with AVX-512: there it is stored as
 * the mask that x86_choose() and x86_masked() read. */
void x86_compare(X86Code *code, X86Compare how, int to, int first, X86Operand second);
/* to = mask ? yes : no, with AVX and AVX-512 */
void x86_choose(X86Code *code, int to, int mask, int yes, int no);
/* to = mask ? memory : 0, with AVX-512 */
void x86_masked(X86Code *code, int to, X86Operand memory);

void x86_load(X86Code *code, int to, X86Operand memory);
void x86_store(X86Code *code, X86Operand memory, int from);
void x86_copy(X86Code *code, int to, int from);

/* a function void (double *slots, double *frame) */
void x86_enter(X86Code *code);
void x86_leave(X86Code *code);
/* Arguments of a call, by number from 0: an address, or a number. */
void x86_argument_address(X86Code *code, int argument, X86Operand memory);
void x86_argument(X86Code *code, int argument, uint64_t value);
void x86_call(X86Code *code, uint64_t function);

#endif

/* x86.c: instructions of x86-64 on doubles, as bytes */
#include "compile/x86.h"

#include <string.h>

/* Bases point here into their memory, so that more of it is within a byte's reach. */
enum { BIAS = 128 };

/* encoding of an instruction */
typedef struct Form {
    uint8_t opcode;
    uint8_t map;    /* 1: 0F, 2: 0F 38, 3: 0F 3A */
    uint8_t prefix; /* as VEX has it: 1: 66, 3: F2 */
    bool wide;      /* VEX.W; always with EVEX */
    int length;     /* bytes of memory that are read or written */
    int mask;       /* of EVEX; 0: all */
    bool zero;      /* masked-out elements are 0 */
} Form;

enum { PREFIX_66 = 1, PREFIX_F2 = 3 };

static void byte(X86Code *code, unsigned value)
{
    LIST_PUSH(code->bytes, (uint8_t)value);
}

static void number(X86Code *code, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        byte(code, (unsigned)(value >> 8 * i & 0xFF));
}

/* number of the register that contains a base: rbx and rbp, or the arguments rdi and rsi */
static unsigned base_register(const X86Code *code, X86Base base)
{
    static const unsigned kept[] = {3, 5}, arguments[] = {7, 6};

    return code->is_leaf ? arguments[base] : kept[base];
}

/* the ModRM byte for both operands, and the displacement; EVEX scales a byte displacement by the
 * vector length */
static void put_operands(X86Code *code, int reg, X86Operand rm, int scale)
{
    const unsigned middle = ((unsigned)reg & 7) << 3;
    const int64_t far = rm.offset - BIAS;

    if (rm.reg >= 0) {
        byte(code, 0xC0 | middle | ((unsigned)rm.reg & 7));
        return;
    }
    if (far % scale == 0 && far / scale >= -128 && far / scale < 128) {
        byte(code, 0x40 | middle | base_register(code, rm.base));
        byte(code, (unsigned)(far / scale) & 0xFF);
    } else {
        byte(code, 0x80 | middle | base_register(code, rm.base));
        number(code, (uint64_t)far, 4);
    }
}

static unsigned length_bits(const X86Code *code)
{
    return code->width == 8 ? 2 : code->width == 4 ? 1 : 0;
}

static void put_sse(X86Code *code, const Form *form, int reg, X86Operand rm)
{
    const unsigned high = (reg >= 8 ? 4U : 0U) | (rm.reg >= 8 ? 1U : 0U);

    byte(code, form->prefix == PREFIX_F2 ? 0xF2 : 0x66);
    if (high != 0)
        byte(code, 0x40 | high);
    byte(code, 0x0F);
    byte(code, form->opcode);
    put_operands(code, reg, rm, 1);
}

static void put_vex(X86Code *code, const Form *form, int reg, int second, X86Operand rm)
{
    const unsigned R = reg >= 8 ? 0 : 0x80, B = rm.reg >= 8 ? 0 : 0x20;
    const unsigned tail = (~(unsigned)second & 0xF) << 3 | length_bits(code) << 2 | form->prefix;

    if (form->map == 1 && !form->wide && B != 0) {
        byte(code, 0xC5);
        byte(code, R | tail);
    } else {
        byte(code, 0xC4);
        byte(code, R | 0x40 | B | form->map);
        byte(code, (form->wide ? 0x80U : 0U) | tail);
    }
    byte(code, form->opcode);
    put_operands(code, reg, rm, 1);
}

static void put_evex(X86Code *code, const Form *form, int reg, int second, X86Operand rm)
{
    const unsigned r = (unsigned)reg, v = (unsigned)second, b = rm.reg < 0 ? 0 : (unsigned)rm.reg;

    byte(code, 0x62);
    byte(code, (~r & 8) << 4 | (~b & 16) << 2 | (~b & 8) << 2 | (~r & 16) | form->map);
    byte(code, 0x80U | (~v & 0xF) << 3 | 4U | form->prefix);
    byte(code, (form->zero ? 0x80U : 0U) | length_bits(code) << 5 | (~v & 16) >> 1 |
                   (unsigned)form->mask);
    byte(code, form->opcode);
    put_operands(code, reg, rm, form->length);
}

/* second 0 where there is none */
static void put(X86Code *code, const Form *form, int reg, int second, X86Operand rm)
{
    if (code->isa == ISA_SSE2)
        put_sse(code, form, reg, rm);
    else if (code->width == 8 || form->mask != 0 || reg >= 16 || second >= 16 || rm.reg >= 16)
        put_evex(code, form, reg, second, rm);
    else
        put_vex(code, form, reg, second, rm);
}

static X86Operand in_register(int reg)
{
    return (X86Operand){.reg = reg};
}

/* of one double, or of all */
static Form arithmetic(const X86Code *code, uint8_t opcode)
{
    return (Form){.opcode = opcode,
                  .map = 1,
                  .prefix = code->width == 1 ? PREFIX_F2 : PREFIX_66,
                  .length = 8 * code->width};
}

/* of all bits, 128 at least */
static Form logic(const X86Code *code, uint8_t opcode)
{
    return (Form){.opcode = opcode,
                  .map = 1,
                  .prefix = PREFIX_66,
                  .length = code->width == 1 ? 16 : 8 * code->width};
}

void x86_binary(X86Code *code, X86Op op, int to, int first, X86Operand second)
{
    static const uint8_t opcodes[] = {
        [X86_ADD] = 0x58, [X86_SUB] = 0x5C,    [X86_MUL] = 0x59,  [X86_DIV] = 0x5E,
        [X86_MIN] = 0x5D, [X86_MAX] = 0x5F,    [X86_SQRT] = 0x51, [X86_XOR] = 0x57,
        [X86_AND] = 0x54, [X86_ANDNOT] = 0x55, [X86_OR] = 0x56,
    };
    const Form form = op >= X86_XOR ? logic(code, opcodes[op]) : arithmetic(code, opcodes[op]);

    /* a packed root has no other operand */
    put(code, &form, to, op == X86_SQRT && code->width > 1 ? 0 : first, second);
}

void x86_fused(X86Code *code, X86Fused kind, X86Tie tie, int to, int second, X86Operand third)
{
    static const uint8_t kinds[] = {[FUSED_ADD] = 8, [FUSED_SUB] = 10, [FUSED_NEGATED] = 12};
    static const uint8_t ties[] = {[TIE_132] = 0x90, [TIE_213] = 0xA0, [TIE_231] = 0xB0};
    const Form form = {.opcode = (uint8_t)(ties[tie] | kinds[kind] | (code->width == 1)),
                       .map = 2,
                       .prefix = PREFIX_66,
                       .wide = true,
                       .length = 8 * code->width};

    put(code, &form, to, second, third);
}

void x86_compare(X86Code *code, X86Compare how, int to, int first, X86Operand second)
{
    Form form = arithmetic(code, 0xC2);

    if (code->isa == ISA_AVX512)
        put_evex(code, &form, 1, first, second); /* to mask 1 */
    else
        put(code, &form, to, first, second);
    byte(code, how);
}

void x86_choose(X86Code *code, int to, int mask, int yes, int no)
{
    const Form masked = {.opcode = 0x65, .map = 2, .prefix = PREFIX_66, .length = 16, .mask = 1};
    const Form blend = {.opcode = 0x4B, .map = 3, .prefix = PREFIX_66, .length = 16};

    if (code->isa == ISA_AVX512) {
        put(code, &masked, to, no, in_register(yes));
        return;
    }
    put(code, &blend, to, no, in_register(yes));
    byte(code, (unsigned)mask << 4);
}

void x86_masked(X86Code *code, int to, X86Operand memory)
{
    Form form = arithmetic(code, 0x10);

    form.mask = 1;
    form.zero = true;
    put(code, &form, to, 0, memory);
}

void x86_load(X86Code *code, int to, X86Operand memory)
{
    const Form form = arithmetic(code, 0x10);

    put(code, &form, to, 0, memory);
}

void x86_store(X86Code *code, X86Operand memory, int from)
{
    const Form form = arithmetic(code, 0x11);

    put(code, &form, from, 0, memory);
}

void x86_copy(X86Code *code, int to, int from)
{
    const Form form = logic(code, 0x28);

    put(code, &form, to, 0, in_register(from));
}

/* --- around them --- */

static void bytes(X86Code *code, const char *text, int count)
{
    for (int i = 0; i < count; i++)
        byte(code, (uint8_t)text[i]);
}
#define BYTES(code, text) bytes(code, text, (int)sizeof(text) - 1)

void x86_enter(X86Code *code)
{
    if (code->is_leaf) {
        BYTES(code, "\x48\x83\xEF\x80"); /* sub rdi, -128 */
        BYTES(code, "\x48\x83\xEE\x80"); /* sub rsi, -128 */
        return;
    }
    BYTES(code, "\x53\x55");         /* push rbx; push rbp */
    BYTES(code, "\x48\x83\xEC\x08"); /* sub rsp, 8 */
    BYTES(code, "\x48\x8D\x9F");     /* lea rbx, [rdi + bias] */
    number(code, BIAS, 4);
    BYTES(code, "\x48\x8D\xAE"); /* lea rbp, [rsi + bias] */
    number(code, BIAS, 4);
}

/* upper parts of registers are left clean for code without AVX */
static void clean(X86Code *code)
{
    if (code->width >= 4)
        BYTES(code, "\xC5\xF8\x77"); /* vzeroupper */
}

void x86_leave(X86Code *code)
{
    clean(code);
    if (!code->is_leaf) {
        BYTES(code, "\x48\x83\xC4\x08"); /* add rsp, 8 */
        BYTES(code, "\x5D\x5B");         /* pop rbp; pop rbx */
    }
    BYTES(code, "\xC3"); /* ret */
}

/* rdi, rsi, rdx, rcx, r8, r9 */
static const unsigned argument_registers[] = {7, 6, 2, 1, 8, 9};

void x86_argument_address(X86Code *code, int argument, X86Operand memory)
{
    const unsigned reg = argument_registers[argument];

    byte(code, reg >= 8 ? 0x4C : 0x48); /* lea */
    byte(code, 0x8D);
    put_operands(code, (int)reg, memory, 1);
}

void x86_argument(X86Code *code, int argument, uint64_t value)
{
    const unsigned reg = argument_registers[argument];

    byte(code, reg >= 8 ? 0x49 : 0x48); /* mov */
    byte(code, 0xB8 | (reg & 7));
    number(code, value, 8);
}

void x86_call(X86Code *code, uint64_t function)
{
    clean(code);
    BYTES(code, "\x48\xB8"); /* mov rax, function */
    number(code, function, 8);
    BYTES(code, "\xFF\xD0"); /* call rax */
}

/* native_registers.c: registers for the steps of a stage, and their bytes
 *
 * One pass. When no register is free, the value whose next use is farthest is evicted (Belady
 * 1966). A value that is in memory anyway counts as twice as far, because it needs no store. An
 * operand in memory is read by the instruction itself, unless it is used again soon. */
#include "compile/native_impl.h"

#ifdef __x86_64__

#include "algebra/elementary.h"

#include <assert.h>
#include <math.h>

enum {
    REGISTERS = 32,
    SOON = 24 /* steps; 0 and 1000 were measured slower */
};
#define NEVER INT32_MAX

typedef struct Registers {
    X86Code *code;
    const SectionSteps *steps;
    int count, width;
    bool has_fused;
    bool has_three; /* three operands: the result need not overwrite the first */
    int32_t now;

    int64_t value[REGISTERS]; /* -1: free */
    bool is_pinned[REGISTERS];
    int8_t *reg; /* of each value; -1: none */
    Home *home;

    /* uses of each value: steps, from first_use on; the next one */
    int32_t *use;
    uint32_t *first_use, *next_use;

    LIST(Home) free_homes;
    uint32_t frame;
} Registers;

X86Operand home_operand(int width, Home place)
{
    const int64_t fixed = 8 * (width < 2 ? 2 : width), own = 8 * width;

    if (place >= FIXED)
        return (X86Operand){-1, BASE_FRAME, fixed * (place - FIXED)};
    if (place >= FRAME)
        return (X86Operand){-1, BASE_FRAME, fixed * FIXED_COUNT + own * (place - FRAME)};
    return (X86Operand){-1, BASE_SLOTS, own * place};
}

/* --- uses --- */

static void find_uses(Registers *r)
{
    const uint32_t values = r->steps->value_count;

    r->first_use = NEW_ARRAY(uint32_t, (size_t)values + 1);
    r->next_use = NEW_ARRAY(uint32_t, values);
    for (int i = 0; i < r->steps->steps.count; i++)
        for (int k = 0; k < r->steps->steps.at[i].operands; k++)
            r->first_use[r->steps->steps.at[i].args[k] + 1]++;
    for (uint32_t v = 0; v < values; v++) {
        r->first_use[v + 1] += r->first_use[v];
        r->next_use[v] = r->first_use[v];
    }
    r->use = NEW_ARRAY(int32_t, r->first_use[values]);
    for (int i = 0; i < r->steps->steps.count; i++)
        for (int k = 0; k < r->steps->steps.at[i].operands; k++)
            r->use[r->next_use[r->steps->steps.at[i].args[k]]++] = i;
    for (uint32_t v = 0; v < values; v++)
        r->next_use[v] = r->first_use[v];
}

/* step of the next use after this one */
static int32_t next_use(const Registers *r, uint32_t value)
{
    return r->next_use[value] < r->first_use[value + 1] ? r->use[r->next_use[value]] : NEVER;
}

static bool is_dead(const Registers *r, uint32_t value)
{
    return next_use(r, value) == NEVER;
}

/* --- registers --- */

static X86Operand at_home(const Registers *r, uint32_t value)
{
    assert(r->home[value] != NO_HOME);
    return home_operand(r->width, r->home[value]);
}

static void release(Registers *r, int reg)
{
    if (r->value[reg] >= 0)
        r->reg[r->value[reg]] = -1;
    r->value[reg] = -1;
}

static void bind(Registers *r, int reg, uint32_t value)
{
    release(r, reg);
    r->value[reg] = value;
    r->reg[value] = (int8_t)reg;
}

static Home spill_home(Registers *r)
{
    return r->free_homes.count > 0 ? r->free_homes.at[--r->free_homes.count] : FRAME | r->frame++;
}

static void spill(Registers *r, uint32_t value)
{
    if (r->home[value] != NO_HOME || is_dead(r, value))
        return;
    r->home[value] = spill_home(r);
    x86_store(r->code, at_home(r, value), r->reg[value]);
}

/* a register for something new; it is pinned */
static int take(Registers *r)
{
    int best = -1;
    double farthest = -1;

    for (int i = 0; i < r->count; i++) {
        double distance;

        if (r->is_pinned[i])
            continue;
        if (r->value[i] < 0) {
            best = i;
            break;
        }
        distance = (double)next_use(r, (uint32_t)r->value[i]) - r->now;
        if (r->home[r->value[i]] != NO_HOME)
            distance *= 2;
        if (distance > farthest) {
            farthest = distance;
            best = i;
        }
    }
    assert(best >= 0);
    if (r->value[best] >= 0)
        spill(r, (uint32_t)r->value[best]);
    release(r, best);
    r->is_pinned[best] = true;
    return best;
}

/* a register that contains the value */
static int bring(Registers *r, uint32_t value)
{
    int reg = r->reg[value];

    if (reg < 0) {
        const X86Operand memory = at_home(r, value);

        reg = take(r);
        x86_load(r->code, reg, memory);
        bind(r, reg, value);
    }
    r->is_pinned[reg] = true;
    return reg;
}

/* the value where it is, or in a register if it is used again soon */
static X86Operand operand(Registers *r, uint32_t value)
{
    if (r->reg[value] < 0 && next_use(r, value) > r->now + SOON)
        return at_home(r, value);
    return (X86Operand){.reg = bring(r, value)};
}

static bool dies_in_register(const Registers *r, uint32_t value)
{
    return r->reg[value] >= 0 && is_dead(r, value);
}

/* registers of operands that are no longer needed are freed before the result gets one */
static void let_go(Registers *r, const NativeStep *step)
{
    for (int k = 0; k < step->operands; k++)
        if (dies_in_register(r, step->args[k])) {
            r->is_pinned[r->reg[step->args[k]]] = false;
            release(r, r->reg[step->args[k]]);
        }
}

/* --- steps --- */

static X86Operand in_register(int reg)
{
    return (X86Operand){.reg = reg};
}

/* The register of the result; it contains the first operand if two-operand instructions require
 * that. */
static int result_of_first(Registers *r, const NativeStep *step, int first)
{
    int to;

    if (r->has_three) {
        let_go(r, step);
        return take(r);
    }
    if (dies_in_register(r, step->args[0])) {
        release(r, first);
        return first;
    }
    to = take(r);
    x86_copy(r->code, to, first);
    return to;
}

static bool commutes(int code)
{
    return code == STEP_ADD || code == STEP_MUL;
}

static int emit_binary(Registers *r, NativeStep *step)
{
    uint32_t *args = step->args;
    X86Operand second;
    int first, to;

    if (commutes(step->code) && r->reg[args[1]] >= 0 &&
        (r->reg[args[0]] < 0 || (!r->has_three && !is_dead(r, args[0]) && is_dead(r, args[1])))) {
        const uint32_t kept = args[0];

        args[0] = args[1];
        args[1] = kept;
    }
    first = bring(r, args[0]);
    second = operand(r, args[1]);
    to = result_of_first(r, step, first);
    x86_binary(r->code, (X86Op)step->code, to, first, second);
    return to;
}

static int emit_root(Registers *r, const NativeStep *step)
{
    const X86Operand of = operand(r, step->args[0]);
    int to;

    let_go(r, step);
    to = take(r);
    x86_binary(r->code, X86_SQRT, to, of.reg >= 0 ? of.reg : to, of);
    return to;
}

static int emit_compare(Registers *r, const NativeStep *step)
{
    const X86Compare how = (X86Compare)(step->code - STEP_COMPARE);
    const X86Operand one = home_operand(r->width, FIXED | FIXED_ONE);
    const int first = bring(r, step->args[0]);
    const X86Operand second = operand(r, step->args[1]);
    const int to = result_of_first(r, step, first);

    x86_compare(r->code, how, to, first, second);
    if (r->code->isa == ISA_AVX512)
        x86_masked(r->code, to, one);
    else
        x86_binary(r->code, X86_AND, to, to, one);
    return to;
}

static int emit_select(Registers *r, const NativeStep *step)
{
    const X86Operand zero = home_operand(r->width, FIXED | FIXED_ZERO);
    const int condition = bring(r, step->args[0]), yes = bring(r, step->args[1]),
              no = bring(r, step->args[2]), to = take(r);

    if (r->has_three) {
        x86_compare(r->code, IS_NOT_EQUAL, to, condition, zero);
        x86_choose(r->code, to, to, yes, no);
    } else {
        const int other = take(r);

        x86_copy(r->code, to, condition);
        x86_compare(r->code, IS_NOT_EQUAL, to, to, zero);
        x86_copy(r->code, other, to);
        x86_binary(r->code, X86_AND, to, to, in_register(yes));
        x86_binary(r->code, X86_ANDNOT, other, other, in_register(no));
        x86_binary(r->code, X86_OR, to, to, in_register(other));
        r->is_pinned[other] = false;
    }
    let_go(r, step);
    return to;
}

/* to = first * second + to, and the like; either factor in a register */
static int fused_onto_addend(Registers *r, const NativeStep *step, X86Fused kind, int to)
{
    uint32_t a = step->args[0], b = step->args[1];
    int first;
    X86Operand second;

    if (r->reg[a] < 0) {
        a = step->args[1];
        b = step->args[0];
    }
    first = bring(r, a);
    second = operand(r, b);
    x86_fused(r->code, kind, TIE_231, to, first, second);
    return to;
}

/* multiply `to`, which contains a factor, by the other one and add the addend; one of these is in a
 * register */
static int fused_onto_factor(Registers *r, const NativeStep *step, X86Fused kind, uint32_t factor,
                             int to)
{
    const uint32_t addend = step->args[2];

    if (r->reg[factor] < 0 && r->reg[addend] >= 0) {
        const int second = bring(r, addend);

        x86_fused(r->code, kind, TIE_132, to, second, operand(r, factor));
    } else {
        const int second = bring(r, factor);

        x86_fused(r->code, kind, TIE_213, to, second, operand(r, addend));
    }
    return to;
}

/* The result gets the register of an operand that isn't used again; else an operand that has to be
 * loaded is loaded there; else one is copied. */
static int emit_fused(Registers *r, const NativeStep *step)
{
    const X86Fused kind = (X86Fused)(step->code - STEP_MULADD);
    const uint32_t a = step->args[0], b = step->args[1], c = step->args[2];
    const bool is_square = a == b;
    int to;

    if (dies_in_register(r, c) && c != a && c != b)
        return fused_onto_addend(r, step, kind, bring(r, c));
    if (dies_in_register(r, a) && !is_square && a != c)
        return fused_onto_factor(r, step, kind, b, bring(r, a));
    if (dies_in_register(r, b) && !is_square && b != c)
        return fused_onto_factor(r, step, kind, a, bring(r, b));
    if (r->reg[c] >= 0)
        (void)bring(r, c);
    if (r->reg[c] < 0 || is_square || (r->reg[a] >= 0 && r->reg[b] >= 0)) {
        to = take(r);
        if (r->reg[c] >= 0)
            x86_copy(r->code, to, r->reg[c]);
        else
            x86_load(r->code, to, at_home(r, c));
        return fused_onto_addend(r, step, kind, to);
    }
    to = take(r);
    if (r->reg[a] < 0) {
        x86_load(r->code, to, at_home(r, a));
        return fused_onto_factor(r, step, kind, b, to);
    }
    x86_load(r->code, to, at_home(r, b));
    return fused_onto_factor(r, step, kind, a, to);
}

static void emit_store(Registers *r, const NativeStep *step)
{
    const int from = bring(r, step->args[0]);

    x86_store(r->code, home_operand(r->width, step->result), from);
    if (r->home[step->args[0]] == NO_HOME)
        r->home[step->args[0]] = step->result;
}

/* --- functions --- */

/* called by native code for a function without an array version */
static void native_function(const double *arguments, double *results, int count, int code,
                            Curve *const *tables, int width)
{
    const int operands = code_operands((Opcode)code);

    for (int i = 0; i < count; i++)
        for (int lane = 0; lane < width; lane++) {
            double args[MOST_OPERANDS] = {0};

            for (int k = 0; k < operands; k++)
                args[k] = arguments[(i * operands + k) * width + lane];
            results[i * width + lane] =
                code == CODE_CALL + OP_TABLE
                    ? curve_value(tables[(int)args[0]], args[1], (int)args[2])
                : code == CODE_POW ? pow(args[0], args[1])
                                   : op_value((Op)(code - CODE_CALL), args);
        }
}

static void emit_call(Registers *r, const NativeStep *step, const Program *program)
{
    const StepCall *call = &r->steps->calls.at[step->result];
    const int results = call->code == CODE_SINCOS ? 2 : 1;
    const uint64_t numbers = (uint64_t)call->count * (uint64_t)r->width;
    X86Code *code = r->code;
    int next = 2;

    for (int i = 0; i < r->count; i++)
        if (r->value[i] >= 0) {
            spill(r, (uint32_t)r->value[i]);
            release(r, i);
        }
    x86_argument_address(code, 0, home_operand(r->width, call->arguments));
    x86_argument_address(code, 1, home_operand(r->width, call->results));
    if (call->code == CODE_SINCOS)
        x86_argument_address(code, next++,
                             home_operand(r->width, call->results + (uint32_t)call->count));
    if (call->code == CODE_SINCOS || call->code == CODE_CALL + OP_EXP ||
        call->code == CODE_CALL + OP_LOG) {
        x86_argument(code, next, numbers);
        x86_call(code, call->code == CODE_SINCOS && r->has_fused
                           ? (uint64_t)&elementary_sincos_fused_all
                       : call->code == CODE_SINCOS        ? (uint64_t)&elementary_sincos_all
                       : call->code == CODE_CALL + OP_EXP ? (uint64_t)&elementary_exp_all
                                                          : (uint64_t)&elementary_log_all);
    } else {
        x86_argument(code, 2, (uint64_t)call->count);
        x86_argument(code, 3, (uint64_t)call->code);
        x86_argument(code, 4, (uint64_t)program->tables.at);
        x86_argument(code, 5, (uint64_t)r->width);
        x86_call(code, (uint64_t)&native_function);
    }
    for (int i = 0; i < call->count * results; i++) {
        const uint32_t value = r->steps->results.at[call->first_result + i];

        if (value != NO_HOME)
            r->home[value] = call->results + (uint32_t)i;
    }
}

static void emit_step(Registers *r, NativeStep step, const Program *program)
{
    int to;

    for (int i = 0; i < r->count; i++)
        r->is_pinned[i] = false;
    for (int k = 0; k < step.operands; k++) {
        r->next_use[step.args[k]]++;
        if (r->reg[step.args[k]] >= 0)
            r->is_pinned[r->reg[step.args[k]]] = true;
    }
    switch ((StepCode)step.code) {
    case STEP_STORE:
        emit_store(r, &step);
        return;
    case STEP_CALL:
        emit_call(r, &step, program);
        return;
    case STEP_SQRT:
        to = emit_root(r, &step);
        break;
    case STEP_MULADD:
    case STEP_MULSUB:
    case STEP_SUBMUL:
        to = emit_fused(r, &step);
        break;
    case STEP_SELECT:
        to = emit_select(r, &step);
        break;
    default:
        to = step.code >= STEP_COMPARE ? emit_compare(r, &step) : emit_binary(r, &step);
        break;
    }
    bind(r, to, step.result);
}

/* values not used again free their registers and places in the frame */
static void forget(Registers *r, const NativeStep *step)
{
    const Home first_spill = FRAME | r->steps->frame;

    for (int k = 0; k < step->operands; k++) {
        const uint32_t value = step->args[k];

        if (!is_dead(r, value))
            continue;
        if (r->reg[value] >= 0)
            release(r, r->reg[value]);
        if (r->home[value] >= first_spill && r->home[value] < FIXED) {
            LIST_PUSH(r->free_homes, r->home[value]);
            r->home[value] = NO_HOME;
        }
    }
}

uint32_t native_emit(X86Code *code, const NativeTarget *target, const Program *program,
                     const SectionSteps *steps, uint32_t first_slot)
{
    const uint32_t slots = (uint32_t)program->slot_count;
    Registers r = {.code = code,
                   .steps = steps,
                   .count = target->registers,
                   .width = target->width,
                   .has_fused = target->fused && elementary_has_fused(),
                   .has_three = target->isa != ISA_SSE2,
                   .frame = steps->frame};

    r.reg = NEW_ARRAY(int8_t, steps->value_count);
    r.home = NEW_ARRAY(Home, steps->value_count);
    for (uint32_t v = 0; v < steps->value_count; v++) {
        const bool is_fixed = v >= slots && v < slots + FIXED_COUNT;

        r.reg[v] = -1;
        r.home[v] = v < first_slot ? v : is_fixed ? FIXED | (v - slots) : NO_HOME;
    }
    for (int i = 0; i < REGISTERS; i++)
        r.value[i] = -1;
    find_uses(&r);

    code->is_leaf = steps->calls.count == 0;
    x86_enter(code);
    for (r.now = 0; r.now < steps->steps.count; r.now++) {
        transaction_worked(VALUE_WORK);
        emit_step(&r, steps->steps.at[r.now], program);
        forget(&r, &steps->steps.at[r.now]);
    }
    x86_leave(code);

    MEM_FREE(r.reg, r.home, r.use, r.first_use, r.next_use);
    LIST_FREE(r.free_homes);
    return r.frame;
}

#endif

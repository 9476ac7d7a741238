/* native_steps.c: the instructions of a section in the order of native code
 *
 * A call of a function destroys all registers, so calls are gathered: first functions that need no
 * other function, with their operands, then functions that need these. The rest follows in its
 * original order. */
#include "compile/native_impl.h"

#ifdef __x86_64__

#include <stdlib.h>

enum { NOT_MADE = -1 };

struct StepMaker {
    const Program *program;
    bool fused, joined;
    uint32_t slots;
    uint8_t *code;    /* of the instruction that makes a slot */
    int *operands;    /* index of the first in the tape; NOT_MADE: an input or a constant */
    bool *is_late;    /* another function needs the slot */
    int *root, *next; /* a root that is a slot, and the next one that is the same; -1: none */
    int *level;       /* of functions below it in its section */
    bool *is_done;
    LIST(uint32_t) functions; /* of a section: slots, a SINCOS once */
    LIST(uint32_t) stack;
    SectionSteps *out;
};

static bool is_call(Opcode code)
{
    switch ((int)code) {
    case CODE_POW:
    case CODE_SIN:
    case CODE_COS:
    case CODE_SINCOS:
        return true;
    case CODE_CALL + OP_ABS:
    case CODE_CALL + OP_MIN:
    case CODE_CALL + OP_MAX:
    case CODE_CALL + OP_RAMP:
    case CODE_CALL + OP_STEP:
    case CODE_CALL + OP_LT:
    case CODE_CALL + OP_LE:
    case CODE_CALL + OP_EQ:
    case CODE_CALL + OP_NE:
    case CODE_CALL + OP_NOT:
        return false;
    default:
        return code >= CODE_CALL;
    }
}

/* --- slots --- */

static const uint32_t *operands_of(const StepMaker *m, uint32_t slot)
{
    return m->program->tape.at + m->operands[slot];
}

/* The sections that are one function with this one: stages have but one each where they are joined.
 */
static int begin_of(const StepMaker *m, int section)
{
    return m->joined && section >= NATIVE_JOINED && section <= NATIVE_JOINED_END ? NATIVE_JOINED
                                                                                 : section;
}

static int end_of(const StepMaker *m, int section)
{
    return m->joined && begin_of(m, section) == NATIVE_JOINED ? NATIVE_JOINED_END : section;
}

static uint32_t first_slot(const StepMaker *m, int section)
{
    return section < m->program->sections.count
               ? (uint32_t)m->program->sections.at[section].first_slot
               : m->slots;
}

static uint32_t slots_end(const StepMaker *m, int section)
{
    return first_slot(m, end_of(m, section) + 1);
}

static bool is_of_section(const StepMaker *m, uint32_t slot, int section)
{
    return slot >= first_slot(m, section) && slot < slots_end(m, section);
}

static void note_run(StepMaker *m, const OpcodeRun *run, int section)
{
    const uint32_t first = first_slot(m, begin_of(m, section));
    const int operands = code_operands(run->code), results = run->code == CODE_SINCOS ? 2 : 1;

    for (int i = 0; i < run->count * results; i++) {
        const uint32_t slot = (uint32_t)(run->result + i);
        int level = 0;

        m->code[slot] = (uint8_t)run->code;
        m->operands[slot] = run->operands + i / results * operands;
        for (int k = 0; k < operands; k++) {
            const uint32_t operand = operands_of(m, slot)[k];

            if (operand < first)
                m->is_late[operand] = true;
            else if (m->level[operand] > level)
                level = m->level[operand];
        }
        m->level[slot] = level + is_call(run->code);
    }
}

StepMaker *step_maker_new(const Program *program, const NativeTarget *target)
{
    StepMaker *m = NEW(StepMaker);

    m->program = program;
    m->fused = target->fused;
    m->joined = target->joined;
    m->slots = (uint32_t)program->slot_count;
    m->code = NEW_ARRAY(uint8_t, m->slots);
    m->operands = NEW_ARRAY(int, m->slots);
    m->is_late = NEW_ARRAY(bool, m->slots);
    m->level = NEW_ARRAY(int, m->slots);
    m->is_done = NEW_ARRAY(bool, m->slots);
    m->root = NEW_ARRAY(int, m->slots);
    m->next = NEW_ARRAY(int, program->root_count);
    for (uint32_t i = 0; i < m->slots; i++) {
        m->operands[i] = NOT_MADE;
        m->root[i] = -1;
    }
    for (int i = program->root_count - 1; i >= 0; i--) {
        m->next[i] = m->root[program->roots[i].slot];
        m->root[program->roots[i].slot] = i;
    }
    for (int s = 0; s < program->sections.count; s++)
        for (int r = program->sections.at[s].first_run; r < section_end(program, s); r++)
            note_run(m, &program->runs.at[r], s);
    return m;
}

void step_maker_free(StepMaker *m)
{
    MEM_FREE(m->code, m->operands, m->is_late, m->level, m->is_done, m->root, m->next);
    LIST_FREE(m->functions);
    LIST_FREE(m->stack);
    mem_free(m);
}

void section_steps_free(SectionSteps *steps)
{
    LIST_FREE(steps->steps);
    LIST_FREE(steps->calls);
    LIST_FREE(steps->results);
}

/* --- steps --- */

static void add_step(StepMaker *m, int code, uint32_t result, int operands, uint32_t a, uint32_t b,
                     uint32_t c)
{
    LIST_PUSH(m->out->steps, (NativeStep){(uint8_t)code, (uint8_t)operands, result, {a, b, c}});
}

static void add_store(StepMaker *m, uint32_t value, Home place)
{
    add_step(m, STEP_STORE, place, 1, value, 0, 0);
}

static uint32_t fixed(const StepMaker *m, FixedValue which)
{
    return m->slots + (uint32_t)which;
}

/* to where others look for it */
static void add_handover(StepMaker *m, uint32_t slot)
{
    if (m->is_late[slot] && m->operands[slot] != NOT_MADE)
        add_store(m, slot, slot);
    for (int i = m->root[slot]; i >= 0; i = m->next[i])
        add_store(m, slot, m->slots + (uint32_t)m->program->roots[i].root);
}

static void add_two(StepMaker *m, int code, uint32_t slot, uint32_t a, uint32_t b)
{
    add_step(m, code, slot, 2, a, b, 0);
}

/* a * b, with c */
static void add_product(StepMaker *m, Opcode code, uint32_t slot, const uint32_t *args)
{
    const uint32_t product = m->out->value_count;

    if (m->fused) {
        add_step(m,
                 code == CODE_MULADD   ? STEP_MULADD
                 : code == CODE_MULSUB ? STEP_MULSUB
                                       : STEP_SUBMUL,
                 slot, 3, args[0], args[1], args[2]);
        return;
    }
    m->out->value_count++;
    add_two(m, STEP_MUL, product, args[0], args[1]);
    if (code == CODE_MULADD)
        add_two(m, STEP_ADD, slot, product, args[2]);
    else if (code == CODE_MULSUB)
        add_two(m, STEP_SUB, slot, product, args[2]);
    else
        add_two(m, STEP_SUB, slot, args[2], product);
}

static void add_instruction(StepMaker *m, uint32_t slot)
{
    const uint32_t *args = operands_of(m, slot);

    switch ((int)m->code[slot]) {
    case CODE_ADD:
        add_two(m, STEP_ADD, slot, args[0], args[1]);
        break;
    case CODE_SUB:
        add_two(m, STEP_SUB, slot, args[0], args[1]);
        break;
    case CODE_MUL:
        add_two(m, STEP_MUL, slot, args[0], args[1]);
        break;
    case CODE_RECIP:
        add_two(m, STEP_DIV, slot, fixed(m, FIXED_ONE), args[0]);
        break;
    case CODE_NEG:
        add_two(m, STEP_XOR, slot, args[0], fixed(m, FIXED_SIGN));
        break;
    case CODE_SQRT:
        add_step(m, STEP_SQRT, slot, 1, args[0], 0, 0);
        break;
    case CODE_SELECT:
        add_step(m, STEP_SELECT, slot, 3, args[0], args[1], args[2]);
        break;
    case CODE_CALL + OP_ABS:
        add_two(m, STEP_AND, slot, args[0], fixed(m, FIXED_SIZE));
        break;
    case CODE_CALL + OP_MIN:
        add_two(m, STEP_MIN, slot, args[1], args[0]);
        break;
    case CODE_CALL + OP_MAX:
        add_two(m, STEP_MAX, slot, args[1], args[0]);
        break;
    case CODE_CALL + OP_RAMP:
        add_two(m, STEP_MAX, slot, args[0], fixed(m, FIXED_ZERO));
        break;
    case CODE_CALL + OP_STEP:
        add_two(m, STEP_COMPARE + IS_LESS_EQUAL, slot, fixed(m, FIXED_ZERO), args[0]);
        break;
    case CODE_CALL + OP_LT:
        add_two(m, STEP_COMPARE + IS_LESS, slot, args[0], args[1]);
        break;
    case CODE_CALL + OP_LE:
        add_two(m, STEP_COMPARE + IS_LESS_EQUAL, slot, args[0], args[1]);
        break;
    case CODE_CALL + OP_EQ:
        add_two(m, STEP_COMPARE + IS_EQUAL, slot, args[0], args[1]);
        break;
    case CODE_CALL + OP_NE:
        add_two(m, STEP_COMPARE + IS_NOT_EQUAL, slot, args[0], args[1]);
        break;
    case CODE_CALL + OP_NOT:
        add_two(m, STEP_COMPARE + IS_EQUAL, slot, args[0], fixed(m, FIXED_ZERO));
        break;
    default:
        add_product(m, (Opcode)m->code[slot], slot, args);
        break;
    }
    add_handover(m, slot);
}

/* emit a slot of the section, with its operands; functions are already emitted */
static void add_with_operands(StepMaker *m, uint32_t slot, int section)
{
    LIST_PUSH(m->stack, slot);
    while (m->stack.count > 0) {
        const uint32_t top = m->stack.at[m->stack.count - 1];
        const int before = m->stack.count;

        transaction_worked(VALUE_WORK);
        if (m->is_done[top] || !is_of_section(m, top, section)) {
            m->stack.count--;
            continue;
        }
        for (int k = code_operands(m->code[top]) - 1; k >= 0; k--) {
            const uint32_t operand = operands_of(m, top)[k];

            if (is_of_section(m, operand, section) && !m->is_done[operand])
                LIST_PUSH(m->stack, operand);
        }
        if (m->stack.count > before)
            continue;
        m->is_done[top] = true;
        m->stack.count--;
        add_instruction(m, top);
    }
}

/* --- functions --- */

static Opcode called(Opcode code)
{
    return code == CODE_SIN || code == CODE_COS ? CODE_SINCOS : code;
}

/* a first argument, and the slot of the call */
typedef struct Called {
    uint32_t argument, slot;
} Called;
typedef LIST(Called) Calleds;

/* by argument, so that arguments that are already consecutive are found */
static int compare(const void *a, const void *b)
{
    const Called *one = a, *other = b;

    return (one->argument > other->argument) - (one->argument < other->argument);
}

/* arguments of one operand each that are consecutive earlier slots */
static bool are_adjacent(const StepMaker *m, const Calleds *calls, int operands, int section)
{
    for (int i = 0; i < calls->count; i++)
        if (operands != 1 || calls->at[i].argument >= first_slot(m, section) ||
            calls->at[i].argument != calls->at[0].argument + (uint32_t)i)
            return false;
    return true;
}

static void add_result(StepMaker *m, uint32_t slot)
{
    LIST_PUSH(m->out->results, slot);
}

static void add_call(StepMaker *m, Opcode code, Calleds *calls, int section)
{
    SectionSteps *out = m->out;
    const int operands = code == CODE_SINCOS ? 1 : code_operands(code);
    StepCall call = {.code = code, .count = calls->count, .first_result = out->results.count};

    if (operands == 1)
        qsort(calls->at, (size_t)calls->count, sizeof *calls->at, compare);
    if (are_adjacent(m, calls, operands, section)) {
        call.arguments = calls->at[0].argument;
    } else {
        call.arguments = FRAME | out->frame;
        for (int i = 0; i < calls->count; i++)
            for (int k = 0; k < operands; k++)
                add_store(m, operands_of(m, calls->at[i].slot)[k], FRAME | out->frame++);
    }
    call.results = FRAME | out->frame;
    out->frame += (uint32_t)calls->count * (code == CODE_SINCOS ? 2 : 1);
    for (int i = 0; i < calls->count; i++)
        add_result(m, m->code[calls->at[i].slot] == CODE_COS ? NO_HOME : calls->at[i].slot);
    for (int i = 0; i < calls->count && code == CODE_SINCOS; i++) {
        const uint32_t slot = calls->at[i].slot;

        add_result(m, m->code[slot] == CODE_COS      ? slot
                      : m->code[slot] == CODE_SINCOS ? slot + 1
                                                     : NO_HOME);
    }
    add_step(m, STEP_CALL, (uint32_t)out->calls.count, 0, 0, 0, 0);
    LIST_PUSH(out->calls, call);
    for (int i = call.first_result; i < out->results.count; i++)
        if (out->results.at[i] != NO_HOME) {
            m->is_done[out->results.at[i]] = true;
            add_handover(m, out->results.at[i]);
        }
}

/* the functions of a level of a kind */
static void add_kind(StepMaker *m, int section, int level, Opcode kind)
{
    Calleds calls = {0};

    for (int i = 0; i < m->functions.count; i++) {
        const uint32_t slot = m->functions.at[i];
        const Opcode own = (Opcode)m->code[slot];

        if (m->level[slot] != level || called(own) != kind)
            continue;
        for (int k = 0; k < code_operands(own); k++)
            add_with_operands(m, operands_of(m, slot)[k], section);
        LIST_PUSH(calls, (Called){operands_of(m, slot)[0], slot});
    }
    if (calls.count > 0)
        add_call(m, kind, &calls, section);
    LIST_FREE(calls);
}

static void add_functions(StepMaker *m, int section)
{
    bool is_there[CODES] = {false};
    int levels = 0;

    m->functions.count = 0;
    for (uint32_t slot = first_slot(m, section); slot < slots_end(m, section); slot++) {
        const Opcode code = (Opcode)m->code[slot];

        if (!is_call(code))
            continue;
        LIST_PUSH(m->functions, slot);
        is_there[called(code)] = true;
        if (m->level[slot] > levels)
            levels = m->level[slot];
        slot += code == CODE_SINCOS;
    }
    for (int level = 1; level <= levels; level++)
        for (int kind = 0; kind < CODES; kind++)
            if (is_there[kind])
                add_kind(m, section, level, (Opcode)kind);
}

/* roots of a stage are handed over with its first section, where nobody makes them */
static int first_root(const StepMaker *m, int section)
{
    Stage stage = 0;

    while (stage < STAGE_COUNT && m->program->first_section[stage] < section)
        stage++;
    return m->program->first_root[stage];
}

void step_maker_section(StepMaker *m, int section, SectionSteps *out)
{
    const Program *program = m->program;

    m->out = out;
    out->steps.count = out->calls.count = out->results.count = 0;
    out->value_count = m->slots + FIXED_COUNT;
    out->frame = 0;
    add_functions(m, section);
    for (int i = 0; i < program->derived.count; i++)
        if (is_of_section(m, program->derived.at[i], section))
            add_with_operands(m, program->derived.at[i], section);
    for (int i = first_root(m, section); i < first_root(m, end_of(m, section) + 1); i++) {
        const Handover *root = &program->roots[i];

        if (m->operands[root->slot] == NOT_MADE)
            add_store(m, (uint32_t)root->slot, m->slots + (uint32_t)root->root);
    }
}

#endif

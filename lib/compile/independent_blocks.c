/* independent_blocks.c: which operations of a stage may run at the same time, block by block
 *
 * An operation belongs to a block if its operands belong to that block or to none. Operations that
 * combine blocks, as the sum over the legs of a platform, read several: they are *mixed*. Their
 * results may be used in one block again, as a leg's accelerations follow from those of the
 * platform. So a stage has five phases: operations of no block; independent blocks; operations that
 * combine them; blocks again; operations that combine these, as their power. Each operation reads
 * results of earlier phases or of its own part of its own phase. Only this dependence determines
 * its phase; values don't depend on it. */
#include "compile/program_impl.h"

#include <string.h>

/* block of a value: none, one from 1, several */
enum { NO_BLOCK = 0, MIXED = -1 };
/* roots that a value leads to: none, one from 1, several */
enum { NO_ROOT = 0, MANY_ROOTS = -1 };
enum { ALONE, BLOCKS_APART, JOINED, BLOCKS_AGAIN, LAST }; /* phases */
enum { MOST_ROUNDS = 16 };
/* In units of a sum or product: the cost of starting and joining threads, the least saving of a
 * phase that pays, and the cost of other operations */
enum { WAKING = 600, QUOTIENT = 5, FUNCTION = 15 };
#define LEAST_GAIN 0.1 /* of a stage's work */

typedef struct Finder {
    const LoweredValue *values;
    uint32_t count;
    const Lowered *lowered;
    uint32_t *order; /* instructions, operands before users */
    uint32_t ordered;
    int parts, blocks; /* blocks are numbered up to that */
    int *block;        /* of values of earlier stages; in the stage, of values that aren't mixed */
    int *again;        /* of mixed values that are of one block again; NO_BLOCK: they join */
    int *root;
    bool *is_last;
    int (*work)[2]; /* of each block, in both phases of independent blocks */
    int *part_of;   /* of each block */
    uint32_t *stack;
    IndependentBlocks *out;
} Finder;

static int work_of(const LoweredValue *value)
{
    switch ((int)value->code) {
    case CODE_RECIP:
    case CODE_SQRT:
        return QUOTIENT;
    case CODE_SIN:
    case CODE_COS:
    case CODE_SINCOS:
    case CODE_POW:
        return FUNCTION;
    default:
        return value->code >= CODE_CALL ? FUNCTION : 1;
    }
}

static int joined(int a, int b)
{
    return a == NO_BLOCK || a == b ? b : b == NO_BLOCK ? a : MIXED;
}

static uint32_t operand(const Finder *f, uint32_t v, int k)
{
    return maker_of(f->values, f->values[v].args[k]);
}

static bool is_of_stage(const Finder *f, uint32_t v, int stage)
{
    return is_instruction(&f->values[v]) && f->values[v].stage == stage;
}

static bool is_mixed(const Finder *f, uint32_t v, int stage)
{
    return is_of_stage(f, v, stage) && f->block[v] == MIXED;
}

/* A cosine may precede the sine that is computed with it, with users between both. */
static void find_order(Finder *f)
{
    bool *is_there = NEW_ARRAY(bool, f->count);

    f->order = NEW_ARRAY(uint32_t, f->count);
    for (uint32_t i = 0; i < f->count; i++) {
        const uint32_t v = maker_of(f->values, i);

        if (is_instruction(&f->values[v]) && !is_there[v])
            f->order[f->ordered++] = v;
        is_there[v] = true;
    }
    mem_free(is_there);
}

/* --- blocks of operands --- */

static void find_blocks(Finder *f, int stage)
{
    for (uint32_t i = 0; i < f->ordered; i++) {
        const uint32_t v = f->order[i];
        int block = NO_BLOCK;

        if (!is_of_stage(f, v, stage))
            continue;
        for (int k = 0; k < code_operands(f->values[v].code); k++)
            block = joined(block, f->block[operand(f, v, k)]);
        f->block[v] = block;
    }
}

/* What a later stage reads leads to many. */
static void find_roots(Finder *f, int stage)
{
    memset(f->root, 0, f->count * sizeof *f->root);
    for (int i = 0; i < f->lowered->root_count; i++) {
        int *root = &f->root[maker_of(f->values, f->lowered->roots[i])];

        *root = *root == NO_ROOT ? i + 1 : MANY_ROOTS;
    }
    for (uint32_t i = f->ordered; i-- > 0;) {
        const uint32_t v = f->order[i];

        if (f->values[v].stage < stage)
            continue;
        for (int k = 0; k < code_operands(f->values[v].code); k++) {
            int *root = &f->root[operand(f, v, k)];
            const int more = f->values[v].stage == stage ? f->root[v] : MANY_ROOTS;

            *root = *root == NO_ROOT || *root == more ? more : MANY_ROOTS;
        }
    }
}

/* A mixed value joins, and so does all that is mixed below it. */
static void mark_joining(Finder *f, uint32_t value, int stage)
{
    int count = 0;

    f->again[value] = NO_BLOCK;
    f->is_last[value] = false;
    f->stack[count++] = value;
    while (count > 0) {
        const uint32_t v = f->stack[--count];

        for (int k = 0; k < code_operands(f->values[v].code); k++) {
            const uint32_t below = operand(f, v, k);

            if (!is_mixed(f, below, stage) || f->again[below] == NO_BLOCK)
                continue;
            f->again[below] = NO_BLOCK;
            f->stack[count++] = below;
        }
    }
}

/* the block that a mixed value is of again, by what it reads; is_last where it reads such */
static int block_again(Finder *f, uint32_t v, int stage)
{
    int block = NO_BLOCK;

    for (int k = 0; k < code_operands(f->values[v].code); k++) {
        const uint32_t below = operand(f, v, k);

        if (is_mixed(f, below, stage)) {
            f->is_last[v] = f->is_last[v] || f->is_last[below];
            block = joined(block, f->again[below]);
        } else {
            block = joined(block, f->block[below]);
        }
    }
    return block;
}

/* One round; true: more operations combine blocks, so that others may depend on these now. */
static bool find_joining(Finder *f, int stage)
{
    bool has_grown = false;

    for (uint32_t i = 0; i < f->ordered; i++) {
        const uint32_t v = f->order[i];
        int block;

        if (!is_mixed(f, v, stage) || f->again[v] == NO_BLOCK)
            continue;
        f->is_last[v] = false;
        block = block_again(f, v, stage);
        if (block == MIXED && f->root[v] == MANY_ROOTS) {
            mark_joining(f, v, stage);
            has_grown = true;
        } else {
            f->is_last[v] = f->is_last[v] || block == MIXED;
            f->again[v] = block;
        }
    }
    return has_grown;
}

/* false: it doesn't terminate */
static bool find_again(Finder *f, int stage)
{
    int rounds = 0;

    for (uint32_t v = 0; v < f->count; v++) {
        f->again[v] = MIXED;
        f->is_last[v] = false;
    }
    while (find_joining(f, stage))
        if (++rounds == MOST_ROUNDS)
            return false;
    return true;
}

/* --- cost and benefit --- */

static int phase_of(const Finder *f, uint32_t v)
{
    if (f->block[v] != MIXED)
        return f->block[v] == NO_BLOCK ? ALONE : BLOCKS_APART;
    return f->is_last[v] ? LAST : f->again[v] == NO_BLOCK ? JOINED : BLOCKS_AGAIN;
}

static int block_of(const Finder *f, uint32_t v)
{
    return f->block[v] != MIXED ? f->block[v] : f->again[v];
}

/* Blocks, as they are numbered, to parts of like work. */
static void share_blocks(Finder *f, int all)
{
    int before = 0;

    for (int b = 1; b <= f->blocks; b++) {
        const int own = f->work[b][0] + f->work[b][1];
        const int part = all > 0 ? (int)((before + own / 2) * (int64_t)f->parts / all) : 0;

        f->part_of[b] = part < f->parts ? part : f->parts - 1;
        before += own;
    }
}

/* work that the caller is spared in one of both phases */
static int spared(const Finder *f, int again)
{
    int work[MOST_THREADS] = {0}, all = 0, most = 0;

    for (int b = 1; b <= f->blocks; b++) {
        work[f->part_of[b]] += f->work[b][again];
        all += f->work[b][again];
    }
    for (int i = 0; i < f->parts; i++)
        most = work[i] > most ? work[i] : most;
    return all - most;
}

static void place_stage(Finder *f, int stage)
{
    int all = 0, apart = 0, gain = 0;
    bool pays[2];

    memset(f->work, 0, (size_t)(f->blocks + 1) * sizeof *f->work);
    for (uint32_t v = 0; v < f->count; v++) {
        if (!is_of_stage(f, v, stage))
            continue;
        all += work_of(&f->values[v]);
        if (phase_of(f, v) % 2 == 0)
            continue;
        apart += work_of(&f->values[v]);
        f->work[block_of(f, v)][phase_of(f, v) == BLOCKS_AGAIN] += work_of(&f->values[v]);
    }
    share_blocks(f, apart);
    for (int i = 0; i < 2; i++) {
        pays[i] = spared(f, i) > WAKING;
        gain += pays[i] ? spared(f, i) - WAKING : 0;
    }
    f->out->is_split[stage] = gain > LEAST_GAIN * all;
    for (uint32_t v = 0; v < f->count; v++) {
        int phase;

        if (!is_of_stage(f, v, stage) || !f->out->is_split[stage])
            continue;
        phase = phase_of(f, v);
        f->out->part[v] = 0;
        if (phase % 2 == 1 && pays[phase == BLOCKS_AGAIN])
            f->out->part[v] = (uint8_t)f->part_of[block_of(f, v)];
        else if (phase % 2 == 1)
            phase--; /* where all that it reads is there already */
        f->out->phase[v] = (uint8_t)phase;
    }
}

/* to those that read them in later stages all but blocks' are of none */
static void settle_stage(Finder *f, int stage)
{
    for (uint32_t v = 0; v < f->count; v++)
        if (is_mixed(f, v, stage))
            f->block[v] = f->is_last[v] ? NO_BLOCK : f->again[v];
}

static void find_stage(Finder *f, int stage)
{
    find_blocks(f, stage);
    find_roots(f, stage);
    if (!find_again(f, stage)) {
        for (uint32_t v = 0; v < f->count; v++)
            f->again[v] = NO_BLOCK;
        settle_stage(f, stage);
        return;
    }
    place_stage(f, stage);
    settle_stage(f, stage);
}

IndependentBlocks independent_blocks_find(const Lowered *lowered, const ProgramBlocks *blocks)
{
    const uint32_t count = (uint32_t)lowered->values.count;
    IndependentBlocks out = {.parts = 1};
    Finder f = {.values = lowered->values.at, .count = count, .lowered = lowered, .out = &out};

    for (int i = 0; blocks != NULL && i < lowered->input_count; i++)
        f.blocks = blocks->block[i] > f.blocks ? blocks->block[i] : f.blocks;
    if (f.blocks < 2 || blocks->parts < 2)
        return out;
    out.parts = blocks->parts < f.blocks ? blocks->parts : f.blocks;
    out.parts = out.parts < MOST_THREADS ? out.parts : MOST_THREADS;
    out.phase = NEW_ARRAY(uint8_t, count);
    out.part = NEW_ARRAY(uint8_t, count);
    f.parts = out.parts;
    f.block = NEW_ARRAY(int, count);
    f.again = NEW_ARRAY(int, count);
    f.root = NEW_ARRAY(int, count);
    f.is_last = NEW_ARRAY(bool, count);
    f.work = mem_array((size_t)f.blocks + 1, sizeof *f.work);
    f.part_of = NEW_ARRAY(int, f.blocks + 1);
    find_order(&f);
    f.stack = NEW_ARRAY(uint32_t, count);
    for (int i = 0; i < lowered->input_count; i++)
        f.block[i] = blocks->block[i];
    for (int stage = STAGE_PARAMETER + 1; stage < STAGE_COUNT; stage++)
        find_stage(&f, stage);
    MEM_FREE(f.order, f.block, f.again, f.root, f.is_last, f.work, f.part_of, f.stack);
    return out;
}

void independent_blocks_free(IndependentBlocks *apart)
{
    MEM_FREE(apart->phase, apart->part);
}

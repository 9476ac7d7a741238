/* schedule.c: orders values into a tape in which equal operations are adjacent
 *
 * A product that only one sum of its stage needs is fused with it, with two roundings as before.
 * Then list scheduling, stage by stage: of the operations whose operands are computed, those of the
 * most frequent opcode form the next run, and operations that become ready in it join it. Where
 * blocks are separated (independent_blocks.c), each section of a stage is scheduled by itself.
 * O(values opcodes) at worst, O(values) where runs are long. */
#include "compile/program_impl.h"

#include <assert.h>
#include <string.h>

enum { NOBODY = UINT32_MAX };

/* values that wait for an opcode's next run, in the order of becoming ready */
typedef struct Queue {
    uint32_t first;
    uint32_t last;
    int count;
} Queue;

typedef struct Plan {
    Program *program;
    LoweredValue *values;
    uint32_t count;
    uint32_t *slot;              /* of each value */
    uint32_t *pending;           /* operands of the same stage that aren't there yet */
    uint32_t *users;             /* of the same stage, by operand */
    uint32_t *first_user;        /* index of each value's first user; count + 1 */
    uint32_t *next;              /* in a queue, or of those that wait for no one in their stage */
    uint32_t ready[STAGE_COUNT]; /* the first of these */
    Queue queues[CODES];
    Opcode codes[CODES]; /* those there are, rising */
    int code_count;
    int work[STAGE_COUNT]; /* instructions that aren't on the tape yet */
    IndependentBlocks apart;
    int phase, part; /* of the section that is being appended to the tape */
} Plan;

/* --- fusing --- */

static void fuse_one(LoweredValue *values, const uint32_t *uses, LoweredValue *sum)
{
    bool add = sum->code == CODE_ADD;

    for (int i = 1; i >= 0; i--) {
        LoweredValue *product = &values[sum->args[i]];

        if (product->code != CODE_MUL || uses[sum->args[i]] != 1 || product->stage != sum->stage)
            continue;
        sum->code = add ? CODE_MULADD : i == 0 ? CODE_MULSUB : CODE_SUBMUL;
        sum->args[2] = sum->args[1 - i];
        sum->args[0] = product->args[0];
        sum->args[1] = product->args[1];
        product->code = CODE_ABSORBED;
        return;
    }
}

static void fuse(const Lowered *lowered)
{
    LoweredValue *values = lowered->values.at;
    int count = lowered->values.count;
    uint32_t *uses = NEW_ARRAY(uint32_t, count);

    for (int v = 0; v < count; v++) {
        for (int i = 0; is_instruction(&values[v]) && i < code_operands(values[v].code); i++)
            uses[values[v].args[i]]++;
    }
    for (int i = 0; i < lowered->root_count; i++)
        uses[lowered->roots[i]]++;
    for (int v = 0; v < count; v++) {
        if (values[v].code == CODE_ADD || values[v].code == CODE_SUB)
            fuse_one(values, uses, &values[v]);
    }
    mem_free(uses);
}

/* --- who waits for whom --- */

/* Call `note` for each operand of an instruction that its own stage computes. */
static inline void for_dependences(Plan *plan, void (*note)(Plan *, uint32_t maker, uint32_t user))
{
    for (uint32_t v = 0; v < plan->count; v++) {
        const LoweredValue *value = &plan->values[v];

        if (!is_instruction(value))
            continue;
        for (int i = 0; i < code_operands(value->code); i++) {
            uint32_t maker = maker_of(plan->values, value->args[i]);

            if (is_instruction(&plan->values[maker]) && plan->values[maker].stage == value->stage)
                note(plan, maker, v);
        }
    }
}

static void count_user(Plan *plan, uint32_t maker, uint32_t user)
{
    plan->pending[user]++;
    plan->first_user[maker + 1]++;
}

/* first_user[maker] moves to where the users end, and is wound back later */
static void note_user(Plan *plan, uint32_t maker, uint32_t user)
{
    plan->users[plan->first_user[maker]++] = user;
}

static void find_users(Plan *plan)
{
    for_dependences(plan, count_user);
    for (uint32_t v = 0; v < plan->count; v++)
        plan->first_user[v + 1] += plan->first_user[v];
    plan->users = NEW_ARRAY(uint32_t, plan->first_user[plan->count]);
    for_dependences(plan, note_user);
    memmove(plan->first_user + 1, plan->first_user, plan->count * sizeof *plan->first_user);
    plan->first_user[0] = 0;
}

/* --- the tape --- */

static void measure(Plan *plan)
{
    bool there[CODES] = {false};
    int instructions = 0, operands = 0;

    for (uint32_t v = 0; v < plan->count; v++) {
        const LoweredValue *value = &plan->values[v];

        if (!is_instruction(value))
            continue;
        there[value->code] = true;
        plan->work[value->stage]++;
        instructions++;
        operands += code_operands(value->code);
    }
    for (int stage = 0; stage < STAGE_COUNT; stage++)
        plan->program->work[stage + 1] = plan->program->work[stage] + plan->work[stage];
    for (int code = 0; code < CODES; code++)
        if (there[code])
            plan->codes[plan->code_count++] = (Opcode)code;
    LIST_ROOM(plan->program->tape, operands);
    LIST_ROOM(plan->program->derived, instructions);
}

static void find_ready(Plan *plan)
{
    for (int stage = 0; stage < STAGE_COUNT; stage++)
        plan->ready[stage] = NOBODY;
    for (uint32_t v = plan->count; v-- > 0;) {
        const LoweredValue *value = &plan->values[v];

        if (is_instruction(value) && plan->pending[v] == 0) {
            plan->next[v] = plan->ready[value->stage];
            plan->ready[value->stage] = v;
        }
    }
}

static bool is_of_section(const Plan *plan, uint32_t value)
{
    return !plan->apart.is_split[plan->values[value].stage] ||
           (plan->apart.phase[value] == plan->phase && plan->apart.part[value] == plan->part);
}

static void enqueue(Plan *plan, uint32_t value)
{
    Queue *queue = &plan->queues[plan->values[value].code];

    plan->next[value] = NOBODY;
    if (queue->count++ == 0)
        queue->first = value;
    else
        plan->next[queue->last] = value;
    queue->last = value;
}

static uint32_t dequeue(Plan *plan, Opcode code)
{
    uint32_t value = plan->queues[code].first;

    plan->queues[code].first = plan->next[value];
    plan->queues[code].count--;
    return value;
}

static uint32_t slot_of(const Plan *plan, uint32_t value)
{
    if (plan->values[value].code == CODE_COSINE)
        return plan->slot[plan->values[value].args[0]] + 1;
    return plan->slot[value];
}

static void emit(Plan *plan, uint32_t value)
{
    Program *program = plan->program;
    const LoweredValue *v = &plan->values[value];

    transaction_worked(VALUE_WORK);
    for (int i = 0; i < code_operands(v->code); i++)
        LIST_PUSH(program->tape, slot_of(plan, v->args[i]));
    plan->work[v->stage]--;
    plan->slot[value] = (uint32_t)program->slot_count;
    program->slot_count += v->code == CODE_SINCOS ? 2 : 1;
    for (uint32_t i = plan->first_user[value]; i < plan->first_user[value + 1]; i++) {
        if (--plan->pending[plan->users[i]] == 0 && is_of_section(plan, plan->users[i]))
            enqueue(plan, plan->users[i]);
    }
}

static void emit_run(Plan *plan, Opcode code)
{
    Program *program = plan->program;
    OpcodeRun run = {.code = code, .operands = program->tape.count, .result = program->slot_count};

    for (; plan->queues[code].count > 0; run.count++)
        emit(plan, dequeue(plan, code));
    LIST_PUSH(program->runs, run);
}

/* operations that are ready at the start of a section, in order */
static void enqueue_ready(Plan *plan, Stage stage)
{
    if (!plan->apart.is_split[stage]) {
        for (uint32_t v = plan->ready[stage], next; v != NOBODY; v = next) {
            next = plan->next[v];
            enqueue(plan, v);
        }
        return;
    }
    for (uint32_t v = 0; v < plan->count && plan->work[stage] > 0; v++) {
        if (is_instruction(&plan->values[v]) && plan->values[v].stage == stage &&
            plan->pending[v] == 0 && is_of_section(plan, v))
            enqueue(plan, v);
    }
}

/* Operations that became ready before their section are scheduled when it starts. */
static void emit_section(Plan *plan, Stage stage, int together)
{
    Program *program = plan->program;

    LIST_PUSH(program->sections, (Section){.first_run = program->runs.count,
                                           .first_slot = program->slot_count,
                                           .together = together});
    enqueue_ready(plan, stage);
    for (;;) {
        Opcode best = plan->codes[0];

        for (int i = 1; i < plan->code_count; i++)
            if (plan->queues[plan->codes[i]].count > plan->queues[best].count)
                best = plan->codes[i];
        if (plan->code_count == 0 || plan->queues[best].count == 0)
            break;
        emit_run(plan, best);
    }
}

static void emit_stage(Plan *plan, Stage stage)
{
    if (!plan->apart.is_split[stage]) {
        emit_section(plan, stage, 1);
        return;
    }
    for (plan->phase = 0; plan->phase < PHASES; plan->phase++) {
        const int parts = plan->phase % 2 == 1 ? plan->apart.parts : 1;

        for (plan->part = 0; plan->part < parts; plan->part++)
            emit_section(plan, stage, parts - plan->part);
    }
}

/* --- the ends of the slots --- */

/* inputs and constants that somebody needs */
static void place_leaves(Plan *plan, const Lowered *lowered)
{
    Program *program = plan->program;
    bool *needed = NEW_ARRAY(bool, plan->count);

    for (uint32_t v = 0; v < plan->count; v++) {
        const LoweredValue *value = &plan->values[v];

        for (int i = 0; is_instruction(value) && i < code_operands(value->code); i++)
            needed[value->args[i]] = true;
    }
    for (int i = 0; i < lowered->root_count; i++)
        needed[lowered->roots[i]] = true;

    for (uint32_t v = 0; v < plan->count; v++) {
        if (plan->values[v].code == CODE_INPUT)
            plan->slot[v] = v;
        if (plan->values[v].code != CODE_CONSTANT || !needed[v])
            continue;
        plan->slot[v] = (uint32_t)(lowered->input_count + program->constants.count);
        LIST_PUSH(program->constants, value_constant(&plan->values[v]));
    }
    program->slot_count = lowered->input_count + program->constants.count;
    mem_free(needed);
}

static void place_roots(Plan *plan, const Lowered *lowered)
{
    Program *program = plan->program;
    int next[STAGE_COUNT];

    program->roots = NEW_ARRAY(Handover, lowered->root_count);
    memset(program->first_root, 0, sizeof program->first_root);
    for (int i = 0; i < lowered->root_count; i++)
        program->first_root[plan->values[lowered->roots[i]].stage + 1]++;
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        next[stage] = program->first_root[stage];
        program->first_root[stage + 1] += next[stage];
    }
    for (int i = 0; i < lowered->root_count; i++) {
        uint32_t value = lowered->roots[i];

        program->roots[next[plan->values[value].stage]++] =
            (Handover){i, (int)slot_of(plan, value)};
    }
}

void program_schedule(Program *program, Lowered *lowered, const ProgramBlocks *blocks)
{
    Plan plan = {
        .program = program,
        .values = lowered->values.at,
        .count = (uint32_t)lowered->values.count,
    };

    fuse(lowered);
    plan.apart = independent_blocks_find(lowered, blocks);
    plan.slot = NEW_ARRAY(uint32_t, plan.count);
    plan.pending = NEW_ARRAY(uint32_t, plan.count);
    plan.first_user = NEW_ARRAY(uint32_t, (size_t)plan.count + 1);
    plan.next = NEW_ARRAY(uint32_t, plan.count);
    find_users(&plan);
    place_leaves(&plan, lowered);
    measure(&plan);
    find_ready(&plan);

    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        program->first_run[stage] = program->runs.count;
        program->first_section[stage] = program->sections.count;
        emit_stage(&plan, (Stage)stage);
        assert(plan.work[stage] == 0);
    }
    program->first_run[STAGE_COUNT] = program->runs.count;
    program->first_section[STAGE_COUNT] = program->sections.count;
    for (uint32_t v = 0; v < plan.count; v++)
        if (is_instruction(&plan.values[v]))
            LIST_PUSH(program->derived, plan.slot[v]);
    place_roots(&plan, lowered);

    MEM_FREE(plan.slot, plan.pending, plan.users, plan.first_user, plan.next);
    independent_blocks_free(&plan.apart);
}

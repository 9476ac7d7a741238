/* test_threads.c: pieces of work are done once each, whoever does them, and programs whose blocks
 * stand apart compute what they compute otherwise, to the last bit */
#include "base/threads.h"
#include "compile/program.h"

#include "base/memory.h"
#include "test.h"

#include <stdatomic.h>
#include <time.h>

/* --- pieces --- */

enum { MOST_PIECES = 100 };

typedef struct Tally {
    atomic_int done[MOST_PIECES];
    Threads *threads;
} Tally;

static void count_piece(void *context, int which)
{
    Tally *tally = context;

    (void)atomic_fetch_add(&tally->done[which], 1);
}

/* asks for work of its own while the threads are busy */
static void count_twice(void *context, int which)
{
    Tally *tally = context;

    count_piece(tally, which);
    threads_do(tally->threads, MOST_PIECES, count_piece, tally);
}

static void expect_done(Tally *tally, int pieces, int times)
{
    int wrong = 0;

    for (int i = 0; i < MOST_PIECES; i++)
        wrong += atomic_exchange(&tally->done[i], 0) != (i < pieces ? times : 0);
    EXPECT(wrong == 0);
}

static void every_piece_is_done_once(void)
{
    static const int counts[] = {1, 2, 3, 8, MOST_THREADS, 2, 1, 5};
    static Tally tally;
    Threads *threads = threads_new();

    EXPECT(threads_count(threads) == 1 && threads_count(NULL) == 1);
    for (int i = 0; i < COUNT(counts); i++) {
        threads_set(threads, counts[i]);
        EXPECT(threads_count(threads) == counts[i]);
        for (int pieces = 0; pieces <= MOST_PIECES; pieces++) {
            threads_do(threads, pieces, count_piece, &tally);
            expect_done(&tally, pieces, 1);
        }
    }
    threads_do(NULL, 7, count_piece, &tally);
    expect_done(&tally, 7, 1);
    threads_set(threads, 0);
    EXPECT(threads_count(threads) == 1);
    threads_set(threads, 1 << 30);
    EXPECT(threads_count(threads) == MOST_THREADS);
    threads_free(threads);
    threads_free(NULL);
}

static void work_within_work_is_done_by_who_asks(void)
{
    static Tally tally;

    tally.threads = threads_new();
    threads_set(tally.threads, 3);
    threads_do(tally.threads, 9, count_twice, &tally);
    for (int i = 0; i < 9; i++)
        EXPECT(atomic_exchange(&tally.done[i], 9) == 10);
    expect_done(&tally, MOST_PIECES, 9);
    threads_free(tally.threads);
}

/* Threads that have fallen asleep wake for the next work. */
static void sleepers_wake(void)
{
    const struct timespec pause = {.tv_nsec = 3000000};
    static Tally tally;
    Threads *threads = threads_new();

    threads_set(threads, 4);
    for (int i = 0; i < 30; i++) {
        threads_do(threads, MOST_PIECES, count_piece, &tally);
        expect_done(&tally, MOST_PIECES, 1);
        (void)nanosleep(&pause, NULL);
    }
    threads_free(threads);
}

/* --- programs --- */

enum { BLOCKS = 7, OWN = 3, SHARED = 3, INPUTS = BLOCKS * OWN + SHARED, CHAIN = 300 };

typedef struct Blocked {
    Arena *arena;
    Expr inputs[INPUTS];
    int block[INPUTS];
    LIST(Expr) roots;
} Blocked;

/* some operations on two values, with functions of all prices */
static Expr mix(Arena *arena, uint64_t *random, Expr a, Expr b)
{
    switch ((int)test_uniform(random, 0, 8)) {
    case 0:
        return expr_sin(arena, expr_add(arena, a, b));
    case 1: /* a cosine before its sine, and a user between both */
        return expr_mul(arena, expr_cos(arena, a),
                        expr_add(arena, expr_cos(arena, b), expr_sin(arena, a)));
    case 2:
        return expr_div(arena, a, expr_add(arena, expr_square(arena, b), expr_int(arena, 1)));
    case 3:
        return expr_sub(arena, a, expr_mul(arena, b, b));
    case 4:
        return expr_sqrt(arena, expr_add(arena, expr_square(arena, a), expr_square(arena, b)));
    default:
        return expr_add(arena, expr_mul(arena, a, b), a);
    }
}

/* a chain from a block's inputs and others' values */
static Expr chain(Blocked *b, uint64_t *random, const Expr *from, int count, int length)
{
    Expr values[CHAIN + 4] = {from[0]};
    int there = 0;

    for (int i = 0; i < count; i++)
        values[there++] = from[i];
    for (int i = 0; i < length; i++) {
        const Expr one = values[(int)test_uniform(random, there > 8 ? there - 8 : 0, there)];
        const Expr other = values[(int)test_uniform(random, 0, there)];

        values[there++] = expr_sin(b->arena, mix(b->arena, random, one, other));
    }
    return values[there - 1];
}

/* What each block tells is summed; what follows from that is each block's again, and its sum. */
static Blocked blocked_new(uint64_t *random)
{
    static const SymbolKind kinds[] = {SYMBOL_COORDINATE, SYMBOL_SPEED, SYMBOL_STATE};
    Blocked b = {.arena = arena_new()};
    Expr told[BLOCKS], sum = expr_int(b.arena, 0), power = sum;
    const Expr *shared = b.inputs + BLOCKS * OWN;

    for (int i = 0; i < INPUTS; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "v%d", i);
        b.inputs[i] = expr_symbol(b.arena, name, kinds[i % OWN]);
        b.block[i] = i < BLOCKS * OWN ? 1 + i / OWN : 0;
    }
    for (int i = 0; i < BLOCKS; i++) {
        const Expr from[] = {b.inputs[i * OWN], shared[0],
                             test_uniform(random, 0, 2) < 1 ? shared[0] : b.inputs[i * OWN + 1]};

        told[i] = chain(&b, random, from, 3, CHAIN);
        sum = expr_add(b.arena, sum, told[i]);
    }
    sum = chain(&b, random, &sum, 1, 20);
    for (int i = 0; i < BLOCKS; i++) {
        const Expr from[] = {told[i], sum, b.inputs[i * OWN + 1], b.inputs[i * OWN + 2]};
        const Expr own = chain(&b, random, from, 4, CHAIN);

        LIST_PUSH(b.roots, own);
        power = expr_add(b.arena, power, expr_mul(b.arena, own, told[i]));
    }
    LIST_PUSH(b.roots, power);
    LIST_PUSH(b.roots, b.inputs[0]);
    LIST_PUSH(b.roots, expr_int(b.arena, 3));
    return b;
}

static void blocked_free(Blocked *b)
{
    LIST_FREE(b->roots);
    arena_free(b->arena);
}

/* Enough of them that code is made meanwhile; parts of the stages, too. */
static void expect_alike(Workspace *one, Workspace *other, int roots, uint64_t *random)
{
    for (int turn = 0; turn < 260; turn++) {
        const Stage from = turn % 3 == 2 ? STAGE_VELOCITY : STAGE_PARAMETER;

        for (int i = 0; i < INPUTS; i++)
            if (from == STAGE_PARAMETER || i % OWN != 0)
                workspace_inputs(one)[i] = workspace_inputs(other)[i] = test_uniform(random, -2, 2);
        if (turn % 6 == 5) { /* after this no run begins in the midst of it */
            workspace_run_joined(one);
            workspace_run_joined(other);
        } else {
            workspace_run(one, from, STAGE_ACCELERATION);
            workspace_run(other, from, STAGE_ACCELERATION);
        }
        EXPECT(memcmp(workspace_roots(one), workspace_roots(other),
                      (size_t)roots * sizeof(double)) == 0);
        if (test_faults > 0)
            return;
    }
}

static void blocks_apart_have_the_same_bits(void)
{
    static const Evaluator evaluators[] = {EVALUATOR_INTERPRETER, EVALUATOR_STRICT,
                                           EVALUATOR_NATIVE};
    uint64_t random = 1124;
    Threads *threads = threads_new();

    for (int turn = 0; turn < 6; turn++) {
        Blocked b = blocked_new(&random);

        for (int parts = 2; parts <= 8; parts += parts < 3 ? 1 : 5) {
            const ProgramBlocks blocks = {b.block, parts};
            Program *plain = NULL, *apart = NULL;
            Workspace *one, *other;
            int operations;

            EXPECT(program_new(b.roots.at, b.roots.count, b.inputs, INPUTS, &plain, NULL) == OK);
            EXPECT(program_new_in_blocks(b.roots.at, b.roots.count, b.inputs, INPUTS, &blocks,
                                         &apart, NULL) == OK);
            EXPECT(program_parts(plain, &operations) == 1 && operations == 0);
            EXPECT(program_parts(apart, &operations) == (parts < BLOCKS ? parts : BLOCKS));
            EXPECT(operations > BLOCKS * CHAIN);
            one = workspace_new(plain);
            other = workspace_new(apart);
            workspace_choose(one, evaluators[turn % COUNT(evaluators)]);
            workspace_choose(other, evaluators[turn % COUNT(evaluators)]);
            threads_set(threads, parts);
            workspace_share(other, threads);
            expect_alike(one, other, b.roots.count, &random);
            workspace_free(one);
            workspace_free(other);
            program_free(plain);
            program_free(apart);
        }
        blocked_free(&b);
    }
    threads_free(threads);
}

/* of two blocks with little to do nothing stands apart */
static void small_work_wakes_nobody(void)
{
    Arena *arena = arena_new();
    const Expr q[] = {expr_symbol(arena, "a", SYMBOL_COORDINATE),
                      expr_symbol(arena, "b", SYMBOL_COORDINATE)};
    const Expr roots[] = {expr_sin(arena, q[0]), expr_sin(arena, q[1])};
    const ProgramBlocks blocks = {(const int[]){1, 2}, 2};
    Program *program = NULL;
    int operations;

    EXPECT(program_new_in_blocks(roots, 2, q, 2, &blocks, &program, NULL) == OK);
    EXPECT(program_parts(program, &operations) == 1);
    program_free(program);
    arena_free(arena);
}

int main(void)
{
    RUN(every_piece_is_done_once);
    RUN(work_within_work_is_done_by_who_asks);
    RUN(sleepers_wake);
    RUN(blocks_apart_have_the_same_bits);
    RUN(small_work_wakes_nobody);
    return test_end();
}

/* symbolic_solve.c: block triangular form, Cramer's rule in small blocks, elimination in others
 *
 * Whether a pivot or a determinant vanishes identically is decided by its value at a point chosen
 * at random. Where Euler parameters occur, sums that are 0, 1 or -1 at two such points are replaced
 * by these numbers, and the inverse of a rotation by its transpose. */
#include "formulate/reduced/symbolic_solve.h"

#include "algebra/block_triangular.h"
#include "base/memory.h"
#include "base/random.h"
#include "formulate/reduced/common_denominator.h"

#include <math.h>
#include <string.h>

enum {
    MOST_COUPLED = 5,  /* equations that are solved by minors */
    MOST_TERMS = 200,  /* of a sum that is multiplied out */
    MOST_TIDIED = 800, /* operations of an expression that is multiplied out at all */
    SETS = 1 << MOST_COUPLED,
    SAMPLES = 2
};
static const double least_open = 1e-12; /* by which numbers at samples may differ from 1 */
static const double least_share = 1e-9; /* of what cancels in a pivot: less is 0 */

typedef struct SymbolicSolve {
    Arena *arena;
    const CallMonitor *watch;
    int n, columns;
    Expr *a, *b, *x;
    bool *solved;      /* by unknown */
    const Expr *units; /* four of each */
    int unit_count;
    struct SymbolicSample {
        const struct SymbolicSolve *solve;
        Evaluation *evaluation;
        uint64_t seed;
    } samples[SAMPLES];
} SymbolicSolve;

/* --- expressions --- */

static Expr smaller(Expr a, Expr b)
{
    return op_count_total(expr_count(&b, 1)) < op_count_total(expr_count(&a, 1)) ? b : a;
}

static Expr tidy_sum(Arena *arena, Expr e)
{
    const Expr folded = expr_collect(arena, expr_fold(arena, e));
    const Expr expanded = expr_fold(arena, expr_expand(arena, e, MOST_TERMS));

    return smaller(folded, expr_collect(arena, expanded));
}

Expr symbolic_tidy(Arena *arena, Expr e)
{
    CommonDenominator denominator = {.bases = {0}};
    Expr under;

    if (op_count_total(expr_count(&e, 1)) > MOST_TIDIED)
        return e;
    if (expr_kind(e) != EXPR_SUM)
        return smaller(e, tidy_sum(arena, e));
    denominator_add(&denominator, e);
    under = denominator_done(arena, &denominator);
    if (expr_is(under, 1))
        return smaller(e, tidy_sum(arena, e));
    return smaller(e, expr_div(arena, tidy_sum(arena, terms_times(arena, e, under)), under));
}

/* --- the sample --- */

static double free_value(uint64_t seed, Expr symbol)
{
    uint64_t state = seed;

    for (const char *c = expr_name(symbol); *c != '\0'; c++)
        state = state * 31 + (unsigned char)*c;
    return 1 + 0.7 * random_unit(&state);
}

static double sample_value(void *context, Expr symbol)
{
    const struct SymbolicSample *sample = context;
    const SymbolicSolve *s = sample->solve;
    double sum = 0;

    for (int i = 0; i < 4 * s->unit_count; i++) {
        const Expr *four = s->units + i / 4 * 4;

        if (s->units[i] != symbol)
            continue;
        for (int k = 0; k < 4; k++)
            sum += free_value(sample->seed, four[k]) * free_value(sample->seed, four[k]);
        return free_value(sample->seed, symbol) / sqrt(sum);
    }
    return free_value(sample->seed, symbol);
}

static double value_of(const SymbolicSolve *s, Expr e)
{
    return evaluation_of(s->samples[0].evaluation, e);
}

/* the sum of the sizes of its terms */
static double size_of(const SymbolicSolve *s, Expr e)
{
    double size = 0;

    if (expr_kind(e) != EXPR_SUM)
        return fabs(value_of(s, e));
    for (int i = 0; i < expr_arg_count(e); i++)
        size += fabs(value_of(s, expr_arg(e, i)));
    return size;
}

static bool vanishes(const SymbolicSolve *s, Expr e)
{
    return expr_is_zero(e) || fabs(value_of(s, e)) <= least_share * size_of(s, e);
}

static bool is_number_at_samples(const SymbolicSolve *s, Expr e, double number)
{
    for (int k = 0; k < SAMPLES; k++)
        if (!(fabs(evaluation_of(s->samples[k].evaluation, e) - number) <= least_open))
            return false;
    return true;
}

static bool reads_units(const SymbolicSolve *s, Expr e)
{
    for (int i = 0; i < 4 * s->unit_count; i++)
        if (expr_depends(e, s->units[i]))
            return true;
    return false;
}

static void samples_open(SymbolicSolve *s)
{
    for (int k = 0; k < SAMPLES; k++) {
        s->samples[k].solve = s;
        s->samples[k].seed = 20261 + (uint64_t)k;
        s->samples[k].evaluation = evaluation_new(sample_value, &s->samples[k]);
    }
}

static void samples_close(SymbolicSolve *s)
{
    for (int k = 0; k < SAMPLES; k++)
        evaluation_free(s->samples[k].evaluation);
}

/* the same, or the number that it is identically */
static Expr not_quite(const SymbolicSolve *s, Expr e)
{
    if (expr_kind(e) != EXPR_SUM)
        return e;
    if (vanishes(s, e))
        return expr_int(s->arena, 0);
    for (int sign = -1; sign <= 1 && reads_units(s, e); sign += 2)
        if (is_number_at_samples(s, e, sign))
            return expr_int(s->arena, sign);
    return e;
}

/* --- blocks --- */

typedef struct SymbolicBlock {
    int size;
    const int *rows; /* each determines the unknown columns[row] */
    const int *columns;
} SymbolicBlock;

static int unknown_at(const SymbolicBlock *block, int i)
{
    return block->columns[block->rows[i]];
}

static Expr entry_at(const SymbolicSolve *s, const SymbolicBlock *block, int i, int j)
{
    return s->a[block->rows[i] * s->n + unknown_at(block, j)];
}

/* Determinant without one row and one unknown (-1: with all), from the last row up, each set of
 * unknowns once (Laplace). */
static Expr minor_of(const SymbolicSolve *s, const SymbolicBlock *block, int but_row,
                     int but_unknown)
{
    const int size = block->size;
    Expr made[SETS];
    int rows[MOST_COUPLED], count = 0;

    for (int r = 0; r < size; r++)
        if (r != but_row)
            rows[count++] = r;
    made[0] = expr_int(s->arena, 1);
    for (int set = 1; set < 1 << size; set++) {
        Expr terms[MOST_COUPLED];
        int members = 0, before = 0, used = 0;

        made[set] = expr_int(s->arena, 0);
        for (int c = 0; c < size; c++)
            members += set >> c & 1;
        if (members > count || (but_unknown >= 0 && (set >> but_unknown & 1) != 0))
            continue;
        for (int c = 0; c < size; c++) {
            Expr factor;

            if ((set >> c & 1) == 0)
                continue;
            factor = entry_at(s, block, rows[members - 1], c);
            before++;
            if (expr_is_zero(factor) || expr_is_zero(made[set & ~(1 << c)]))
                continue;
            factor = expr_mul(s->arena, factor, made[set & ~(1 << c)]);
            terms[used++] = (members - before) % 2 == 0 ? factor : expr_neg(s->arena, factor);
        }
        made[set] = not_quite(s, symbolic_tidy(s->arena, expr_sum(s->arena, terms, used)));
    }
    return made[((1 << size) - 1) & ~(but_unknown >= 0 ? 1 << but_unknown : 0)];
}

/* b of a row without the unknowns that are solved */
static Expr right_of(const SymbolicSolve *s, int row, int column)
{
    Expr sum = s->b[row * s->columns + column];

    for (int u = 0; u < s->n; u++)
        if (s->solved[u] && !expr_is_zero(s->a[row * s->n + u]) &&
            !expr_is_zero(s->x[u * s->columns + column]))
            sum = expr_sub(s->arena, sum,
                           expr_mul(s->arena, s->a[row * s->n + u], s->x[u * s->columns + column]));
    return not_quite(s, symbolic_tidy(s->arena, sum));
}

/* 1 or -1: a block is that multiple of a rotation, whose minors are its entries; 0: it is none. */
static int rotation_sign(const SymbolicSolve *s, const SymbolicBlock *block, const Expr *minors,
                         Expr all)
{
    const int sign = is_number_at_samples(s, all, 1)    ? 1
                     : is_number_at_samples(s, all, -1) ? -1
                                                        : 0;

    if (s->unit_count == 0 || block->size != 3 || sign == 0)
        return 0;
    for (int i = 0; i < 9; i++) {
        const Expr entry = entry_at(s, block, i / 3, i % 3);

        if (!is_number_at_samples(
                s, expr_sub(s->arena, minors[i], sign > 0 ? entry : expr_neg(s->arena, entry)), 0))
            return 0;
    }
    return sign;
}

static Status solve_by_minors(const SymbolicSolve *s, const SymbolicBlock *block, int *unknown)
{
    const int size = block->size;
    Expr terms[MOST_COUPLED], minors[MOST_COUPLED * MOST_COUPLED];
    Expr all = minor_of(s, block, -1, -1);
    int sign;

    if (vanishes(s, all)) {
        *unknown = unknown_at(block, size - 1);
        return E_SINGULAR;
    }
    for (int r = 0; r < size; r++)
        for (int u = 0; u < size; u++) {
            const Expr minor = minor_of(s, block, r, u);

            minors[r * size + u] = (r + u) % 2 == 0 ? minor : expr_neg(s->arena, minor);
        }
    sign = rotation_sign(s, block, minors, all);
    for (int i = 0; i < size * size && sign != 0; i++) {
        const Expr entry = entry_at(s, block, i / size, i % size);

        minors[i] = sign > 0 ? entry : expr_neg(s->arena, entry);
    }
    if (sign != 0)
        all = expr_int(s->arena, sign);
    for (int c = 0; c < s->columns; c++) {
        Expr right[MOST_COUPLED];

        TRY(monitor_poll(s->watch));
        for (int r = 0; r < size; r++)
            right[r] = right_of(s, block->rows[r], c);
        for (int u = 0; u < size; u++) {
            for (int r = 0; r < size; r++)
                terms[r] = expr_mul(s->arena, minors[r * size + u], right[r]);
            s->x[unknown_at(block, u) * s->columns + c] = not_quite(
                s, symbolic_tidy(s->arena,
                                 expr_div(s->arena,
                                          symbolic_tidy(s->arena, expr_sum(s->arena, terms, size)),
                                          all)));
        }
    }
    return OK;
}

/* --- elimination --- */

static Expr temporary(const SymbolicSolve *s, Expr e)
{
    e = not_quite(s, e);
    return expr_name_temporary(s->arena, e);
}

/* the largest pivot at the sample, of those that are left; false: there is none */
static bool choose_pivot(const SymbolicSolve *s, const SymbolicBlock *block, const bool *row_used,
                         const bool *unknown_used, int *row, int *unknown)
{
    double largest = 0;

    for (int i = 0; i < block->size; i++)
        for (int j = 0; j < block->size; j++) {
            const Expr e = entry_at(s, block, i, j);

            if (row_used[i] || unknown_used[j] || vanishes(s, e))
                continue;
            if (fabs(value_of(s, e)) > largest) {
                largest = fabs(value_of(s, e));
                *row = i;
                *unknown = j;
            }
        }
    return largest > 0;
}

static void take_off_row(const SymbolicSolve *s, const SymbolicBlock *block, int from, int pivot,
                         Expr factor, Expr *right)
{
    for (int j = 0; j < block->size; j++) {
        Expr *entry = &s->a[block->rows[from] * s->n + unknown_at(block, j)];
        const Expr above = entry_at(s, block, pivot, j);

        if (!expr_is_zero(above))
            *entry = temporary(s, expr_sub(s->arena, *entry, expr_mul(s->arena, factor, above)));
    }
    for (int c = 0; c < s->columns; c++)
        right[from * s->columns + c] =
            temporary(s, expr_sub(s->arena, right[from * s->columns + c],
                                  expr_mul(s->arena, factor, right[pivot * s->columns + c])));
}

static Status solve_by_elimination(const SymbolicSolve *s, const SymbolicBlock *block, int *unknown)
{
    const int size = block->size;
    bool *row_used = NEW_ARRAY(bool, size), *unknown_used = NEW_ARRAY(bool, size);
    int *pivot_row = NEW_ARRAY(int, size), *pivot_unknown = NEW_ARRAY(int, size);
    Expr *right = NEW_ARRAY(Expr, size * s->columns);
    Status status = OK;

    for (int r = 0; r < size; r++)
        for (int c = 0; c < s->columns; c++)
            right[r * s->columns + c] = temporary(s, right_of(s, block->rows[r], c));
    for (int k = 0; k < size; k++) {
        int p = 0, u = 0;

        CHECK(monitor_poll(s->watch));
        if (!choose_pivot(s, block, row_used, unknown_used, &p, &u)) {
            for (int j = 0; j < size; j++)
                *unknown = unknown_used[j] ? *unknown : unknown_at(block, j);
            status = E_SINGULAR;
            goto done;
        }
        row_used[p] = unknown_used[u] = true;
        pivot_row[k] = p;
        pivot_unknown[k] = u;
        for (int i = 0; i < size; i++) {
            Expr *entry = &s->a[block->rows[i] * s->n + unknown_at(block, u)];
            Expr factor;

            if (row_used[i] || expr_is_zero(*entry))
                continue;
            factor = temporary(s, expr_div(s->arena, *entry, entry_at(s, block, p, u)));
            take_off_row(s, block, i, p, factor, right);
            *entry = expr_int(s->arena, 0);
        }
    }
    for (int k = size - 1; k >= 0; k--)
        for (int c = 0; c < s->columns; c++) {
            const int p = pivot_row[k];
            Expr sum = right[p * s->columns + c];

            for (int l = k + 1; l < size; l++)
                sum =
                    expr_sub(s->arena, sum,
                             expr_mul(s->arena, entry_at(s, block, p, pivot_unknown[l]),
                                      s->x[unknown_at(block, pivot_unknown[l]) * s->columns + c]));
            s->x[unknown_at(block, pivot_unknown[k]) * s->columns + c] =
                temporary(s, expr_div(s->arena, sum, entry_at(s, block, p, pivot_unknown[k])));
        }
done:
    MEM_FREE(row_used, unknown_used, pivot_row, pivot_unknown, right);
    return status;
}

static Status solve_blocks(const SymbolicSolve *s, const int *columns, int *unknown)
{
    const int n = s->n;
    bool *acts = NEW_ARRAY(bool, n *n);
    BlockTriangular blocks;
    Status status = OK;

    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            acts[i * n + j] = !expr_is_zero(s->a[i * n + columns[j]]);
    blocks = block_triangular_find(acts, n);
    for (int b = 0; b < blocks.count; b++) {
        const SymbolicBlock block = {.size = blocks.start[b + 1] - blocks.start[b],
                                     .rows = blocks.order + blocks.start[b],
                                     .columns = columns};

        status = block.size <= MOST_COUPLED ? solve_by_minors(s, &block, unknown)
                                            : solve_by_elimination(s, &block, unknown);
        CHECK(status);
        for (int i = 0; i < block.size; i++)
            s->solved[unknown_at(&block, i)] = true;
    }
done:
    block_triangular_free(&blocks);
    mem_free(acts);
    return status;
}

Status symbolic_solve(Arena *arena, const Expr *a, const Expr *b, int n, int columns,
                      const Expr *units, int unit_count, const CallMonitor *watch, Expr *x,
                      int *unknown)
{
    SymbolicSolve s = {.arena = arena,
                       .watch = watch,
                       .n = n,
                       .columns = columns,
                       .x = x,
                       .units = units,
                       .unit_count = unit_count};
    bool *pattern = NEW_ARRAY(bool, n *n);
    int *column = NEW_ARRAY(int, n);
    Status status = OK;

    s.a = NEW_ARRAY(Expr, n * n);
    s.b = NEW_ARRAY(Expr, n * columns);
    s.solved = NEW_ARRAY(bool, n);
    samples_open(&s);
    *unknown = -1;
    for (int i = 0; i < n * n; i++) {
        s.a[i] = not_quite(&s, a[i]);
        pattern[i] = !expr_is_zero(s.a[i]);
    }
    for (int i = 0; i < n * columns; i++)
        s.b[i] = b[i];
    if (!block_triangular_match(pattern, n, column)) {
        status = E_SINGULAR;
        goto done;
    }
    CHECK(solve_blocks(&s, column, unknown));
done:
    samples_close(&s);
    MEM_FREE(s.a, s.b, s.solved, pattern, column);
    return status;
}

void symbolic_fold_units(Arena *arena, Expr *e, int count, const Expr *units, int unit_count)
{
    SymbolicSolve s = {.arena = arena, .units = units, .unit_count = unit_count};

    samples_open(&s);
    for (int i = 0; i < count; i++)
        e[i] = not_quite(&s, e[i]);
    samples_close(&s);
}

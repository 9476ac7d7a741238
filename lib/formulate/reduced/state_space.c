/* state_space.c: state equations of a linear network, solved in symbols
 *
 * The network's equations are A w = r for w = [x'; z], linear in the states and in the sources,
 * whose values are replaced by symbols. Coupled equations are solved block by block, by Cramer's
 * rule. So the results have no common factors that cancel, except single terms. */
#include "formulate/reduced/state_space.h"

#include "formulate/reduced/common_denominator.h"
#include "formulate/reduced/linear_network.h"

#include <stdlib.h>
#include <string.h>

enum {
    MOST_COUPLED = 9, /* equations that are solved together */
    MOST_LEFT = 400,  /* equations that remain after all equations with one unknown are solved */
    SIZE = 1 << MOST_COUPLED
};

typedef struct Space {
    LinearNetwork net;
    Expr *solution; /* n x columns, by unknown */
    bool *solved;   /* by unknown */
    bool *used;     /* by row */
} Space;

/* --- fractions --- */

/* e * factor, term by term, multiplied out */
static Expr times(Arena *arena, Expr e, Expr factor)
{
    return expr_expand(arena, terms_times(arena, e, factor), LINEAR_TERMS);
}

/* a sum of fractions as one: its numerator multiplied out and collected */
static Expr tidy(Arena *arena, Expr e)
{
    CommonDenominator denominator = {.bases = {0}};
    Expr under;

    if (expr_kind(e) != EXPR_SUM)
        return e;
    denominator_add(&denominator, e);
    under = denominator_done(arena, &denominator);
    return expr_div(arena, expr_collect(arena, times(arena, e, under)), under);
}

/* Multiplies an equation by the denominators of its fractions. */
static void clear_row(Space *s, int row)
{
    CommonDenominator denominator = {.bases = {0}};
    Expr factor;

    for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++)
        denominator_add(&denominator, s->net.entry[k].value);
    for (int c = 0; c < s->net.columns; c++)
        denominator_add(&denominator, s->net.right[row * s->net.columns + c]);
    factor = denominator_done(s->net.arena, &denominator);
    if (expr_is(factor, 1))
        return;
    for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++)
        s->net.entry[k].value = times(s->net.arena, s->net.entry[k].value, factor);
    for (int c = 0; c < s->net.columns; c++)
        s->net.right[row * s->net.columns + c] =
            times(s->net.arena, s->net.right[row * s->net.columns + c], factor);
}

static Status read_rows(Space *s, Diag *diag)
{
    TRY(linear_network_read(&s->net, diag));
    s->solution = mem_array((size_t)s->net.n * (size_t)s->net.columns, sizeof(Expr));
    s->solved = NEW_ARRAY(bool, s->net.n);
    s->used = NEW_ARRAY(bool, s->net.n);
    for (int r = 0; r < s->net.n; r++)
        clear_row(s, r);
    return OK;
}

/* --- blocks --- */

/* a square block of coupled equations */
typedef struct CoupledStates {
    int size;
    int rows[MOST_COUPLED], unknowns[MOST_COUPLED];
} CoupledStates;

static Expr entry_at(const Space *s, int row, int unknown)
{
    for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++)
        if (s->net.entry[k].column == unknown)
            return s->net.entry[k].value;
    return expr_int(s->net.arena, 0);
}

/* Determinant of a block without one row and one unknown (-1: with all), by its rows from the last,
 * each set of unknowns once (Laplace). `made` has room for SIZE. */
static Expr minor_of(const Space *s, const CoupledStates *block, int but_row, int but_unknown,
                     Expr *made)
{
    Arena *arena = s->net.arena;
    const int size = block->size;
    int rows[MOST_COUPLED], count = 0;

    for (int r = 0; r < size; r++)
        if (r != but_row)
            rows[count++] = r;
    made[0] = expr_int(arena, 1);
    for (int set = 1; set < 1 << size; set++) {
        Expr terms[MOST_COUPLED];
        int members = 0, before = 0, used = 0;

        made[set] = expr_int(arena, 0);
        for (int c = 0; c < size; c++)
            members += set >> c & 1;
        if (members > count || (but_unknown >= 0 && (set >> but_unknown & 1) != 0))
            continue;
        /* the last of the rows that a set of this size uses */
        for (int c = 0; c < size; c++) {
            Expr factor;

            if ((set >> c & 1) == 0)
                continue;
            factor = entry_at(s, block->rows[rows[members - 1]], block->unknowns[c]);
            before++;
            if (expr_is_zero(factor))
                continue;
            factor = expr_mul(arena, factor, made[set & ~(1 << c)]);
            terms[used++] = (members - before) % 2 == 0 ? factor : expr_neg(arena, factor);
        }
        made[set] = expr_expand(arena, expr_sum(arena, terms, used), LINEAR_TERMS);
    }
    return made[((1 << size) - 1) & ~(but_unknown >= 0 ? 1 << but_unknown : 0)];
}

/* moves solved unknowns to the right side */
static void move_solved(Space *s, int row)
{
    for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++) {
        const int w = s->net.entry[k].column;

        for (int c = 0; s->solved[w] && c < s->net.columns; c++) {
            const Expr x = s->solution[w * s->net.columns + c];

            if (!expr_is_zero(x))
                s->net.right[row * s->net.columns + c] =
                    expr_sub(s->net.arena, s->net.right[row * s->net.columns + c],
                             expr_mul(s->net.arena, s->net.entry[k].value, x));
        }
    }
}

static Status solve_block(Space *s, const CoupledStates *block, Diag *diag)
{
    Arena *arena = s->net.arena;
    Expr *made = NEW_ARRAY(Expr, SIZE);
    Expr cofactor[MOST_COUPLED * MOST_COUPLED], terms[MOST_COUPLED];
    const Expr all = minor_of(s, block, -1, -1, made);
    Status status = OK;

    if (expr_is_zero(all))
        CHECK(diag_set(diag, E_SINGULAR, "the equation of %s determines nothing",
                       linear_network_part(&s->net, block->rows[0])));
    for (int r = 0; r < block->size; r++) {
        move_solved(s, block->rows[r]);
        for (int c = 0; c < s->net.columns; c++) {
            Expr *right = &s->net.right[block->rows[r] * s->net.columns + c];

            *right = tidy(arena, *right);
        }
        for (int u = 0; u < block->size; u++) {
            const Expr minor = minor_of(s, block, r, u, made);

            cofactor[r * block->size + u] = expr_div(
                arena, (r + u) % 2 == 0 ? minor : expr_neg(arena, minor), expr_collect(arena, all));
        }
        s->used[block->rows[r]] = true;
    }
    for (int u = 0; u < block->size; u++) {
        CHECK(monitor_poll(s->net.watch));
        for (int c = 0; c < s->net.columns; c++) {
            for (int r = 0; r < block->size; r++)
                terms[r] = expr_mul(arena, cofactor[r * block->size + u],
                                    s->net.right[block->rows[r] * s->net.columns + c]);
            s->solution[block->unknowns[u] * s->net.columns + c] =
                tidy(arena, expr_sum(arena, terms, block->size));
        }
    }
    for (int u = 0; u < block->size; u++)
        s->solved[block->unknowns[u]] = true;
done:
    mem_free(made);
    return status;
}

/* Solves rows with one remaining unknown, as long as there are any. */
static Status solve_chains(Space *s, Diag *diag)
{
    bool goes_on = true;

    while (goes_on) {
        goes_on = false;
        for (int r = 0; r < s->net.n; r++) {
            CoupledStates one = {.size = 0, .rows = {r}};

            for (int k = s->net.row_start[r]; !s->used[r] && k < s->net.row_start[r + 1]; k++)
                if (!s->solved[s->net.entry[k].column]) {
                    one.unknowns[0] = s->net.entry[k].column;
                    one.size++;
                }
            if (one.size != 1)
                continue;
            TRY(solve_block(s, &one, diag));
            goes_on = true;
        }
    }
    return OK;
}

/* --- coupled equations --- */

/* Remaining rows, an unknown for each, and which others each needs. */
typedef struct Rest {
    int count;
    int *rows;
    int *row_of;     /* by unknown: index of the row that determines it, or -1 */
    int *unknown_of; /* by index */
    bool *tried;     /* by unknown */
    bool *needs;     /* count x count, transitive */
} Rest;

/* Assigns an unknown to a row, and if needed other unknowns to other rows (Kuhn 1955). The
 * recursion is as deep as there are rows, which are few. */
static bool assign(const Space *s, Rest *rest, int place)
{
    const int row = rest->rows[place];

    for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++) {
        const int w = s->net.entry[k].column;

        if (s->solved[w] || rest->tried[w])
            continue;
        rest->tried[w] = true;
        if (rest->row_of[w] < 0 || assign(s, rest, rest->row_of[w])) {
            rest->row_of[w] = place;
            rest->unknown_of[place] = w;
            return true;
        }
    }
    return false;
}

static Status find_needs(const Space *s, Rest *rest, Diag *diag)
{
    const int n = rest->count;

    for (int p = 0; p < n; p++) {
        memset(rest->tried, 0, (size_t)s->net.n * sizeof(bool));
        if (!assign(s, rest, p))
            return diag_set(diag, E_SINGULAR, "the equation of %s determines nothing",
                            linear_network_part(&s->net, rest->rows[p]));
    }
    for (int p = 0; p < n; p++) {
        const int row = rest->rows[p];

        rest->needs[p * n + p] = true;
        for (int k = s->net.row_start[row]; k < s->net.row_start[row + 1]; k++)
            if (!s->solved[s->net.entry[k].column])
                rest->needs[p * n + rest->row_of[s->net.entry[k].column]] = true;
    }
    for (int k = 0; k < n; k++)
        for (int p = 0; p < n; p++)
            for (int o = 0; rest->needs[p * n + k] && o < n; o++)
                rest->needs[p * n + o] = rest->needs[p * n + o] || rest->needs[k * n + o];
    return OK;
}

static int need_count(const Rest *rest, int place)
{
    int count = 0;

    for (int o = 0; o < rest->count; o++)
        count += rest->needs[place * rest->count + o];
    return count;
}

static Status too_many(const Space *s, int row, Diag *diag)
{
    (void)diag_set(diag, E_MODEL,
                   "too many equations of the network are coupled, that of %s among them, to be "
                   "solved in symbols",
                   linear_network_part(&s->net, row));
    diag_hint(diag, "'linearize' solves them in numbers");
    return E_MODEL;
}

/* blocks of mutually dependent equations, in order of dependence */
static Status solve_blocks(Space *s, Rest *rest, Diag *diag)
{
    for (int needed = 1; needed <= rest->count; needed++)
        for (int p = 0; p < rest->count; p++) {
            CoupledStates block = {.size = 0};

            if (s->used[rest->rows[p]] || need_count(rest, p) != needed)
                continue;
            for (int o = 0; o < rest->count; o++) {
                if (!rest->needs[p * rest->count + o] || !rest->needs[o * rest->count + p])
                    continue;
                if (block.size == MOST_COUPLED)
                    TRY(too_many(s, rest->rows[p], diag));
                block.rows[block.size] = rest->rows[o];
                block.unknowns[block.size++] = rest->unknown_of[o];
            }
            TRY(solve_block(s, &block, diag));
        }
    return OK;
}

static Status solve_rest(Space *s, Diag *diag)
{
    Rest rest = {.rows = NEW_ARRAY(int, s->net.n),
                 .row_of = NEW_ARRAY(int, s->net.n),
                 .unknown_of = NEW_ARRAY(int, s->net.n),
                 .tried = NEW_ARRAY(bool, s->net.n)};
    Status status = OK;

    for (int r = 0; r < s->net.n; r++) {
        rest.row_of[r] = -1;
        if (!s->used[r])
            rest.rows[rest.count++] = r;
    }
    if (rest.count > MOST_LEFT)
        CHECK(too_many(s, rest.rows[0], diag));
    rest.needs = NEW_ARRAY(bool, rest.count *rest.count);
    CHECK(find_needs(s, &rest, diag));
    CHECK(solve_blocks(s, &rest, diag));
done:
    MEM_FREE(rest.rows, rest.row_of, rest.unknown_of, rest.tried, rest.needs);
    return status;
}

/* --- result --- */

static StateSpace *take_solution(const Space *s)
{
    const int n = system_nx(s->net.system), inputs = s->net.sources.count;
    StateSpace *out = NEW(StateSpace);

    out->states = n;
    out->inputs = inputs;
    out->state = NEW_ARRAY(Expr, n);
    out->input = NEW_ARRAY(Expr, inputs);
    out->a = NEW_ARRAY(Expr, n * n);
    for (int i = 0; i < n; i++) {
        out->state[i] = system_x(s->net.system, i)->symbol;
        for (int j = 0; j < n; j++)
            out->a[i * n + j] = s->solution[i * s->net.columns + j];
    }
    for (int k = 0; k < inputs; k++)
        out->input[k] = s->net.symbols.at[INPUT_ORDERS * k];
    for (int order = 0; order < INPUT_ORDERS; order++) {
        out->b[order] = NEW_ARRAY(Expr, n * inputs);
        for (int i = 0; i < n; i++)
            for (int k = 0; k < inputs; k++) {
                const Expr entry = s->solution[i * s->net.columns + n + INPUT_ORDERS * k + order];

                out->b[order][i * inputs + k] = entry;
                out->has[order] = out->has[order] || !expr_is_zero(entry);
            }
    }
    return out;
}

void state_space_free(StateSpace *space)
{
    if (space == NULL)
        return;
    MEM_FREE(space->state, space->input, space->a);
    for (int order = 0; order < INPUT_ORDERS; order++)
        mem_free(space->b[order]);
    mem_free(space);
}

/* the network must have states */
static Status check_states(const Space *s, Diag *diag)
{
    if (system_nx(s->net.system) > 0)
        return OK;
    (void)diag_set(diag, E_MODEL,
                   system_nz(s->net.system) + s->net.sources.count > 0 ? "the network has no states"
                                                                       : "there is no network");
    diag_hint(diag, "states are the voltages of capacitors and the currents of inductors");
    return E_MODEL;
}

Status state_space_new(const Scene *scene, const CallMonitor *watch, StateSpace **out, Diag *diag)
{
    Space s = {.solution = NULL};
    Status status;

    CHECK(linear_network_form(scene, false, watch, &s.net, diag));
    CHECK(check_states(&s, diag));
    CHECK(read_rows(&s, diag));
    CHECK(solve_chains(&s, diag));
    CHECK(solve_rest(&s, diag));
    *out = take_solution(&s);
done:
    linear_network_free(&s.net);
    MEM_FREE(s.solution, s.solved, s.used);
    return status;
}

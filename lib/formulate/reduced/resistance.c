/* resistance.c: articulated inertia, turned, shifted, and reduced by eliminated unknowns
 *
 * A turn about one of the axes uses the difference of the blocks of its plane. With d = p - q and g
 * = s d + 2 c r, [p, r; r, q] becomes [p - s g, c g - r; ., q + s g]. */
#include "formulate/reduced/resistance.h"
#include "formulate/kinematics/frames.h"

#include "formulate/system/kinematics.h"
#include "formulate/system/system_impl.h"

#include <string.h>

static Expr get(const Resistance *r, int i, int j)
{
    return r->A[i * r->count + j];
}

static void put(Arena *arena, Resistance *r, int i, int j, Expr value)
{
    r->A[i * r->count + j] = r->A[j * r->count + i] = expr_name_temporary(arena, value);
}

static void resize(Arena *arena, Resistance *r, int count)
{
    Expr *A = NEW_ARRAY(Expr, count * count);
    const int kept = count < r->count ? count : r->count;

    for (int i = 0; i < count * count; i++)
        A[i] = expr_int(arena, 0);
    for (int i = 0; i < kept; i++)
        memcpy(A + (ptrdiff_t)i * count, r->A + (ptrdiff_t)i * r->count,
               (size_t)kept * sizeof(Expr));
    mem_free(r->A);
    r->A = A;
    r->b = mem_grow(r->b, (size_t)count, sizeof(Expr));
    r->speeds = mem_grow(r->speeds, (size_t)count, sizeof(int));
    for (int i = kept; i < count; i++)
        r->b[i] = expr_int(arena, 0);
    r->count = count;
}

void resistance_init(Arena *arena, Resistance *r)
{
    *r = (Resistance){0};
    resize(arena, r, MOTION);
}

void resistance_free(Resistance *r)
{
    MEM_FREE(r->A, r->b, r->speeds);
    *r = (Resistance){0};
}

void resistance_add_body(Arena *arena, Resistance *r, const Group *group)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Expr S = group->moment.at[k];

        put(arena, r, SHIFT + i, SHIFT + i,
            expr_add(arena, get(r, SHIFT + i, SHIFT + i), group->mass));
        put(arena, r, i, SHIFT + j, expr_sub(arena, get(r, i, SHIFT + j), S));
        put(arena, r, j, SHIFT + i, expr_add(arena, get(r, j, SHIFT + i), S));
        for (int l = i; l < 3; l++)
            put(arena, r, i, l, expr_add(arena, get(r, i, l), group->inertia.at[3 * i + l]));
    }
}

void resistance_add(Arena *arena, Resistance *r, Resistance *part)
{
    const int first = r->count, more = part->count - MOTION;

    if (more > 0)
        resize(arena, r, first + more);
    for (int i = 0; i < part->count; i++) {
        const int row = i < MOTION ? i : first + i - MOTION;

        for (int j = i; j < part->count; j++) {
            const int column = j < MOTION ? j : first + j - MOTION;

            put(arena, r, row, column, expr_add(arena, get(r, row, column), get(part, i, j)));
        }
        r->b[row] = expr_name_temporary(arena, expr_add(arena, r->b[row], part->b[i]));
        if (i >= MOTION)
            r->speeds[row - MOTION] = part->speeds[i - MOTION];
    }
    resistance_free(part);
}

/* --- rows as vectors --- */

static Vec rows_at(const Resistance *r, int first, int column)
{
    return (Vec){{get(r, first, column), get(r, first + 1, column), get(r, first + 2, column)}};
}

static void put_rows(Arena *arena, Resistance *r, int first, int column, Vec v)
{
    for (int i = 0; i < 3; i++)
        put(arena, r, first + i, column, v.at[i]);
}

static Vec right_at(const Resistance *r, int first)
{
    return (Vec){{r->b[first], r->b[first + 1], r->b[first + 2]}};
}

static void put_right(Arena *arena, Resistance *r, int first, Vec v)
{
    for (int i = 0; i < 3; i++)
        r->b[first + i] = expr_name_temporary(arena, v.at[i]);
}

void resistance_add_speed(Arena *arena, Resistance *r, int speed, Vec turn, Vec shift)
{
    const int own = r->count;
    Expr *row = NEW_ARRAY(Expr, own);

    for (int c = 0; c < own; c++)
        row[c] = expr_name_temporary(arena, expr_add(arena, vec_dot(arena, turn, rows_at(r, 0, c)),
                                                     vec_dot(arena, shift, rows_at(r, SHIFT, c))));
    resize(arena, r, own + 1);
    r->speeds[own - MOTION] = speed;
    for (int c = 0; c < own; c++)
        put(arena, r, own, c, row[c]);
    put(arena, r, own, own,
        expr_add(arena, vec_dot(arena, turn, rows_at(r, 0, own)),
                 vec_dot(arena, shift, rows_at(r, SHIFT, own))));
    r->b[own] = expr_name_temporary(arena, expr_add(arena, vec_dot(arena, turn, right_at(r, 0)),
                                                    vec_dot(arena, shift, right_at(r, SHIFT))));
    mem_free(row);
}

void resistance_confine(Arena *arena, Resistance *r, const bool *moves)
{
    for (int i = 0; i < MOTION; i++) {
        if (moves[i])
            continue;
        for (int j = 0; j < r->count; j++)
            put(arena, r, i, j, expr_int(arena, 0));
        r->b[i] = expr_int(arena, 0);
    }
}

/* --- a turn --- */

typedef struct Kernel {
    int i, j;
    Expr c, s; /* of the angle from i to j */
} Kernel;

static void turn_pair(Arena *arena, const Kernel *turn, Expr *x, Expr *y)
{
    const Expr a = *x, b = *y;

    *x = expr_name_temporary(
        arena, expr_sub(arena, expr_mul(arena, turn->c, a), expr_mul(arena, turn->s, b)));
    *y = expr_name_temporary(
        arena, expr_add(arena, expr_mul(arena, turn->s, a), expr_mul(arena, turn->c, b)));
}

/* the block of rows i, j and columns k, l that turn together */
static void turn_block(Arena *arena, const Kernel *turn, Resistance *r, int i, int j, int k, int l)
{
    const Expr d = expr_name_temporary(arena, expr_sub(arena, get(r, i, k), get(r, j, l)));
    const Expr e = expr_name_temporary(arena, expr_add(arena, get(r, i, l), get(r, j, k)));
    const Expr g = expr_name_temporary(
        arena, expr_add(arena, expr_mul(arena, turn->s, d), expr_mul(arena, turn->c, e)));
    const Expr sg = expr_name_temporary(arena, expr_mul(arena, turn->s, g));
    const Expr cg = expr_name_temporary(arena, expr_mul(arena, turn->c, g));
    const Expr il = get(r, i, l), jk = get(r, j, k);

    put(arena, r, i, k, expr_sub(arena, get(r, i, k), sg));
    put(arena, r, j, l, expr_add(arena, get(r, j, l), sg));
    put(arena, r, i, l, expr_sub(arena, cg, jk));
    if (i != k)
        put(arena, r, j, k, expr_sub(arena, cg, il));
}

static void turn_about_axis(Arena *arena, const Kernel *turn, Resistance *r)
{
    for (int half = 0; half <= SHIFT; half += SHIFT) {
        const int i = half + turn->i, j = half + turn->j;

        turn_block(arena, turn, r, i, j, i, j);
        if (half == 0)
            turn_block(arena, turn, r, i, j, SHIFT + i, SHIFT + j);
        for (int c = 0; c < r->count; c++) {
            Expr x = get(r, i, c), y = get(r, j, c);

            if (c < MOTION && (c % SHIFT == turn->i || c % SHIFT == turn->j))
                continue;
            turn_pair(arena, turn, &x, &y);
            put(arena, r, i, c, x);
            put(arena, r, j, c, y);
        }
        turn_pair(arena, turn, &r->b[i], &r->b[j]);
    }
}

/* first the rows, then the columns */
static void turn_any(const System *system, Resistance *r, int from, int to)
{
    Arena *arena = system->arena;
    Expr *half = NEW_ARRAY(Expr, MOTION * r->count);

    for (int c = 0; c < r->count; c++)
        for (int k = 0; k < MOTION; k += SHIFT) {
            const Vec v = vec_carry_held(system, rows_at(r, k, c), from, to);

            for (int i = 0; i < 3; i++)
                half[(k + i) * r->count + c] = v.at[i];
        }
    for (int i = 0; i < MOTION; i++) {
        const Expr *row = half + (ptrdiff_t)i * r->count;

        for (int k = 0; k < MOTION; k += SHIFT) {
            const Vec v = vec_carry(system, (Vec){{row[k], row[k + 1], row[k + 2]}}, from, to);

            for (int j = 0; j < 3; j++)
                if (k + j >= i)
                    put(arena, r, i, k + j, v.at[j]);
        }
        for (int c = MOTION; c < r->count; c++)
            put(arena, r, i, c, row[c]);
    }
    for (int k = 0; k < MOTION; k += SHIFT)
        put_right(arena, r, k, vec_carry(system, right_at(r, k), from, to));
    mem_free(half);
}

void resistance_turn(const System *system, Resistance *r, int from, int to)
{
    Arena *arena = system->arena;
    Turns turns = {0};

    if (from == to)
        return;
    turns_between(system, to, from, &turns);
    for (int i = 0; i < 3 && turns.count == 1 && turns.at[0].matrix == NULL; i++) {
        const Turn *turn = &turns.at[0];
        const bool back = expr_is(turn->axis.at[i], -1);

        if (back || expr_is(turn->axis.at[i], 1)) {
            const Expr s = expr_sin(arena, turn->angle);
            const Kernel kernel = {(i + 1) % 3, (i + 2) % 3, expr_cos(arena, turn->angle),
                                   back ? expr_neg(arena, s) : s};

            turn_about_axis(arena, &kernel, r);
            turns.count = 0;
        }
    }
    if (turns.count > 0)
        turn_any(system, r, from, to);
    LIST_FREE(turns);
}

/* the current a is a + alpha x way: H increases by way x M, then J by way x H^T + H' way^T */
void resistance_shift(Arena *arena, Resistance *r, Vec way)
{
    Rotation before;

    if (vec_is_zero(way))
        return;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            before.at[3 * i + j] = get(r, i, SHIFT + j);
    for (int c = SHIFT; c < r->count; c++)
        put_rows(arena, r, 0, c,
                 vec_add(arena, rows_at(r, 0, c), vec_cross(arena, way, rows_at(r, SHIFT, c))));
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            const Vec old = {{before.at[3 * j], before.at[3 * j + 1], before.at[3 * j + 2]}};
            const Vec new = rows_at(r, SHIFT, i);
            Expr terms[3] = {get(r, i, j), vec_cross(arena, way, old).at[i],
                             vec_cross(arena, way, new).at[j]};

            put(arena, r, i, j, expr_sum(arena, terms, 3));
        }
    put_right(arena, r, 0,
              vec_add(arena, right_at(r, 0), vec_cross(arena, way, right_at(r, SHIFT))));
}

/* --- elimination --- */

static void give_up(Arena *arena, Resistance *r, int unknown)
{
    for (int i = unknown; i + 1 < r->count; i++) {
        for (int j = 0; j < r->count; j++)
            r->A[i * r->count + j] = r->A[(i + 1) * r->count + j];
        r->b[i] = r->b[i + 1];
        r->speeds[i - MOTION] = r->speeds[i + 1 - MOTION];
    }
    for (int i = 0; i < r->count; i++)
        for (int j = unknown; j + 1 < r->count; j++)
            r->A[i * r->count + j] = r->A[i * r->count + j + 1];
    resize(arena, r, r->count - 1);
}

bool resistance_yield(Arena *arena, Resistance *r, int unknown, Yield *out)
{
    const Expr D = get(r, unknown, unknown);
    bool moves[MOTION];

    if (expr_is_zero(D))
        return false;
    *out = (Yield){.unknown = unknown, .count = r->count};
    out->inverse = expr_name_temporary(arena, expr_div(arena, expr_int(arena, 1), D));
    out->right = r->b[unknown];
    out->factor = NEW_ARRAY(Expr, r->count);
    out->speeds = NEW_ARRAY(int, r->count);
    memcpy(out->speeds, r->speeds, (size_t)(r->count - MOTION) * sizeof(int));
    for (int i = 0; i < r->count; i++)
        out->factor[i] =
            expr_name_temporary(arena, expr_mul(arena, get(r, i, unknown), out->inverse));
    for (int i = 0; i < r->count; i++) {
        if (i == unknown || expr_is_zero(out->factor[i]))
            continue;
        for (int j = i; j < r->count; j++)
            if (j != unknown)
                put(arena, r, i, j,
                    expr_sub(arena, get(r, i, j),
                             expr_mul(arena, out->factor[i], get(r, j, unknown))));
        r->b[i] = expr_name_temporary(
            arena, expr_sub(arena, r->b[i], expr_mul(arena, out->factor[i], out->right)));
    }
    for (int i = 0; i < MOTION; i++)
        moves[i] = i != unknown;
    if (unknown < MOTION)
        resistance_confine(arena, r, moves);
    else
        give_up(arena, r, unknown);
    return true;
}

void yield_free(Yield *yield)
{
    MEM_FREE(yield->factor, yield->speeds);
}

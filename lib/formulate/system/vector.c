/* vector.c: three expressions as a vector, nine as a rotation */
#include "formulate/system/vector.h"

Vec vec_zero(Arena *arena)
{
    Expr zero = expr_int(arena, 0);

    return (Vec){{zero, zero, zero}};
}

bool vec_is_zero(Vec a)
{
    return expr_is_zero(a.at[0]) && expr_is_zero(a.at[1]) && expr_is_zero(a.at[2]);
}

bool vec_same(Vec a, Vec b)
{
    return a.at[0] == b.at[0] && a.at[1] == b.at[1] && a.at[2] == b.at[2];
}

Vec vec_add(Arena *arena, Vec a, Vec b)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = expr_add(arena, a.at[i], b.at[i]);
    return a;
}

Vec vec_sub(Arena *arena, Vec a, Vec b)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = expr_sub(arena, a.at[i], b.at[i]);
    return a;
}

Vec vec_scale(Arena *arena, Expr s, Vec a)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = expr_mul(arena, s, a.at[i]);
    return a;
}

Vec vec_neg(Arena *arena, Vec a)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = expr_neg(arena, a.at[i]);
    return a;
}

Vec vec_cross(Arena *arena, Vec a, Vec b)
{
    Vec c;

    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        c.at[i] =
            expr_sub(arena, expr_mul(arena, a.at[j], b.at[k]), expr_mul(arena, a.at[k], b.at[j]));
    }
    return c;
}

Expr vec_dot(Arena *arena, Vec a, Vec b)
{
    Expr terms[3];

    for (int i = 0; i < 3; i++)
        terms[i] = expr_mul(arena, a.at[i], b.at[i]);
    return expr_sum(arena, terms, 3);
}

Vec vec_hold(Arena *arena, Vec a)
{
    for (int i = 0; i < 3; i++)
        a.at[i] = expr_name_temporary(arena, a.at[i]);
    return a;
}

Rotation rotation_one(Arena *arena)
{
    Rotation one;

    for (int i = 0; i < 9; i++)
        one.at[i] = expr_int(arena, i % 4 == 0);
    return one;
}

Rotation rotation_product(Arena *arena, const Rotation *a, const Rotation *b)
{
    Rotation c;

    if (rotation_is_one(a) || rotation_is_one(b))
        return rotation_is_one(a) ? *b : *a;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            Expr terms[3];

            for (int k = 0; k < 3; k++)
                terms[k] = expr_mul(arena, a->at[3 * i + k], b->at[3 * k + j]);
            c.at[3 * i + j] = expr_sum(arena, terms, 3);
        }
    return c;
}

Rotation rotation_transpose(const Rotation *a)
{
    Rotation t;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t.at[3 * i + j] = a->at[3 * j + i];
    return t;
}

Vec rotation_apply(Arena *arena, const Rotation *a, Vec b)
{
    Vec c;

    if (rotation_is_one(a))
        return b;
    for (int i = 0; i < 3; i++) {
        Expr terms[3];

        for (int k = 0; k < 3; k++)
            terms[k] = expr_mul(arena, a->at[3 * i + k], b.at[k]);
        c.at[i] = expr_sum(arena, terms, 3);
    }
    return c;
}

bool rotation_is_one(const Rotation *a)
{
    const Expr one = a->at[0], zero = a->at[1];

    /* all from one arena: equal numbers are the same node */
    for (int i = 1; i < 9; i++)
        if (a->at[i] != (i % 4 == 0 ? one : zero))
            return false;
    return expr_is(one, 1) && expr_is_zero(zero);
}

Rotation inertia_turned(Arena *arena, const Rotation *z, const Expr tensor[6])
{
    Rotation inertia = {{tensor[0], tensor[3], tensor[4], tensor[3], tensor[1], tensor[5],
                         tensor[4], tensor[5], tensor[2]}};
    Rotation back = rotation_transpose(z);

    if (rotation_is_one(z))
        return inertia;
    inertia = rotation_product(arena, z, &inertia);
    return rotation_product(arena, &inertia, &back);
}

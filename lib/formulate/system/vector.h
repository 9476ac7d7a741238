/* vector.h: vectors and rotations of expressions */
#ifndef COTREE_FORMULATE_SYSTEM_VECTOR_H
#define COTREE_FORMULATE_SYSTEM_VECTOR_H

#include "expr/expr.h"

typedef struct Vec {
    Expr at[3];
} Vec;

typedef struct Rotation {
    Expr at[9]; /* row by row */
} Rotation;

Vec vec_zero(Arena *arena);
bool vec_is_zero(Vec a);
Vec vec_add(Arena *arena, Vec a, Vec b);
Vec vec_sub(Arena *arena, Vec a, Vec b);
Vec vec_scale(Arena *arena, Expr s, Vec a);
Vec vec_neg(Arena *arena, Vec a);
Vec vec_cross(Arena *arena, Vec a, Vec b);
Expr vec_dot(Arena *arena, Vec a, Vec b);
Vec vec_hold(Arena *arena, Vec a);
bool vec_same(Vec a, Vec b);
Rotation rotation_one(Arena *arena);
Rotation rotation_product(Arena *arena, const Rotation *a, const Rotation *b);
Rotation rotation_transpose(const Rotation *a);
Vec rotation_apply(Arena *arena, const Rotation *a, Vec b);
bool rotation_is_one(const Rotation *a);
Rotation inertia_turned(Arena *arena, const Rotation *z, const Expr tensor[6]); /* Z I Z^T */

#endif

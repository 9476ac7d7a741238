/* euler_parameters.c: Euler parameters of frames: the product of those of their turns
 *
 * p = (e0, e), 4 x 1, of unit length: e0 = cos(a/2) and e = k sin(a/2) for a turn by a (rad) about
 * k. */
#include "formulate/kinematics/coordinate.h"
#include "formulate/system/kinematics.h"
#include "formulate/system/sample.h"
#include "formulate/system/system_impl.h"
#include "formulate/system/vector.h"

/* a b, scalar part first */
static void parameters_product(Arena *arena, Expr a[4], const Expr b[4])
{
    Vec av = {{a[1], a[2], a[3]}};
    Vec bv = {{b[1], b[2], b[3]}};
    Vec v = vec_add(arena, vec_scale(arena, a[0], bv), vec_scale(arena, b[0], av));

    v = vec_add(arena, v, vec_cross(arena, av, bv));
    a[0] = expr_sub(arena, expr_mul(arena, a[0], b[0]), vec_dot(arena, av, bv));
    for (int i = 0; i < 3; i++)
        a[1 + i] = v.at[i];
}

/* Euler parameters of a constant rotation, from its trace or, where the first of them is small,
 * from the diagonal entry that leaves the largest (Shepperd 1978) */
static void parameters_of(const System *system, const Rotation *rotation, Expr p[4])
{
    Arena *arena = system->arena;
    const Expr *R = rotation->at;
    Expr half = expr_rational(arena, 1, 2);
    Sample *now = sample_new(system, 1, false);
    Expr one = expr_int(arena, 1);
    Expr square = expr_sum(arena, (Expr[]){R[0], R[4], R[8], one}, 4); /* of 2 e0 */
    int i = 0;
    int j;
    int k;

    if (sample_number(now, square) >= 1) {
        Expr scale = expr_sqrt(arena, square);

        p[0] = expr_mul(arena, half, scale);
        for (i = 0; i < 3; i++) {
            j = (i + 1) % 3;
            k = (i + 2) % 3;
            p[1 + i] = expr_mul(
                arena, half, expr_div(arena, expr_sub(arena, R[3 * k + j], R[3 * j + k]), scale));
        }
        return;
    }
    for (int other = 1; other < 3; other++)
        if (sample_number(now, R[4 * other]) > sample_number(now, R[4 * i]))
            i = other;
    j = (i + 1) % 3;
    k = (i + 2) % 3;
    square = expr_sub(arena, expr_add(arena, one, R[4 * i]), expr_add(arena, R[4 * j], R[4 * k]));
    half = expr_div(arena, half, expr_sqrt(arena, square));
    /* the first one remains positive */
    if (sample_number(now, R[3 * k + j]) < sample_number(now, R[3 * j + k]))
        half = expr_neg(arena, half);
    p[0] = expr_mul(arena, half, expr_sub(arena, R[3 * k + j], R[3 * j + k]));
    p[1 + i] = expr_mul(arena, half, square);
    p[1 + j] = expr_mul(arena, half, expr_add(arena, R[3 * j + i], R[3 * i + j]));
    p[1 + k] = expr_mul(arena, half, expr_add(arena, R[3 * k + i], R[3 * i + k]));
}

void frame_parameters(const System *system, int node, Expr p[4])
{
    Arena *arena = system->arena;
    const Frame *frame = &system->kinematics->frames[node];
    Expr constant[4];

    parameters_of(system, &frame->zero, p);
    for (int c = frame->chain; c > 0; c = system->kinematics->chains.at[c].parent) {
        const OrientationClass *chain = &system->kinematics->chains.at[c];
        Expr half = expr_mul(arena, expr_rational(arena, 1, 2),
                             chain->is_free ? expr_int(arena, 0) : chain->angle);
        Expr turn[4];

        for (int i = 0; i < 4; i++) {
            constant[i] = p[i];
            if (chain->is_free)
                turn[i] = chain->parameter[i];
            else
                turn[i] = i == 0 ? expr_cos(arena, half)
                                 : expr_mul(arena, expr_sin(arena, half), chain->axis.at[i - 1]);
        }
        parameters_product(arena, turn, constant);
        for (int i = 0; i < 4; i++)
            p[i] = expr_name_temporary(arena, turn[i]);
    }
}

void relative_parameters(const System *system, int tail, int head, Expr p[4])
{
    Expr far[4];

    frame_parameters(system, tail, p);
    frame_parameters(system, head, far);
    for (int i = 1; i < 4; i++)
        p[i] = expr_neg(system->arena, p[i]);
    parameters_product(system->arena, p, far);
}

/* rotation_vector.c: rotation vector, without a singularity at 0
 *
 * With c = cos(theta) = (tr R - 1)/2 and s = sin(theta) a = vee(R - R^T)/2,
 *
 *     phi = f(c) s,   f = theta/sin(theta)
 *
 * f is analytic at c = 1, and a formula with acos() is not. Halved three times, with C, D and E the
 * cosines of theta/2, theta/4 and theta/8,
 *
 *     f = 2 G(y)/(C D E (1 + E)),   y = tan^2(theta/16) = (1 - E)/(1 + E)
 *
 * where G(y) = atan(sqrt y)/sqrt y = P(y)/Q(y), its Pade approximant of degrees 3 and 4. For theta
 * up to pi, y is below 0.04, and the relative error 1.2e-16 there.
 *
 * With the angular velocity w of the head, R' = [w] R, so that c' = -s.w and
 * s' = (tr R - R) w/2. phi' = A w, and the moment of an effort e along phi is A^T e. */
#include "formulate/kinematics/rotation_vector.h"

enum { P_DEGREE = 3, Q_DEGREE = 4, HALVINGS = 3 };

/* coefficients of P and Q, from the constant on */
static const int64_t p_of[] = {225225, 345345, 147455, 15159};
static const int64_t q_of[] = {225225, 420420, 242550, 44100, 1225};

/* a polynomial and its derivative by y, by Horner's rule */
static void polynomial(Arena *arena, const int64_t *c, int degree, Expr y, Expr *value, Expr *slope)
{
    *value = expr_int(arena, c[degree]);
    *slope = expr_int(arena, 0);
    for (int i = degree - 1; i >= 0; i--) {
        *slope = expr_name_temporary(arena, expr_add(arena, *value, expr_mul(arena, y, *slope)));
        *value = expr_name_temporary(
            arena, expr_add(arena, expr_int(arena, c[i]), expr_mul(arena, y, *value)));
    }
}

/* f, df/dc and C */
static void ratio_of(Arena *arena, Expr c, RotationVector *out)
{
    const Expr one = expr_int(arena, 1), half = expr_rational(arena, 1, 2);
    Expr cosine = c, rate = one, below = one, below_rate = expr_int(arena, 0);
    Expr y, y_rate, p, p_y, q, q_y, G, G_rate, rest;

    /* `below` is C D E, below_rate the rate of its logarithm by c */
    for (int i = 0; i < HALVINGS; i++) {
        const Expr square = expr_mul(arena, half, expr_add(arena, one, cosine));

        cosine = expr_name_temporary(arena, expr_sqrt(arena, square));
        rate = expr_name_temporary(
            arena, expr_div(arena, rate, expr_mul(arena, expr_int(arena, 4), cosine)));
        below = expr_mul(arena, below, cosine);
        below_rate = expr_add(arena, below_rate, expr_div(arena, rate, cosine));
        if (i == 0)
            out->half_cos = cosine;
    }
    rest = expr_add(arena, one, cosine);
    y = expr_name_temporary(arena, expr_div(arena, expr_sub(arena, one, cosine), rest));
    y_rate = expr_div(arena, expr_mul(arena, expr_int(arena, -2), rate), expr_square(arena, rest));
    below = expr_name_temporary(arena, expr_mul(arena, below, rest));
    below_rate =
        expr_name_temporary(arena, expr_add(arena, below_rate, expr_div(arena, rate, rest)));
    polynomial(arena, p_of, P_DEGREE, y, &p, &p_y);
    polynomial(arena, q_of, Q_DEGREE, y, &q, &q_y);
    G = expr_name_temporary(arena, expr_div(arena, p, q));
    G_rate =
        expr_mul(arena, y_rate, expr_div(arena, expr_sub(arena, p_y, expr_mul(arena, G, q_y)), q));
    rest = expr_name_temporary(arena, expr_div(arena, expr_int(arena, 2), below));
    out->ratio = expr_name_temporary(arena, expr_mul(arena, G, rest));
    out->slope = expr_name_temporary(arena, expr_sub(arena, expr_mul(arena, G_rate, rest),
                                                     expr_mul(arena, out->ratio, below_rate)));
}

void rotation_vector_of(Arena *arena, const Expr turn[9], RotationVector *out)
{
    static const int row[3] = {2, 0, 1}, column[3] = {1, 2, 0};
    const Expr half = expr_rational(arena, 1, 2);
    const Expr trace = expr_sum(arena, (Expr[]){turn[0], turn[4], turn[8]}, 3);

    for (int i = 0; i < 9; i++)
        out->turn.at[i] = turn[i];
    for (int i = 0; i < 3; i++) {
        const Expr twice =
            expr_sub(arena, turn[3 * row[i] + column[i]], turn[3 * column[i] + row[i]]);

        out->sine.at[i] = expr_name_temporary(arena, expr_mul(arena, half, twice));
    }
    ratio_of(arena,
             expr_name_temporary(arena,
                                 expr_mul(arena, half, expr_sub(arena, trace, expr_int(arena, 1)))),
             out);
    out->at = vec_hold(arena, vec_scale(arena, out->ratio, out->sine));
}

static Expr trace(Arena *arena, const Rotation *turn)
{
    return expr_sum(arena, (Expr[]){turn->at[0], turn->at[4], turn->at[8]}, 3);
}

/* (f/2) (tr R - M) a - f_c s (s.a) for M = R or its transpose */
static Vec turned(Arena *arena, const RotationVector *phi, const Rotation *matrix, Vec a)
{
    const Expr half = expr_mul(arena, expr_rational(arena, 1, 2), phi->ratio);
    const Expr along = expr_mul(arena, phi->slope, vec_dot(arena, phi->sine, a));
    const Vec whole =
        vec_sub(arena, vec_scale(arena, trace(arena, matrix), a), rotation_apply(arena, matrix, a));

    return vec_hold(
        arena, vec_sub(arena, vec_scale(arena, half, whole), vec_scale(arena, along, phi->sine)));
}

Vec rotation_vector_rate(Arena *arena, const RotationVector *phi, Vec w)
{
    return turned(arena, phi, &phi->turn, w);
}

Vec rotation_vector_moment(Arena *arena, const RotationVector *phi, Vec effort)
{
    const Rotation back = rotation_transpose(&phi->turn);

    return turned(arena, phi, &back, effort);
}

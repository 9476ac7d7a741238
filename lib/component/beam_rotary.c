/* beam_rotary.c: rotary inertia of a beam's sections
 *
 * Lagrange's equations in quasi-velocities of the root, with the angular velocity of a section to
 * second order in its angles c, b, a about x, y, z, untruncated after that (theory 9). */
#include "base/memory.h"
#include "component/beam_graded.h"

typedef struct BeamRotaryAngles {
    Graded angle[3], turning[3]; /* c, b, a about x, y, z; their rates */
    Graded *turn;                /* d angle/d q of its own angle, of each shape */
} BeamRotaryAngles;

static void add_shape(const GradedShapes *along, BeamRotaryAngles *f, int i)
{
    const BeamShape *shape = &along->beam->shapes[i];
    const int t = beam_angle(shape);
    Expr *slope = NULL;

    if (t < 0)
        return;
    if (t == 0)
        slope = parts_of(along, &shape->value);
    else
        parts_add(
            along, &slope, parts_of(along, &shape->slope),
            expr_div(along->arena, expr_int(along->arena, t == 1 ? -1 : 1), along->beam->length));
    f->turn[i].at[0] = slope;
    parts_add(along, &f->angle[t].at[1], slope, along->state->q[i]);
    parts_add(along, &f->turning[t].at[1], slope, along->state->rate[i]);
}

static BeamRotaryAngles angles_of(const GradedShapes *along)
{
    BeamRotaryAngles f = {.turn =
                              pool_alloc(along->pool, (size_t)along->beam->count * sizeof(Graded))};

    for (int i = 0; i < along->beam->count; i++)
        add_shape(along, &f, i);
    for (int k = 0; k < 3; k++) {
        f.angle[k] = graded_hold(along, f.angle[k]);
        f.turning[k] = graded_hold(along, f.turning[k]);
    }
    return f;
}

typedef struct Spin {
    Graded A[3][3], C[3][3]; /* omega = A w + C theta', theta = (c, b, a) */
    Graded A_rate[3][3];
    Graded omega[3], rest[3]; /* and its rate at zero accelerations */
    Graded left[3][3];        /* d/dt C - d omega/d theta, of each angle */
} Spin;

/* dA/dtheta_k, or its rate along `by`, from the entries of A = 1 - S(theta) + B */
static Graded slope_A(const GradedShapes *along, const Graded theta[3], int r, int s, int k)
{
    Graded out = {{NULL}};

    if (r == s) { /* 1 - (sum of the squares of the two others)/2 */
        if (k != r)
            out = graded_scaled(along, expr_int(along->arena, -1), theta[k]);
        return out;
    }
    if (k != r && k != s) /* -S(theta) */
        out = graded_constant(along, s == (r + 1) % 3 ? 1 : -1);
    /* of b c at (1, 0), a c at (2, 0), a b at (2, 1) */
    if (r > s && (k == r || k == s))
        out = graded_plus(along, out, 1, theta[k == r ? s : r]);
    return out;
}

static void spin_of(const GradedShapes *along, const BeamRotaryAngles *f, Spin *spin)
{
    const Graded *theta = f->angle, *rate = f->turning;
    const Expr half = expr_rational(along->arena, 1, 2);
    Graded own[3] = {{{NULL}}}; /* the rate of C theta' at theta'' = 0 */

    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) {
            Graded linear = {{NULL}}, square = {{NULL}};

            for (int k = 0; k < 3; k++) {
                Graded slope = slope_A(along, theta, r, s, k), zero = {{slope.at[0]}},
                       one = {{NULL, slope.at[1]}};

                linear = graded_plus(along, linear, 1, graded_times(along, zero, theta[k]));
                square = graded_plus(along, square, 1, graded_times(along, one, theta[k]));
                spin->A_rate[r][s] =
                    graded_plus(along, spin->A_rate[r][s], 1, graded_times(along, slope, rate[k]));
            }
            spin->A[r][s] = r == s ? graded_constant(along, 1) : (Graded){{NULL}};
            spin->A[r][s] = graded_plus(along, spin->A[r][s], 1, linear);
            spin->A[r][s] = graded_hold(
                along, graded_plus(along, spin->A[r][s], 1, graded_scaled(along, half, square)));
            spin->A_rate[r][s] = graded_hold(along, spin->A_rate[r][s]);
        }
    /* C theta' = (c' - b a', b' + c a', a' - c b') */
    for (int k = 0; k < 3; k++)
        spin->C[k][k] = graded_constant(along, 1);
    spin->C[0][2] = graded_scaled(along, expr_int(along->arena, -1), theta[1]);
    spin->C[1][2] = theta[0];
    spin->C[2][1] = graded_scaled(along, expr_int(along->arena, -1), theta[0]);
    own[0] =
        graded_scaled(along, expr_int(along->arena, -1), graded_times(along, rate[1], rate[2]));
    own[1] = graded_times(along, rate[0], rate[2]);
    own[2] =
        graded_scaled(along, expr_int(along->arena, -1), graded_times(along, rate[0], rate[1]));
    for (int r = 0; r < 3; r++) {
        spin->rest[r] = own[r];
        for (int s = 0; s < 3; s++) {
            graded_add(along, &spin->omega[r], spin->A[r][s], along->state->w[s]);
            graded_add(along, &spin->rest[r], spin->A_rate[r][s], along->state->w[s]);
            spin->omega[r] =
                graded_plus(along, spin->omega[r], 1, graded_times(along, spin->C[r][s], rate[s]));
        }
        spin->omega[r] = graded_hold(along, spin->omega[r]);
        spin->rest[r] = graded_hold(along, spin->rest[r]);
    }
    /* C' minus the derivatives of C theta', then of A w */
    spin->left[0][1] = rate[2];
    spin->left[1][0] = graded_scaled(along, expr_int(along->arena, -1), rate[2]);
    spin->left[2][0] = rate[1];
    spin->left[0][2] = graded_scaled(along, expr_int(along->arena, -1), rate[1]);
    spin->left[1][2] = rate[0];
    spin->left[2][1] = graded_scaled(along, expr_int(along->arena, -1), rate[0]);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            for (int s = 0; s < 3; s++)
                graded_add(along, &spin->left[r][k], slope_A(along, theta, r, s, k),
                           expr_neg(along->arena, along->state->w[s]));
            spin->left[r][k] = graded_hold(along, spin->left[r][k]);
        }
}

/* adds the section's component r, whose inertia per length is J */
static void add_rotary(const GradedShapes *along, const BeamRotaryAngles *f, const Spin *spin,
                       int r, const Weights *weights, ShapeInertia *out)
{
    Arena *arena = along->arena;
    const int count = along->beam->count;
    const Expr *w = along->state->w, J = weights->factor;
    Expr momentum[3];

    for (int s = 0; s < 3; s++) {
        Graded torque = graded_plus(along, graded_times(along, spin->A_rate[r][s], spin->omega[r]),
                                    1, graded_times(along, spin->A[r][s], spin->rest[r]));

        for (int t = 0; t < 3; t++)
            beam_add(along, &out->inertia[3 * s + t], J,
                     graded_integral(along, weights,
                                     graded_times(along, spin->A[r][s], spin->A[r][t]), 0,
                                     along->limit[0]));
        momentum[s] = graded_integral(
            along, weights, graded_times(along, spin->A[r][s], spin->omega[r]), 0, along->limit[0]);
        beam_add(along, &out->bias_torque[s], J,
                 graded_integral(along, weights, torque, 0, along->limit[0]));
    }
    for (int s = 0; s < 3; s++) {
        const int a = (s + 1) % 3, b = (s + 2) % 3;
        Expr turned =
            expr_sub(arena, expr_mul(arena, w[a], momentum[b]), expr_mul(arena, w[b], momentum[a]));

        beam_add(along, &out->bias_torque[s], J, turned);
    }
    for (int i = 0; i < count; i++) {
        const int k = beam_angle(&along->beam->shapes[i]);
        Graded push, own;

        if (k < 0)
            continue;
        own = graded_times(along, spin->C[r][k], f->turn[i]);
        push = graded_plus(along, graded_times(along, spin->left[r][k], spin->omega[r]), 1,
                           graded_times(along, spin->C[r][k], spin->rest[r]));
        beam_add(along, &out->bias[i], J,
                 graded_integral(along, weights, graded_times(along, f->turn[i], push), 0,
                                 along->limit[1]));
        for (int s = 0; s < 3; s++)
            beam_add(along, &out->with_turn[3 * i + s], J,
                     graded_integral(along, weights, graded_times(along, own, spin->A[r][s]), 0,
                                     along->limit[1]));
        for (int j = 0; j <= i; j++) {
            const int l = beam_angle(&along->beam->shapes[j]);

            if (l >= 0)
                beam_add(
                    along, &out->block[i * count + j], J,
                    graded_integral(
                        along, weights,
                        graded_times(along, own, graded_times(along, spin->C[r][l], f->turn[j])), 1,
                        along->limit[2]));
        }
    }
}

void beam_add_rotary(const GradedShapes *along, const Powers J[3], ShapeInertia *out)
{
    const BeamRotaryAngles f = angles_of(along);
    Spin spin = {0};

    spin_of(along, &f, &spin);
    for (int r = 0; r < 3; r++)
        if (J[r].count > 1 || !expr_is_zero(J[r].at[0])) {
            const Weights weights = weights_of(along, &J[r]);

            add_rotary(along, &f, &spin, r, &weights, out);
        }
}

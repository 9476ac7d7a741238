/* beam_inertia.c: what a beam hands over to the equations of motion
 *
 * A quantity along the beam is a Graded: parts of rising order in shapes and their rates, each by
 * its coefficients over xi, so that integrals are exact, or where those are many by its values at
 * the points of a Gauss rule that is exact for it. Translation follows d'Alembert with the field of
 * the axis, rotary inertia Lagrange's equations in quasi-velocities of the root; what the user
 * wants linear is cut by order (theory 9). */
#include "base/memory.h"
#include "component/beam.h"

#include <gsl/gsl_integration.h>

#include <string.h>

enum {
    ORDERS = 5,     /* 0..4: products of two that go up to the second */
    MOST_EXACT = 3, /* shapes of a family with which integrals are written out */
};

typedef struct Graded {
    Expr *at[ORDERS]; /* NULL: nothing of that order */
} Graded;

typedef struct Along {
    Beam beam;
    Arena *arena;
    Pool *pool;
    bool is_exact;
    int length; /* coefficients or points */
    double *points, *weights;
    const ShapeState *state;
    int limit[3]; /* orders of what the root feels, of its coupling with shapes, of shapes */
} Along;

/* --- algebra of what varies along the beam --- */

static Expr *parts_new(const Along *along)
{
    Expr *parts = pool_alloc(along->pool, (size_t)along->length * sizeof *parts);

    for (int k = 0; k < along->length; k++)
        parts[k] = expr_int(along->arena, 0);
    return parts;
}

static Expr *parts_of(const Along *along, const Polynomial *p)
{
    Expr *parts = parts_new(along);

    for (int k = 0; k < along->length; k++) {
        if (along->is_exact && k < p->count)
            parts[k] = beam_number(along->arena, p->at[k]);
        else if (!along->is_exact)
            parts[k] = expr_real(along->arena, polynomial_value(p, along->points[k]));
    }
    return parts;
}

static void parts_add(const Along *along, Expr **to, const Expr *parts, Expr scale)
{
    if (parts == NULL || expr_is_zero(scale))
        return;
    if (*to == NULL)
        *to = parts_new(along);
    for (int k = 0; k < along->length; k++)
        (*to)[k] = expr_add(along->arena, (*to)[k], expr_mul(along->arena, scale, parts[k]));
}

static void parts_hold(const Along *along, Expr *parts)
{
    for (int k = 0; parts != NULL && k < along->length; k++)
        parts[k] = expr_hold(along->arena, parts[k]);
}

static Graded graded_hold(const Along *along, Graded g)
{
    for (int d = 0; d < ORDERS; d++)
        parts_hold(along, g.at[d]);
    return g;
}

static void graded_add(const Along *along, Graded *to, Graded g, Expr scale)
{
    for (int d = 0; d < ORDERS; d++)
        parts_add(along, &to->at[d], g.at[d], scale);
}

static Graded plus(const Along *along, Graded a, int sign, Graded b)
{
    Graded sum = {{NULL}};

    graded_add(along, &sum, a, expr_int(along->arena, 1));
    graded_add(along, &sum, b, expr_int(along->arena, sign));
    return sum;
}

static Graded scaled(const Along *along, Expr scale, Graded a)
{
    Graded out = {{NULL}};

    graded_add(along, &out, a, scale);
    return out;
}

static void parts_multiply(const Along *along, Expr **to, const Expr *a, const Expr *b)
{
    Arena *arena = along->arena;

    if (*to == NULL)
        *to = parts_new(along);
    for (int i = 0; i < along->length; i++)
        for (int j = 0; j < along->length; j++) {
            const int k = along->is_exact ? i + j : i;

            if ((!along->is_exact && i != j) || expr_is_zero(a[i]) || expr_is_zero(b[j]) ||
                k >= along->length)
                continue;
            (*to)[k] = expr_add(arena, (*to)[k], expr_mul(arena, a[i], b[j]));
        }
}

static Graded times(const Along *along, Graded a, Graded b)
{
    Graded out = {{NULL}};

    for (int i = 0; i < ORDERS; i++)
        for (int j = 0; i + j < ORDERS; j++)
            if (a.at[i] != NULL && b.at[j] != NULL && i + j <= along->limit[0])
                parts_multiply(along, &out.at[i + j], a.at[i], b.at[j]);
    return graded_hold(along, out);
}

/* over x from 0 to L, of orders from..most */
static Expr integral(const Along *along, Graded g, int from, int most)
{
    Arena *arena = along->arena;
    Expr sum = expr_int(arena, 0);

    for (int d = from; d < ORDERS && d <= most; d++)
        for (int k = 0; g.at[d] != NULL && k < along->length; k++)
            sum = expr_add(arena, sum,
                           expr_mul(arena,
                                    along->is_exact ? expr_rational(arena, 1, k + 1)
                                                    : expr_real(arena, along->weights[k]),
                                    g.at[d][k]));
    return expr_hold(arena, expr_mul(arena, along->beam.length, sum));
}

static Graded constant(const Along *along, int value)
{
    Polynomial one = polynomial_power(0);
    Graded g = {{NULL}};

    g.at[0] = parts_of(along, &one);
    polynomial_free(&one);
    return scaled(along, expr_int(along->arena, value), g);
}

/* --- fields --- */

typedef struct Fields {
    Graded p[3], rate[3], left[3]; /* of the axis: where, p', what is left of p'' at q'' = 0 */
    Graded angle[3], turning[3];   /* c, b, a about x, y, z; their rates */
    Graded (*move)[3];             /* d p/d q, of each shape */
    Graded *turn;                  /* d angle/d q of its own angle */
} Fields;

/* of which angle (x, y, z) is a shape */
static int angle_of(const BeamShape *shape)
{
    static const int of[SHAPE_FAMILIES] = {-1, 2, 1, 0};

    return of[shape->family];
}

static void add_shape(const Along *along, Fields *f, int i)
{
    static const int shifted[SHAPE_FAMILIES] = {0, 1, 2, -1};
    Arena *arena = along->arena;
    const BeamShape *shape = &along->beam.shapes[i];
    const int s = shifted[shape->family], t = angle_of(shape);
    Expr *value = parts_of(along, &shape->value);

    if (s >= 0) {
        f->move[i][s].at[0] = value;
        parts_add(along, &f->p[s].at[1], value, along->state->q[i]);
        parts_add(along, &f->rate[s].at[1], value, along->state->rate[i]);
    }
    if (t >= 0) {
        Expr inverse = expr_div(arena, expr_int(arena, t == 1 ? -1 : 1), along->beam.length);
        Expr *slope = t == 0 ? value : NULL;

        if (t > 0)
            parts_add(along, &slope, parts_of(along, &shape->slope), inverse);
        f->turn[i].at[0] = slope;
        parts_add(along, &f->angle[t].at[1], slope, along->state->q[i]);
        parts_add(along, &f->turning[t].at[1], slope, along->state->rate[i]);
    }
}

static void shorten(const Along *along, Fields *f)
{
    Arena *arena = along->arena;
    const Beam *beam = &along->beam;

    for (int i = 0; i < beam->count; i++) {
        Expr *moved = NULL, *rate = NULL;

        for (int j = 0; j < beam->count && beam_bends(&beam->shapes[i]); j++) {
            Polynomial s;
            Expr *parts;

            if (beam->shapes[j].family != beam->shapes[i].family)
                continue;
            s = beam_shortening(&beam->shapes[i], &beam->shapes[j]);
            parts = parts_of(along, &s);
            polynomial_free(&s);
            parts_add(along, &moved, parts,
                      expr_div(arena, expr_neg(arena, along->state->q[j]), beam->length));
            parts_add(along, &rate, parts,
                      expr_div(arena, expr_neg(arena, along->state->rate[j]), beam->length));
        }
        if (moved == NULL)
            continue;
        parts_hold(along, moved);
        parts_hold(along, rate);
        f->move[i][0].at[1] = moved;
        parts_add(along, &f->p[0].at[2], moved,
                  expr_mul(arena, expr_rational(arena, 1, 2), along->state->q[i]));
        parts_add(along, &f->rate[0].at[2], moved, along->state->rate[i]);
        parts_add(along, &f->left[0].at[2], rate, along->state->rate[i]);
    }
}

static Fields fields_of(const Along *along)
{
    const size_t count = (size_t)along->beam.count;
    Polynomial x = polynomial_power(1);
    Fields f = {.move = pool_alloc(along->pool, count * sizeof(Graded[3])),
                .turn = pool_alloc(along->pool, count * sizeof(Graded))};

    parts_add(along, &f.p[0].at[0], parts_of(along, &x), along->beam.length);
    polynomial_free(&x);
    for (int i = 0; i < along->beam.count; i++)
        add_shape(along, &f, i);
    if (along->beam.shortens)
        shorten(along, &f);
    for (int k = 0; k < 3; k++) {
        f.p[k] = graded_hold(along, f.p[k]);
        f.rate[k] = graded_hold(along, f.rate[k]);
        f.left[k] = graded_hold(along, f.left[k]);
        f.angle[k] = graded_hold(along, f.angle[k]);
        f.turning[k] = graded_hold(along, f.turning[k]);
    }
    return f;
}

/* --- vectors along the beam --- */

static void cross(const Along *along, const Graded a[3], const Graded b[3], Graded out[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out[i] = plus(along, times(along, a[j], b[k]), -1, times(along, a[k], b[j]));
    }
}

static Graded dot(const Along *along, const Graded a[3], const Graded b[3])
{
    Graded sum = {{NULL}};

    for (int i = 0; i < 3; i++)
        sum = plus(along, sum, 1, times(along, a[i], b[i]));
    return sum;
}

/* w x a, of the root's angular velocity */
static void spun(const Along *along, const Graded a[3], Graded out[3])
{
    const Expr *w = along->state->w;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out[i] = graded_hold(along,
                             plus(along, scaled(along, w[j], a[k]), -1, scaled(along, w[k], a[j])));
    }
}

/* --- translation --- */

/* R^T(p'' of a point) where root and shapes don't accelerate: w x (w x p) + 2 w x p' + left */
static void bias_of(const Along *along, const Fields *f, Graded out[3])
{
    Graded turned[3], twice[3];

    spun(along, f->p, turned);
    for (int k = 0; k < 3; k++)
        turned[k] = plus(along, turned[k], 1, scaled(along, expr_int(along->arena, 2), f->rate[k]));
    spun(along, turned, twice);
    for (int k = 0; k < 3; k++)
        out[k] = graded_hold(along, plus(along, twice[k], 1, f->left[k]));
}

static void add(const Along *along, Expr *to, Expr factor, Expr what)
{
    *to = expr_add(along->arena, *to, expr_mul(along->arena, factor, what));
}

/* int (p.p 1 - p p') */
static void add_tensor(const Along *along, const Fields *f, Expr density, ShapeInertia *out)
{
    Expr product[3][3];

    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++)
            product[i][j] = product[j][i] =
                integral(along, times(along, f->p[i], f->p[j]), 0, along->limit[0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            Expr entry = i != j ? expr_neg(along->arena, product[i][j])
                                : expr_add(along->arena, product[a][a], product[b][b]);

            if (!along->beam.planar || (i == 2 && j == 2))
                add(along, &out->inertia[3 * i + j], density, entry);
        }
}

static void add_translation(const Along *along, const Fields *f, Expr density, ShapeInertia *out)
{
    const int count = along->beam.count;
    Graded bias[3], moment[3];

    bias_of(along, f, bias);
    cross(along, f->p, bias, moment);
    add_tensor(along, f, density, out);
    for (int k = 0; k < 3; k++) {
        out->spread[k] = integral(along, f->p[k], 0, along->limit[0]);
        add(along, &out->moment[k], density, out->spread[k]);
        add(along, &out->bias_force[k], density, integral(along, bias[k], 0, along->limit[0]));
        add(along, &out->bias_torque[k], density, integral(along, moment[k], 0, along->limit[0]));
    }
    for (int i = 0; i < count; i++) {
        Graded arm[3];

        cross(along, f->p, f->move[i], arm);
        for (int k = 0; k < 3; k++) {
            out->spread_shift[3 * i + k] = integral(along, f->move[i][k], 0, along->limit[1]);
            add(along, &out->with_shift[3 * i + k], density, out->spread_shift[3 * i + k]);
            add(along, &out->with_turn[3 * i + k], density,
                integral(along, arm[k], 0, along->limit[1]));
        }
        add(along, &out->bias[i], density,
            integral(along, dot(along, f->move[i], bias), 0, along->limit[1]));
        for (int j = 0; j <= i; j++)
            add(along, &out->block[i * count + j], density,
                integral(along, times(along, f->move[i][0], f->move[j][0]), 1, along->limit[2]));
    }
}

/* --- rotary inertia --- */

typedef struct Spin {
    Graded A[3][3], C[3][3]; /* omega = A w + C theta', theta = (c, b, a) */
    Graded A_rate[3][3];
    Graded omega[3], rest[3]; /* and its rate where nothing accelerates */
    Graded left[3][3];        /* d/dt C - d omega/d theta, of each angle */
} Spin;

/* d A/d theta_k, or its rate along `by`, from the entries of A = 1 - S(theta) + B */
static Graded slope_A(const Along *along, const Graded theta[3], int r, int s, int k)
{
    Graded out = {{NULL}};

    if (r == s) { /* 1 - (sum of the squares of the two others)/2 */
        if (k != r)
            out = scaled(along, expr_int(along->arena, -1), theta[k]);
        return out;
    }
    if (k != r && k != s) /* -S(theta) */
        out = constant(along, s == (r + 1) % 3 ? 1 : -1);
    /* of b c at (1, 0), a c at (2, 0), a b at (2, 1) */
    if (r > s && (k == r || k == s))
        out = plus(along, out, 1, theta[k == r ? s : r]);
    return out;
}

static void spin_of(const Along *along, const Fields *f, Spin *spin)
{
    const Graded *theta = f->angle, *rate = f->turning;
    const Expr half = expr_rational(along->arena, 1, 2);
    Graded own[3] = {{{NULL}}}; /* what is left of C theta' */

    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) {
            Graded linear = {{NULL}}, square = {{NULL}};

            for (int k = 0; k < 3; k++) {
                Graded slope = slope_A(along, theta, r, s, k), zero = {{slope.at[0]}},
                       one = {{NULL, slope.at[1]}};

                linear = plus(along, linear, 1, times(along, zero, theta[k]));
                square = plus(along, square, 1, times(along, one, theta[k]));
                spin->A_rate[r][s] =
                    plus(along, spin->A_rate[r][s], 1, times(along, slope, rate[k]));
            }
            spin->A[r][s] = r == s ? constant(along, 1) : (Graded){{NULL}};
            spin->A[r][s] = plus(along, spin->A[r][s], 1, linear);
            spin->A[r][s] =
                graded_hold(along, plus(along, spin->A[r][s], 1, scaled(along, half, square)));
            spin->A_rate[r][s] = graded_hold(along, spin->A_rate[r][s]);
        }
    /* C theta' = (c' - b a', b' + c a', a' - c b') */
    for (int k = 0; k < 3; k++)
        spin->C[k][k] = constant(along, 1);
    spin->C[0][2] = scaled(along, expr_int(along->arena, -1), theta[1]);
    spin->C[1][2] = theta[0];
    spin->C[2][1] = scaled(along, expr_int(along->arena, -1), theta[0]);
    own[0] = scaled(along, expr_int(along->arena, -1), times(along, rate[1], rate[2]));
    own[1] = times(along, rate[0], rate[2]);
    own[2] = scaled(along, expr_int(along->arena, -1), times(along, rate[0], rate[1]));
    for (int r = 0; r < 3; r++) {
        spin->rest[r] = own[r];
        for (int s = 0; s < 3; s++) {
            graded_add(along, &spin->omega[r], spin->A[r][s], along->state->w[s]);
            graded_add(along, &spin->rest[r], spin->A_rate[r][s], along->state->w[s]);
            spin->omega[r] = plus(along, spin->omega[r], 1, times(along, spin->C[r][s], rate[s]));
        }
        spin->omega[r] = graded_hold(along, spin->omega[r]);
        spin->rest[r] = graded_hold(along, spin->rest[r]);
    }
    /* C' less the derivatives of C theta', then of A w */
    spin->left[0][1] = rate[2];
    spin->left[1][0] = scaled(along, expr_int(along->arena, -1), rate[2]);
    spin->left[2][0] = rate[1];
    spin->left[0][2] = scaled(along, expr_int(along->arena, -1), rate[1]);
    spin->left[1][2] = rate[0];
    spin->left[2][1] = scaled(along, expr_int(along->arena, -1), rate[0]);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) {
            for (int s = 0; s < 3; s++)
                graded_add(along, &spin->left[r][k], slope_A(along, theta, r, s, k),
                           expr_neg(along->arena, along->state->w[s]));
            spin->left[r][k] = graded_hold(along, spin->left[r][k]);
        }
}

/* of the section's component r, whose inertia per length is J */
static void add_rotary(const Along *along, const Fields *f, const Spin *spin, int r, Expr J,
                       ShapeInertia *out)
{
    Arena *arena = along->arena;
    const int count = along->beam.count;
    const Expr *w = along->state->w;
    Expr momentum[3];

    for (int s = 0; s < 3; s++) {
        Graded torque = plus(along, times(along, spin->A_rate[r][s], spin->omega[r]), 1,
                             times(along, spin->A[r][s], spin->rest[r]));

        for (int t = 0; t < 3; t++)
            add(along, &out->inertia[3 * s + t], J,
                integral(along, times(along, spin->A[r][s], spin->A[r][t]), 0, along->limit[0]));
        momentum[s] =
            integral(along, times(along, spin->A[r][s], spin->omega[r]), 0, along->limit[0]);
        add(along, &out->bias_torque[s], J, integral(along, torque, 0, along->limit[0]));
    }
    for (int s = 0; s < 3; s++) {
        const int a = (s + 1) % 3, b = (s + 2) % 3;
        Expr turned =
            expr_sub(arena, expr_mul(arena, w[a], momentum[b]), expr_mul(arena, w[b], momentum[a]));

        add(along, &out->bias_torque[s], J, turned);
    }
    for (int i = 0; i < count; i++) {
        const int k = angle_of(&along->beam.shapes[i]);
        Graded push, own;

        if (k < 0)
            continue;
        own = times(along, spin->C[r][k], f->turn[i]);
        push = plus(along, times(along, spin->left[r][k], spin->omega[r]), 1,
                    times(along, spin->C[r][k], spin->rest[r]));
        add(along, &out->bias[i], J,
            integral(along, times(along, f->turn[i], push), 0, along->limit[1]));
        for (int s = 0; s < 3; s++)
            add(along, &out->with_turn[3 * i + s], J,
                integral(along, times(along, own, spin->A[r][s]), 0, along->limit[1]));
        for (int j = 0; j <= i; j++) {
            const int l = angle_of(&along->beam.shapes[j]);

            if (l >= 0)
                add(along, &out->block[i * count + j], J,
                    integral(along, times(along, own, times(along, spin->C[r][l], f->turn[j])), 1,
                             along->limit[2]));
        }
    }
}

/* --- constants: exact whatever the number of shapes --- */

static Expr gram(const Along *along, const Polynomial *a, const Polynomial *b, int power)
{
    Expr number;
    mpq_t sum;

    mpq_init(sum);
    polynomial_integral(a, b, 0, sum);
    number = beam_number(along->arena, sum);
    mpq_clear(sum);
    return expr_mul(along->arena, number,
                    expr_pow(along->arena, along->beam.length, expr_int(along->arena, power)));
}

static Expr mass_entry(const Along *along, int i, int j, Expr density, const Expr J[3])
{
    const BeamShape *a = &along->beam.shapes[i], *b = &along->beam.shapes[j];
    const int t = angle_of(a);
    Expr sum = expr_int(along->arena, 0);

    if (a->family != b->family)
        return sum;
    if (a->family != SHAPE_PHI)
        add(along, &sum, density, gram(along, &a->value, &b->value, 1));
    if (t == 0)
        add(along, &sum, J[0], gram(along, &a->value, &b->value, 1));
    else if (t > 0)
        add(along, &sum, J[t], gram(along, &a->slope, &b->slope, -1));
    return sum;
}

static Expr stiffness_entry(const Along *along, int i, int j)
{
    static const char *const keys[SHAPE_FAMILIES] = {"EA", "EIz", "EIy", "GJ"};
    const BeamShape *a = &along->beam.shapes[i], *b = &along->beam.shapes[j];
    Expr entry;

    if (a->family != b->family)
        return expr_int(along->arena, 0);
    entry = beam_bends(a) ? gram(along, &a->curve, &b->curve, -3)
                          : gram(along, &a->slope, &b->slope, -1);
    return expr_mul(along->arena, instance_scalar(along->beam.instance, keys[a->family]), entry);
}

static void add_constants(const Along *along, Expr density, const Expr J[3], ShapeInertia *out)
{
    Arena *arena = along->arena;
    const Value *damping = instance_value(along->beam.instance, "damping");
    const int count = along->beam.count;
    const Expr *q = along->state->q, *rate = along->state->rate;

    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            Expr m = mass_entry(along, i, j, density, J), k = stiffness_entry(along, i, j);
            Expr bent = expr_mul(arena, k, q[j]), lost = expr_int(arena, 0);

            if (j <= i)
                out->block[i * count + j] = expr_add(arena, out->block[i * count + j], m);
            if (damping->count == 2)
                lost = expr_mul(arena,
                                expr_add(arena, expr_mul(arena, damping->at[0], m),
                                         expr_mul(arena, damping->at[1], k)),
                                rate[j]);
            out->stress[i] = expr_sub(arena, out->stress[i], bent);
            out->push[i] = expr_sub(arena, out->push[i], expr_add(arena, bent, lost));
            add(along, &out->stored, expr_mul(arena, expr_rational(arena, 1, 2), q[i]), bent);
        }
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++)
            out->block[i * count + j] = out->block[j * count + i];
}

/* --- all --- */

static void clear(const Along *along, Expr *at, int count)
{
    for (int i = 0; i < count; i++)
        at[i] = expr_int(along->arena, 0);
}

static void clear_all(const Along *along, ShapeInertia *out)
{
    const int count = along->beam.count;

    clear(along, out->moment, 3);
    clear(along, out->inertia, 9);
    clear(along, out->bias_force, 3);
    clear(along, out->bias_torque, 3);
    clear(along, out->with_shift, 3 * count);
    clear(along, out->with_turn, 3 * count);
    clear(along, out->block, count * count);
    clear(along, out->bias, count);
    clear(along, out->push, count);
    clear(along, out->stress, count);
    clear(along, &out->stored, 1);
}

/* how products are kept: exactly where the shapes are few */
static void choose_form(Along *along)
{
    int degree = 1, most = 0;

    for (int i = 0; i < along->beam.count; i++) {
        const int own = along->beam.shapes[i].value.count - 1;

        degree = own > degree ? own : degree;
        most = own - (beam_bends(&along->beam.shapes[i]) ? 1 : 0) > most ? own : most;
    }
    along->is_exact = degree <= MOST_EXACT + 1;
    /* s goes like v'^2, integrated; the longest products are s^2 and a^4 */
    along->length = along->is_exact ? 4 * degree + 1 : 2 * degree + 1;
    if (!along->is_exact) {
        gsl_integration_glfixed_table *rule =
            gsl_integration_glfixed_table_alloc((size_t)along->length);

        along->points = pool_alloc(along->pool, (size_t)along->length * sizeof(double));
        along->weights = pool_alloc(along->pool, (size_t)along->length * sizeof(double));
        for (int k = 0; k < along->length; k++)
            (void)gsl_integration_glfixed_point(0, 1, (size_t)k, &along->points[k],
                                                &along->weights[k], rule);
        gsl_integration_glfixed_table_free(rule);
    }
}

void beam_inertia(const Instance *instance, Arena *arena, bool planar, const ShapeState *state,
                  ShapeInertia *out)
{
    const Value *rotary = instance_value(instance, "inertia_per_length");
    const Value *load = instance_value(instance, "load");
    const Expr density = instance_scalar(instance, "mass_per_length");
    const Expr zero = expr_int(arena, 0);
    Expr J[3] = {zero, zero, zero};
    Along along = {.beam = beam_open(instance, arena, planar), .arena = arena, .state = state};
    Fields f;
    Spin spin = {0};

    along.pool = pool_new(0);
    for (int k = 0; k < 3; k++)
        along.limit[k] = along.beam.limit == LIMITLESS ? LIMITLESS : along.beam.limit - k;
    choose_form(&along);
    clear_all(&along, out);
    for (int k = 0; k < rotary->count && k < 3; k++)
        J[planar ? 2 : k] = rotary->at[k];
    out->mass = expr_mul(arena, density, along.beam.length);
    out->length = load->given ? along.beam.length : NULL;
    for (int k = 0; k < 3; k++)
        out->load[k] = load->given && k < load->count ? load->at[k] : zero;
    f = fields_of(&along);
    add_translation(&along, &f, density, out);
    if (rotary->count > 0)
        spin_of(&along, &f, &spin);
    for (int r = 0; r < 3 && rotary->count > 0; r++)
        if (!expr_is_zero(J[r]))
            add_rotary(&along, &f, &spin, r, J[r], out);
    add_constants(&along, density, J, out);
    pool_free(along.pool);
    beam_close(&along.beam);
}

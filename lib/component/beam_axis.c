/* beam_axis.c: translation of a beam's axis, by d'Alembert
 *
 * p(x) = (x + u - s, v, w), with s' = (v'^2 + w'^2)/2 (theory 9). All fields are coefficients of
 * Legendre polynomials over the beam. These are orthogonal, so integrals of products are sums over
 * coefficients. s is formed once, by derivatives that M needs anyway. */
#include "component/beam_graded.h"

typedef struct Fields {
    Graded p[3], rate[3], left[3]; /* position p, rate p', and p'' at q'' = 0 */
    Graded (*move)[3];             /* dp/dq, for each shape */
} Fields;

static void add_shape(const GradedShapes *along, Fields *f, int i)
{
    static const int shifted[SHAPE_FAMILIES] = {0, 1, 2, -1};
    const BeamShape *shape = &along->beam->shapes[i];
    const int s = shifted[shape->family];

    if (s < 0)
        return;
    f->move[i][s].at[0] = parts_of(along, &shape->value);
    parts_add(along, &f->p[s].at[1], f->move[i][s].at[0], along->state->q[i]);
    parts_add(along, &f->rate[s].at[1], f->move[i][s].at[0], along->state->rate[i]);
}

/* int_0^x N_i' N_j', for shapes of one family: adds to -ds/dq of both, and to -s'' at q'' = 0 */
static void shorten_pair(const GradedShapes *along, Fields *f, int i, int j)
{
    Arena *arena = along->arena;
    const Beam *beam = along->beam;
    const Expr *q = along->state->q, *rate = along->state->rate;
    const Expr scale = expr_div(arena, expr_int(arena, -1), beam->length);
    const Expr twice = expr_mul(arena, expr_int(arena, j < i ? 2 : 1), scale);
    Polynomial s = beam_shortening(&beam->shapes[i], &beam->shapes[j]);
    Expr *parts = parts_of(along, &s);

    polynomial_free(&s);
    parts_add(along, &f->move[i][0].at[1], parts, expr_mul(arena, scale, q[j]));
    if (j < i)
        parts_add(along, &f->move[j][0].at[1], parts, expr_mul(arena, scale, q[i]));
    parts_add(
        along, &f->left[0].at[2], parts,
        expr_name_temporary(arena, expr_mul(arena, twice, expr_mul(arena, rate[i], rate[j]))));
}

/* -s = q.(-ds/dq)/2, -s' = q'.(-ds/dq) */
static void shorten(const GradedShapes *along, Fields *f)
{
    const Beam *beam = along->beam;
    Expr *way = NULL;

    for (int i = 0; i < beam->count; i++)
        for (int j = 0; j <= i && beam_bends(&beam->shapes[i]); j++)
            if (beam->shapes[j].family == beam->shapes[i].family)
                shorten_pair(along, f, i, j);
    for (int i = 0; i < beam->count; i++) {
        Expr *moved = f->move[i][0].at[1];

        parts_hold(along, moved);
        parts_add(along, &way, moved, along->state->q[i]);
        parts_add(along, &f->rate[0].at[2], moved, along->state->rate[i]);
    }
    parts_add(along, &f->p[0].at[2], way, expr_rational(along->arena, 1, 2));
}

/* merges the orders where none is dropped */
static Graded merged(const GradedShapes *along, Graded g)
{
    Graded sum = {{NULL}};

    for (int d = 0; d < ORDERS; d++)
        parts_add(along, &sum.at[along->limit[0] < LIMITLESS ? d : 0], g.at[d],
                  expr_int(along->arena, 1));
    return graded_hold(along, sum);
}

static Fields fields_of(const GradedShapes *along)
{
    Polynomial x = polynomial_power(1);
    Fields f = {.move = pool_alloc(along->pool, (size_t)along->beam->count * sizeof(Graded[3]))};

    parts_add(along, &f.p[0].at[0], parts_of(along, &x), along->beam->length);
    polynomial_free(&x);
    for (int i = 0; i < along->beam->count; i++)
        add_shape(along, &f, i);
    if (along->beam->shortens)
        shorten(along, &f);
    for (int k = 0; k < 3; k++) {
        f.p[k] = merged(along, f.p[k]);
        f.rate[k] = merged(along, f.rate[k]);
        f.left[k] = merged(along, f.left[k]);
    }
    return f;
}

/* w x a, with the root's angular velocity w */
static void spun(const GradedShapes *along, const Graded a[3], Graded out[3])
{
    const Expr *w = along->state->w;

    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;

        out[i] = graded_hold(along, graded_plus(along, graded_scaled(along, w[j], a[k]), -1,
                                                graded_scaled(along, w[k], a[j])));
    }
}

/* R^T(p'' of a point) where root and shapes don't accelerate: w x (w x p) + 2 w x p' + p'' at q'' =
 * 0 */
static void bias_of(const GradedShapes *along, const Fields *f, Graded out[3])
{
    const Expr two = expr_int(along->arena, 2);
    Graded turned[3], twice[3];

    spun(along, f->p, turned);
    for (int k = 0; k < 3; k++)
        turned[k] = graded_plus(along, turned[k], 1, graded_scaled(along, two, f->rate[k]));
    spun(along, turned, twice);
    for (int k = 0; k < 3; k++)
        out[k] = graded_hold(along, graded_plus(along, twice[k], 1, f->left[k]));
}

/* --- integrals --- */

static void weigh(const GradedShapes *along, const Weights *weights, const Graded a[3],
                  Graded out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = graded_weighed(along, weights, a[k]);
}

static Expr cross(const GradedShapes *along, const Graded weighed[3], const Graded b[3], int i,
                  int most)
{
    const int j = (i + 1) % 3, k = (i + 2) % 3;

    return expr_sub(along->arena, graded_inner(along, weighed[j], b[k], 0, most),
                    graded_inner(along, weighed[k], b[j], 0, most));
}

/* integral of g: of the first polynomial, which is 1, times a density that may vary */
static Expr whole(const GradedShapes *along, const Weights *weights, Graded g, int most)
{
    Expr sum = expr_int(along->arena, 0);

    for (int d = 0; d < ORDERS && d <= most; d++)
        for (int l = 0; g.at[d] != NULL && l <= weights->band && l < along->length; l++)
            sum = expr_add(along->arena, sum, expr_mul(along->arena, weights->at[l], g.at[d][l]));
    return expr_name_temporary(along->arena, expr_mul(along->arena, along->beam->length, sum));
}

/* int (p.p 1 - p p') */
static void add_tensor(const GradedShapes *along, const Graded weighed[3], const Graded p[3],
                       const Weights *weights, ShapeInertia *out)
{
    Expr product[3][3];

    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++)
            product[i][j] = product[j][i] =
                graded_inner(along, weighed[i], p[j], 0, along->limit[0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            Expr entry = i != j ? expr_neg(along->arena, product[i][j])
                                : expr_add(along->arena, product[a][a], product[b][b]);

            if (!along->beam->planar || (i == 2 && j == 2))
                beam_add(along, &out->inertia[3 * i + j], weights->factor, entry);
        }
}

static void add_shapes(const GradedShapes *along, const Fields *f, const Graded weighed[3],
                       const Graded bias[3], const Weights *weights, ShapeInertia *out)
{
    const int count = along->beam->count;
    const Expr density = weights->factor;

    for (int i = 0; i < count; i++) {
        Graded move[3];

        weigh(along, weights, f->move[i], move);
        for (int k = 0; k < 3; k++) {
            beam_add(along, &out->with_shift[3 * i + k], density,
                     whole(along, weights, f->move[i][k], along->limit[1]));
            beam_add(along, &out->with_turn[3 * i + k], density,
                     cross(along, weighed, f->move[i], k, along->limit[1]));
            beam_add(along, &out->bias[i], density,
                     graded_inner(along, move[k], bias[k], 0, along->limit[1]));
        }
        for (int j = 0; j <= i; j++)
            beam_add(along, &out->block[i * count + j], density,
                     graded_inner(along, move[0], f->move[j][0], 1, along->limit[2]));
    }
}

/* generalised forces of a load xi^power with 1 per length */
static void add_load(const GradedShapes *along, const Fields *f, int power, ShapeInertia *out)
{
    const int count = along->beam->count;
    Powers density = {.count = power + 1};
    Weights weights;

    for (int d = 0; d <= power; d++)
        density.at[d] = expr_int(along->arena, d == power);
    weights = weights_of(along, &density);
    out->extent[power] = expr_mul(along->arena, weights.at[0], along->beam->length);
    for (int k = 0; k < 3; k++) {
        out->spread[3 * power + k] = whole(along, &weights, f->p[k], along->limit[0]);
        for (int i = 0; i < count; i++)
            out->spread_shift[3 * (power * count + i) + k] =
                whole(along, &weights, f->move[i][k], along->limit[1]);
    }
}

void beam_add_axis(const GradedShapes *along, const Powers *density, ShapeInertia *out)
{
    const Fields f = fields_of(along);
    const Weights weights = weights_of(along, density);
    const int loads = beam_load_powers(along->beam->instance, along->arena);
    Graded bias[3], weighed[3];

    bias_of(along, &f, bias);
    out->mass =
        expr_product(along->arena, (Expr[]){weights.factor, weights.at[0], along->beam->length}, 3);
    weigh(along, &weights, f.p, weighed);
    add_tensor(along, weighed, f.p, &weights, out);
    for (int k = 0; k < 3; k++) {
        beam_add(along, &out->moment[k], weights.factor,
                 whole(along, &weights, f.p[k], along->limit[0]));
        beam_add(along, &out->bias_force[k], weights.factor,
                 whole(along, &weights, bias[k], along->limit[0]));
        beam_add(along, &out->bias_torque[k], weights.factor,
                 cross(along, weighed, bias, k, along->limit[0]));
    }
    add_shapes(along, &f, weighed, bias, &weights, out);
    for (int power = 0; power < loads; power++)
        add_load(along, &f, power, out);
}

/* beam_graded.c: sums and products of quantities that vary along a beam */
#include "component/beam_graded.h"

#include "base/memory.h"

#include <gsl/gsl_integration.h>

/* the points of a Gauss rule and their weights, from the lower limit of integrals to the end */
static void take_points(GradedShapes *along)
{
    const size_t count = (size_t)along->point_count;
    const Expr share = expr_sub(along->arena, expr_int(along->arena, 1), along->from);
    gsl_integration_glfixed_table *rule = MEM_GIVEN(gsl_integration_glfixed_table_alloc(count));

    along->points = pool_alloc(along->pool, count * sizeof(Expr));
    along->weights = pool_alloc(along->pool, count * sizeof(Expr));
    for (size_t k = 0; k < count; k++) {
        double point, weight;

        (void)gsl_integration_glfixed_point(0, 1, k, &point, &weight, rule);
        along->points[k] = expr_add(along->arena, along->from,
                                    expr_mul(along->arena, expr_real(along->arena, point), share));
        along->weights[k] = expr_mul(along->arena, expr_real(along->arena, weight), share);
    }
    gsl_integration_glfixed_table_free(rule);
}

/* P_0 .. P_most at each point: (n + 1) next = (2 n + 1) z this - n before, z = 2 xi - 1 */
static void take_legendre(GradedShapes *along, int most)
{
    Arena *arena = along->arena;
    const Expr one = expr_int(arena, 1), two = expr_int(arena, 2);

    along->legendre =
        pool_alloc(along->pool, (size_t)along->point_count * (size_t)(most + 1) * sizeof(Expr));
    for (int k = 0; k < along->point_count; k++) {
        Expr *p = along->legendre + (ptrdiff_t)k * (most + 1);
        const Expr z = expr_name_temporary(
            arena, expr_sub(arena, expr_mul(arena, two, along->points[k]), one));

        p[0] = one;
        p[most > 0 ? 1 : 0] = most > 0 ? z : one;
        for (int n = 1; n < most; n++)
            p[n + 1] = expr_name_temporary(
                arena,
                expr_sub(arena,
                         expr_product(arena,
                                      (Expr[]){expr_rational(arena, 2 * n + 1, n + 1), z, p[n]}, 3),
                         expr_mul(arena, expr_rational(arena, n, n + 1), p[n - 1])));
    }
}

GradedShapes along_of(const Beam *beam, Expr from, const ShapeState *state, Pool *pool, Basis basis,
                      int degree, int varies)
{
    const bool is_whole = expr_is_zero(from);
    GradedShapes along = {.beam = beam,
                          .arena = beam->arena,
                          .pool = pool,
                          .basis = basis,
                          .state = state,
                          .from = from,
                          .length = degree + 1};

    for (int k = 0; k < 3; k++)
        along.limit[k] = beam->limit == LIMITLESS ? LIMITLESS : beam->limit - k;
    /* n points are exact up to the degree 2 n - 1 */
    if (basis == BASIS_POINTS)
        along.length = along.point_count = (degree + varies) / 2 + 1;
    else if (!is_whole)
        along.point_count = degree + varies / 2 + 1;
    if (along.point_count > 0)
        take_points(&along);
    if (!is_whole)
        take_legendre(&along, degree);
    along.degree = degree;
    return along;
}

static Expr at_point(const GradedShapes *along, const Polynomial *legendre, const Polynomial *p,
                     int k)
{
    const Expr *values = along->legendre + (ptrdiff_t)k * (along->degree + 1);
    Expr sum = expr_int(along->arena, 0);

    if (along->legendre == NULL)
        return expr_real(along->arena, polynomial_value(p, expr_value(along->points[k])));
    for (int m = 0; m < legendre->count; m++)
        sum =
            expr_add(along->arena, sum,
                     expr_mul(along->arena, beam_number(along->arena, legendre->at[m]), values[m]));
    return sum;
}

static Expr *parts_new(const GradedShapes *along)
{
    Expr *parts = pool_alloc(along->pool, (size_t)along->length * sizeof *parts);

    for (int k = 0; k < along->length; k++)
        parts[k] = expr_int(along->arena, 0);
    return parts;
}

Expr *parts_of(const GradedShapes *along, const Polynomial *p)
{
    Expr *parts = parts_new(along);
    Polynomial legendre = {0};
    const Polynomial *from = p;

    if (along->basis == BASIS_LEGENDRE || along->legendre != NULL)
        legendre = legendre_of(p);
    if (along->basis == BASIS_LEGENDRE)
        from = &legendre;
    for (int k = 0; k < along->length; k++) {
        if (along->basis == BASIS_POINTS)
            parts[k] = at_point(along, &legendre, p, k);
        else if (k < from->count)
            parts[k] = beam_number(along->arena, from->at[k]);
    }
    polynomial_free(&legendre);
    return parts;
}

void parts_add(const GradedShapes *along, Expr **to, const Expr *parts, Expr scale)
{
    if (parts == NULL || expr_is_zero(scale))
        return;
    if (*to == NULL)
        *to = parts_new(along);
    for (int k = 0; k < along->length; k++)
        (*to)[k] = expr_add(along->arena, (*to)[k], expr_mul(along->arena, scale, parts[k]));
}

void parts_hold(const GradedShapes *along, Expr *parts)
{
    for (int k = 0; parts != NULL && k < along->length; k++)
        parts[k] = expr_name_temporary(along->arena, parts[k]);
}

Graded graded_hold(const GradedShapes *along, Graded g)
{
    for (int d = 0; d < ORDERS; d++)
        parts_hold(along, g.at[d]);
    return g;
}

void graded_add(const GradedShapes *along, Graded *to, Graded g, Expr scale)
{
    for (int d = 0; d < ORDERS; d++)
        parts_add(along, &to->at[d], g.at[d], scale);
}

Graded graded_plus(const GradedShapes *along, Graded a, int sign, Graded b)
{
    Graded sum = {{NULL}};

    graded_add(along, &sum, a, expr_int(along->arena, 1));
    graded_add(along, &sum, b, expr_int(along->arena, sign));
    return sum;
}

Graded graded_scaled(const GradedShapes *along, Expr scale, Graded a)
{
    Graded out = {{NULL}};

    graded_add(along, &out, a, scale);
    return out;
}

static void parts_multiply(const GradedShapes *along, Expr **to, const Expr *a, const Expr *b)
{
    Arena *arena = along->arena;

    if (*to == NULL)
        *to = parts_new(along);
    for (int i = 0; i < along->length; i++)
        for (int j = 0; j < along->length; j++) {
            const int k = along->basis == BASIS_POWERS ? i + j : i;

            if ((along->basis == BASIS_POINTS && i != j) || expr_is_zero(a[i]) ||
                expr_is_zero(b[j]) || k >= along->length)
                continue;
            (*to)[k] = expr_add(arena, (*to)[k], expr_mul(arena, a[i], b[j]));
        }
}

Graded graded_times(const GradedShapes *along, Graded a, Graded b)
{
    Graded out = {{NULL}};

    for (int i = 0; i < ORDERS; i++)
        for (int j = 0; i + j < ORDERS; j++)
            if (a.at[i] != NULL && b.at[j] != NULL && i + j <= along->limit[0])
                parts_multiply(along, &out.at[i + j], a.at[i], b.at[j]);
    return graded_hold(along, out);
}

Graded graded_constant(const GradedShapes *along, int value)
{
    Polynomial one = polynomial_power(0);
    Graded g = {{NULL}};

    g.at[0] = parts_of(along, &one);
    polynomial_free(&one);
    return graded_scaled(along, expr_int(along->arena, value), g);
}

/* --- integrals --- */

static Expr scaled_by(const GradedShapes *along, const mpq_t number, Expr power)
{
    return expr_mul(along->arena, beam_number(along->arena, number), power);
}

/* int_0^1 P_m P_l density */
static Expr between(const GradedShapes *along, const Polynomial *m, const Polynomial *l,
                    const Powers *density)
{
    Expr sum = expr_int(along->arena, 0);
    mpq_t own;

    mpq_init(own);
    for (int d = 0; d < density->count; d++) {
        polynomial_integral(m, l, d, own);
        sum = expr_add(along->arena, sum, scaled_by(along, own, density->at[d]));
    }
    mpq_clear(own);
    return sum;
}

/* int P_m P_(m + b) density from the lower limit of integrals */
static void weigh_beyond(const GradedShapes *along, const Powers *density, Weights *out)
{
    Arena *arena = along->arena;
    const int row = out->band + 1;

    for (int m = 0; m < along->length; m++)
        for (int b = 0; b < row && m + b < along->length; b++) {
            Expr sum = expr_int(arena, 0);

            for (int k = 0; k < along->point_count; k++) {
                const Expr *values = along->legendre + (ptrdiff_t)k * (along->degree + 1);

                sum = expr_add(arena, sum,
                               expr_product(arena,
                                            (Expr[]){along->weights[k], values[m], values[m + b],
                                                     powers_at(arena, density, along->points[k])},
                                            4));
            }
            out->at[m * row + b] = expr_name_temporary(arena, sum);
        }
}

static void weigh_legendre(const GradedShapes *along, const Powers *density, Weights *out)
{
    Polynomial *legendre = NEW_ARRAY(Polynomial, along->length);
    const int row = out->band + 1;

    for (int m = 0; m < along->length; m++)
        legendre[m] = beam_legendre(m);
    for (int m = 0; m < along->length; m++)
        for (int b = 0; b < row && m + b < along->length; b++)
            out->at[m * row + b] = expr_name_temporary(
                along->arena, between(along, &legendre[m], &legendre[m + b], density));
    for (int m = 0; m < along->length; m++)
        polynomial_free(&legendre[m]);
    mem_free(legendre);
}

/* for the part k: int xi^k density, or the density at a point */
static Expr weight_of(const GradedShapes *along, const Powers *density, int k)
{
    Arena *arena = along->arena;
    Expr sum = expr_int(arena, 0);

    if (along->basis == BASIS_POINTS)
        return expr_mul(arena, along->weights[k], powers_at(arena, density, along->points[k]));
    for (int d = 0; d < density->count; d++)
        sum = expr_add(arena, sum,
                       expr_mul(arena, expr_rational(arena, 1, k + d + 1), density->at[d]));
    return sum;
}

Weights weights_of(const GradedShapes *along, const Powers *density)
{
    const Expr one = expr_int(along->arena, 1);
    const Powers even = {1, {one}};
    const bool varies = density->count > 1;
    Weights out = {.factor = varies ? one : density->at[0], .band = density->count - 1};
    const bool is_beyond = along->basis == BASIS_LEGENDRE && along->legendre != NULL;

    if (is_beyond) /* they are orthogonal over the whole length only */
        out.band = along->length - 1;
    out.at =
        pool_alloc(along->pool, (size_t)along->length * (size_t)(out.band + 1) * sizeof *out.at);
    if (is_beyond)
        weigh_beyond(along, varies ? density : &even, &out);
    else if (along->basis == BASIS_LEGENDRE)
        weigh_legendre(along, varies ? density : &even, &out);
    else
        for (int k = 0; k < along->length; k++)
            out.at[k] =
                expr_name_temporary(along->arena, weight_of(along, varies ? density : &even, k));
    return out;
}

Expr graded_integral(const GradedShapes *along, const Weights *weights, Graded g, int from,
                     int most)
{
    Arena *arena = along->arena;
    Expr sum = expr_int(arena, 0);

    for (int d = from; d < ORDERS && d <= most; d++)
        for (int k = 0; g.at[d] != NULL && k < along->length; k++)
            sum = expr_add(arena, sum, expr_mul(arena, weights->at[k], g.at[d][k]));
    return expr_name_temporary(arena, expr_mul(arena, along->beam->length, sum));
}

Graded graded_weighed(const GradedShapes *along, const Weights *weights, Graded g)
{
    Arena *arena = along->arena;
    const int band = weights->band;
    Graded out = {{NULL}};

    for (int d = 0; d < ORDERS; d++) {
        if (g.at[d] == NULL)
            continue;
        out.at[d] = parts_new(along);
        for (int m = 0; m < along->length; m++)
            for (int l = m > band ? m - band : 0; l <= m + band && l < along->length; l++) {
                const int first = l < m ? l : m, apart = l < m ? m - l : l - m;
                const Expr weight =
                    expr_mul(arena, weights->at[first * (band + 1) + apart], along->beam->length);

                out.at[d][m] = expr_add(arena, out.at[d][m], expr_mul(arena, weight, g.at[d][l]));
            }
    }
    return graded_hold(along, out);
}

Expr graded_inner(const GradedShapes *along, Graded weighed, Graded g, int from, int most)
{
    Arena *arena = along->arena;
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < ORDERS; i++)
        for (int j = 0; j < ORDERS; j++)
            for (int m = 0; m < along->length && i + j >= from && i + j <= most; m++)
                if (weighed.at[i] != NULL && g.at[j] != NULL)
                    sum = expr_add(arena, sum, expr_mul(arena, weighed.at[i][m], g.at[j][m]));
    return expr_name_temporary(arena, sum);
}

void beam_add(const GradedShapes *along, Expr *to, Expr factor, Expr what)
{
    *to = expr_add(along->arena, *to, expr_mul(along->arena, factor, what));
}

int beam_angle(const BeamShape *shape)
{
    static const int of[SHAPE_FAMILIES] = {-1, 2, 1, 0};

    return of[shape->family];
}

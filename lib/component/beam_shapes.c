/* beam_shapes.c: families of shapes, and frames on a bent beam */
#include "component/beam.h"

#include "base/exact_memory.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

void beam_modes(const Instance *instance, bool planar, int modes[SHAPE_FAMILIES])
{
    const Value *given = instance_value(instance, "modes");

    for (int f = 0; f < SHAPE_FAMILIES; f++)
        modes[f] = 0;
    for (int f = 0; f < given->count && f < (planar ? 2 : SHAPE_FAMILIES); f++)
        if (expr_is_number(given->at[f]) && expr_value(given->at[f]) >= 0)
            modes[f] = expr_value(given->at[f]) < MOST_SHAPES ? (int)expr_value(given->at[f])
                                                              : MOST_SHAPES;
}

Expr beam_number(Arena *arena, const mpq_t value)
{
    if (mpz_fits_slong_p(mpq_numref(value)) && mpz_fits_slong_p(mpq_denref(value)))
        return expr_rational(arena, mpz_get_si(mpq_numref(value)), mpz_get_si(mpq_denref(value)));
    return expr_real(arena, mpq_get_d(value));
}

bool beam_bends(const BeamShape *shape)
{
    return shape->family == SHAPE_V || shape->family == SHAPE_W;
}

/* --- quantities that vary along the beam --- */

Powers beam_powers(const Instance *instance, Arena *arena, Expr value)
{
    const Expr x = expr_symbol(arena, "x", SYMBOL_ARGUMENT),
               length = instance_scalar(instance, "length");
    Powers powers;

    powers.count = expr_powers(arena, value, x, powers.at, MOST_POWERS);
    for (int k = 1; k < powers.count; k++)
        powers.at[k] = expr_mul(arena, powers.at[k], expr_pow(arena, length, expr_int(arena, k)));
    return powers;
}

Powers beam_key(const Beam *beam, const char *key)
{
    return beam_powers(beam->instance, beam->arena, instance_scalar(beam->instance, key));
}

Expr powers_at(Arena *arena, const Powers *p, Expr xi)
{
    Expr sum = expr_int(arena, 0);

    for (int k = p->count - 1; k >= 0; k--)
        sum = expr_add(arena, expr_mul(arena, sum, xi), p->at[k]);
    return sum;
}

int beam_load_powers(const Instance *instance, Arena *arena)
{
    const Value *load = instance_value(instance, "load");
    int most = 0;

    for (int k = 0; load->given && k < load->count; k++) {
        const Powers own = beam_powers(instance, arena, load->at[k]);

        most = own.count > most ? own.count : most;
    }
    return most;
}

/* --- families --- */

/* Orthogonal polynomial k over 0..1 by the recurrence in z = 2 xi - 1, from 1 and z: next = (a z
 * this - b before)/c. */
static Polynomial orthogonal(int k, bool legendre)
{
    Polynomial before = polynomial_power(0), now = polynomial_new(2), z;

    mpq_set_si(now.at[0], -1, 1);
    mpq_set_si(now.at[1], 2, 1);
    z = polynomial_copy(&now);
    for (int n = 1; n < k; n++) {
        Polynomial next = polynomial_times(&z, &now);
        mpq_t scale;

        mpq_init(scale);
        for (int i = 0; i < next.count; i++) {
            mpq_t own;

            mpq_init(own);
            mpq_set_si(scale, legendre ? 2 * n + 1 : 2, 1);
            mpq_mul(next.at[i], next.at[i], scale);
            mpq_set_si(scale, legendre ? n : 1, 1);
            if (i < before.count)
                mpq_mul(own, before.at[i], scale);
            mpq_sub(next.at[i], next.at[i], own);
            mpq_set_si(scale, 1, legendre ? (unsigned long)n + 1 : 1);
            mpq_mul(next.at[i], next.at[i], scale);
            mpq_clear(own);
        }
        mpq_clear(scale);
        polynomial_free(&before);
        before = now;
        now = next;
    }
    polynomial_free(&z);
    if (k > 0) {
        polynomial_free(&before);
        return now;
    }
    polynomial_free(&now);
    return before;
}

/* `p` integrated n times from 0, or times xi^n */
static Polynomial clamp(Polynomial p, int n, bool integrate)
{
    for (int i = 0; i < n; i++) {
        Polynomial x = polynomial_power(1);
        Polynomial next = integrate ? polynomial_primitive(&p) : polynomial_times(&x, &p);

        polynomial_free(&x);
        polynomial_free(&p);
        p = next;
    }
    return p;
}

static BeamShape shape_of(ShapeFamily family, int k, const char *basis)
{
    const int order = family == SHAPE_V || family == SHAPE_W ? 2 : 1;
    BeamShape shape = {.family = family};

    if (strcmp(basis, "taylor") == 0)
        shape.value = polynomial_power(k + order);
    else if (strcmp(basis, "chebyshev") == 0)
        shape.value = clamp(orthogonal(k, false), order, false);
    else
        shape.value = clamp(orthogonal(k, true), order, true);
    shape.slope = polynomial_slope(&shape.value);
    shape.curve = polynomial_slope(&shape.slope);
    return shape;
}

static void shape_close(BeamShape *shape)
{
    polynomial_free(&shape->value);
    polynomial_free(&shape->slope);
    polynomial_free(&shape->curve);
}

Beam beam_open(const Instance *instance, Arena *arena, bool planar)
{
    const char *stiffening = instance_value(instance, "stiffening")->word;
    const char *basis = instance_value(instance, "basis")->word;
    int modes[SHAPE_FAMILIES];
    Beam beam = {.instance = instance,
                 .arena = arena,
                 .planar = planar,
                 .shortens = strcmp(stiffening, "off") != 0,
                 .limit = strcmp(stiffening, "linear") == 0 ? 2 : LIMITLESS,
                 .length = instance_scalar(instance, "length")};

    exact_begin();
    beam_modes(instance, planar, modes);
    beam.shapes = NEW_ARRAY(BeamShape, SHAPE_FAMILIES * MOST_SHAPES);
    for (int f = 0; f < SHAPE_FAMILIES; f++)
        for (int k = 0; k < modes[f]; k++)
            beam.shapes[beam.count++] = shape_of((ShapeFamily)f, k, basis);
    return beam;
}

void beam_close(Beam *beam)
{
    for (int i = 0; i < beam->count; i++)
        shape_close(&beam->shapes[i]);
    mem_free(beam->shapes);
    exact_end();
}

double beam_unit(const Instance *instance, bool planar, int i)
{
    enum { PLACES = 32 }; /* two in the shortest half wave of 16 shapes */
    int modes[SHAPE_FAMILIES], family = 0;
    BeamShape shape;
    double most = 0;

    beam_modes(instance, planar, modes);
    for (; i >= modes[family]; family++)
        i -= modes[family];
    exact_begin();
    shape = shape_of((ShapeFamily)family, i, instance_value(instance, "basis")->word);
    for (int k = 1; k <= PLACES; k++)
        most = fmax(most, fabs(polynomial_value(&shape.value, (double)k / PLACES)));
    shape_close(&shape);
    exact_end();
    return 1 / most;
}

Polynomial beam_legendre(int k)
{
    return orthogonal(k, true);
}

Polynomial beam_shortening(const BeamShape *a, const BeamShape *b)
{
    Polynomial product = polynomial_times(&a->slope, &b->slope);
    Polynomial primitive = polynomial_primitive(&product);

    polynomial_free(&product);
    return primitive;
}

/* --- section frames --- */

static Expr value_at(Arena *arena, const Polynomial *p, Expr xi)
{
    Expr sum = expr_int(arena, 0);

    if (expr_is_number(xi) && !expr_rational_parts(xi, &(int64_t){0}, &(int64_t){0}))
        return expr_real(arena, polynomial_value(p, expr_value(xi)));
    for (int i = p->count - 1; i >= 0; i--)
        sum = expr_add(arena, expr_mul(arena, sum, xi), beam_number(arena, p->at[i]));
    return sum;
}

/* s = q S q/(2 L), its derivatives -(S q)/L, and its second rate at q'' = 0, q' S q'/L */
static void shorten(const Beam *beam, Expr xi, const ShapeState *state, SectionFrame *out)
{
    Arena *arena = beam->arena;
    Expr way = expr_int(arena, 0), left = way;

    for (int i = 0; i < beam->count; i++) {
        Expr moved = expr_int(arena, 0), rate = moved;

        if (!beam_bends(&beam->shapes[i]))
            continue;
        for (int j = 0; j < beam->count; j++) {
            Polynomial s;
            Expr entry;

            if (beam->shapes[j].family != beam->shapes[i].family)
                continue;
            s = beam_shortening(&beam->shapes[i], &beam->shapes[j]);
            entry = expr_div(arena, value_at(arena, &s, xi), beam->length);
            polynomial_free(&s);
            moved = expr_add(arena, moved, expr_mul(arena, entry, state->q[j]));
            rate = expr_add(arena, rate, expr_mul(arena, entry, state->rate[j]));
        }
        out->shift[(ptrdiff_t)3 * i] = expr_name_temporary(arena, expr_neg(arena, moved));
        way = expr_sub(arena, way, expr_mul(arena, state->q[i], out->shift[(ptrdiff_t)3 * i]));
        left = expr_add(arena, left,
                        expr_mul(arena, state->rate[i], expr_name_temporary(arena, rate)));
    }
    way = expr_mul(arena, expr_rational(arena, 1, 2), way);
    out->position[0] = expr_sub(arena, out->position[0], way);
    out->bend[0] = expr_neg(arena, left);
}

void beam_section_frame(const Instance *instance, Arena *arena, bool planar, Expr at,
                        const ShapeState *state, SectionFrame *out)
{
    static const int turned[SHAPE_FAMILIES] = {-1, 0, 1, 2};
    static const int shifted[SHAPE_FAMILIES] = {0, 1, 2, -1};
    Beam beam = beam_open(instance, arena, planar);
    const Expr zero = expr_int(arena, 0);
    const Expr xi = expr_div(arena, at, beam.length);

    for (int k = 0; k < 3; k++)
        out->position[k] = out->angle[k] = out->bend[k] = out->twist[k] = zero;
    for (int i = 0; i < 3 * beam.count; i++)
        out->shift[i] = out->turn[i] = zero;
    out->position[0] = at;
    for (int i = 0; i < beam.count; i++) {
        const BeamShape *shape = &beam.shapes[i];
        const int s = shifted[shape->family], t = turned[shape->family];
        Expr value = value_at(arena, &shape->value, xi);
        Expr slope = expr_div(arena, value_at(arena, &shape->slope, xi), beam.length);

        if (s >= 0) {
            out->shift[3 * i + s] = value;
            out->position[s] =
                expr_add(arena, out->position[s], expr_mul(arena, value, state->q[i]));
        }
        if (t >= 0) {
            out->turn[3 * i + t] = t == 2 ? value : t == 1 ? expr_neg(arena, slope) : slope;
            out->angle[t] =
                expr_add(arena, out->angle[t], expr_mul(arena, out->turn[3 * i + t], state->q[i]));
        }
    }
    if (beam.shortens)
        shorten(&beam, xi, state, out);
    beam_close(&beam);
}

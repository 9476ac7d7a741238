/* beam_shapes.c: families of shapes, and frames on a bent beam */
#include "component/beam.h"

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

Expr beam_number(Arena *arena, const fmpq_t value)
{
    if (fmpz_fits_si(fmpq_numref(value)) && fmpz_fits_si(fmpq_denref(value)))
        return expr_rational(arena, fmpz_get_si(fmpq_numref(value)),
                             fmpz_get_si(fmpq_denref(value)));
    return expr_real(arena, fmpq_get_d(value));
}

Expr beam_coefficient(Arena *arena, const fmpq_poly_t p, int power)
{
    fmpq_t own;
    Expr out;

    fmpq_init(own);
    fmpq_poly_get_coeff_fmpq(own, p, power);
    out = beam_number(arena, own);
    fmpq_clear(own);
    return out;
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

static BeamShape shape_of(ShapeFamily family, int k, const char *basis)
{
    const int order = family == SHAPE_V || family == SHAPE_W ? 2 : 1;
    BeamShape shape = {.family = family};

    fmpq_poly_init(shape.value);
    fmpq_poly_init(shape.slope);
    fmpq_poly_init(shape.curve);
    if (strcmp(basis, "taylor") == 0) {
        fmpq_poly_set_coeff_si(shape.value, k + order, 1);
    } else if (strcmp(basis, "chebyshev") == 0) {
        polynomial_chebyshev(k, shape.value);
        fmpq_poly_shift_left(shape.value, shape.value, order);
    } else {
        polynomial_legendre(k, shape.value);
        for (int i = 0; i < order; i++)
            fmpq_poly_integral(shape.value, shape.value);
    }
    fmpq_poly_derivative(shape.slope, shape.value);
    fmpq_poly_derivative(shape.curve, shape.slope);
    return shape;
}

static void shape_close(BeamShape *shape)
{
    fmpq_poly_clear(shape->value);
    fmpq_poly_clear(shape->slope);
    fmpq_poly_clear(shape->curve);
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
                 .length = instance_scalar(instance, "length"),
                 .exact = exact_open()};

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
    exact_close(beam->exact);
}

double beam_unit(const Instance *instance, bool planar, int i)
{
    enum { PLACES = 32 }; /* two in the shortest half wave of 16 shapes */
    int modes[SHAPE_FAMILIES], family = 0;
    ExactMemory *exact = exact_open();
    BeamShape shape;
    double most = 0;

    beam_modes(instance, planar, modes);
    for (; i >= modes[family]; family++)
        i -= modes[family];
    shape = shape_of((ShapeFamily)family, i, instance_value(instance, "basis")->word);
    for (int k = 1; k <= PLACES; k++)
        most = fmax(most, fabs(polynomial_value(shape.value, (double)k / PLACES)));
    shape_close(&shape);
    exact_close(exact);
    return 1 / most;
}

void beam_shortening(const BeamShape *a, const BeamShape *b, fmpq_poly_t out)
{
    fmpq_poly_mul(out, a->slope, b->slope);
    fmpq_poly_integral(out, out);
}

/* --- section frames --- */

static Expr value_at(Arena *arena, const fmpq_poly_t p, Expr xi)
{
    Expr sum = expr_int(arena, 0);

    if (expr_is_number(xi) && !expr_rational_parts(xi, &(int64_t){0}, &(int64_t){0}))
        return expr_real(arena, polynomial_value(p, expr_value(xi)));
    for (int i = (int)fmpq_poly_degree(p); i >= 0; i--)
        sum = expr_add(arena, expr_mul(arena, sum, xi), beam_coefficient(arena, p, i));
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
            fmpq_poly_t s;
            Expr entry;

            if (beam->shapes[j].family != beam->shapes[i].family)
                continue;
            fmpq_poly_init(s);
            beam_shortening(&beam->shapes[i], &beam->shapes[j], s);
            entry = expr_div(arena, value_at(arena, s, xi), beam->length);
            fmpq_poly_clear(s);
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
        Expr value = value_at(arena, shape->value, xi);
        Expr slope = expr_div(arena, value_at(arena, shape->slope, xi), beam.length);

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

/* beam_inertia.c: a beam's contributions to the equations of motion
 *
 * Translation follows from d'Alembert's principle with the field of the axis (beam_axis.c). Rotary
 * inertia follows from Lagrange's equations in quasi-velocities of the root (beam_rotary.c). What
 * the user wants linear is truncated by order (theory 9). Constant terms are exact for any number
 * of shapes. */
#include "base/memory.h"
#include "component/beam_graded.h"

enum { MOST_EXACT = 3 }; /* degree of sections' angles up to which integrals are exact */

/* int density a b over xi, times a power of the length */
static Expr gram(const GradedShapes *along, const Powers *density, const Polynomial *a,
                 const Polynomial *b, int power)
{
    Arena *arena = along->arena;
    Expr entry = expr_int(arena, 0);
    mpq_t sum;

    mpq_init(sum);
    for (int d = 0; d < density->count; d++) {
        polynomial_integral(a, b, d, sum);
        beam_add(along, &entry, density->at[d], beam_number(arena, sum));
    }
    mpq_clear(sum);
    return expr_mul(arena, entry, expr_pow(arena, along->beam->length, expr_int(arena, power)));
}

static Expr mass_entry(const GradedShapes *along, int i, int j, const Powers *density,
                       const Powers J[3])
{
    const BeamShape *a = &along->beam->shapes[i], *b = &along->beam->shapes[j];
    const int t = beam_angle(a);
    Expr sum = expr_int(along->arena, 0);

    if (a->family != b->family)
        return sum;
    if (a->family != SHAPE_PHI)
        sum = expr_add(along->arena, sum, gram(along, density, &a->value, &b->value, 1));
    if (t == 0)
        sum = expr_add(along->arena, sum, gram(along, &J[0], &a->value, &b->value, 1));
    else if (t > 0)
        sum = expr_add(along->arena, sum, gram(along, &J[t], &a->slope, &b->slope, -1));
    return sum;
}

static Expr stiffness_entry(const GradedShapes *along, const Powers stiffness[SHAPE_FAMILIES],
                            int i, int j)
{
    const BeamShape *a = &along->beam->shapes[i], *b = &along->beam->shapes[j];

    if (a->family != b->family)
        return expr_int(along->arena, 0);
    return beam_bends(a) ? gram(along, &stiffness[a->family], &a->curve, &b->curve, -3)
                         : gram(along, &stiffness[a->family], &a->slope, &b->slope, -1);
}

static void add_constants(const GradedShapes *along, const Powers *density, const Powers J[3],
                          ShapeInertia *out)
{
    static const char *const keys[SHAPE_FAMILIES] = {"EA", "EIz", "EIy", "GJ"};
    Arena *arena = along->arena;
    const Value *damping = instance_value(along->beam->instance, "damping");
    const int count = along->beam->count;
    const Expr *q = along->state->q, *rate = along->state->rate;
    Powers stiffness[SHAPE_FAMILIES];

    for (int f = 0; f < SHAPE_FAMILIES; f++)
        stiffness[f] = beam_key(along->beam, keys[f]);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            Expr m = mass_entry(along, i, j, density, J),
                 k = stiffness_entry(along, stiffness, i, j);
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
            beam_add(along, &out->stored, expr_mul(arena, expr_rational(arena, 1, 2), q[i]), bent);
        }
}

/* copies the part above the diagonal */
static void finish_block(const GradedShapes *along, ShapeInertia *out)
{
    const int count = along->beam->count;

    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++)
            out->block[i * count + j] = out->block[j * count + i];
}

/* --- complete block --- */

static void clear(const GradedShapes *along, Expr *at, int count)
{
    for (int i = 0; i < count; i++)
        at[i] = expr_int(along->arena, 0);
}

static void clear_all(const GradedShapes *along, ShapeInertia *out)
{
    const int count = along->beam->count;

#define CLEAR_ROW(name, entries) clear(along, out->name, entries);
    SHAPE_ARRAYS_OF_ROOT(CLEAR_ROW)
    SHAPE_ARRAYS_OF_SHAPES(CLEAR_ROW)
    clear(along, &out->stored, 1);
}

/* degrees of the axis' position, and of the angles of sections */
static void find_degrees(const Beam *beam, int *axis, int *angles)
{
    *axis = *angles = 1;
    for (int i = 0; i < beam->count; i++) {
        const BeamShape *shape = &beam->shapes[i];
        const int own = shape->value.count - 1;
        const int moved = beam_bends(shape) && beam->shortens ? 2 * own - 1 : own;
        const int turned = beam_bends(shape) ? own - 1 : own;

        if (shape->family != SHAPE_PHI && moved > *axis)
            *axis = moved;
        if (beam_angle(shape) >= 0 && turned > *angles)
            *angles = turned;
    }
}

/* integrals of each power of a load, by the components of the load */
static void spread_load(const Beam *beam, ShapeInertia *out)
{
    const Value *load = instance_value(beam->instance, "load");
    const int count = beam_load_powers(beam->instance, beam->arena);

    for (int k = 0; k < 3; k++) {
        const Powers own = beam_powers(beam->instance, beam->arena, load->at[k]);

        for (int p = 0; p < count; p++)
            out->load[3 * p + k] = p < own.count ? own.at[p] : expr_int(beam->arena, 0);
    }
}

void beam_inertia(const Instance *instance, Arena *arena, bool planar, Expr from,
                  const ShapeState *state, ShapeInertia *out)
{
    const Value *rotary = instance_value(instance, "inertia_per_length");
    const Powers none = {1, {expr_int(arena, 0)}};
    Powers density, J[3] = {none, none, none};
    Beam beam = beam_open(instance, arena, planar);
    const bool is_whole = expr_is_zero(from);
    Pool *pool = pool_new(0);
    int degree, turned, varies = 0;
    GradedShapes along;

    from = expr_div(arena, from, beam.length);
    find_degrees(&beam, &degree, &turned);
    along = along_of(&beam, from, state, pool, BASIS_LEGENDRE, degree, MOST_POWERS - 1);
    clear_all(&along, out);
    density = beam_key(&beam, "mass_per_length");
    for (int k = 0; k < rotary->count && k < 3; k++) {
        J[planar ? 2 : k] = beam_powers(instance, arena, rotary->at[k]);
        varies = J[planar ? 2 : k].count > varies ? J[planar ? 2 : k].count : varies;
    }
    spread_load(&beam, out);
    beam_add_axis(&along, &density, out);
    if (is_whole) /* a part of the beam has no equations for shapes of its own */
        add_constants(&along, &density, J, out);
    if (rotary->count > 0) { /* products of up to four angles */
        const Basis basis = is_whole && turned <= MOST_EXACT ? BASIS_POWERS : BASIS_POINTS;

        along = along_of(&beam, from, state, pool, basis, 4 * turned, varies - 1);
        beam_add_rotary(&along, J, out);
    }
    finish_block(&along, out);
    pool_free(pool);
    beam_close(&beam);
}

/* beam_inertia.c: what a beam hands over to the equations of motion
 *
 * Translation follows d'Alembert with the field of the axis (beam_axis.c), rotary inertia
 * Lagrange's equations in quasi-velocities of the root (beam_rotary.c); what the user wants linear
 * is cut by order (theory 9). What is constant is exact whatever the number of shapes. */
#include "base/memory.h"
#include "component/beam_graded.h"

enum { MOST_EXACT = 3 }; /* degree of sections' angles with which integrals are written out */

static Expr gram(const Along *along, const Polynomial *a, const Polynomial *b, int power)
{
    Expr number;
    mpq_t sum;

    mpq_init(sum);
    polynomial_integral(a, b, 0, sum);
    number = beam_number(along->arena, sum);
    mpq_clear(sum);
    return expr_mul(along->arena, number,
                    expr_pow(along->arena, along->beam->length, expr_int(along->arena, power)));
}

static Expr mass_entry(const Along *along, int i, int j, Expr density, const Expr J[3])
{
    const BeamShape *a = &along->beam->shapes[i], *b = &along->beam->shapes[j];
    const int t = beam_angle(a);
    Expr sum = expr_int(along->arena, 0);

    if (a->family != b->family)
        return sum;
    if (a->family != SHAPE_PHI)
        beam_add(along, &sum, density, gram(along, &a->value, &b->value, 1));
    if (t == 0)
        beam_add(along, &sum, J[0], gram(along, &a->value, &b->value, 1));
    else if (t > 0)
        beam_add(along, &sum, J[t], gram(along, &a->slope, &b->slope, -1));
    return sum;
}

static Expr stiffness_entry(const Along *along, int i, int j)
{
    static const char *const keys[SHAPE_FAMILIES] = {"EA", "EIz", "EIy", "GJ"};
    const BeamShape *a = &along->beam->shapes[i], *b = &along->beam->shapes[j];
    Expr entry;

    if (a->family != b->family)
        return expr_int(along->arena, 0);
    entry = beam_bends(a) ? gram(along, &a->curve, &b->curve, -3)
                          : gram(along, &a->slope, &b->slope, -1);
    return expr_mul(along->arena, instance_scalar(along->beam->instance, keys[a->family]), entry);
}

static void add_constants(const Along *along, Expr density, const Expr J[3], ShapeInertia *out)
{
    Arena *arena = along->arena;
    const Value *damping = instance_value(along->beam->instance, "damping");
    const int count = along->beam->count;
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
            beam_add(along, &out->stored, expr_mul(arena, expr_rational(arena, 1, 2), q[i]), bent);
        }
}

/* what is above its diagonal */
static void finish_block(const Along *along, ShapeInertia *out)
{
    const int count = along->beam->count;

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
    const int count = along->beam->count;

#define CLEAR_ROW(name, entries) clear(along, out->name, entries);
    SHAPE_ARRAYS_OF_ROOT(CLEAR_ROW)
    SHAPE_ARRAYS_OF_SHAPES(CLEAR_ROW)
    clear(along, &out->stored, 1);
}

/* degrees of where the axis is, and of the angles of sections */
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

void beam_inertia(const Instance *instance, Arena *arena, bool planar, const ShapeState *state,
                  ShapeInertia *out)
{
    const Value *rotary = instance_value(instance, "inertia_per_length");
    const Value *load = instance_value(instance, "load");
    const Expr density = instance_scalar(instance, "mass_per_length");
    const Expr zero = expr_int(arena, 0);
    Expr J[3] = {zero, zero, zero};
    Beam beam = beam_open(instance, arena, planar);
    Pool *pool = pool_new(0);
    int degree, turned;
    Along along;

    find_degrees(&beam, &degree, &turned);
    along = along_of(&beam, state, pool, BASIS_LEGENDRE, degree);
    clear_all(&along, out);
    for (int k = 0; k < rotary->count && k < 3; k++)
        J[planar ? 2 : k] = rotary->at[k];
    out->mass = expr_mul(arena, density, beam.length);
    out->length = load->given ? beam.length : NULL;
    for (int k = 0; k < 3; k++)
        out->load[k] = load->given && k < load->count ? load->at[k] : zero;
    beam_add_axis(&along, density, out);
    add_constants(&along, density, J, out);
    if (rotary->count > 0) { /* products of up to four angles */
        along = along_of(&beam, state, pool, turned <= MOST_EXACT ? BASIS_POWERS : BASIS_POINTS,
                         4 * turned);
        beam_add_rotary(&along, J, out);
    }
    finish_block(&along, out);
    pool_free(pool);
    beam_close(&beam);
}

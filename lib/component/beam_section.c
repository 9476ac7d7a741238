/* beam_section.c: forces and moments in a section, of the shapes by the law of the material
 *
 * They are what the part beyond the section exerts on the part before it, along the axes of the
 * section: EA u', EI v'', GJ phi'. Shear is the derivative of the moment, since a beam of Euler and
 * Bernoulli has no strain of shear. */
#include "component/beam.h"

#include <string.h>

typedef struct Section {
    const char *name;
    bool in_plane, in_space;
    ShapeFamily family;
    int order; /* of the derivative along the beam */
    const char *stiffness;
    int sign; /* w turns a section against y */
} Section;

static const Section sections[] = {
    {"axial", true, true, SHAPE_U, 1, "EA", 1},
    {"bending", true, false, SHAPE_V, 2, "EIz", 1},
    {"shear", true, false, SHAPE_V, 3, "EIz", -1},
    {"bendingz", false, true, SHAPE_V, 2, "EIz", 1},
    {"sheary", false, true, SHAPE_V, 3, "EIz", -1},
    {"bendingy", false, true, SHAPE_W, 2, "EIy", -1},
    {"shearz", false, true, SHAPE_W, 3, "EIy", -1},
    {"torsion", false, true, SHAPE_PHI, 1, "GJ", 1},
};

/* NULL: a beam has none of that name */
static const Section *section_named(bool planar, const char *name)
{
    const size_t length = strcspn(name, "(");

    for (int i = 0; i < COUNT(sections); i++)
        if ((planar ? sections[i].in_plane : sections[i].in_space) &&
            strncmp(sections[i].name, name, length) == 0 && sections[i].name[length] == '\0')
            return &sections[i];
    return NULL;
}

SectionForce beam_has_section(const Instance *instance, bool planar, const char *name)
{
    const Section *section = section_named(planar, name);
    int modes[SHAPE_FAMILIES];

    if (section == NULL)
        return SECTION_UNKNOWN;
    beam_modes(instance, planar, modes);
    return modes[section->family] > 0 ? SECTION_TOLD : SECTION_RIGID;
}

/* by xi: EA u', EI v'', or minus the derivative of the latter */
static Expr strained(const Beam *beam, const Section *section, const BeamShape *shape,
                     const Powers *stiffness, Expr xi)
{
    Arena *arena = beam->arena;
    const bool bends = beam_bends(shape);
    const Polynomial *curve = bends ? &shape->curve : &shape->slope;
    Polynomial third = polynomial_slope(curve);
    const Powers graded = powers_slope(arena, stiffness);
    const Expr value = beam_value_at(arena, curve, xi), next = beam_value_at(arena, &third, xi);
    const Expr held = powers_at(arena, stiffness, xi);
    Expr out = expr_mul(arena, held, value);

    polynomial_free(&third);
    if (section->order > 2)
        out = expr_add(arena, expr_mul(arena, held, next),
                       expr_mul(arena, powers_at(arena, &graded, xi), value));
    return out;
}

Expr beam_section(const Instance *instance, Arena *arena, bool planar, const char *name, Expr at,
                  const ShapeState *state)
{
    const Section *section = section_named(planar, name);
    Beam beam = beam_open(instance, arena, planar);
    const Powers stiffness = beam_key(&beam, section->stiffness);
    const Expr xi = expr_div(arena, at, beam.length);
    Expr sum = expr_int(arena, 0);

    for (int i = 0; i < beam.count; i++)
        if (beam.shapes[i].family == section->family)
            sum =
                expr_add(arena, sum,
                         expr_mul(arena, strained(&beam, section, &beam.shapes[i], &stiffness, xi),
                                  state->q[i]));
    for (int i = 0; i < section->order; i++)
        sum = expr_div(arena, sum, beam.length);
    beam_close(&beam);
    return section->sign > 0 ? sum : expr_neg(arena, sum);
}

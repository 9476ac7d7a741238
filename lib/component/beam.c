/* beam.c: elastic beams: the row of the table, and the values it refuses
 *
 * A beam is an edge from ground to its root frame, like a body; its shapes have coordinates of
 * their own. */
#include "component/beam.h"
#include "component/component_rows.h"

#include <math.h>
#include <string.h>

/* clang-format off */
static const Param params[] = {
    {"length",             PARAM_SCALAR, "m",     NULL, "along x of the undeformed root frame", 0},
    {"mass_per_length",    PARAM_SCALAR, "kg/m",  NULL, "mass per length", ALONG},
    {"inertia_per_length", PARAM_LIST,   "kg*m",  "",   "of the section per length: planar one number, spatial [Jx, Jy, Jz]; none: Euler-Bernoulli", ALONG},
    {"EA",                 PARAM_SCALAR, "N",     "0",  "axial stiffness", ALONG},
    {"EIy",                PARAM_SCALAR, "N*m^2", "0",  "bending stiffness about y, of w", ALONG},
    {"EIz",                PARAM_SCALAR, "N*m^2", "0",  "bending stiffness about z, of v", ALONG},
    {"GJ",                 PARAM_SCALAR, "N*m^2", "0",  "torsional stiffness", ALONG},
    {"modes",              PARAM_LIST,   "1",     NULL, "numbers of shapes: planar [axial, y], spatial [axial, y, z, torsion]", 0},
    {"basis",              PARAM_WORD,   NULL,    "legendre|taylor|chebyshev", "polynomials of the shapes", 0},
    {"stiffening",         PARAM_WORD,   NULL,    "full|linear|off", "effect of the shortening by bending: full, to first order in the "
                                                                     "shapes, or none", 0},
    {"damping",            PARAM_LIST,   NULL,    "",   "[alpha, beta]: -(alpha M0 + beta K) q' on the shapes", 0},
    {"load",               PARAM_LAWS,   "N/m",   "0",  "force per length, ground axes", ALONG},
    EULER_PARAM,
};
/* clang-format on */

#define NAMES(x)                                                                                   \
    {                                                                                              \
        x "1", x "2", x "3", x "4", x "5", x "6", x "7", x "8", x "9", x "10", x "11", x "12",     \
            x "13", x "14", x "15", x "16"                                                         \
    }

static const char *const names[SHAPE_FAMILIES][MOST_SHAPES] = {NAMES("u"), NAMES("v"), NAMES("w"),
                                                               NAMES("phi")};

static int shape_count(const Instance *instance, bool planar)
{
    int modes[SHAPE_FAMILIES];

    beam_modes(instance, planar, modes);
    return modes[SHAPE_U] + modes[SHAPE_V] + modes[SHAPE_W] + modes[SHAPE_PHI];
}

static CoordinateRow shape_coordinate(const Instance *instance, bool planar, int i)
{
    int modes[SHAPE_FAMILIES], family = 0;

    beam_modes(instance, planar, modes);
    for (; i >= modes[family]; family++) /* i is below their sum */
        i -= modes[family];
    return (CoordinateRow){names[family][i],
                           family == SHAPE_PHI ? COORDINATE_TWIST : COORDINATE_LENGTH, false};
}

/* --- checks --- */

/* `key`: the parameter that the message is about */
static Status refuse(const Instance *instance, const char *key, Diag *diag, const char *what,
                     const char *hint)
{
    (void)diag_set(diag, E_VALUE, "%s: %s", instance->name, what);
    diag_hint(diag, "%s", hint);
    diag_about(diag, "%s", key);
    return E_VALUE;
}

static Status check_modes(const Instance *instance, bool planar, Diag *diag)
{
    const Value *modes = instance_value(instance, "modes");
    const int wanted = planar ? 2 : SHAPE_FAMILIES;

    if (modes->count != wanted)
        return refuse(instance, "modes", diag,
                      planar ? "modes= has two entries in a planar scene"
                             : "modes= has four entries",
                      planar ? "modes=[axial, y], such as modes=[0, 3]"
                             : "modes=[axial, y, z, torsion], such as modes=[1, 3, 3, 1]");
    for (int f = 0; f < wanted; f++) {
        const Expr entry = modes->at[f];
        const double value = expr_is_number(entry) ? expr_value(entry) : -1;

        if (!(value >= 0 && value <= MOST_SHAPES && value == floor(value)))
            return refuse(instance, "modes", diag, "numbers of shapes are whole, from 0 to 16",
                          "modes=[1, 3] takes one axial shape and three of bending");
    }
    if (shape_count(instance, planar) != instance->coord_count - instance->pose_count)
        return refuse(instance, "modes", diag,
                      "numbers of shapes decide which coordinates there are",
                      "write them as numbers, such as modes=[1, 3], without parameters");
    if (shape_count(instance, planar) == 0)
        return refuse(instance, "modes", diag, "a beam without any shape is rigid",
                      "give modes= at least one shape, or make it a body");
    return OK;
}

/* For values that are numbers: a density or a stiffness is nowhere negative, and a density is 0 at
 * single points at most. */
static Status check_sign(const Instance *instance, const char *key, const Powers *p, Arena *arena,
                         Diag *diag)
{
    enum { PLACES = 64 }; /* five of each turn of the highest power */
    const bool is_mass = strcmp(key, "mass_per_length") == 0;
    bool has_some = false;

    for (int i = 0; i <= PLACES; i++) {
        const Expr value = powers_at(arena, p, expr_rational(arena, i, PLACES));

        if (!expr_is_number(value))
            return OK;
        has_some = has_some || expr_value(value) > 0;
        if (expr_value(value) >= 0)
            continue;
        (void)diag_set(diag, E_VALUE, "%s of %s is negative%s: %g", key, instance->name,
                       p->count > 1 ? " somewhere along it" : "", expr_value(value));
        diag_hint(diag, is_mass ? "it has to be positive" : "it is zero or positive");
        diag_about(diag, "%s", key);
        return E_VALUE;
    }
    if (has_some || !is_mass)
        return OK;
    (void)diag_set(diag, E_VALUE, "%s of %s is zero", key, instance->name);
    diag_hint(diag, "it has to be positive");
    diag_about(diag, "%s", key);
    return E_VALUE;
}

/* values that vary along the beam must be polynomials of x */
static Status check_along(const Instance *instance, Arena *arena, Diag *diag)
{
    for (int i = 0; i < COUNT(params); i++) {
        const Value *value = instance_value(instance, params[i].name);

        for (int k = 0; (params[i].use & ALONG) != 0 && k < value->count; k++) {
            const Powers p = beam_powers(instance, arena, value->at[k]);

            if (p.count == 0) {
                (void)diag_set(diag, E_VALUE, "%s: %s= is no polynomial in x", instance->name,
                               params[i].name);
                diag_hint(diag,
                          "x is the place along the beam: sums of its powers up to x^%d can "
                          "stand here; beams of other kinds are pieces welded together",
                          MOST_POWERS - 1);
                diag_about(diag, "%s", params[i].name);
                return E_VALUE;
            }
            if (params[i].kind != PARAM_LAWS)
                TRY(check_sign(instance, params[i].name, &p, arena, diag));
        }
    }
    return OK;
}

static Status check_stiffness(const Instance *instance, bool planar, Diag *diag)
{
    static const struct {
        const char *key, *of;
    } needs[SHAPE_FAMILIES] = {{"EA", "axial shapes need EA="},
                               {"EIz", "bending shapes of y need EIz="},
                               {"EIy", "bending shapes of z need EIy="},
                               {"GJ", "shapes of torsion need GJ="}};
    int modes[SHAPE_FAMILIES];

    beam_modes(instance, planar, modes);
    for (int f = 0; f < SHAPE_FAMILIES; f++) {
        if (modes[f] > 0 && !instance_value(instance, needs[f].key)->given)
            return refuse(instance, "modes", diag, needs[f].of,
                          "give the stiffness, or take these shapes out of modes=");
    }
    return OK;
}

static Status check_rotary(const Instance *instance, bool planar, Diag *diag)
{
    const Value *rotary = instance_value(instance, "inertia_per_length");
    int modes[SHAPE_FAMILIES];

    beam_modes(instance, planar, modes);
    if (rotary->count != 0 && rotary->count != (planar ? 1 : 3))
        return refuse(instance, "inertia_per_length", diag,
                      planar ? "inertia_per_length= is one number in a planar scene"
                             : "inertia_per_length= has three entries",
                      planar ? "write inertia_per_length=J, about z"
                             : "inertia_per_length=[Jx, Jy, Jz]");
    if (modes[SHAPE_PHI] > 0 && (rotary->count == 0 || expr_is_zero(rotary->at[0])))
        return refuse(instance, "inertia_per_length", diag, "shapes of torsion have no inertia",
                      "give inertia_per_length=[Jx, Jy, Jz], Jx above zero");
    return OK;
}

static Status check_damping(const Instance *instance, Diag *diag)
{
    const Value *damping = instance_value(instance, "damping");

    if (damping->count != 0 && damping->count != 2)
        return refuse(instance, "damping", diag, "damping= has two entries",
                      "damping=[alpha, beta], of the mass and of the stiffness");
    for (int k = 0; k < damping->count; k++)
        if (expr_is_number(damping->at[k]) && expr_value(damping->at[k]) < 0)
            return refuse(instance, "damping", diag, "damping= is negative",
                          "its entries are zero or positive");
    return OK;
}

static Status check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    TRY(attitude_check(instance, arena, planar, diag));
    TRY(check_modes(instance, planar, diag));
    TRY(check_along(instance, arena, diag));
    TRY(check_stiffness(instance, planar, diag));
    TRY(check_rotary(instance, planar, diag));
    return check_damping(instance, diag);
}

/* a monomial basis of many terms is nearly linearly dependent */
static void doubt(const Instance *instance, bool planar, Text *out)
{
    enum { MOST = 8 };
    int modes[SHAPE_FAMILIES];

    beam_modes(instance, planar, modes);
    for (int f = 0; f < SHAPE_FAMILIES; f++)
        if (modes[f] > MOST && instance_value(instance, "basis")->word[0] == 't') {
            text_addf(out,
                      "%s: %d shapes of basis=taylor lose digits to rounding; legendre doesn't\n",
                      instance->name, modes[f]);
            return;
        }
}

static const Deforming deforming = {
    shape_count,        shape_coordinate, beam_unit,    beam_load_powers,
    beam_section_frame, beam_inertia,     beam_section,
};

const Component component_beam = {
    .name = "beam",
    .family = FAMILY_BODY,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_NONE,
    .brief = "elastic beam along x of its root frame",
    .params = params,
    .param_count = COUNT(params),
    .coords = free_coords,
    .coord_count = FREE_COORDS,
    .coords_planar = free_coords_planar,
    .coord_count_planar = FREE_COORDS_PLANAR,
    .coords_of = free_coords_of,
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 50,
    .steps = free_steps,
    .deforming = &deforming,
    .positive = "length",
    .check = check,
    .doubt = doubt,
    .help = "Makes an elastic beam and a frame of the same name at its root. Its extension, "
            "bending and torsion are sums of polynomials along the beam (shapes), with the "
            "coordinates u1 .. (axial), v1 .. (along y), w1 .. (along z) and phi1 .. (torsion). "
            "The root is positioned like a body. Bending shortens the axis, which stiffens a "
            "spinning beam; stiffening=linear takes this to first order in the shapes, off "
            "omits it. Frames on the beam are arms with at=: arm tip b1 at=L. Mass, stiffness "
            "and load may be polynomials of x, the position along the beam: EIz=100*(1 - x/2)^3.",
    .example = "scene planar\nbeam b1 length=1 mass_per_length=2 EIz=100 modes=[0, 2]\n"
               "weld w1 ground b1\narm tip b1 at=1\nforce F1 tip [0, 1]\nequilibrium\n"
               "print tip.y",
    .see = "arm body weld modes",
};

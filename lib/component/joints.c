/* joints.c: joints that shift and turn along axes fixed in the tail
 *
 * u is the joint's axis; n1 and n2 complete a right-handed triad in the tail frame. The joint
 * primitives span the motion space; its complement is the reaction space. */
#include "component/component_rows.h"

/* clang-format off */
static const Param axis_params[] = {
    {"axis", PARAM_AXIS, "1", "z", "x y z -x -y -z, or a vector in the axes of the tail", 0},
};

static const Param normal_params[] = {
    {"normal", PARAM_AXIS, "1", "z", "of the plane, in the axes of the tail", 0},
};

static const CoordinateRow turn_coords[] = {{"", COORDINATE_ANGLE, true}};
static const CoordinateRow slide_coords[] = {{"", COORDINATE_LENGTH, false}};

static const CoordinateRow sleeve_coords[] = {
    {"s",     COORDINATE_LENGTH, false},
    {"theta", COORDINATE_ANGLE,  true},
};

static const CoordinateRow plane_coords[] = {
    {"s1",    COORDINATE_LENGTH, false},
    {"s2",    COORDINATE_LENGTH, false},
    {"theta", COORDINATE_ANGLE,  true},
};
/* clang-format on */

static void turn_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    (void)planar;
    steps_none(arena, out);
    steps_turn(arena, out, instance_value(instance, "axis")->at, 0);
}

const Component component_revolute = {
    .name = "revolute",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "hinge: one free rotation about an axis",
    .params = axis_params,
    .param_count = COUNT(axis_params),
    .coords = turn_coords,
    .coord_count = COUNT(turn_coords),
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = turn_steps,
    .help =
        "Allows the tip to turn relative to the tail about one axis fixed in the tail. The "
        "coordinate is the angle, positive about the axis (right hand); its name is that of the "
        "joint, or that of coord=. Reactions: three forces, two moments.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm pin rod [-1/2, 0]\nrevolute h1 ground pin coord=phi\n"
               "init phi = -60 deg\nsimulate 1\nprint phi, h1.fx",
    .see = "prismatic cylindrical universal arm driver motor virtual",
};

static void slide_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    (void)planar;
    steps_none(arena, out);
    steps_shift(arena, out, instance_value(instance, "axis")->at, 0);
}

const Component component_prismatic = {
    .name = "prismatic",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "slide: one free shift along an axis",
    .params = axis_params,
    .param_count = COUNT(axis_params),
    .coords = slide_coords,
    .coord_count = COUNT(slide_coords),
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = slide_steps,
    .help =
        "Allows the tip to slide relative to the tail along one axis fixed in the tail, without "
        "turning. The coordinate is the distance along the axis. Reactions: two forces, three "
        "moments.",
    .example = "scene planar\nbody cart mass=2 inertia=1\nprismatic s1 ground cart axis=x\n"
               "spring k1 s1 k=50 rest=0.1\ninit s1 = 0\nsimulate 1\nprint s1, s1'",
    .see = "revolute cylindrical spring",
};

static void sleeve_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    const Expr *u = instance_value(instance, "axis")->at;

    (void)planar;
    steps_none(arena, out);
    steps_shift(arena, out, u, 0);
    steps_turn(arena, out, u, 1);
}

const Component component_cylindrical = {
    .name = "cylindrical",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "sleeve on a shaft: a shift along an axis and a turn about it",
    .params = axis_params,
    .param_count = COUNT(axis_params),
    .coords = sleeve_coords,
    .coord_count = COUNT(sleeve_coords),
    .not_in_plane = "revolute or prismatic",
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = sleeve_steps,
    .help = "Allows the tip to slide along one axis fixed in the tail and to turn about it, "
            "independently. Coordinates: s, the distance, and theta, the angle. Reactions: two "
            "forces, two moments.",
    .example = "gravity [0, 0, -9.81]\nbody sleeve mass=0.5 inertia=[1e-3, 1e-3, 2e-3]\n"
               "cylindrical c1 ground sleeve axis=z\nspring k1 c1.s k=40\n"
               "init c1.s = 0, c1.theta = 0, c1.theta' = 3\nsimulate 1\nprint c1.s, c1.theta",
    .see = "prismatic revolute screw",
};

static void plane_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    const Expr *u = instance_value(instance, "normal")->at;
    Expr n1[3];
    Expr n2[3];

    (void)planar;
    steps_none(arena, out);
    axis_complement(arena, u, n1, n2);
    steps_shift(arena, out, n1, 0);
    steps_shift(arena, out, n2, 1);
    steps_turn(arena, out, u, 2);
}

const Component component_planarjoint = {
    .name = "planarjoint",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "plane on plane: two shifts and the turn about the normal",
    .params = normal_params,
    .param_count = COUNT(normal_params),
    .coords = plane_coords,
    .coord_count = COUNT(plane_coords),
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = plane_steps,
    .help = "Allows the tip to move in a plane fixed in the tail and to turn about its normal. "
            "Coordinates: s1 s2 along two axes in the plane (x and y for the normal z, cyclically "
            "for the others) and theta about the normal. Reactions: one force, two moments.",
    .example = "scene planar\ngravity [0, -9.81]\nbody disk mass=1 inertia=0.1\n"
               "planarjoint p1 ground disk\ninit p1.s1' = 1, p1.theta' = 2\n"
               "simulate 1\nprint p1.s1, p1.s2, p1.theta",
    .see = "free prismatic revolute",
};

static void weld_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    (void)instance;
    (void)planar;
    steps_none(arena, out);
}

const Component component_weld = {
    .name = "weld",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "holds two frames together",
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = weld_steps,
    .help = "Joins the tip's frame to the tail's in position and attitude. It has no "
            "coordinate. Unlike an arm it may be a chord, and its force and moment are "
            "available.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm left rod [-1/2, 0]\narm right rod [1/2, 0]\nbody bob mass=0.3 inertia=0\n"
               "revolute h1 ground left\nweld w1 right bob\ninit h1 = 0\nsimulate 1\n"
               "print h1, w1.fy",
    .see = "arm revolute",
};

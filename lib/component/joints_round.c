/* joints_round.c: joints that turn about several axes, and the free joint */
#include "component/component_rows.h"

#include <math.h>

/* clang-format off */
static const Param cross_params[] = {
    {"axes", PARAM_AXES, "1", "x y", "the first in the axes of the tail, the second in those that the first turn made; square to each other", 0},
};

static const Param euler_params[] = {EULER_PARAM};

static const CoordinateRow cross_coords[] = {
    {"a1", COORDINATE_ANGLE, POSITIONAL},
    {"a2", COORDINATE_ANGLE, POSITIONAL},
};
/* clang-format on */

static void cross_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    const Expr *axes = instance_value(instance, "axes")->at;

    (void)planar;
    steps_none(arena, out);
    steps_turn(arena, out, axes, 0);
    steps_turn(arena, out, axes + 3, 1);
}

/* u1 . u2 = 0: the constraint of a chord requires it */
static Status cross_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const Expr *axes = instance_value(instance, "axes")->at;
    Expr terms[3];
    double dot, angle;
    Status status;

    (void)planar;
    for (int i = 0; i < 3; i++)
        terms[i] = expr_mul(arena, axes[i], axes[3 + i]);
    dot = expr_evaluate(expr_sum(arena, terms, 3), NULL, NULL);
    if (fabs(dot) < 1e-12)
        return OK;
    angle = acos(fmax(-1.0, fmin(1.0, dot)));
    status = diag_set(diag, E_VALUE, "the axes of %s stand at %.6g deg to each other, not 90",
                      instance->name, angle * 180.0 / M_PI);
    diag_hint(diag, "a cross has square arms; two revolutes and a body turn about any axes");
    diag_about(diag, "axes");
    return status;
}

const Component component_universal = {
    .name = "universal",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "cross: a turn about one axis, then about another perpendicular to it",
    .params = cross_params,
    .param_count = COUNT(cross_params),
    .coords = cross_coords,
    .coord_count = COUNT(cross_coords),
    .not_in_plane = "revolute",
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = cross_steps,
    .check = cross_check,
    .help = "Allows the tip to turn about an axis fixed in the tail (angle a1), then about one "
            "fixed in the cross and in the tip (angle a2). If both angles are zero, the frames "
            "coincide. Reactions: three forces, and the moment about the third axis of the "
            "cross.",
    .example = "gravity [0, 0, -9.81]\nbody rod mass=1 inertia=[1/12, 1/12, 1e-4]\n"
               "arm top rod [0, 0, 1/2]\nuniversal u1 ground top axes=[x, y]\n"
               "init u1.a1 = 0.3, u1.a2 = 0.1\nsimulate 1\nprint u1.a1, u1.a2",
    .see = "revolute spherical",
};

static void ball_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    (void)planar;
    steps_none(arena, out);
    attitude_steps(instance, arena, 0, out);
}

const Component component_spherical = {
    .name = "spherical",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "ball in a socket: every rotation about a common point",
    .params = euler_params,
    .param_count = COUNT(euler_params),
    .coords = free_coords + FREE_SHIFTS,
    .coord_count = FREE_COORDS - FREE_SHIFTS,
    .coords_of = spherical_coords_of,
    .not_in_plane = "revolute",
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = ball_steps,
    .help = "Joins the origins of two frames and allows every rotation of the tip. Coordinates: "
            "Euler parameters q0 q1 q2 q3, scalar part first, tip to tail, or with euler=zxz "
            "and similar sequences three angles a1 a2 a3. Sequences with equal first and last "
            "axes (zxz) are singular where a2 is 0 or half a turn, the others (zyx) where it is "
            "a quarter of a turn; Euler parameters have no singularity. Angles of a chord "
            "follow from its attitude: a1 and a3 within half a turn of 0, and a2 from 0 to half "
            "a turn (zxz) or within a quarter of a turn (zyx). Reactions: three forces.",
    .example = "gravity [0, 0, -9.81]\nbody top mass=15 inertia=[0.3, 0.5, 0.3]\n"
               "arm P top [0, -1, 0]\nspherical b1 ground P\ninit top.wy = 150\n"
               "simulate 0.1\nprint top.x, top.y, top.z",
    .see = "universal free body",
};

const Component component_free_joint = {
    .name = "free",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "no constraint: every motion of the tip against the tail",
    .params = euler_params,
    .param_count = COUNT(euler_params),
    .coords = free_coords,
    .coord_count = FREE_COORDS,
    .coords_planar = free_coords_planar,
    .coord_count_planar = FREE_COORDS_PLANAR,
    .coords_of = free_coords_of,
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 10,
    .steps = free_steps,
    .check = attitude_check,
    .help = "Allows every motion of the tip relative to the tail. As a branch it has the "
            "coordinates of one frame relative to another: x y z in the axes of the tail and "
            "Euler parameters q0 q1 q2 q3, or with euler= angles a1 a2 a3 (planar: x y theta). "
            "As a chord it constrains nothing.",
    .example = "scene planar\nbody ship mass=100 inertia=10\nbody boat mass=1 inertia=0.1\n"
               "free f1 ship boat\ntree ship f1\ninit f1.x = 5, f1.x' = -1\nsimulate 1\n"
               "print f1.x, boat.x",
    .see = "planarjoint spherical virtual body",
};

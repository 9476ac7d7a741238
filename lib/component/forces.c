/* forces.c: forces and torques: on a frame, along a line, on a joint's coordinate
 *
 * x is the distance of the two frames or the joint's coordinate, x' its rate. An effort is the one
 * on the head: a positive one pushes it away from the tail, or acts in the positive direction of
 * the coordinate. */
#include "component/component_rows.h"

/* clang-format off */
static const Param force_params[] = {
    {"force", PARAM_LAWS, "N", NULL, "components along x, y (and z)", POSITIONAL | GIVES_LOAD},
    {"in",    PARAM_WORD, NULL, "ground|body", "axes of the components", 0},
};

static const Param torque_params[] = {
    {"torque", PARAM_MOMENT, "N*m", NULL, "planar one number, spatial components along x, y, z", POSITIONAL | GIVES_LOAD},
    {"in",     PARAM_WORD, NULL, "ground|body", "axes of the components", 0},
};

static const Param spring_params[] = {
    {"k",      PARAM_SCALAR, "N/m|N*m",     NULL, "stiffness", 0},
    {"length", PARAM_SCALAR, "m|rad",       "0",  "of the relaxed spring between two frames", 0},
    {"rest",   PARAM_SCALAR, "m|rad",       "0", "coordinate at which a spring on a joint is relaxed", 0},
    {"d",      PARAM_SCALAR, "N*s/m|N*m*s", "0", "damping in parallel with the spring", 0},
};

static const Param damper_params[] = {
    {"d", PARAM_LAW, "N*s/m|N*m*s", NULL, "force per rate, against the motion", 0},
};

static const Param actuator_params[] = {
    {"force",  PARAM_LAW, "N",   "0", "between two frames, or on a slide's coordinate", GIVES_LOAD},
    {"torque", PARAM_LAW, "N*m", "0", "on the coordinate of a hinge", GIVES_LOAD},
};

static const Member effort_members[] = {
    {"effort", NULL, "force along the line or on the coordinate, on the tip", 0},
};
/* clang-format on */

static void zeros(Arena *arena, Expr v[3])
{
    v[0] = v[1] = v[2] = expr_int(arena, 0);
}

static bool in_body_axes(const Instance *instance)
{
    return instance_value(instance, "in")->word[0] == 'b';
}

static void force_wrench(const Instance *instance, Arena *arena, bool planar, Expr force[3],
                         Expr torque[3], bool *in_body)
{
    const Value *value = instance_value(instance, "force");

    (void)planar;
    zeros(arena, torque);
    for (int i = 0; i < 3; i++)
        force[i] = value->at[i];
    *in_body = in_body_axes(instance);
}

const Component component_force = {
    .name = "force",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_ON,
    .brief = "force on a frame",
    .params = force_params,
    .param_count = COUNT(force_params),
    .wrench = force_wrench,
    .help = "A force on the origin of a frame, with components in ground axes or, with in=body, "
            "in those of the frame. Each component may use t, parameters and other variables. A "
            "multiple of an acceleration, as in 3 - 2*m1.x'', is inertia, 2 kg here.",
    .example = "scene planar\nbody m1 mass=2 inertia=0.1\nforce F1 m1 [3*sin(2*t), -m1.vy]\n"
               "simulate 1\nprint m1.x",
    .see = "torque gravity actuator",
};

static void torque_wrench(const Instance *instance, Arena *arena, bool planar, Expr force[3],
                          Expr torque[3], bool *in_body)
{
    const Value *value = instance_value(instance, "torque");

    zeros(arena, force);
    zeros(arena, torque);
    if (planar)
        torque[2] = value->at[0];
    else
        for (int i = 0; i < 3; i++)
            torque[i] = value->at[i];
    *in_body = in_body_axes(instance);
}

const Component component_torque = {
    .name = "torque",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_ON,
    .brief = "torque on the body of a frame",
    .params = torque_params,
    .param_count = COUNT(torque_params),
    .wrench = torque_wrench,
    .help = "A torque on the body of a frame; planar one number, about z. Components in ground "
            "axes or, with in=body, in those of the frame.",
    .example = "scene planar\nbody wheel mass=2 inertia=0.1\nrevolute h1 ground wheel\n"
               "torque T1 wheel 0.3*cos(t)\nsimulate 1\nprint h1'",
    .see = "force actuator motor",
};

/* length or coordinate at which a spring is relaxed */
static Expr relaxed(const Instance *instance)
{
    return instance_scalar(instance, instance->joint >= 0 ? "rest" : "length");
}

static Expr spring_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr stretch = expr_sub(arena, motion->displacement, relaxed(instance));
    Expr pull = expr_mul(arena, instance_scalar(instance, "k"), stretch);
    Expr drag = expr_mul(arena, instance_scalar(instance, "d"), motion->rate);

    return expr_neg(arena, expr_add(arena, pull, drag));
}

static Expr spring_potential(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr stretch = expr_sub(arena, motion->displacement, relaxed(instance));

    return expr_mul(arena, expr_rational(arena, 1, 2),
                    expr_mul(arena, instance_scalar(instance, "k"), expr_square(arena, stretch)));
}

static Status spring_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    bool on_joint = instance->joint >= 0;
    const char *wrong = on_joint ? "length" : "rest";
    Status status;

    (void)arena;
    (void)planar;
    if (!instance_value(instance, wrong)->given)
        return OK;
    status = diag_set(diag, E_VALUE, "%s= is for a spring %s", wrong,
                      on_joint ? "between two frames" : "on a joint");
    diag_hint(diag, "where it is relaxed is said with %s= here", on_joint ? "rest" : "length");
    diag_about(diag, "%s", wrong);
    return status;
}

const Component component_spring = {
    .name = "spring",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_LINK,
    .brief = "spring along the line between two frames, or on a joint",
    .params = spring_params,
    .param_count = COUNT(spring_params),
    .effort = spring_effort,
    .potential = spring_potential,
    .members = effort_members,
    .member_count = COUNT(effort_members),
    .check = spring_check,
    .help =
        "Between two frames: the force on the tip along their line is -(k*(distance - length) + "
        "d*rate); a positive force pushes the tip away. On a joint: -(k*(coordinate - rest) + "
        "d*rate) on its tip, a torque if the coordinate is an angle.",
    .example =
        "scene planar\nbody m1 mass=1 inertia=0\nprismatic s1 ground m1 axis=x\n"
        "spring k1 s1 k=40 rest=0.2\narm wall ground [-1, 0]\nspring k2 wall m1 k=10 length=1\n"
        "init s1 = 0.3\nsimulate 1\nprint s1, k1.effort",
    .see = "damper actuator",
};

static Expr damper_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_neg(arena, expr_mul(arena, instance_scalar(instance, "d"), motion->rate));
}

const Component component_damper = {
    .name = "damper",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_LINK,
    .brief = "damper along the line between two frames, or on a joint",
    .params = damper_params,
    .param_count = COUNT(damper_params),
    .effort = damper_effort,
    .members = effort_members,
    .member_count = COUNT(effort_members),
    .help = "The force on the tip is -d times the rate of the distance between two frames, or "
            "of the joint's coordinate (a torque if that is an angle).",
    .example = "scene planar\nbody m1 mass=1 inertia=0\nprismatic s1 ground m1 axis=x\n"
               "damper d1 s1 d=2\ninit s1' = 1\nsimulate 1\nprint s1', d1.effort",
    .see = "spring actuator",
};

static Expr actuator_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    (void)arena;
    (void)motion;
    return instance_scalar(instance, instance->on_angle ? "torque" : "force");
}

static Status actuator_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const char *right = instance->on_angle ? "torque" : "force";
    const char *wrong = instance->on_angle ? "force" : "torque";
    Status status;

    (void)arena;
    (void)planar;
    if (instance_value(instance, right)->given && !instance_value(instance, wrong)->given)
        return OK;
    if (instance_value(instance, wrong)->given) {
        status = diag_set(diag, E_VALUE, "%s= does not fit: %s acts on %s", wrong, instance->name,
                          instance->on_angle    ? "an angle"
                          : instance->joint < 0 ? "the line between two frames"
                                                : "a length");
        diag_hint(diag, "use %s=", right);
        diag_about(diag, "%s", wrong);
        return status;
    }
    status = diag_set(diag, E_VALUE, "%s needs %s=", instance->name, right);
    diag_hint(diag, "an expression of t, parameters and variables: %s=2*sin(t)", right);
    return status;
}

const Component component_actuator = {
    .name = "actuator",
    .family = FAMILY_FORCE,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_LINK,
    .brief = "given force between two frames, or force or torque on a joint",
    .params = actuator_params,
    .param_count = COUNT(actuator_params),
    .effort = actuator_effort,
    .members = effort_members,
    .member_count = COUNT(effort_members),
    .check = actuator_check,
    .help =
        "Between two frames: force= along their line; a positive force pushes the tip away from "
        "the tail. On a joint: force= on a slide, torque= on a hinge, positive in the direction "
        "of the coordinate. It may be any expression of t, parameters and variables: "
        "force=-5*sign(s1') is dry friction, which also holds at rest.",
    .example = "scene planar\nbody wheel mass=1 inertia=0.1\nrevolute h1 ground wheel\n"
               "actuator a1 h1 torque=2*(1 - h1) - 0.5*h1'\nsimulate 5\nprint h1, a1.effort",
    .see = "spring motor force",
};

/* driver.c: a coordinate that follows a given function of time */
#include "component/component_rows.h"

/* clang-format off */
static const Param params[] = {
    {"value", PARAM_LAW, "m|rad", NULL, "what the coordinate follows: an expression of t and parameters", 0},
};

static const Member members[] = {
    {"effort", NULL, "force or torque that the driver takes, along the coordinate", 0},
};
/* clang-format on */

static Expr prescribed(const Instance *instance, Arena *arena)
{
    (void)arena;
    return instance_scalar(instance, "value");
}

const Component component_driver = {
    .name = "driver",
    .family = FAMILY_DRIVER,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_COORDINATE,
    .brief = "prescribes a coordinate as a function of time",
    .params = params,
    .param_count = COUNT(params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 90,
    .prescribed = prescribed,
    .members = members,
    .member_count = COUNT(members),
    .help = "Makes a coordinate of a joint or a body follow an expression of t. Its effort is the "
            "force or torque that this takes. With by= another coordinate or a source supplies "
            "the motion instead, in inverse runs.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm pin rod [-1/2, 0]\nrevolute h1 ground pin\ndriver D1 h1 = 2*pi*t\n"
               "inverse 1 every=0.1\nprint D1.effort",
    .see = "inverse kinematics motor",
};

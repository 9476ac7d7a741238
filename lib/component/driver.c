/* driver.c: a coordinate that follows time, and one that follows others: gears, racks, cams,
 * differentials
 *
 * q = f(t), or q = f(c1, c2, ..), is one constraint row, q - f = 0. Its multiplier is the effort on
 * q along that coordinate. For a coupler, -df/dc times this effort acts on each c, so that it does
 * no work. q' = f(c, c', t), linear in the rates c', is a velocity row likewise, with -df/dc'. */
#include "component/component_rows.h"

/* clang-format off */
static const Param driver_params[] = {
    {"value", PARAM_LAW, "m|rad", NULL, "the prescribed coordinate: an expression of t and parameters", 0},
};

static const Member driver_members[] = {
    {"effort", NULL, "force or torque that the driver needs, along the coordinate", 0},
};

static const Param coupler_params[] = {
    {"value", PARAM_LAW, "m|rad", NULL, "the coordinate: an expression of other joints' coordinates", 0},
};

static const Param rates_params[] = {
    {"value", PARAM_LAW, "m/s|rad/s", NULL, "the rate: an expression of other rates, coordinates and t", 0},
};

static const Member coupler_members[] = {
    {"effort", NULL, "force or torque on the coordinate, along it", 0},
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
    .params = driver_params,
    .param_count = COUNT(driver_params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 90,
    .prescribed = prescribed,
    .members = driver_members,
    .member_count = COUNT(driver_members),
    .help = "Prescribes the coordinate of a joint or a body as an expression of t. Its effort "
            "is the force or torque that this needs. With by= another coordinate or a source "
            "produces the motion instead, in inverse runs.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm pin rod [-1/2, 0]\nrevolute h1 ground pin\ndriver D1 h1 = 2*pi*t\n"
               "inverse 1 every=0.1\nprint D1.effort",
    .see = "inverse kinematics motor",
};

#define COUPLER                                                                                    \
    .name = "coupler", .family = FAMILY_COUPLER, .domain = DOMAIN_MECHANICAL,                      \
    .places = PLACES_COORDINATE, .translation = BRANCH_NEVER, .rotation = BRANCH_NEVER,            \
    .preference = 90, .prescribed = prescribed, .members = coupler_members,                        \
    .member_count = COUNT(coupler_members)

/* coupler C1 x' = ...: in place of the other where the coordinate has a prime */
static const Component coupler_of_rates = {
    COUPLER,
    .is_of_rates = true,
    .brief = "a rate as a function of others",
    .params = rates_params,
    .param_count = COUNT(rates_params),
    .see = "driver roll knife",
};

static const Component *const coupler_variants[] = {&coupler_of_rates, NULL};

const Component component_coupler = {
    COUPLER,
    .variants = coupler_variants,
    .brief = "gears, racks, cams: a coordinate as a function of others",
    .params = coupler_params,
    .param_count = COUNT(coupler_params),
    .help =
        "Makes the coordinate of a joint a function of those of other joints, without play or "
        "elasticity: gears (coupler C1 h2 = -20/60*h1), a rack (s = 0.03*h1), a differential "
        "(h3 = (h1 + h2)/2), a cam (s = table(\"cam.csv\", h1)). Each coupler removes one "
        "degree of freedom. Its effort acts on the coordinate, and the corresponding efforts on "
        "the others; in total it does no work. The reactions of each joint include the "
        "effort on its own coordinate. With a prime it gives the rate of a coordinate of a joint "
        "or a body, by others and their rates, of which it is linear: coupler C1 w.x' = "
        "0.1*w.theta'*cos(phi). That takes a freedom of motion, but none of place.",
    .example = "scene planar\nbody a inertia=1 mass=1; body b inertia=3 mass=1\n"
               "revolute h1 ground a; revolute h2 ground b\ncoupler C1 h2 = -h1/2\n"
               "actuator T1 h1 torque=7\nsimulate 1\nprint h1, h2, C1.effort",
    .see = "driver gear screw roll",
};

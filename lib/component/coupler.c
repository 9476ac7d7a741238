/* coupler.c: a coordinate that is a function of others: gears, racks, cams, differentials
 *
 * q = f(c1, c2, ..) is one row of the constraints, q - f. Its multiplier is the effort on q along
 * that coordinate, and -df/dc of it act on each c, so that it does no work. */
#include "component/component_rows.h"

/* clang-format off */
static const Param params[] = {
    {"value", PARAM_LAW, "m|rad", NULL, "what the coordinate is: an expression of other joints' coordinates", 0},
};

static const Member members[] = {
    {"effort", NULL, "force or torque on the coordinate, along it", 0},
};
/* clang-format on */

static Expr prescribed(const Instance *instance, Arena *arena)
{
    (void)arena;
    return instance_scalar(instance, "value");
}

const Component component_coupler = {
    .name = "coupler",
    .family = FAMILY_COUPLER,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_COORDINATE,
    .brief = "gears, racks, cams: a coordinate as a function of others",
    .params = params,
    .param_count = COUNT(params),
    .translation = BRANCH_NEVER,
    .rotation = BRANCH_NEVER,
    .preference = 90,
    .prescribed = prescribed,
    .members = members,
    .member_count = COUNT(members),
    .help =
        "Ties the coordinate of a joint to those of other joints, without play or elasticity: "
        "gears (coupler C1 h2 = -20/60*h1), a rack (s = 0.03*h1), a differential "
        "(h3 = (h1 + h2)/2), a cam (s = table(\"cam.csv\", h1)). One freedom less for each. Its "
        "effort acts on the coordinate, and what follows from it on the others; it does no "
        "work. The bearings are the joints': they feel what acts on their own coordinate.",
    .example = "scene planar\nbody a inertia=1 mass=1; body b inertia=3 mass=1\n"
               "revolute h1 ground a; revolute h2 ground b\ncoupler C1 h2 = -h1/2\n"
               "actuator T1 h1 torque=7\nsimulate 1\nprint h1, h2, C1.effort",
    .see = "driver gear screw",
};

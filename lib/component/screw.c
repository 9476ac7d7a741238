/* screw.c: the joint whose shift follows from its turn
 *
 * u is the axis (unit vector), h the pitch (m), the shift of one turn, and theta the coordinate
 * (rad): the head shifts by h theta / (2 pi) along u and turns by theta about it. */
#include "component/component_rows.h"

#include <math.h>

/* clang-format off */
static const Param screw_params[] = {
    {"pitch", PARAM_SCALAR, "m", NULL, "shift along the axis for one full turn; negative for a left-hand thread", 0},
    {"axis",  PARAM_AXIS,   "1", "z",  "x y z -x -y -z, or a vector in the axes of the tail", 0},
};

static const CoordinateRow screw_coords[] = {{"theta", COORDINATE_ANGLE, true}};

static const Member screw_members[] = {
    {"s", "m", "shift along the axis", 2},
};
/* clang-format on */

static void screw_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    const Expr *u = instance_value(instance, "axis")->at;

    (void)planar;
    steps_none(arena, out);
    steps_shift(arena, out, u, 0);
    steps_turn(arena, out, u, 0);
    out->shift[0].scale = expr_product(arena,
                                       (Expr[]){instance_scalar(instance, "pitch"),
                                                expr_rational(arena, 1, 2), expr_pi(arena, -1)},
                                       3);
}

/* A screw is a branch of both trees or of none, so it comes before the other joints in both: then
 * the same screws close a circuit of screws in either tree. */
enum { BEFORE_OTHERS = 5 };

const Component component_screw = {
    .name = "screw",
    .family = FAMILY_JOINT,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FRAMES,
    .brief = "thread: a turn that shifts along its axis",
    .params = screw_params,
    .param_count = COUNT(screw_params),
    .coords = screw_coords,
    .coord_count = COUNT(screw_coords),
    .not_in_plane = "revolute or prismatic",
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = BEFORE_OTHERS,
    .steps = screw_steps,
    .members = screw_members,
    .member_count = COUNT(screw_members),
    .help = "Allows the tip to turn about an axis fixed in the tail, and shifts it by the pitch "
            "for each turn. The coordinate is theta, the angle; s, the shift, follows from it. "
            "A screw is a branch of both trees or of none. Reactions: three forces and two "
            "moments; the axial force also causes the moment -pitch/(2 pi) times itself about "
            "the axis.",
    .example = "gravity [0, 0, -9.81]\nbody nut mass=0.2 inertia=[1e-4, 1e-4, 2e-4]\n"
               "screw s1 ground nut pitch=10 mm axis=z\nshow coordinates",
    .see = "cylindrical revolute prismatic",
};

/* bodies.c: what has mass, and the frames fixed in it
 *
 * A body is an edge from ground to its mass centre; an arm leads from a frame to
 * another one of the same body. */
#include "component/component_rows.h"

/* clang-format off */
static const Param body_params[] = {
    /* name      kind           unit       default  meaning */
    {"mass",    PARAM_SCALAR,  "kg",      NULL,    "mass", false},
    {"inertia", PARAM_INERTIA, "kg*m^2",  "0",     "about the mass centre, in the body's axes: planar one number, spatial [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] (tensor entries)", false},
    EULER_PARAM,
};

static const Param arm_params[] = {
    {"position", PARAM_VECTOR,   "m", "0", "of the new frame's origin, in the axes of the frame it starts from", true},
    {"rotation", PARAM_ROTATION, "1", "1", "how the new frame is turned: z(90 deg)*x(a) about z, then about the new x", false},
};
/* clang-format on */

static void body_inertia(const Instance *instance, Arena *arena, bool planar, Expr *mass,
                         Expr tensor[6])
{
    const Value *inertia = instance_value(instance, "inertia");

    for (int i = 0; i < 6; i++)
        tensor[i] = i < inertia->count ? inertia->at[i] : expr_int(arena, 0);
    if (planar) {
        tensor[2] = inertia->at[0];
        tensor[0] = tensor[1] = expr_int(arena, 0);
    }
    *mass = instance_scalar(instance, "mass");
}

static bool is_negative(Expr e)
{
    return expr_is_number(e) && expr_value(e) < 0.0;
}

static Status body_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    const Value *inertia = instance_value(instance, "inertia");
    double I[3];
    Status status = OK;

    CHECK(attitude_check(instance, arena, planar, diag));
    if (is_negative(instance_scalar(instance, "mass")))
        return diag_set(diag, E_VALUE, "the mass of %s is negative", instance->name);
    for (int i = 0; i < inertia->count && i < 3; i++)
        if (is_negative(inertia->at[i]))
            return diag_set(diag, E_VALUE, "a moment of inertia of %s is negative", instance->name);
    if (inertia->count < 3)
        return OK;
    for (int i = 0; i < 3; i++) {
        if (!expr_is_number(inertia->at[i]))
            return OK;
        I[i] = expr_value(inertia->at[i]);
    }
    /* Ixx = int y^2+z^2 dm and so on: none is larger than the other two together */
    for (int i = 0; i < 3; i++)
        if (I[i] > (I[(i + 1) % 3] + I[(i + 2) % 3]) * (1.0 + 1e-9)) {
            status = diag_set(diag, E_VALUE, "no body has the moments of inertia %g, %g, %g of %s",
                              I[0], I[1], I[2], instance->name);
            diag_hint(diag, "none of them can be larger than the sum of the other two");
            return status;
        }
done:
    return status;
}

const Component component_body = {
    .name = "body",
    .family = FAMILY_BODY,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_NONE,
    .brief = "rigid body; its frame is at the mass centre",
    .params = body_params,
    .param_count = COUNT(body_params),
    .coords = free_coords,
    .coord_count = FREE_COORDS,
    .coords_planar = free_coords_planar,
    .coord_count_planar = FREE_COORDS_PLANAR,
    .coords_of = free_coords_of,
    .translation = BRANCH_MAY,
    .rotation = BRANCH_MAY,
    .preference = 50,
    .steps = free_steps,
    .inertia = body_inertia,
    .check = body_check,
    .help =
        "Makes a rigid body and the frame of its name, at the mass centre. In the graph it is an "
        "edge from ground to that frame. As a branch it brings absolute coordinates (planar: "
        "x y theta; spatial: x y z and Euler parameters q0 q1 q2 q3, or with euler= three angles "
        "a1 a2 a3, which have a singular attitude), as a chord its motion follows from the joints.",
    .example = "scene planar\ngravity [0, -9.81]\nbody ball mass=0.2 inertia=1e-4\n"
               "init ball.vx = 3, ball.vy = 4\nsimulate 1\nprint ball.x, ball.y",
    .see = "arm gravity force revolute",
};

static void arm_steps(const Instance *instance, Arena *arena, bool planar, Steps *out)
{
    const Value *position = instance_value(instance, "position");
    const Value *rotation = instance_value(instance, "rotation");

    (void)planar;
    steps_none(arena, out);
    for (int i = 0; i < 3; i++)
        out->constant[i] = position->at[i];
    for (int i = 0; i < 9; i++)
        out->rotation[i] = rotation->at[i];
}

const Component component_arm = {
    .name = "arm",
    .family = FAMILY_ARM,
    .domain = DOMAIN_MECHANICAL,
    .places = PLACES_FROM,
    .brief = "a further frame fixed in the body of a frame, or on ground",
    .params = arm_params,
    .param_count = COUNT(arm_params),
    .translation = BRANCH_ALWAYS,
    .rotation = BRANCH_ALWAYS,
    .preference = 0,
    .steps = arm_steps,
    .help = "Makes the frame of its name, at a fixed position and, with rotation=, in a fixed "
            "attitude against the frame it starts from. Joints and forces act on such frames. Arms "
            "are branches of every tree.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm tip rod [1/2, 0]\narm pin rod [-1/2, 0]\nrevolute h1 ground pin\n"
               "init h1 = 0\nsimulate 1\nprint tip.x, tip.y",
    .see = "body revolute",
};

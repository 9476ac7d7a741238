/* bodies.c: parts with mass, and the frames fixed in them
 *
 * A body is an edge from ground to its mass centre. An arm is an edge from a frame to another frame
 * of the same body. */
#include "component/component_rows.h"

#include <math.h>

/* relative to the largest entry of a tensor: rounding error of its arithmetic */
#define ROUNDING 1e-12
#define CARELESS 1e-6 /* relative to half the trace: entries with six digits give no message */

/* clang-format off */
static const Param body_params[] = {
    /* name      kind           unit       default  meaning */
    {"mass",    PARAM_SCALAR,  "kg",      NULL,    "mass", 0},
    {"inertia", PARAM_INERTIA, "kg*m^2",  "0",     "about the mass centre, in the body's axes: planar one number, spatial [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] (tensor entries)", 0},
    EULER_PARAM,
};

static const Param arm_params[] = {
    {"position", PARAM_VECTOR,   "m", "0", "of the new frame's origin, in the axes of the frame it starts from", POSITIONAL},
    {"at",       PARAM_SCALAR,   "m", "0", "on a beam: the position along it, from its root", 0},
    {"rotation", PARAM_ROTATION, "1", "1", "rotation of the new frame: z(90 deg)*x(a) about z, then about the new x", 0},
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

/* Whether a + rounding*1 of a symmetric 3 x 3 matrix is positive definite: by the pivots of its
 * Cholesky factor. Entries in the order of body_inertia(). */
static bool is_positive(const double a[6], double rounding)
{
    const double d0 = a[0] + rounding, l1 = a[3] / d0, l2 = a[4] / d0;
    const double d1 = a[1] + rounding - l1 * a[3];
    const double m = a[5] - l2 * a[3];

    return d0 > 0 && d1 > 0 && a[2] + rounding - l2 * a[4] - m * m / d1 > 0;
}

/* the tensor as numbers, and the rounding error of an entry; false where it has no values yet */
static bool read_tensor(const Instance *instance, double out[6], double *rounding)
{
    const Value *inertia = instance_value(instance, "inertia");

    *rounding = 0;
    for (int i = 0; i < 6; i++) {
        if (i < inertia->count && !expr_is_number(inertia->at[i]))
            return false;
        out[i] = i < inertia->count ? expr_value(inertia->at[i]) : 0;
        *rounding = fmax(*rounding, ROUNDING * fabs(out[i]));
    }
    return true;
}

static Status refuse_inertia(const Instance *instance, bool planar, Diag *diag)
{
    const char *const axes[] = {"x", "y", "z"};
    double a[6], rounding;
    Status status = OK;

    if (!read_tensor(instance, a, &rounding) || rounding == 0)
        return OK;
    for (int i = 0; i < (planar ? 1 : 3); i++)
        if (a[i] < 0) {
            status = diag_set(diag, E_VALUE, "a moment of inertia of %s is negative: %g about %s",
                              instance->name, a[i], axes[planar ? 2 : i]);
            diag_hint(diag, "it is zero or positive");
            diag_about(diag, "inertia");
            return status;
        }
    if (planar || is_positive(a, rounding))
        return OK;
    status = diag_set(diag, E_VALUE,
                      "no body has the inertia of %s: about some axis its moment is negative",
                      instance->name);
    diag_hint(diag, "the entries of the tensor are Ixx, Iyy, Izz, Ixy, Ixz, Iyz, the last three "
                    "with the sign of -sum m*x*y; each is at most sqrt(Ixx*Iyy) in size");
    diag_about(diag, "inertia");
    return status;
}

static Status body_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Expr mass = instance_scalar(instance, "mass");

    TRY(attitude_check(instance, arena, planar, diag));
    if (expr_is_number(mass) && expr_value(mass) < 0) {
        (void)diag_set(diag, E_VALUE, "the mass of %s is negative: %g", instance->name,
                       expr_value(mass));
        diag_hint(diag, "it is zero or positive");
        diag_about(diag, "mass");
        return E_VALUE;
    }
    return refuse_inertia(instance, planar, diag);
}

/* Ixx = int y^2+z^2 dm and so on. So int x^2 dm is half the trace minus Ixx, and about no axis is
 * it negative for a body. A model may contain such a tensor on purpose (for mass that turns with a
 * body but isn't part of it), and the equations can be solved with it. */
static void body_doubt(const Instance *instance, bool planar, Text *out)
{
    double a[6], rounding, half;

    if (planar || !read_tensor(instance, a, &rounding) || rounding == 0)
        return;
    half = (a[0] + a[1] + a[2]) / 2;
    for (int i = 0; i < 6; i++)
        a[i] = i < 3 ? half - a[i] : -a[i];
    if (!is_positive(a, rounding + CARELESS * half))
        text_addf(out,
                  "no rigid body has the inertia of %s: a principal moment is larger than the sum "
                  "of the other two\n",
                  instance->name);
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
    .doubt = body_doubt,
    .help =
        "Makes a rigid body and a frame of the same name at its mass centre. In the graph it is "
        "an edge from ground to that frame. As a branch it has absolute coordinates (planar: x "
        "y theta; spatial: x y z and Euler parameters q0 q1 q2 q3, or with euler= three angles "
        "a1 a2 a3, which have a singular attitude). As a chord its motion follows from the "
        "joints. Mass and moments of inertia may be 0; no moment of inertia may be negative.",
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
    if (instance_value(instance, "at")->given) /* until the beam bends */
        out->constant[0] = instance_scalar(instance, "at");
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
    .help = "Makes a frame at a fixed position and, with rotation=, in a fixed attitude "
            "relative to the frame it starts from. Joints and forces act on such frames. Arms "
            "are branches of every tree.",
    .example = "scene planar\ngravity [0, -9.81]\nbody rod mass=1 inertia=1/12\n"
               "arm tip rod [1/2, 0]\narm pin rod [-1/2, 0]\nrevolute h1 ground pin\n"
               "init h1 = 0\nsimulate 1\nprint tip.x, tip.y",
    .see = "body revolute",
};

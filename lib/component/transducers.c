/* transducers.c: one object with an edge in two domains
 *
 * DC motor on the coordinate of a joint, w its rate, N the gear ratio:
 *   v = R i + L i' + Kv N w,   effort on the head = N Kt i - N^2 B w,   rotor N^2 J */
#include "component/component_rows.h"

/* clang-format off */
static const Param motor_params[] = {
    {"R",     PARAM_SCALAR, "ohm",       NULL, "resistance of the winding", false},
    {"L",     PARAM_SCALAR, "H",         "0",  "its inductance; 0 makes the current algebraic", false},
    {"Kt",    PARAM_SCALAR, "N*m/A",     "0",  "torque per current, at the motor's shaft; as Kv if not given", false},
    {"Kv",    PARAM_SCALAR, "V*s/rad",   "0",  "voltage per rate, at the motor's shaft; as Kt if not given", false},
    {"J",     PARAM_SCALAR, "kg*m^2",    "0",  "inertia of the rotor, at the motor's shaft", false},
    {"B",     PARAM_SCALAR, "N*m*s/rad", "0",  "friction per rate, at the motor's shaft", false},
    {"ratio", PARAM_SCALAR, "1",         "1",  "turns of the motor's shaft for one of the joint", false},
};

static const Member motor_members[] = {
    {"torque", "N*m", "on the tip of the joint, along its coordinate; without the rotor's inertia", 0},
};
/* clang-format on */

/* in SI both constants are the same number, so one may stand for the other */
static Expr constant(const Instance *instance, const char *name, const char *other)
{
    return instance_scalar(instance, instance_value(instance, name)->given ? name : other);
}

static Expr motor_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr ratio = instance_scalar(instance, "ratio");
    Expr push =
        expr_mul(arena, ratio, expr_mul(arena, constant(instance, "Kt", "Kv"), motion->through));
    Expr drag = expr_mul(arena, expr_square(arena, ratio),
                         expr_mul(arena, instance_scalar(instance, "B"), motion->rate));

    return expr_sub(arena, push, drag);
}

static Expr motor_rotor(const Instance *instance, Arena *arena)
{
    return expr_mul(arena, expr_square(arena, instance_scalar(instance, "ratio")),
                    instance_scalar(instance, "J"));
}

static void motor_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    Expr R = instance_scalar(instance, "R");
    Expr L = instance_scalar(instance, "L");
    Expr i = motion->through;
    Expr back = expr_mul(arena, constant(instance, "Kv", "Kt"),
                         expr_mul(arena, instance_scalar(instance, "ratio"), motion->rate));

    (void)which;
    if (!expr_is_zero(L)) {
        Expr half = expr_rational(arena, 1, 2);

        *out =
            (Relation){.kind = RELATION_INDUCTIVE,
                       .content = expr_mul(arena, L, i),
                       .rest = expr_add(arena, expr_mul(arena, R, i), back),
                       .stored = expr_product(arena, (Expr[]){half, L, expr_square(arena, i)}, 3)};
    } else if (!expr_is_zero(R)) {
        *out = (Relation){.kind = RELATION_RESISTIVE, .value = R, .rest = back};
    } else {
        *out = (Relation){.kind = RELATION_ACROSS, .value = back};
    }
}

static Status motor_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    static const char *const positive[] = {"R", "L", "J", "B"};
    Status status;

    if (!instance_value(instance, "Kt")->given && !instance_value(instance, "Kv")->given) {
        status = diag_set(diag, E_VALUE, "motor %s needs Kt= or Kv=", instance->name);
        diag_hint(diag, "torque per current in N*m/A; the two are one number in SI");
        return status;
    }
    for (int i = 0; i < COUNT(positive); i++) {
        Expr value = instance_scalar(instance, positive[i]);

        if (expr_is_number(value) && expr_value(value) < 0.0)
            return diag_set(diag, E_VALUE, "%s of %s is negative", positive[i], instance->name);
    }
    if (expr_is_zero(instance_scalar(instance, "ratio")))
        return diag_set(diag, E_VALUE, "the gear ratio of %s is zero", instance->name);
    return OK;
}

const Component component_motor = {
    .name = "motor",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TRANSDUCER,
    .brief = "DC motor on a joint",
    .params = motor_params,
    .param_count = COUNT(motor_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .effort = motor_effort,
    .rotor = motor_rotor,
    .relation = motor_relation,
    .members = motor_members,
    .member_count = COUNT(motor_members),
    .check = motor_check,
    .help = "Turns the coordinate of a joint and stands between two terminals: v = R*i + L*i' + "
            "Kv*ratio*w, torque on the tip ratio*Kt*i - ratio^2*B*w, and ratio^2*J joins the "
            "inertia of the joint; w is the rate of the joint. Kt, Kv, J and B are those at the "
            "motor's own shaft. Without L the current is algebraic.",
    .example = "scene planar\nbody wheel mass=1 inertia=0.02\nrevolute h1 ground wheel\n"
               "vsource V1 a 0 12\nmotor M1 h1 a 0 R=1 L=10 mH Kt=0.1 J=1e-4\n"
               "init h1 = 0, h1' = 0, M1.i = 0\nsimulate 1\nprint h1', M1.i, M1.torque",
    .see = "vsource driver actuator",
};

/* transducers.c: one object with an edge in two domains
 *
 * On the coordinate s of a joint; F the effort on its head along s. The power v i - F s' is stored
 * or lost:
 *   DC motor          v = R i + L i' + Kv N s',   F = N Kt i - N^2 B s',   rotor N^2 J
 *   plate capacitor   q = C(s) v,                 F = 1/2 dC/ds v^2
 *   solenoid          v = R i + (L(s) i)',        F = 1/2 dL/ds i^2
 *   voice coil        v = R i + L i' + K s',      F = K i
 *   piezo stack       q = C v + d k (s - rest),   F = k (d v - (s - rest))
 * N is the gear ratio of the motor; C of the piezo stack is that at constant s. */
#include "component/component_rows.h"

#include <string.h>

/* clang-format off */
static const Param motor_params[] = {
    {"R",     PARAM_SCALAR, "ohm",               NULL, "resistance of the winding", 0},
    {"L",     PARAM_SCALAR, "H",                 "0",  "its inductance; 0 makes the current algebraic", 0},
    {"Kt",    PARAM_SCALAR, "N/A|N*m/A",         "0", "torque per current, at the motor's shaft; default: Kv", PAIRED},
    {"Kv",    PARAM_SCALAR, "V*s/m|V*s/rad",     "0", "voltage per rate, at the motor's shaft; default: Kt", PAIRED},
    {"J",     PARAM_SCALAR, "kg|kg*m^2",         "0",  "inertia of the rotor, at the motor's shaft", 0},
    {"B",     PARAM_SCALAR, "N*s/m|N*m*s/rad",   "0",  "friction per rate, at the motor's shaft", 0},
    {"ratio", PARAM_SCALAR, "rad/m|1",           "1",  "turns of the motor's shaft for one of the joint", GEARS},
};

static const Param platecap_params[] = {
    {"C", PARAM_LAW, "F", NULL, "capacitance, an expression of the coordinate: eps*A/(d - s)", 0},
};
static const Param solenoid_params[] = {
    {"L", PARAM_LAW,    "H",   NULL, "inductance, an expression of the coordinate", 0},
    {"R", PARAM_SCALAR, "ohm", "0",  "resistance of the winding", 0},
};
static const Param voicecoil_params[] = {
    {"K", PARAM_LAW,    "N/A|N*m/A", NULL, "force per current, which is voltage per rate", 0},
    {"R", PARAM_SCALAR, "ohm",       "0",  "resistance of the winding", 0},
    {"L", PARAM_SCALAR, "H",         "0",  "its inductance; 0 makes the current algebraic", 0},
};
static const Param piezo_params[] = {
    {"C",    PARAM_SCALAR, "F",           NULL, "capacitance of the stack at constant length", 0},
    {"d",    PARAM_SCALAR, "m/V|rad/V",   NULL, "free stroke per voltage", 0},
    {"k",    PARAM_SCALAR, "N/m|N*m/rad", NULL, "stiffness at constant voltage", 0},
    {"rest", PARAM_SCALAR, "m|rad",       "0", "coordinate of the relaxed, uncharged stack", 0},
};

static const Member capacitive_members[] = {
    {"q",      "C",   "charge", 2},
    {"force",  "N|N*m", "on the tip of the joint, along its coordinate", 0},
    {"torque", "N|N*m", "the same, by the name that suits an angle", 0},
};
static const Member inductive_members[] = {
    {"flux",   "Wb",  "flux linkage", 2},
    {"force",  "N|N*m", "on the tip of the joint, along its coordinate", 0},
    {"torque", "N|N*m", "the same, by the name that suits an angle", 0},
};
static const Member motor_members[] = {
    {"torque", "N|N*m", "on the tip of the joint, along its coordinate; without the rotor's inertia", 0},
    {"force",  "N|N*m", "the same, by the name that suits a slide", 0},
};
/* clang-format on */

/* Kt or Kv: in SI both are the same number, so one may replace the other */
static Expr constant(const Instance *instance, const char *name)
{
    const int param = component_param(instance->row, name);

    return instance->values[instance_in_force(instance, param)].at[0];
}

static Expr motor_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr ratio = instance_scalar(instance, "ratio");
    Expr push = expr_mul(arena, ratio, expr_mul(arena, constant(instance, "Kt"), motion->through));
    Expr drag = expr_mul(arena, expr_square(arena, ratio),
                         expr_mul(arena, instance_scalar(instance, "B"), motion->rate));

    return expr_sub(arena, push, drag);
}

static Expr motor_rotor(const Instance *instance, Arena *arena)
{
    return expr_mul(arena, expr_square(arena, instance_scalar(instance, "ratio")),
                    instance_scalar(instance, "J"));
}

/* v = R i + (L i)' + back: algebraic without L, a voltage source without both */
static void winding(Arena *arena, Expr R, Expr L, Expr back, Expr i, Relation *out)
{
    Expr half = expr_rational(arena, 1, 2);

    if (!expr_is_zero(L))
        *out =
            (Relation){.kind = RELATION_INDUCTIVE,
                       .content = expr_mul(arena, L, i),
                       .rest = expr_add(arena, expr_mul(arena, R, i), back),
                       .stored = expr_product(arena, (Expr[]){half, L, expr_square(arena, i)}, 3)};
    else if (!expr_is_zero(R))
        *out = (Relation){.kind = RELATION_RESISTIVE, .value = R, .rest = back};
    else
        *out = (Relation){.kind = RELATION_ACROSS, .value = back};
}

static void motor_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    Expr back = expr_mul(arena, constant(instance, "Kv"),
                         expr_mul(arena, instance_scalar(instance, "ratio"), motion->rate));

    (void)which;
    winding(arena, instance_scalar(instance, "R"), instance_scalar(instance, "L"), back,
            motion->through, out);
}

static Status motor_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    static const char *const positive[] = {"R", "L", "J", "B"};
    Status status = OK;

    if (!instance_value(instance, "Kt")->given && !instance_value(instance, "Kv")->given) {
        status = diag_set(diag, E_VALUE, "motor %s needs Kt= or Kv=", instance->name);
        diag_hint(diag,
                  "torque per current in N*m/A, on a slide force per current in N/A; the two are "
                  "one number in SI");
        return status;
    }
    for (int i = 0; i < COUNT(positive); i++)
        CHECK(check_not_negative(instance, positive[i], diag));
    if (expr_is_zero(instance_scalar(instance, "ratio"))) {
        status = diag_set(diag, E_VALUE, "the gear ratio of %s is zero", instance->name);
        diag_about(diag, "ratio");
    }
done:
    return status;
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
    .help =
        "Drives the coordinate of a joint, with its winding between two terminals: v = R*i + "
        "L*i' + Kv*ratio*w. The torque on the tip is ratio*Kt*i - ratio^2*B*w, and ratio^2*J "
        "adds to the inertia of the joint; w is the rate of the joint. Kt, Kv, J and B are "
        "those at the motor's own shaft. Without L the current is algebraic. On a slide without "
        "ratio= it is a linear motor: Kt in N/A, Kv in V*s/m, J a mass in kg, B in N*s/m. With "
        "ratio=, in rad/m, a shaft turns there, too. On a slide, M1.torque and M1.force are the "
        "force in N.",
    .example = "scene planar\nbody wheel mass=1 inertia=0.02\nrevolute h1 ground wheel\n"
               "vsource V1 a 0 12\nmotor M1 h1 a 0 R=1 L=10 mH Kt=0.1 J=1e-4\n"
               "init h1 = 0, h1' = 0, M1.i = 0\nsimulate 1\nprint h1', M1.i, M1.torque",
    .see = "vsource driver actuator",
};

/* --- plate capacitor and solenoid: C or L is a law of the joint's coordinate --- */

/* A dependence on anything else would do work, too. */
static Status check_law(const Instance *instance, const char *param, Diag *diag)
{
    Expr law = instance_scalar(instance, param);
    Expr *symbols;
    int count = expr_symbols(&law, 1, &symbols);
    Status status = OK;

    for (int i = 0; i < count && status == OK; i++) {
        SymbolKind kind = expr_symbol_kind(symbols[i]);

        if (kind != SYMBOL_TIME &&
            (kind != SYMBOL_VARIABLE || strcmp(expr_name(symbols[i]), instance->coordinate) == 0))
            continue;
        status = diag_set(diag, E_VALUE, "%s of %s can't depend on %s", param, instance->name,
                          expr_name(symbols[i]));
        diag_hint(diag, "it is a law of %s, the coordinate that it acts on", instance->coordinate);
        diag_about(diag, "%s", param);
    }
    mem_free(symbols);
    return status;
}

/* 1/2 law'(s) x^2 */
static Expr pull(const Instance *instance, Arena *arena, const char *param, Expr x)
{
    Expr slope = expr_diff(arena, instance_scalar(instance, param),
                           instance_joint_coordinate(instance, arena));

    return expr_product(arena, (Expr[]){expr_rational(arena, 1, 2), slope, expr_square(arena, x)},
                        3);
}

static Expr platecap_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return pull(instance, arena, "C", motion->across);
}

static void platecap_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    Expr C = instance_scalar(instance, "C");
    Expr v = motion->across;
    Expr half = expr_rational(arena, 1, 2);

    (void)which;
    *out = (Relation){.kind = RELATION_CAPACITIVE,
                      .content = expr_mul(arena, C, v),
                      .rest = expr_int(arena, 0),
                      .stored = expr_product(arena, (Expr[]){half, C, expr_square(arena, v)}, 3)};
}

static Status platecap_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_law(instance, "C", diag);
}

const Component component_platecap = {
    .name = "platecap",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TRANSDUCER,
    .brief = "capacitor with a moving plate",
    .params = platecap_params,
    .param_count = COUNT(platecap_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .effort = platecap_effort,
    .relation = platecap_relation,
    .members = capacitive_members,
    .member_count = COUNT(capacitive_members),
    .positive = "C",
    .check = platecap_check,
    .help =
        "A capacitor whose capacitance is a function of a joint's coordinate s. Its charge is "
        "C(s)*v, and the force on the tip along s is 1/2*dC/ds*v^2. Plates of area A have "
        "C=eps*A/s if s is the gap, and C=eps*A/(d - s) if s points towards the fixed plate at "
        "d. C can't contain other variables, since these would do work, too. A run ends with an "
        "error where the gap closes; 'event closed when=d - s < 1e-6 do=stop' ends it before.",
    .example = "scene planar\nbody plate mass=1e-3 inertia=0\nprismatic s ground plate axis=x\n"
               "spring k1 s k=100\ndamper d1 s d=0.1\nvsource E1 a 0 10\n"
               "resistor R1 a b 10 kohm\nplatecap C1 s b 0 C=1e-10/(1e-3 - s)\n"
               "init s = 0, s' = 0, C1.v = 0\nsimulate 0.5\nprint s, C1.v, C1.force",
    .see = "capacitor solenoid piezo",
};

static Expr solenoid_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return pull(instance, arena, "L", motion->through);
}

static void solenoid_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    winding(arena, instance_scalar(instance, "R"), instance_scalar(instance, "L"),
            expr_int(arena, 0), motion->through, out);
}

static Status solenoid_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_not_negative(instance, "R", diag));
    return check_law(instance, "L", diag);
}

const Component component_solenoid = {
    .name = "solenoid",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TRANSDUCER,
    .brief = "coil whose inductance a joint changes",
    .params = solenoid_params,
    .param_count = COUNT(solenoid_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .effort = solenoid_effort,
    .relation = solenoid_relation,
    .members = inductive_members,
    .member_count = COUNT(inductive_members),
    .positive = "L",
    .check = solenoid_check,
    .help = "A coil whose inductance is a function of a joint's coordinate s: v = R*i + "
            "(L(s)*i)'. The force on the tip along s is 1/2*dL/ds*i^2, towards higher "
            "inductance for either sign of the current: plungers, relays, levitated balls, "
            "reluctance motors. L can't contain other variables.",
    .example = "scene planar\nbody core mass=0.05 inertia=0\nprismatic x ground core axis=x\n"
               "spring k1 x k=400\ndamper d1 x d=2\nvsource E1 a 0 6\n"
               "solenoid X1 x a 0 L=0.02*(1 + exp(x/0.01)) R=3\n"
               "init x = -0.01, x' = 0, X1.i = 0\nsimulate 0.3\nprint x, X1.i, X1.force",
    .see = "inductor voicecoil platecap",
};

/* --- voice coil --- */

static Expr voicecoil_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_mul(arena, instance_scalar(instance, "K"), motion->through);
}

static void voicecoil_relation(const Instance *instance, Arena *arena, int which,
                               const Motion1 *motion, Relation *out)
{
    (void)which;
    winding(arena, instance_scalar(instance, "R"), instance_scalar(instance, "L"),
            expr_mul(arena, instance_scalar(instance, "K"), motion->rate), motion->through, out);
}

static Status voicecoil_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_not_negative(instance, "R", diag));
    return check_not_negative(instance, "L", diag);
}

const Component component_voicecoil = {
    .name = "voicecoil",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TRANSDUCER,
    .brief = "coil in the field of a magnet",
    .params = voicecoil_params,
    .param_count = COUNT(voicecoil_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .effort = voicecoil_effort,
    .relation = voicecoil_relation,
    .members = inductive_members,
    .member_count = COUNT(inductive_members),
    .check = voicecoil_check,
    .help = "A coil that moves in the field of a magnet with a joint's coordinate s: v = R*i + "
            "L*i' + K*s'. The force on the tip along s is K*i: loudspeakers, shakers, and "
            "without R and L an ideal converter. K may be an expression, also of the "
            "coordinate. Without L the current is algebraic.",
    .example = "# a loudspeaker\nscene planar\nbody cone mass=0.01 inertia=0\n"
               "prismatic x ground cone axis=x\nspring k1 x k=1000\ndamper d1 x d=1.5\n"
               "vsource E1 a 0 5*sin(2*pi*80*t)\nvoicecoil X1 x a 0 K=6 R=6 L=0.5 mH\n"
               "init x = 0, x' = 0, X1.i = 0\nsimulate 0.2 every=1e-4\nprint max(x), rms(X1.i)",
    .see = "motor solenoid",
};

/* --- piezo stack --- */

static Expr stretch(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    return expr_sub(arena, motion->displacement, instance_scalar(instance, "rest"));
}

static Expr piezo_effort(const Instance *instance, Arena *arena, const Motion1 *motion)
{
    Expr stroke = expr_mul(arena, instance_scalar(instance, "d"), motion->across);

    return expr_mul(arena, instance_scalar(instance, "k"),
                    expr_sub(arena, stroke, stretch(instance, arena, motion)));
}

static void piezo_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    Expr C = instance_scalar(instance, "C");
    Expr k = instance_scalar(instance, "k");
    Expr v = motion->across;
    Expr s = stretch(instance, arena, motion);
    Expr half = expr_rational(arena, 1, 2);
    Expr by_stretch = expr_product(arena, (Expr[]){instance_scalar(instance, "d"), k, s}, 3);
    Expr field = expr_mul(arena, C, expr_square(arena, v));
    Expr strain = expr_mul(arena, k, expr_square(arena, s));

    (void)which;
    *out = (Relation){.kind = RELATION_CAPACITIVE,
                      .content = expr_add(arena, expr_mul(arena, C, v), by_stretch),
                      .rest = expr_int(arena, 0),
                      .stored = expr_mul(arena, half, expr_add(arena, field, strain))};
}

static Status piezo_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    TRY(check_positive(instance, "C", diag));
    return check_positive(instance, "k", diag);
}

const Component component_piezo = {
    .name = "piezo",
    .family = FAMILY_TRANSDUCER,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TRANSDUCER,
    .brief = "piezo stack on a joint",
    .params = piezo_params,
    .param_count = COUNT(piezo_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .effort = piezo_effort,
    .relation = piezo_relation,
    .members = capacitive_members,
    .member_count = COUNT(capacitive_members),
    .check = piezo_check,
    .help = "A linear piezo stack along a joint's coordinate s. The force on the tip is k*(d*v "
            "- (s - rest)), so that d*v is its free stroke and k*d*v its blocked force. Its "
            "charge is C*v + d*k*(s - rest). C is the capacitance at constant length; without "
            "load it is C + d^2*k, the value of data sheets.",
    .example = "scene planar\nbody stage mass=0.2 inertia=0\nprismatic x ground stage axis=x\n"
               "damper d1 x d=200\nvsource E1 a 0 100\nresistor R1 a b 100\n"
               "piezo P1 x b 0 C=2 uF d=0.15e-6 k=5e7\ninit x = 0, x' = 0, P1.v = 0\n"
               "simulate 0.02\nprint x, P1.v, P1.q, P1.force",
    .see = "platecap spring",
};

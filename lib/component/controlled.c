/* controlled.c: sources whose voltage or current is a multiple of another quantity
 *
 * The terminals c and d of a controlling voltage are only measured: no current flows into them, so
 * other components must determine their potentials. A controlling current is any expression. */
#include "component/component_rows.h"

/* clang-format off */
static const Param vcvs_params[] = {
    {"gain", PARAM_LAW, "1", NULL, "voltage per controlling voltage", 0},
};
static const Param vccs_params[] = {
    {"gain", PARAM_LAW, "S", NULL, "current per controlling voltage", 0},
};
static const Param ccvs_params[] = {
    {"of",   PARAM_LAW, "A",   NULL, "the controlling current, as R1.i", 0},
    {"gain", PARAM_LAW, "ohm", NULL, "voltage per controlling current", 0},
};
static const Param cccs_params[] = {
    {"of",   PARAM_LAW, "A", NULL, "the controlling current, as R1.i", 0},
    {"gain", PARAM_LAW, "1", NULL, "current per controlling current", 0},
};

static const Param sensor_params[] = {
    {"gain", PARAM_LAW, NULL, "1", "volts per unit of what is sensed", 0},
};
/* clang-format on */

/* gain times the voltage between terminals c and d */
static Expr by_voltage(const Instance *instance, Arena *arena)
{
    Expr voltage = expr_sub(arena, instance_potential(instance, arena, 2),
                            instance_potential(instance, arena, 3));

    return expr_mul(arena, instance_scalar(instance, "gain"), voltage);
}

static Expr by_current(const Instance *instance, Arena *arena)
{
    return expr_mul(arena, instance_scalar(instance, "gain"), instance_scalar(instance, "of"));
}

static void vcvs_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_ACROSS, .value = by_voltage(instance, arena)};
}

const Component component_vcvs = {
    .name = "vcvs",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "voltage source controlled by a voltage",
    .params = vcvs_params,
    .param_count = COUNT(vcvs_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .terminal_count = 4,
    .terminal_usage = " PLUS MINUS C D",
    .relation = vcvs_relation,
    .help = "Its voltage is gain times the voltage of terminal C relative to terminal D, "
            "whatever the current: an amplifier. No current flows into C and D; other "
            "components have to determine their voltages. The gain may be an expression.",
    .example = "vsource V1 in 0 0.1*sin(100*t)\nvcvs E1 out 0 in 0 gain=50\n"
               "resistor R1 out 0 1 kohm\nsimulate 0.1\nprint max(E1.v), rms(R1.i)",
    .see = "vccs ccvs opamp vsource",
};

static void vccs_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_THROUGH, .value = by_voltage(instance, arena)};
}

const Component component_vccs = {
    .name = "vccs",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "current source controlled by a voltage",
    .params = vccs_params,
    .param_count = COUNT(vccs_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .terminal_count = 4,
    .terminal_usage = " PLUS MINUS C D",
    .relation = vccs_relation,
    .help = "Its current, from plus to minus inside, is gain times the voltage of terminal C "
            "relative to terminal D: a transistor's transconductance. No current flows into C "
            "and D; other components have to determine their voltages. The gain, in siemens, "
            "may be an expression.",
    .example = "vsource V1 in 0 0.1\nvccs G1 0 out in 0 gain=20 mS\nresistor R1 out 0 1 kohm\n"
               "capacitor C1 out 0 1 uF\ninit C1.v = 0\nsimulate 0.01\nprint out.v",
    .see = "vcvs cccs isource",
};

static void ccvs_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_ACROSS, .value = by_current(instance, arena)};
}

const Component component_ccvs = {
    .name = "ccvs",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "voltage source controlled by a current",
    .params = ccvs_params,
    .param_count = COUNT(ccvs_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = ccvs_relation,
    .help = "Its voltage is gain times the current of another component, named by of=R1.i. The "
            "gain, in ohm, may be an expression.",
    .example = "vsource V1 a 0 5\nresistor R1 a b 10 ohm\ninductor L1 b 0 20 mH\n"
               "ccvs H1 c 0 of=R1.i gain=100\nresistor R2 c 0 50 ohm\ninit L1.i = 0\n"
               "simulate 0.02\nprint H1.v, R2.i",
    .see = "cccs vcvs vsource",
};

static void cccs_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                          Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_THROUGH, .value = by_current(instance, arena)};
}

const Component component_cccs = {
    .name = "cccs",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "current source controlled by a current",
    .params = cccs_params,
    .param_count = COUNT(cccs_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .relation = cccs_relation,
    .help = "Its current, from plus to minus inside, is gain times the current of another "
            "component, named by of=R1.i. The gain may be an expression.",
    .example = "vsource V1 a 0 1\nresistor R1 a 0 1 kohm\ncccs F1 0 b of=R1.i gain=100\n"
               "resistor R2 b 0 50 ohm\nsimulate 0.01\nprint R2.i, b.v",
    .see = "ccvs vccs isource",
};

static void sensor_relation(const Instance *instance, Arena *arena, int which,
                            const Motion1 *motion, Relation *out)
{
    (void)which;
    (void)motion;
    *out =
        (Relation){.kind = RELATION_ACROSS,
                   .value = expr_mul(arena, instance_scalar(instance, "gain"), instance->sensed)};
}

const Component component_sensor = {
    .name = "sensor",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_SENSED,
    .brief = "voltage proportional to a variable",
    .params = sensor_params,
    .param_count = COUNT(sensor_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = sensor_relation,
    .help = "Its voltage is gain times a variable, without an effect on what it measures: the "
            "angle or position of a joint (h8), its rate (h8', a tachometer), the position of a "
            "point (r5.x), a force (h9.fx), a current (R1.i). An expression needs brackets.",
    .example = "scene planar\nbody wheel mass=1 inertia=0.02\nrevolute h1 ground wheel\n"
               "actuator a1 h1 torque=0.1\nsensor v1 h1 a 0 gain=2\nsensor v2 h1' b 0 gain=0.1\n"
               "resistor R1 a 0 1 kohm\ninit h1 = 0, h1' = 0\nsimulate 1\nprint v1.v, v2.v, R1.i",
    .see = "vsource pd potentiometer",
};

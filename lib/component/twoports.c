/* twoports.c: parts with two edges: op-amp, transformer, gyrator, potentiometer
 *
 * Of the edges p (terminals a b) and s (c d), with the ratio n and the gyration r:
 *   transformer  v_p = n v_s,  i_s = -n i_p        gyrator  v_p = r i_s,  v_s = -r i_p
 * They are lossless: v_p i_p + v_s i_s = 0. */
#include "component/component_rows.h"

/* clang-format off */
static const Param transformer_params[] = {
    {"n", PARAM_LAW, "1", NULL, "turns of the first side for one of the second", 0},
};
static const Param gyrator_params[] = {
    {"r", PARAM_LAW, "ohm", NULL, "voltage of either side per current of the other", 0},
};
static const Param potentiometer_params[] = {
    {"R",  PARAM_LAW, "ohm", NULL, "resistance from end to end", 0},
    {"at", PARAM_LAW, "1",   NULL, "position of the wiper: 0 at A, 1 at B", 0},
};

static const Member sides[] = {
    {"p.v",     "V", "voltage of the first side, A relative to B", 2},
    {"p.i",     "A", "current from A to B inside", 2},
    {"p.power", "W", "power taken by the first side", 0},
    {"s.v",     "V", "voltage of the second side, C relative to D", 2},
    {"s.i",     "A", "current from C to D inside", 2},
    {"s.power", "W", "power taken by the second side", 0},
};
static const Member opamp_members[] = {
    {"in.v",      "V", "voltage between the inputs: 0", 2},
    {"in.i",      "A", "current between the inputs: 0", 2},
    {"out.v",     "V", "voltage of the output relative to the reference", 2},
    {"out.i",     "A", "current into the output", 2},
    {"out.power", "W", "power taken at the output", 0},
};
static const Member potentiometer_members[] = {
    {"a.v",     "V", "voltage from A to the wiper", 2},
    {"a.i",     "A", "current from A to the wiper", 2},
    {"a.power", "W", "power lost between A and the wiper", 0},
    {"b.v",     "V", "voltage from the wiper to B", 2},
    {"b.i",     "A", "current from the wiper to B", 2},
    {"b.power", "W", "power lost between the wiper and B", 0},
};

static const ScalarEdge transformer_edges[] = {
    {"p", 0, 1, BRANCH_MAY, 10},
    {"s", 2, 3, BRANCH_MAY, 50},
};
static const ScalarEdge gyrator_edges[] = {
    {"p", 0, 1, BRANCH_MAY, 30},
    {"s", 2, 3, BRANCH_MAY, 30},
};
static const ScalarEdge opamp_edges[] = {
    {"in",  0, 1,  BRANCH_MAY, 50},
    {"out", 2, -1, BRANCH_MAY, 10},
};
static const ScalarEdge potentiometer_edges[] = {
    {"a", 0, 1, BRANCH_MAY, 30},
    {"b", 1, 2, BRANCH_MAY, 30},
};
/* clang-format on */

/* --- op-amp --- */

static void opamp_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    (void)motion;
    if (which == 0)
        *out = (Relation){.kind = RELATION_THROUGH, .value = expr_int(arena, 0)};
    else
        *out = (Relation){.kind = RELATION_FREE, .value = instance_across(instance, arena, 0)};
}

const Component component_opamp = {
    .name = "opamp",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "ideal operational amplifier",
    .translation = BRANCH_MAY,
    .terminal_count = 3,
    .terminal_usage = " PLUS MINUS OUT",
    .scalar_edges = opamp_edges,
    .scalar_edge_count = COUNT(opamp_edges),
    .relation = opamp_relation,
    .members = opamp_members,
    .member_count = COUNT(opamp_members),
    .help = "An amplifier without limits. No current flows into its inputs, and the output "
            "voltage is such that the voltage between the inputs is zero. This needs feedback "
            "from the output to the minus input. Its edges are U1.in (PLUS to MINUS) and U1.out "
            "(OUT to 0), in trees and in U1.out.v, U1.out.i.",
    .example = "# inverting integrator, -1/(R C) of the input\nvsource V1 a 0 sin(10*t)\n"
               "resistor R1 a m 10 kohm\ncapacitor C1 m out 10 uF\nopamp U1 0 m out\n"
               "init C1.v = 0\nsimulate 1\nprint U1.out.v",
    .see = "vcvs resistor",
};

/* --- transformer and gyrator --- */

static void transformer_relation(const Instance *instance, Arena *arena, int which,
                                 const Motion1 *motion, Relation *out)
{
    (void)motion;
    scalar_converter(instance, arena, which, instance_scalar(instance, "n"), out);
}

static Status transformer_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    if (!expr_is_zero(instance_scalar(instance, "n")))
        return OK;
    (void)diag_set(diag, E_VALUE, "n of %s is zero", instance->name);
    diag_hint(diag, "it is the voltage of the first side for 1 V at the second");
    diag_about(diag, "n");
    return E_VALUE;
}

const Component component_transformer = {
    .name = "transformer",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "ideal transformer",
    .params = transformer_params,
    .param_count = COUNT(transformer_params),
    .translation = BRANCH_MAY,
    .terminal_count = 4,
    .terminal_usage = " A B C D",
    .scalar_edges = transformer_edges,
    .scalar_edge_count = COUNT(transformer_edges),
    .relation = transformer_relation,
    .members = sides,
    .member_count = COUNT(sides),
    .check = transformer_check,
    .help = "The voltage of the first side (A relative to B) is n times that of the second (C "
            "relative to D), the current of the second -n times that of the first. No power is "
            "lost, and direct voltages are transformed as well. Its edges are T1.p and T1.s, in "
            "trees and in T1.p.v, T1.s.i. Each side needs a path to the reference: a terminal "
            "of the second side may be 0. For a real transformer add resistors and inductors, "
            "or use 'coupling'.",
    .example = "vsource V1 a 0 325*sin(314*t)\nresistor R1 a b 5 ohm\ntransformer T1 b 0 c 0 n=20\n"
               "resistor R2 c 0 8 ohm\nsimulate 0.1\nprint rms(T1.s.v), rms(T1.p.i)",
    .see = "coupling gyrator inductor",
};

/* between capacitors and inductors in the order of branches, so that both keep their states */
static void gyrator_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    Expr v = expr_mul(arena, instance_scalar(instance, "r"),
                      instance_through(instance, arena, 1 - which));

    (void)motion;
    *out = (Relation){.kind = RELATION_RESISTIVE,
                      .value = expr_int(arena, 0),
                      .rest = which == 0 ? v : expr_neg(arena, v)};
}

static Status gyrator_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    if (!expr_is_zero(instance_scalar(instance, "r")))
        return OK;
    (void)diag_set(diag, E_VALUE, "r of %s is zero", instance->name);
    diag_hint(diag, "it is the voltage of one side for 1 A in the other");
    diag_about(diag, "r");
    return E_VALUE;
}

const Component component_gyrator = {
    .name = "gyrator",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "ideal gyrator",
    .params = gyrator_params,
    .param_count = COUNT(gyrator_params),
    .translation = BRANCH_MAY,
    .terminal_count = 4,
    .terminal_usage = " A B C D",
    .scalar_edges = gyrator_edges,
    .scalar_edge_count = COUNT(gyrator_edges),
    .relation = gyrator_relation,
    .members = sides,
    .member_count = COUNT(sides),
    .check = gyrator_check,
    .help = "The voltage of the first side (A relative to B) is r times the current of the "
            "second (C to D inside), that of the second -r times the current of the first: no "
            "power is lost. A capacitor C at the second side acts as an inductor r^2*C at the "
            "first. Its edges are G1.p and G1.s.",
    .example = "# the capacitor behind the gyrator is an inductor of 0.1 H\nvsource V1 a 0 1\n"
               "resistor R1 a b 10 ohm\ngyrator G1 b 0 c 0 r=100\ncapacitor C1 c 0 10 uF\n"
               "init C1.v = 0\nsimulate 0.05\nprint G1.p.i",
    .see = "transformer capacitor",
};

/* --- potentiometer --- */

/* The resistance of an end of the track may be 0 at some time, so nothing is divided by it. */
static void potentiometer_relation(const Instance *instance, Arena *arena, int which,
                                   const Motion1 *motion, Relation *out)
{
    Expr at = instance_scalar(instance, "at");
    Expr part = which == 0 ? at : expr_sub(arena, expr_int(arena, 1), at);
    Expr R = expr_mul(arena, instance_scalar(instance, "R"), part);

    if (expr_is_number(at))
        *out = (Relation){.kind = RELATION_RESISTIVE, .value = R, .rest = expr_int(arena, 0)};
    else
        *out = (Relation){.kind = RELATION_IMPLICIT,
                          .value =
                              expr_sub(arena, motion->across, expr_mul(arena, R, motion->through))};
}

static Status potentiometer_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    Expr at = instance_scalar(instance, "at");
    Status status;

    (void)arena;
    (void)planar;
    if (expr_is_number(at) && (expr_value(at) < 0.0 || expr_value(at) > 1.0)) {
        status = diag_set(diag, E_VALUE, "the wiper of %s is off its track", instance->name);
        diag_hint(diag, "at= is 0 at one end and 1 at the other");
        diag_about(diag, "at");
        return status;
    }
    return check_positive(instance, "R", diag);
}

const Component component_potentiometer = {
    .name = "potentiometer",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "resistor with a wiper",
    .params = potentiometer_params,
    .param_count = COUNT(potentiometer_params),
    .translation = BRANCH_MAY,
    .terminal_count = 3,
    .terminal_usage = " A WIPER B",
    .scalar_edges = potentiometer_edges,
    .scalar_edge_count = COUNT(potentiometer_edges),
    .relation = potentiometer_relation,
    .members = potentiometer_members,
    .member_count = COUNT(potentiometer_members),
    .check = potentiometer_check,
    .help = "A resistor R from A to B with a wiper: R*at is between A and the wiper, R*(1 - at) "
            "between the wiper and B. at may be any expression, such as the angle of a joint in "
            "turns; 0 and 1 are allowed. Its edges are P1.a and P1.b.",
    .example = "vsource V1 a 0 10\npotentiometer P1 a w 0 R=10 kohm at=0.5 + 0.4*sin(t)\n"
               "resistor R1 w 0 100 kohm\nsimulate 10 every=0.1\nprint w.v, min(w.v), max(w.v)",
    .see = "resistor sensor",
};

/* switching.c: diode and switch
 *
 * Diode, v the forward voltage, i the current from plus to minus inside:
 *   exponential   i = Is (exp(v/(n Vt)) - 1) + G v,  Vt = k T/q at T = 300.15 K (27 degrees
 *                 Celsius), G = 1e-12 S, without which voltages between blocking diodes are
 * undetermined piecewise     i = v/Roff below Vf, Vf/Roff + (v - Vf)/Ron above it ideal         i
 * >= 0, v <= Vf, i (v - Vf) = 0 Runs locate the zeros of the comparisons in max and if, and the
 * state changes of ideal parts. */
#include "component/component_rows.h"

#include <string.h>

/* clang-format off */
static const Param diode_params[] = {
    {"Is",   PARAM_LAW, "A",   "0", "saturation current; makes the diode exponential", 0},
    {"n",    PARAM_LAW, "1",   "1", "emission coefficient, with Is=", 0},
    {"Ron",  PARAM_LAW, "ohm", "0", "resistance above the forward voltage; 0 if not given", 0},
    {"Roff", PARAM_LAW, "ohm", "0", "resistance below it, with Ron=; no current if not given", 0},
    {"Vf",   PARAM_LAW, "V",   "0", "forward voltage, above which it conducts; not with Is=", 0},
};
static const Param switch_params[] = {
    {"when", PARAM_LAW, NULL,  NULL, "the condition that closes it, such as t > 0.1 or h8 < 0", 0},
    {"Ron",  PARAM_LAW, "ohm", "0",  "resistance when it is closed", 0},
    {"Roff", PARAM_LAW, "ohm", "0", "resistance when it is open; no current if not given", 0},
};
/* clang-format on */

static bool given(const Instance *instance, const char *name)
{
    return instance_value(instance, name)->given;
}

/* --- diode --- */

/* k T/q in volts at 300.15 K, both constants exact since 2019 (SI brochure, 9th edition) */
static Expr thermal_voltage(Arena *arena)
{
    return expr_real(arena, 1.380649e-23 * 300.15 / 1.602176634e-19);
}

/* exp(x), from x = 100 on its tangent: no solution is there, but iterates may be */
static Expr bounded_exp(Arena *arena, Expr x)
{
    Expr most = expr_int(arena, 100);
    Expr beyond = expr_call2(arena, OP_MAX, expr_int(arena, 0), expr_sub(arena, x, most));
    Expr slope = expr_call1(arena, OP_EXP, most);

    return expr_add(arena, expr_call1(arena, OP_EXP, expr_call2(arena, OP_MIN, most, x)),
                    expr_mul(arena, slope, beyond));
}

static Expr exponential(const Instance *instance, Arena *arena, Expr v)
{
    Expr scale = expr_mul(arena, instance_scalar(instance, "n"), thermal_voltage(arena));
    Expr power = bounded_exp(arena, expr_div(arena, v, scale));

    return expr_add(arena,
                    expr_mul(arena, instance_scalar(instance, "Is"),
                             expr_sub(arena, power, expr_int(arena, 1))),
                    expr_mul(arena, expr_decimal(arena, "1e-12"), v));
}

/* two straight lines that meet at the forward voltage; excess = v - Vf */
static Expr piecewise(const Instance *instance, Arena *arena, Expr v, Expr excess)
{
    Expr zero = expr_int(arena, 0);
    Expr off = instance_scalar(instance, "Roff");
    Expr above = expr_add(arena, expr_div(arena, excess, instance_scalar(instance, "Ron")),
                          expr_div(arena, instance_scalar(instance, "Vf"), off));

    return expr_if(arena, expr_call2(arena, OP_LT, zero, excess), above, expr_div(arena, v, off));
}

/* the resistances of an instance, closed and open */
static Ideal two_sides(const Instance *instance, Expr when, Expr least)
{
    return (Ideal){.when = when,
                   .on = instance_scalar(instance, "Ron"),
                   .off = given(instance, "Roff") ? instance_scalar(instance, "Roff") : NULL,
                   .least = least};
}

static void diode_relation(const Instance *instance, Arena *arena, int which, const Motion1 *motion,
                           Relation *out)
{
    Expr least = instance_scalar(instance, "Vf");
    Expr excess = expr_sub(arena, motion->across, least);

    (void)which;
    if (given(instance, "Is"))
        *out = (Relation){.kind = RELATION_CONDUCTIVE,
                          .value = exponential(instance, arena, motion->across)};
    else if (given(instance, "Roff"))
        *out = (Relation){.kind = RELATION_CONDUCTIVE,
                          .value = piecewise(instance, arena, motion->across, excess),
                          .ideal = two_sides(instance, NULL, least),
                          .switches = true};
    else
        *out = (Relation){.kind = RELATION_IDEAL, .ideal = two_sides(instance, NULL, least)};
}

static Status diode_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    static const char *const lines[] = {"Ron", "Roff", "Vf"};
    Status status = OK;

    (void)arena;
    (void)planar;
    for (int i = 0; i < COUNT(lines); i++)
        if (given(instance, "Is") && given(instance, lines[i])) {
            (void)diag_set(diag, E_VALUE, "%s has Is= and %s=: it is exponential or it switches",
                           instance->name, lines[i]);
            diag_hint(diag, "a series resistance is a resistor of its own");
            diag_about(diag, "%s", lines[i]);
            return E_VALUE;
        }
    if (given(instance, "n") && !given(instance, "Is")) {
        (void)diag_set(diag, E_VALUE, "n= of %s needs Is=", instance->name);
        diag_hint(diag, "as in Is=1e-14 n=1");
        diag_about(diag, "n");
        return E_VALUE;
    }
    if (given(instance, "Roff") && !given(instance, "Ron")) {
        (void)diag_set(diag, E_VALUE, "Roff= of %s needs Ron=", instance->name);
        diag_hint(diag, "without both it is ideal");
        diag_about(diag, "Roff");
        return E_VALUE;
    }
    for (int i = 0; i < instance->row->param_count && status == OK; i++)
        if (strcmp(instance->row->params[i].name, "Vf") != 0 && instance->values[i].given)
            status = check_positive(instance, instance->row->params[i].name, diag);
    return status;
}

const Component component_diode = {
    .name = "diode",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "diode: exponential, piecewise linear, or ideal",
    .params = diode_params,
    .param_count = COUNT(diode_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = diode_relation,
    .has_named_law = true,
    .check = diode_check,
    .help =
        "Conducts from plus to minus. With Is= it is exponential, i = Is*(exp(v/(n*Vt)) - 1) "
        "with Vt = k*T/q = 25.865 mV at 27 degrees Celsius, and a leakage of 1 pA per volt. "
        "With Ron= (and Roff=, Vf=) it is piecewise linear: two straight lines that meet at the "
        "forward voltage Vf. With neither it is ideal: no reverse current, no forward voltage "
        "(or Vf). Runs locate the instants where it starts and ceases to conduct. The tree of "
        "an ideal diode changes there, and the states with it. Stored quantities carry over, "
        "and can't jump.",
    .example = "# bridge rectifier\nvsource V1 a b 10*sin(314*t)\ndiode D1 a p\ndiode D2 b p\n"
               "diode D3 0 a\ndiode D4 0 b\ncapacitor C1 p 0 1 mF\nresistor R1 p 0 100 ohm\n"
               "init C1.v = 0\nsimulate 0.06\nprint p.v",
    .see = "switch resistor",
};

/* --- switch --- */

static void switch_relation(const Instance *instance, Arena *arena, int which,
                            const Motion1 *motion, Relation *out)
{
    Expr when = instance_scalar(instance, "when");
    Ideal sides = two_sides(instance, when, expr_int(arena, 0));

    (void)which, (void)motion;
    if (sides.off != NULL && !expr_is_zero(sides.on))
        *out = (Relation){.kind = RELATION_RESISTIVE,
                          .value = expr_if(arena, when, sides.on, sides.off),
                          .rest = expr_int(arena, 0),
                          .ideal = sides,
                          .switches = true};
    else
        *out = (Relation){.kind = RELATION_IDEAL, .ideal = sides};
}

static Status switch_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    if (given(instance, "Ron"))
        TRY(check_not_negative(instance, "Ron", diag));
    if (given(instance, "Roff"))
        TRY(check_positive(instance, "Roff", diag));
    return OK;
}

const Component component_switch = {
    .name = "switch",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "switch that a condition closes",
    .params = switch_params,
    .param_count = COUNT(switch_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = switch_relation,
    .check = switch_check,
    .help = "Closed while the condition holds, open otherwise. The condition may contain time "
            "(when=t > 0.1), variables (when=C1.v > 5), or both (&&, ||, !). With Ron= and "
            "Roff= it is one resistance or the other; without them it is ideal: no voltage when "
            "closed, no current when open. Runs locate the instants of switching. The tree of "
            "an ideal switch changes there, and the states with it. A stored voltage or current "
            "can't jump, so a coil needs a diode for its current where a switch opens.",
    .example =
        "# buck converter\nvsource V1 a 0 12\nswitch S1 a b when=t*50e3 - floor(t*50e3) < 0.4\n"
        "diode D1 0 b\ninductor L1 b c 100 uH\ncapacitor C1 c 0 22 uF\nresistor R1 c 0 5\n"
        "init L1.i = 0, C1.v = 0\nsimulate 0.002 every=1e-6\nprint c.v, max(L1.i)",
    .see = "diode resistor event",
};

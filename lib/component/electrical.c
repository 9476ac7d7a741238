/* electrical.c: resistor, capacitor, inductor, sources
 *
 * v is the potential of plus against minus, i flows from plus to minus inside. R, C
 * and L may depend on time and variables, also on the component's own v or i; a capacitor's charge
 * is C v and an inductor's flux L i all the same. */
#include "component/component_rows.h"

/* clang-format off */
static const Param resistor_params[] = {
    {"R", PARAM_LAW, "ohm", NULL, "resistance", true},
};
static const Param capacitor_params[] = {
    {"C", PARAM_LAW, "F", NULL, "capacitance, charge per voltage", true},
};
static const Param inductor_params[] = {
    {"L", PARAM_LAW, "H", NULL, "inductance, flux per current", true},
};
static const Param vsource_params[] = {
    {"value", PARAM_LAW, "V", NULL, "voltage, of t, parameters and variables", true},
};
static const Param isource_params[] = {
    {"value", PARAM_LAW, "A", NULL, "current, of t, parameters and variables", true},
};

static const Member capacitor_members[] = {
    {"q", "C", "charge, C*v", 2},
};
static const Member inductor_members[] = {
    {"flux", "Wb", "flux linkage, L*i", 2},
};
/* clang-format on */

static Status check_number(const Instance *instance, const char *param, bool zero_only, Diag *diag)
{
    Expr value = instance_scalar(instance, param);
    Status status;

    if (!expr_is_number(value) || expr_value(value) > 0.0 ||
        (zero_only && expr_value(value) != 0.0))
        return OK;
    status = diag_set(diag, E_VALUE, "%s of %s is %s", param, instance->name,
                      expr_value(value) == 0.0 ? "zero" : "negative");
    diag_hint(diag, zero_only ? "a wire is a vsource of 0 V, or one terminal in two places"
                              : "it has to be positive");
    return status;
}

static void resistor_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_RESISTIVE,
                      .value = instance_scalar(instance, "R"),
                      .rest = expr_int(arena, 0)};
}

static Status resistor_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_number(instance, "R", true, diag);
}

const Component component_resistor = {
    .name = "resistor",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "v = R*i",
    .params = resistor_params,
    .param_count = COUNT(resistor_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = resistor_relation,
    .check = resistor_check,
    .help = "A resistor between two terminals. R may be an expression, also of its own variables.",
    .example = "vsource E1 a 0 10\nresistor R1 a b 100 ohm\ncapacitor C1 b 0 10 uF\n"
               "init C1.v = 0\nsimulate 0.01\nprint R1.i, R1.power",
    .see = "capacitor inductor vsource",
};

/* value * x as a charge or flux, and its energy where the value does not depend on x itself */
static void storage_relation(RelationKind kind, Expr value, Expr x, Arena *arena, Relation *out)
{
    Expr half = expr_rational(arena, 1, 2);

    *out =
        (Relation){.kind = kind, .content = expr_mul(arena, value, x), .rest = expr_int(arena, 0)};
    if (expr_is_zero(expr_diff(arena, value, x)))
        out->stored = expr_product(arena, (Expr[]){half, value, expr_square(arena, x)}, 3);
}

static void capacitor_relation(const Instance *instance, Arena *arena, int which,
                               const Motion1 *motion, Relation *out)
{
    (void)which;
    storage_relation(RELATION_CAPACITIVE, instance_scalar(instance, "C"), motion->across, arena,
                     out);
}

static Status capacitor_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_number(instance, "C", false, diag);
}

const Component component_capacitor = {
    .name = "capacitor",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "i = (C*v)'",
    .params = capacitor_params,
    .param_count = COUNT(capacitor_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .relation = capacitor_relation,
    .members = capacitor_members,
    .member_count = COUNT(capacitor_members),
    .check = capacitor_check,
    .help = "A capacitor between two terminals; its charge is C*v. C may be an expression, also of "
            "its own voltage: C0/(1 + C1.v/0.7). Its voltage is a state that init may give.",
    .example = "resistor R1 a 0 1 kohm\ncapacitor C1 a 0 1 uF\ninit C1.v = 5\nsimulate 0.002\n"
               "print C1.v, C1.q",
    .see = "resistor inductor init",
};

static void inductor_relation(const Instance *instance, Arena *arena, int which,
                              const Motion1 *motion, Relation *out)
{
    (void)which;
    storage_relation(RELATION_INDUCTIVE, instance_scalar(instance, "L"), motion->through, arena,
                     out);
}

static Status inductor_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    (void)arena;
    (void)planar;
    return check_number(instance, "L", false, diag);
}

const Component component_inductor = {
    .name = "inductor",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "v = (L*i)'",
    .params = inductor_params,
    .param_count = COUNT(inductor_params),
    .translation = BRANCH_MAY,
    .preference = 40,
    .relation = inductor_relation,
    .members = inductor_members,
    .member_count = COUNT(inductor_members),
    .check = inductor_check,
    .help = "An inductor between two terminals; its flux linkage is L*i. L may be an expression, "
            "also of its own current. Its current is a state that init may give.",
    .example = "vsource E1 a 0 12\nresistor R1 a b 2 ohm\ninductor L1 b 0 50 mH\ninit L1.i = 0\n"
               "simulate 0.1\nprint L1.i, L1.flux",
    .see = "resistor capacitor init",
};

static void vsource_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    (void)arena;
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_ACROSS, .value = instance_scalar(instance, "value")};
}

const Component component_vsource = {
    .name = "vsource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "voltage source",
    .params = vsource_params,
    .param_count = COUNT(vsource_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = vsource_relation,
    .help =
        "A voltage of plus against minus, whatever the current: any expression of t, parameters "
        "and other variables, so that it is also a controller.",
    .example = "vsource E1 a 0 10*sin(100*t)\nresistor R1 a b 5 ohm\ninductor L1 b 0 20 mH\n"
               "simulate 0.1\nprint E1.i, a.v",
    .see = "isource resistor motor",
};

static void isource_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    (void)arena;
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_THROUGH, .value = instance_scalar(instance, "value")};
}

const Component component_isource = {
    .name = "isource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_TERMINALS,
    .brief = "current source",
    .params = isource_params,
    .param_count = COUNT(isource_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .relation = isource_relation,
    .help = "A current from plus to minus inside, whatever the voltage: any expression of t, "
            "parameters and other variables.",
    .example = "isource I1 0 a 1 mA\nresistor R1 a 0 1 kohm\ncapacitor C1 a 0 1 uF\n"
               "init C1.v = 0\nsimulate 0.005\nprint a.v",
    .see = "vsource resistor",
};

/* electrical.c: resistor, capacitor, inductor, coupling, sources
 *
 * v is the potential of plus against minus, i flows from plus to minus inside. R (ohm), C (F) and L
 * (H) may depend on time and variables, also on the component's own v or i. A capacitor's charge is
 * C v and an inductor's flux is L i in every case. */
#include "component/component_rows.h"

/* clang-format off */
static const Param resistor_params[] = {
    {"R", PARAM_LAW, "ohm", NULL, "resistance", POSITIONAL},
};
static const Param capacitor_params[] = {
    {"C", PARAM_LAW, "F", NULL, "capacitance, charge per voltage", POSITIONAL},
};
static const Param inductor_params[] = {
    {"L", PARAM_LAW, "H", NULL, "inductance, flux per current", POSITIONAL},
};
static const Param coupling_params[] = {
    {"k", PARAM_SCALAR, "1", "0", "coupling factor, M/sqrt(L1*L2), between -1 and 1", 0},
    {"M", PARAM_SCALAR, "H", "0", "or the mutual inductance", 0},
};
static const Param vsource_params[] = {
    {"value", PARAM_LAW, "V", NULL, "voltage, an expression of t, parameters and variables", POSITIONAL | GIVES_SOURCE},
};
static const Param isource_params[] = {
    {"value", PARAM_LAW, "A", NULL, "current, an expression of t, parameters and variables", POSITIONAL | GIVES_SOURCE},
};

static const Member capacitor_members[] = {
    {"q", "C", "charge, C*v", 2},
};
static const Member inductor_members[] = {
    {"flux", "Wb", "flux linkage, L*i", 2},
};
/* clang-format on */

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
    Expr R = instance_scalar(instance, "R");

    (void)arena;
    (void)planar;
    if (!expr_is_zero(R))
        return OK;
    (void)diag_set(diag, E_VALUE, "R of %s is zero", instance->name);
    diag_hint(diag, "a wire is a vsource of 0 V, or one terminal in two places");
    diag_about(diag, "R");
    return E_VALUE;
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
    .positive = "C",
    .help = "A capacitor between two terminals; its charge is C*v. C may be an expression, also "
            "of its own voltage: C0/(1 + C1.v/0.7). Its voltage is a state; init may set it.",
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
    .positive = "L",
    .help = "An inductor between two terminals; its flux linkage is L*i. L may be an "
            "expression, also of its own current. Its current is a state; init may set it.",
    .example = "vsource E1 a 0 12\nresistor R1 a b 2 ohm\ninductor L1 b 0 50 mH\ninit L1.i = 0\n"
               "simulate 0.1\nprint L1.i, L1.flux",
    .see = "resistor capacitor init",
};

/* --- coupling: flux1 = L1 i1 + M i2, flux2 = L2 i2 + M i1 --- */

static Expr mutual(const Instance *instance, Arena *arena, const Instance *const parts[2])
{
    Expr product = expr_mul(arena, instance_scalar(parts[0], "L"), instance_scalar(parts[1], "L"));

    if (instance_value(instance, "M")->given)
        return instance_scalar(instance, "M");
    return expr_mul(arena, instance_scalar(instance, "k"), expr_sqrt(arena, product));
}

static Expr coupling_stores(const Instance *instance, Arena *arena, const Instance *const parts[2],
                            int row, int column)
{
    return row == column ? instance_scalar(parts[row], "L") : mutual(instance, arena, parts);
}

static void coupling_couple(const Instance *instance, Arena *arena, const Instance *const parts[2],
                            int which, Relation *out)
{
    Expr M = mutual(instance, arena, parts);
    Expr own = instance_through(parts[which], arena, 0);
    Expr other = instance_through(parts[1 - which], arena, 0);

    out->content = expr_add(arena, out->content, expr_mul(arena, M, other));
    /* M i1 i2 belongs to both parts: it is counted with the first */
    if (which == 0 && out->stored != NULL)
        out->stored = expr_add(arena, out->stored, expr_product(arena, (Expr[]){M, own, other}, 3));
}

static Status coupling_check(const Instance *instance, Arena *arena, bool planar, Diag *diag)
{
    bool has_k = instance_value(instance, "k")->given;
    Expr k = instance_scalar(instance, "k");

    (void)arena;
    (void)planar;
    if (has_k == instance_value(instance, "M")->given) {
        (void)diag_set(diag, E_VALUE,
                       has_k ? "%s has k= and M=" : "%s needs k= or M=", instance->name);
        diag_hint(diag, "k is M/sqrt(L1*L2): either one determines the other");
        return E_VALUE;
    }
    if (!has_k || !expr_is_number(k) || (expr_value(k) > -1.0 && expr_value(k) < 1.0))
        return OK;
    (void)diag_set(diag, E_VALUE, "k of %s is not between -1 and 1", instance->name);
    diag_hint(diag, "perfect coupling, without leakage, is a transformer with an inductor across");
    diag_about(diag, "k");
    return E_VALUE;
}

const Component component_coupling = {
    .name = "coupling",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_ELECTRICAL,
    .places = PLACES_PARTS,
    .brief = "couples two inductors",
    .params = coupling_params,
    .param_count = COUNT(coupling_params),
    .couple = coupling_couple,
    .stores = coupling_stores,
    .couples = "inductor",
    .check = coupling_check,
    .help = "Couples two inductors on one core: the flux of each contains M times the current "
            "of the other, where M = k*sqrt(L1*L2) or M is given. Both currents are positive "
            "from plus to minus inside; a negative k reverses one winding. Any number of pairs "
            "may be coupled, as long as coils can be: M stays below sqrt(L1*L2), and the matrix "
            "of all L and M is positive definite.",
    .example = "vsource V1 a 0 10*sin(314*t)\nresistor R1 a b 1 ohm\ninductor L1 b 0 0.4 H\n"
               "inductor L2 c 0 0.1 H\ncoupling K1 L1 L2 k=0.98\nresistor R2 c 0 50 ohm\n"
               "init L1.i = 0, L2.i = 0\nsimulate 0.1\nprint max(L1.v), max(L2.v)",
    .see = "inductor transformer",
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
    .help = "A voltage of plus relative to minus, whatever the current: any expression of t, "
            "parameters and other variables, so that it can also be a controller.",
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

/* thermal.c: heat capacity and resistance, sources of heat and of temperature
 *
 * T is the temperature of plus against minus (against 0 K or the surroundings, as the model defines
 * it), heat flows from plus to minus inside. Their product is no power. */
#include "component/component_rows.h"

/* clang-format off */
static const Param heatcap_params[] = {
    {"C", PARAM_SCALAR, "J/K", NULL, "heat per temperature: mass times specific heat", 0},
};
static const Param heatres_params[] = {
    {"R", PARAM_LAW, "K/W", NULL, "temperature per heat flow", 0},
};
static const Param heatsource_params[] = {
    {"value", PARAM_LAW, "W", NULL, "heat flow into the first terminal, of t, parameters and variables", POSITIONAL | GIVES_SOURCE},
};
static const Param tempsource_params[] = {
    {"value", PARAM_LAW, "K", NULL, "temperature of the first terminal relative to the second", POSITIONAL | GIVES_SOURCE},
};

static const Member heatcap_members[] = {
    {"stored", "J", "stored heat, C*T", 2},
};
/* clang-format on */

static void heatcap_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    (void)which;
    *out = (Relation){.kind = RELATION_CAPACITIVE,
                      .content = expr_mul(arena, instance_scalar(instance, "C"), motion->across),
                      .rest = expr_int(arena, 0)};
}

const Component component_heatcap = {
    .name = "heatcap",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_THERMAL,
    .places = PLACES_TERMINALS,
    .brief = "heat capacity: heat = C*T'",
    .params = heatcap_params,
    .param_count = COUNT(heatcap_params),
    .translation = BRANCH_MAY,
    .preference = 20,
    .relation = heatcap_relation,
    .members = heatcap_members,
    .member_count = COUNT(heatcap_members),
    .positive = "C",
    .help = "The temperature of a heat capacity rises with the heat that flows into it; the "
            "second terminal is 0. Its temperature is a state; init may set it.",
    .example = "heatsource H1 a 0 10\nheatcap C1 a 0 C=500\nheatres R1 a 0 R=2\n"
               "init C1.T = 0\nsimulate 3000\nprint C1.T, R1.heat",
    .see = "heatres heatsource tempsource init",
};

static void heatres_relation(const Instance *instance, Arena *arena, int which,
                             const Motion1 *motion, Relation *out)
{
    (void)which;
    (void)motion;
    *out = (Relation){.kind = RELATION_RESISTIVE,
                      .value = instance_scalar(instance, "R"),
                      .rest = expr_int(arena, 0)};
}

const Component component_heatres = {
    .name = "heatres",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_THERMAL,
    .places = PLACES_TERMINALS,
    .brief = "heat resistance: T = R*heat",
    .params = heatres_params,
    .param_count = COUNT(heatres_params),
    .translation = BRANCH_MAY,
    .preference = 30,
    .relation = heatres_relation,
    .positive = "R",
    .help = "Conduction or convection between two terminals: thickness/(conductivity*area), or "
            "1/(coefficient*area). R may be an expression, also of its own variables.",
    .example = "tempsource T1 a 0 80\nheatres R1 a b R=0.5\nheatcap C1 b 0 C=1000\n"
               "heatres R2 b 0 R=2\ninit C1.T = 20\nsimulate 2000\nprint C1.T, R1.heat",
    .see = "heatcap tempsource",
};

const Component component_heatsource = {
    .name = "heatsource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_THERMAL,
    .places = PLACES_TERMINALS,
    .brief = "heat flow into a terminal",
    .params = heatsource_params,
    .param_count = COUNT(heatsource_params),
    .translation = BRANCH_MAY,
    .preference = 50,
    .relation = scalar_through_source,
    .help = "Supplies the heat flow to its first terminal and takes it from the second, "
            "whatever the temperature: any expression, such as the loss R1.power of a resistor. "
            "As heat is positive from plus to minus inside, H1.heat is minus the value.",
    .example = "vsource E1 e 0 10\nresistor R1 e 0 20 ohm\nheatsource H1 a 0 R1.power\n"
               "heatcap C1 a 0 C=30\nheatres R2 a 0 R=12\ninit C1.T = 0\nsimulate 1000\n"
               "print C1.T, H1.heat",
    .see = "tempsource heatcap resistor",
};

const Component component_tempsource = {
    .name = "tempsource",
    .family = FAMILY_SCALAR,
    .domain = DOMAIN_THERMAL,
    .places = PLACES_TERMINALS,
    .brief = "temperature of a terminal",
    .params = tempsource_params,
    .param_count = COUNT(tempsource_params),
    .translation = BRANCH_MAY,
    .preference = 10,
    .relation = scalar_across_source,
    .help = "Sets the temperature of its first terminal relative to the second, whatever the "
            "heat flow: any expression of t, parameters and other variables.",
    .example = "tempsource T1 a 0 20 + 5*sin(t/3600)\nheatres R1 a b R=1\nheatcap C1 b 0 C=3600\n"
               "init C1.T = 20\nsimulate 7200\nprint C1.T, T1.heat",
    .see = "heatsource heatres",
};

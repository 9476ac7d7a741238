/* test_transducers.c: what each side of a transducer takes, the other gives, stores or loses */
#include "component/component.h"
#include "session_kit.h"
#include "test_model.h"

#include <math.h>
#include <string.h>

/* --- the power balance, of every row --- */

typedef struct Sample { /* values of symbols at random, the same for the same name */
    uint32_t seed;
} Sample;

static double some_value(void *context, Expr symbol)
{
    const Sample *sample = context;
    uint32_t x = (uint32_t)expr_symbol_number(symbol) * 2654435761U + sample->seed * 40503U;

    x ^= x >> 15;
    x *= 2246822519U;
    x ^= x >> 13;
    return 0.1 + 0.3 * (double)x / 4294967296.0;
}

/* names of units in which losses are given */
static bool is_loss(const Param *param)
{
    return param->unit != NULL &&
           (strcmp(param->unit, "ohm") == 0 || strcmp(param->unit, "N*m*s/rad") == 0 ||
            strcmp(param->unit, "N*s/m") == 0 || strstr(param->unit, "N*s/m|") != NULL);
}

/* the part with other values: losses that are 0, or 0.3; *any whether it has some */
static Instance with_losses(const Instance *from, Arena *arena, bool lossy, Value *values)
{
    Instance part = *from;

    memcpy(values, from->values, sizeof *values * (size_t)from->row->param_count);
    for (int i = 0; i < from->row->param_count; i++)
        if (is_loss(&from->row->params[i]))
            values[i].at[0] = lossy ? expr_rational(arena, 3, 10) : expr_int(arena, 0);
    part.values = values;
    return part;
}

/* v i - F s' - stored', over s, s' and i or v with their rates; in *size the terms' sum */
static Expr imbalance(const Instance *part, const Instance *joint, Arena *arena, Expr *size)
{
    Motion1 motion = {instance_coordinate(part, joint, arena, 0),
                      instance_coordinate(part, joint, arena, 1), instance_across(part, arena, 0),
                      instance_through(part, arena, 0)};
    Expr v = motion.across;
    Expr i = motion.through;
    Expr effort;
    Expr given;
    Expr power[3];
    Relation relation = {0};

    part->row->relation(part, arena, 0, &motion, &relation);
    effort = part->row->effort(part, arena, &motion);
    if (relation.content != NULL)
        given = expr_add(arena, system_user_rate(arena, relation.content), relation.rest);
    else if (relation.kind == RELATION_RESISTIVE)
        given = expr_add(arena, expr_mul(arena, relation.value, i), relation.rest);
    else
        given = relation.value;
    switch (relation.kind) {
    case RELATION_CAPACITIVE:
    case RELATION_CONDUCTIVE:
    case RELATION_THROUGH:
        effort = expr_substitute(arena, effort, &i, &given, 1);
        i = given;
        break;
    default:
        effort = expr_substitute(arena, effort, &v, &given, 1);
        v = given;
    }
    power[0] = expr_mul(arena, v, i);
    power[1] = expr_neg(arena, expr_mul(arena, effort, motion.rate));
    power[2] = relation.stored != NULL ? expr_neg(arena, system_user_rate(arena, relation.stored))
                                       : expr_int(arena, 0);
    *size = expr_int(arena, 1);
    for (int k = 0; k < 3; k++)
        *size = expr_add(arena, *size, expr_call1(arena, OP_ABS, power[k]));
    return expr_sum(arena, power, 3);
}

static void expect_balance(const Instance *part, const Instance *joint, Arena *arena)
{
    for (int lossy = 0; lossy < 2; lossy++) {
        Value values[16] = {{0}};
        Instance copy = with_losses(part, arena, lossy == 1, values);
        Expr size;
        Expr lost = imbalance(&copy, joint, arena, &size);
        for (uint32_t seed = 1; seed <= 20; seed++) {
            Sample sample = {seed};
            double left =
                expr_evaluate(lost, some_value, &sample) / expr_evaluate(size, some_value, &sample);

            EXPECT(lossy ? left > -1e-13 : fabs(left) < 1e-13);
        }
        /* what is lost depends on no rate of the states */
        for (int k = 0; k < 2; k++) {
            Expr rate = system_user_rate(arena, k == 0 ? instance_across(part, arena, 0)
                                                       : instance_through(part, arena, 0));
            Expr slope = expr_diff(arena, lost, rate);
            Sample sample = {7};

            EXPECT(fabs(expr_evaluate(slope, some_value, &sample)) <
                   1e-13 * expr_evaluate(size, some_value, &sample));
        }
    }
}

static void every_transducer_balances_its_power(void)
{
    const Component *row;
    int count = 0;

    for (int i = 0; (row = component_at(i)) != NULL; i++) {
        Model *model;

        if (row->family != FAMILY_TRANSDUCER || row->domain == DOMAIN_THERMAL)
            continue;
        model = model_of(row->example);
        for (int k = 0; k < model_count(model); k++) {
            const Instance *part = model_instance(model, k);

            if (part->row != row)
                continue;
            expect_balance(part, model_instance(model, part->joint), model_arena(model));
            count++;
        }
        model_free(model);
    }
    EXPECT(count >= 5);
}

/* --- closed forms --- */

static void expect_value(const char *model, const char *what, double wanted, double relative)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, what), wanted, relative * (fabs(wanted) + 1e-12));
    kit_free(&kit);
}

#define SLIDE            "scene planar\nbody m mass=0.5 inertia=0\nprismatic s ground m axis=x\n"
#define RUN_FOR(seconds) "simulate " #seconds " rtol=1e-10 atol=1e-13\n"

/* static pull of a plate capacitor against a spring: k s = eps A E^2/(2 (d - s)^2) */
static void plate_comes_to_rest_where_the_spring_holds_it(void)
{
    double low = 0, high = 1e-3 / 3;
    const double E = 10;

    for (int k = 0; k < 100; k++) {
        double s = (low + high) / 2;

        if (100 * s < 0.5 * 1e-10 * E * E / ((1e-3 - s) * (1e-3 - s)))
            low = s;
        else
            high = s;
    }
    expect_value("scene planar\nbody m mass=0.001 inertia=0\nprismatic s ground m axis=x\n"
                 "spring k1 s k=100\ndamper d1 s d=0.6\n"
                 "vsource E1 a 0 10\nresistor R1 a b 1000\nplatecap C1 s b 0 C=1e-10/(1e-3 - s)\n"
                 "init s = 0, s' = 0, C1.v = 0\nsimulate 1 rtol=1e-11 atol=1e-14\n",
                 "s", low, 1e-7);
}

/* held at constant speed by a driver: q = C(s) v with a constant charge, so v = q d(t)/A */
static void plates_drawn_apart_raise_the_voltage(void)
{
    expect_value(SLIDE "driver D1 s = 1e-3 + 0.01*t\nplatecap C1 s a 0 C=1e-10/s\n"
                       "resistor R1 a 0 1e15\ninit C1.v = 3\n"
                       "simulate 0.1 rtol=1e-9 atol=1e-12\n",
                 "C1.v", 6, 1e-4);
}

/* L = 0.02 + 2 x at constant current: F = i^2 */
static void solenoid_pulls_with_half_the_slope_of_its_inductance(void)
{
    expect_value(SLIDE "isource I1 0 a 3\nsolenoid X1 s a 0 L=0.02 + 2*s R=1\n"
                       "init s = 0, s' = 0\n" RUN_FOR(0.1),
                 "s", 0.5 * 9 / 0.5 * 0.01, 1e-8);
}

/* L = 0: m s'' = K (E - K s')/R */
static void voicecoil_runs_up_exponentially(void)
{
    double tau = 0.5 * 4 / 36;

    expect_value(SLIDE
                 "vsource E1 a 0 12\nvoicecoil X1 s a 0 K=6 R=4\ninit s = 0, s' = 0\n" RUN_FOR(0.1),
                 "s'", 2 * (1 - exp(-0.1 / tau)), 1e-8);
}

/* without ohms it is a damper K^2/R of what stands at its terminals */
static void voicecoil_without_ohms_is_a_plain_converter(void)
{
    expect_value(SLIDE "damper d1 s d=3\nresistor R1 a 0 5\nvoicecoil X1 s a 0 K=6\n"
                       "init s = 0, s' = 0.2\n" RUN_FOR(0.1),
                 "s'", 0.2 * exp(-(3 + 36 / 5.0) * 0.1 / 0.5), 1e-7);
}

/* a capacitor behind it is a mass K^2 C */
static void voicecoil_turns_a_capacitor_into_a_mass(void)
{
    expect_value(SLIDE "damper d1 s d=3\ncapacitor C1 a 0 2\nvoicecoil X1 s a 0 K=6\n"
                       "init s = 0, s' = 0.2\n" RUN_FOR(0.3),
                 "s'", 0.2 * exp(-3 * 0.3 / (0.5 + 2 * 36)), 1e-7);
}

/* free stack: the natural frequency with the terminals shorted is sqrt(k/m), open it is stiffer by
 * (d k)^2/C */
static void piezo_is_stiffer_with_open_terminals(void)
{
    double k = 2e6, open = 2e6 + pow(1e-6 * 2e6, 2) / 1e-6;

    expect_value(SLIDE "vsource E1 a 0 0\npiezo P1 s a 0 C=1e-6 d=1e-6 k=2e6\n"
                       "init s = 1e-5, s' = 0\n" RUN_FOR(0.01),
                 "s", 1e-5 * cos(sqrt(k / 0.5) * 0.01), 1e-6);
    expect_value(SLIDE "isource I1 a 0 0\npiezo P1 s a 0 C=1e-6 d=1e-6 k=2e6\n"
                       "init s = 1e-5, s' = 0, P1.q = 0\n" RUN_FOR(0.01),
                 "s", 1e-5 * cos(sqrt(open / 0.5) * 0.01), 1e-6);
    expect_value(SLIDE "vsource E1 a 0 50\npiezo P1 s a 0 C=1e-6 d=1e-6 k=2e6 rest=0.01\n"
                       "damper d1 s d=2000\ninit s = 0.01, s' = 0\n" RUN_FOR(0.1),
                 "s - 0.01", 50e-6, 1e-6);
}

static void energy_is_kept_through_transducers(void)
{
    static const char *const parts[] = {
        "platecap X1 s a 0 C=1e-3/(1 + s^2)\ncapacitor C1 a 0 1e-3\ninit s = 0.5, s' = 1, X1.v = "
        "3\n",
        "solenoid X1 s a 0 L=0.2/(1 + s^2)\ncapacitor C1 a 0 1e-2\n"
        "init s = 0.5, s' = 1, X1.i = 3, C1.v = 2\n",
        "voicecoil X1 s a 0 K=2 + s L=0.1\ncapacitor C1 a 0 1e-2\n"
        "init s = 0.5, s' = 1, X1.i = 3, C1.v = 2\n",
        "piezo X1 s a 0 C=1e-3 d=0.1 k=20\ninductor L1 a 0 0.2\n"
        "init s = 0.5, s' = 1, X1.v = 3, L1.i = 1\n",
    };

    for (int k = 0; k < 4; k++) {
        Kit kit = kit_new();
        char model[400];
        double before;

        (void)snprintf(model, sizeof model, SLIDE "spring k1 s k=40\n%s", parts[k]);
        EXPECT_DONE(&kit, model);
        EXPECT_DONE(&kit, "assemble\n");
        before = kit_value(&kit, "energy.total");
        EXPECT_DONE(&kit, RUN_FOR(2));
        EXPECT_NEAR(kit_value(&kit, "energy.total"), before, 1e-8 * before);
        kit_free(&kit);
    }
}

/* --- sensors --- */

static void sensors_tell_without_a_load(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SLIDE "actuator a1 s force=2\nsensor v1 s a 0 gain=5\nsensor v2 s' b 0\n"
                            "resistor R1 a 0 10\nsensor v3 R1.i c 0 gain=100\n"
                            "sensor v4 (s + 2*m.x) d 0\ninit s = 0.1, s' = 0.3\n" RUN_FOR(1));
    EXPECT_NEAR(kit_value(&kit, "s"), 0.1 + 0.3 + 2, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "v1.v"), 5 * 2.4, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "b.v"), 4.3, 1e-8);
    EXPECT_NEAR(kit_value(&kit, "v3.v"), 100 * 5 * 2.4 / 10, 1e-6);
    EXPECT_NEAR(kit_value(&kit, "v4.v"), 3 * 2.4, 1e-8);
    EXPECT(kit_do(&kit, "delete R1\n") != CT_OK);
    EXPECT_HOLDS(kit.error.message, "R1 is used by");
    kit_free(&kit);
}

/* a joint's reaction, sensed: it waits for the equations of motion */
static void sensor_of_a_force_tells_the_weight(void)
{
    expect_value("scene planar\ngravity [0, -10]\nbody m mass=2 inertia=0.1\n"
                 "prismatic s ground m axis=x\nsensor v1 s.fy a 0 gain=0.5\nresistor R1 a 0 100\n"
                 "init s = 0, s' = 1\n" RUN_FOR(1),
                 "R1.i", 0.5 * 20 / 100, 1e-9);
}

/* --- where laws end --- */

#define PULLED_IN                                                                                  \
    "scene planar\neA = 5e-5; s0 = 0.05\nbody plate mass=0.1\nprismatic s ground plate axis=x\n"   \
    "spring k s k=200 d=0.8\nvsource E1 a 0 2000\nresistor R1 a b 10\n"                            \
    "platecap C2 s b 0 C=eA/(s0 - s)\ninit C2.v = 0\n"

/* whatever the method, and however long the steps: the way through the gap is no way */
static void a_gap_that_closes_ends_the_run(void)
{
    static const char *const methods[] = {"dop853", "radau", "bdf", "ida", "rk4 step=0.0001"};
    double when = 0;

    for (int i = 0; i < COUNT(methods); i++) {
        Kit kit = kit_new();
        char line[80];

        EXPECT_DONE(&kit, PULLED_IN);
        (void)snprintf(line, sizeof line, "simulate 1 every=0.01 method=%s", methods[i]);
        EXPECT_FAILS(&kit, line,
                     "the gap of C2 closed: s0 - s came to 0, where its law has no bound");
        EXPECT_HOLDS(kit.error.hint, "event closed when=s0 - s < 0.0005 do=stop");
        /* what was computed is kept, up to there */
        EXPECT_NEAR(kit_value(&kit, "s"), 0.05, 1e-7);
        when = i == 0 ? kit_value(&kit, "max(t)") : when;
        EXPECT_NEAR(kit_value(&kit, "max(t)"), when, 1e-6 * when + (i == 4 ? 1e-5 : 0));
        EXPECT_DONE(&kit, "show events");
        EXPECT_HOLDS(kit.text, "C2 at its bound");
        /* the way out that the hint tells */
        EXPECT_DONE(&kit, "event closed when=s0 - s < 0.0005 do=stop\n");
        EXPECT_DONE(&kit, line);
        EXPECT_NEAR(kit_value(&kit, "s"), 0.0495, 1e-9);
        EXPECT_DONE(&kit, "show events");
        EXPECT_LACKS(kit.text, "C2 at its bound");
        kit_free(&kit);
    }
}

/* L0 - k s: a coil that leaves its core, by a law that is straight for too long */
static void a_law_that_falls_to_nothing_ends_the_run(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nL0 = 0.1; k = 1; v = 2\nbody core mass=1\n"
                      "prismatic s ground core axis=x\nisource I1 0 a 0.01\n"
                      "solenoid X s a 0 L=L0 - k*s R=1\ninit s = 0, s' = v\n");
    EXPECT_FAILS(&kit, "simulate 1 every=0.01", "the law of X came to its end: L0 - k*s fell to 0");
    EXPECT_HOLDS(kit.error.hint, "event closed when=L0 - k*s < 0.001 do=stop");
    EXPECT_NEAR(kit_value(&kit, "s"), 0.1, 1e-6);
    kit_free(&kit);
}

/* a measure that is negative from the start */
static void a_gap_may_be_counted_backwards(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\neA = 5e-5; s0 = 0.05\nbody plate mass=0.1\n"
                      "prismatic s ground plate axis=x\nspring k s k=200 d=0.8\n"
                      "vsource E1 a 0 2000\nresistor R1 a b 10\n"
                      "platecap C2 s b 0 C=-eA/(s + s0)\ninit s = -0.1, s' = 0, C2.v = 0\n");
    EXPECT_FAILS(&kit, "simulate 1 every=0.01", "the gap of C2 closed: s0 + s came to 0");
    EXPECT_HOLDS(kit.error.hint, "event closed when=s0 + s > -0.0005 do=stop");
    kit_free(&kit);
}

int main(void)
{
    RUN(every_transducer_balances_its_power);
    RUN(plate_comes_to_rest_where_the_spring_holds_it);
    RUN(plates_drawn_apart_raise_the_voltage);
    RUN(solenoid_pulls_with_half_the_slope_of_its_inductance);
    RUN(voicecoil_runs_up_exponentially);
    RUN(voicecoil_without_ohms_is_a_plain_converter);
    RUN(voicecoil_turns_a_capacitor_into_a_mass);
    RUN(piezo_is_stiffer_with_open_terminals);
    RUN(energy_is_kept_through_transducers);
    RUN(sensors_tell_without_a_load);
    RUN(sensor_of_a_force_tells_the_weight);
    RUN(a_gap_that_closes_ends_the_run);
    RUN(a_law_that_falls_to_nothing_ends_the_run);
    RUN(a_gap_may_be_counted_backwards);
    return test_end();
}

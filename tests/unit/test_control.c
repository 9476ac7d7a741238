/* test_control.c: control blocks against closed forms; what they are when sampled */
#include "component/component.h"
#include "session_kit.h"
#include "test_model.h"

#include <math.h>

#define RUN_FOR(seconds) "simulate " #seconds " rtol=1e-10 atol=1e-13\n"

static void expect_value(const char *model, const char *what, double wanted, double relative)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT_NEAR(kit_value(&kit, what), wanted, relative * (fabs(wanted) + 1e-9));
    kit_free(&kit);
}

/* --- continuous --- */

static void blocks_of_signals_answer_a_step(void)
{
    expect_value("gain c1 a 0 of=t^2 k=-3\n" RUN_FOR(2), "a.v", -12, 1e-12);
    expect_value("gain c1 a 0 of=t^2 k=-3\nsum c2 b 0 of=[a.v, 5, -t]\n" RUN_FOR(2), "c2.v", -9,
                 1e-12);
    expect_value("integrator c1 a 0 of=t k=4 initial=7\n" RUN_FOR(3), "a.v", 7 + 2 * 9, 1e-9);
    expect_value("lag c1 a 0 of=2 k=3 T=0.5 initial=1\n" RUN_FOR(0.7), "a.v",
                 6 - 5 * exp(-0.7 / 0.5), 1e-9);
    expect_value("lag c1 a 0 of=2 k=3 T=0.5 initial=1\n" RUN_FOR(0.7), "c1.x'",
                 10 * exp(-0.7 / 0.5), 1e-9);
}

static void outputs_stay_within_limits(void)
{
    expect_value("gain c1 a 0 of=t k=3 limits=[-1, 2]\n" RUN_FOR(2), "a.v", 2, 1e-12);
    expect_value("sum c1 a 0 of=[-t, -1] limits=[-2, 2]\n" RUN_FOR(2), "a.v", -2, 1e-12);
    expect_value("lag c1 a 0 of=5 T=0.1 limits=[-1, 2]\n" RUN_FOR(2), "c1.v", 2, 1e-12);
}

/* it fills in 1 s, stays there for 2 s, and leaves as soon as its input turns */
static void integrator_stops_at_its_limit(void)
{
    expect_value("integrator c1 a 0 of=if(t < 3, 2, -1) limits=[-1, 2]\n" RUN_FOR(2.9), "a.v", 2,
                 1e-9);
    expect_value("integrator c1 a 0 of=if(t < 3, 2, -1) limits=[-1, 2]\n" RUN_FOR(4), "a.v", 1,
                 1e-9);
    expect_value("integrator c1 a 0 of=if(t < 3, 2, -1) limits=[-1, 2]\n" RUN_FOR(9), "a.v", -1,
                 1e-9);
}

/* partial fractions of (2 s + 3)/((s + 1)(s + 2)), (s + 2)/(s + 1) and 12/(s + 1)^3 */
static void transfer_functions_answer_a_step(void)
{
    expect_value("transfer c1 a 0 of=1 num=[2, 3] den=[1, 3, 2]\n" RUN_FOR(1.3), "a.v",
                 1.5 - exp(-1.3) - exp(-2.6) / 2, 1e-9);
    expect_value("transfer c1 a 0 of=1 num=[4, 6] den=[2, 6, 4]\n" RUN_FOR(1.3), "a.v",
                 1.5 - exp(-1.3) - exp(-2.6) / 2, 1e-9);
    expect_value("transfer c1 a 0 of=1 num=[1, 2] den=[1, 1]\n" RUN_FOR(1.3), "a.v", 2 - exp(-1.3),
                 1e-9);
    expect_value("transfer c1 a 0 of=1 num=12 den=[1, 3, 3, 1]\n" RUN_FOR(2), "a.v",
                 12 * (1 - exp(-2) * (1 + 2 + 2)), 1e-9);
    expect_value("transfer c1 a 0 of=1 num=12 den=[1, 3, 3, 1]\n" RUN_FOR(2), "c1.x1'", exp(-2) * 2,
                 1e-8);
    expect_value("transfer c1 a 0 of=t num=3 den=4\n" RUN_FOR(2), "a.v", 1.5, 1e-12);
}

/* 1/(s + 1)^10: 1 - exp(-t) times the sum of t^k/k! up to t^9, and its ninth derivative */
static void transfer_function_has_any_order(void)
{
    static const char ten_lags[] =
        "transfer c1 a 0 of=1 num=1 den=[1, 10, 45, 120, 210, 252, 210, 120, 45, 10, 1]\n";
    double term = 1, sum = 1;
    Text model = {0};

    for (int k = 1; k < 10; k++)
        sum += term *= 2.0 / k;
    text_addf(&model, "%s%s", ten_lags, RUN_FOR(2));
    expect_value(model.at, "a.v", 1 - exp(-2) * sum, 1e-7);
    expect_value(model.at, "c1.x10", exp(-2) * 142.0 / 405, 1e-7);
    expect_value("sum c1 a 0 of=[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n" RUN_FOR(1), "a.v", 78,
                 1e-12);
    text_free(&model);
}

#define MASS "scene planar\nbody m mass=1 inertia=0\nprismatic s ground m axis=x\n"

/* a mass on PD control of its force, critically damped: s = 1 - (1 + 2 t) exp(-2 t) */
static void pd_control_is_a_spring_and_a_damper(void)
{
    expect_value(MASS "pd c1 a 0 ref=1 of=s Kp=4 Kd=4\nactuator a1 s force=c1.v\n"
                      "init s = 0, s' = 0\n" RUN_FOR(1.5),
                 "s", 1 - 4 * exp(-3), 1e-8);
}

/* it takes the rate of what it follows: of a ramp behind it nothing is left */
static void pd_control_needs_rates_of_both(void)
{
    expect_value("pd c1 a 0 ref=3*t of=t^2 Kp=2 Kd=5\n" RUN_FOR(2), "a.v", 2 * 2 + 5 * (3 - 4),
                 1e-10);
    expect_value("vsource V1 b 0 sin(t)\npd c1 a 0 ref=0 of=b.v Kp=0 Kd=5\n" RUN_FOR(2), "a.v",
                 -5 * cos(2), 1e-9);
    expect_value("pd c1 a 0 ref=3*t of=0 Kp=2 Kd=5 filter=0.4\n" RUN_FOR(1), "a.v",
                 6 + 15 * (1 - exp(-1 / 0.4)), 1e-8);
}

static void refused(const char *model, const char *statement, const char *message, const char *hint)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, model);
    EXPECT(kit_do(&kit, statement) != CT_OK);
    EXPECT_HOLDS(kit.error.message, message);
    EXPECT_HOLDS(kit.error.hint, hint);
    kit_free(&kit);
}

static void rate_of_a_jump_is_refused(void)
{
    static const char *const jump[] = {
        "pd c1 a 0 ref=step(t - 1) of=0 Kp=2 Kd=5\n", "pd c1 a 0 ref=3*(t > 1) of=0 Kp=2 Kd=5\n",
        "pd c1 a 0 ref=0 of=L(t) Kp=2 Kd=5\n", "pd c1 a 0 ref=if(R1.v > 1, p, 0) of=0 Kp=2 Kd=5\n",
        "pid c1 a 0 ref=sign(R1.v - 1) of=0 Kp=2 Ki=1 Kd=5\n"};
    static const char *const bend[] = {"pd c1 a 0 ref=ramp(t - 1) of=0 Kp=2 Kd=5\n",
                                       "pd c1 a 0 ref=if(t > 1, t, 1) of=0 Kp=2 Kd=5\n",
                                       "pd c1 a 0 ref=max(R1.v, p) of=0 Kp=2 Kd=5\n",
                                       "pd c1 a 0 ref=3*(t > 1) of=0 Kp=2 Kd=5 filter=0.1\n",
                                       "pd c1 a 0 ref=3*(t > 1) of=0 Kp=2 Kd=5 period=0.1\n"};
    static const char base[] =
        "p = 2\nL(x) = if(x > 1, p, 0)\nvsource E1 b 0 t\nresistor R1 b 0 3\n";

    for (size_t i = 0; i < sizeof jump / sizeof *jump; i++)
        refused(base, jump[i], "c1 takes the derivative of something that jumps", "filter=");
    for (size_t i = 0; i < sizeof bend / sizeof *bend; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, base);
        EXPECT_DONE(&kit, bend[i]);
        kit_free(&kit);
    }
    refused("L(x) = x\npd c1 a 0 ref=L(t) of=0 Kp=2 Kd=5\n", "L(x) = step(x - 1)\n",
            "c1 takes the derivative of something that jumps", "filter=");
    refused("vsource V1 b 0 pulse(t, 0, 1, 1, 0, 0, 1, 2)\npd c1 a 0 ref=b.v of=0 Kp=2 Kd=5\n",
            "simulate 2\n", "c1 takes the derivative of something that jumps", "filter=");
    expect_value("pd c1 a 0 ref=step(t - 1) of=0 Kp=2 Kd=0\n" RUN_FOR(2), "a.v", 2, 1e-12);
}

static void pid_control_integrates_the_error(void)
{
    expect_value("pid c1 a 0 ref=2 of=0 Kp=3 Ki=5 initial=0.1\n" RUN_FOR(2), "a.v", 6 + 5 * 4.1,
                 1e-9);
    expect_value("pid c1 a 0 ref=t^2 of=0 Kp=3 Ki=5 Kd=7\n" RUN_FOR(2), "a.v",
                 12 + 5 * 8 / 3.0 + 28, 1e-9);
    expect_value("pid c1 a 0 ref=t of=0 Kp=3 Ki=5 Kd=7 filter=0.5\n" RUN_FOR(2), "a.v",
                 6 + 10 + 7 * (1 - exp(-4)), 1e-9);
}

/* e = 1: u reaches 8 at t = 1; then I' = 1 + (8 - u)/3 with u = 3 + 5 I goes to I = 1.6 */
static void pid_control_does_not_wind_up(void)
{
    const char *model = "pid c1 a 0 ref=if(t < 4, 1, -1) of=0 Kp=3 Ki=5 limits=[-10, 8]\n";
    double wound = 1.6 - 0.6 * exp(-5.0 / 3 * 3);
    char text[200];

    (void)snprintf(text, sizeof text, "%s%s", model, RUN_FOR(3.99999999));
    expect_value(text, "a.v", 8, 1e-9);
    expect_value(text, "c1.integral", wound, 1e-6);
    /* the error turns: out of the limit at once, u = -3 + 5 I - 5 t */
    (void)snprintf(text, sizeof text, "%s%s", model, RUN_FOR(4.5));
    expect_value(text, "a.v", -3 + 5 * wound - 2.5, 1e-6);
}

/* --- sampled: what a run is told --- */

static double some_state(void *context, Expr symbol)
{
    const char *name = expr_name(symbol);

    (void)context;
    if (strcmp(name, "c1.previous") == 0)
        return 0.5;
    if (strcmp(name, "c1.filtered") == 0)
        return 0.25;
    if (strcmp(name, "c1.integral") == 0)
        return 3;
    if (strcmp(name, "c1.x1") == 0 || strcmp(name, "c1.x") == 0)
        return 1.5;
    return strcmp(name, "c1.x2") == 0 ? -2 : 0;
}

/* `next` of a state of c1 where ref or of is 2, period 0.1 */
static double next_of(const char *statement, const char *member)
{
    Model *model = model_of(statement);
    const Instance *part = model_find(model, "c1");
    double value = NAN;

    for (int k = 0; part != NULL && k < part->row->own_state_count(part); k++) {
        OwnState own;

        part->row->own_state(part, model_arena(model), k, &own);
        EXPECT(expr_is_zero(own.rate));
        EXPECT_NEAR(model_number(model, own.period), 0.1, 1e-15);
        if (strcmp(own.member, member) == 0)
            value = expr_evaluate(own.next, some_state, NULL);
    }
    model_free(model);
    return value;
}

static void sampled_blocks_hold_their_output(void)
{
    EXPECT_NEAR(next_of("gain c1 a 0 of=2 k=7 period=0.1", "held"), 14, 1e-12);
    EXPECT_NEAR(next_of("sum c1 a 0 of=[2, 3] limits=[-1, 4] period=0.1", "held"), 4, 1e-12);
    EXPECT_NEAR(next_of("integrator c1 a 0 of=2 k=7 period=0.1", "x"), 1.5 + 1.4, 1e-12);
    EXPECT_NEAR(next_of("integrator c1 a 0 of=2 k=7 limits=[0, 2] period=0.1", "x"), 2, 1e-12);
    EXPECT_NEAR(next_of("integrator c1 a 0 of=2 k=7 period=0.1", "held"), 1.5, 1e-12);
    EXPECT_NEAR(next_of("lag c1 a 0 of=2 k=7 T=0.3 period=0.1", "x"), 14 - 12.5 * exp(-1.0 / 3),
                1e-12);
}

static void sampled_controllers_take_differences(void)
{
    EXPECT_NEAR(next_of("pd c1 a 0 ref=2 of=0 Kp=3 Kd=5 period=0.1", "held"), 6 + 5 * 15, 1e-12);
    EXPECT_NEAR(next_of("pd c1 a 0 ref=2 of=0 Kp=3 Kd=5 period=0.1", "previous"), 2, 1e-12);
    EXPECT_NEAR(next_of("pd c1 a 0 ref=2 of=0 Kp=3 Kd=5 filter=0.4 period=0.1", "held"),
                6 + 5 * 1.75 / 0.5, 1e-12);
    EXPECT_NEAR(next_of("pd c1 a 0 ref=2 of=0 Kp=3 Kd=5 filter=0.4 period=0.1", "filtered"),
                0.25 + 1.75 * 0.2, 1e-12);
    EXPECT_NEAR(next_of("pid c1 a 0 ref=2 of=0 Kp=3 Ki=4 period=0.1", "held"), 18, 1e-12);
    EXPECT_NEAR(next_of("pid c1 a 0 ref=2 of=0 Kp=3 Ki=4 period=0.1", "integral"), 3.2, 1e-12);
    EXPECT_NEAR(next_of("pid c1 a 0 ref=2 of=0 Kp=3 Ki=4 limits=[0, 9] period=0.1", "integral"),
                3 + 0.1 * (2 - 3), 1e-12);
}

/* (2 s + 3)/(s^2 + 3 s + 2), trapezoidal: x+ = x + h/2 (f(x+) + f(x)), solved here by repetition */
static void sampled_transfer_function_goes_by_the_trapezoidal_rule(void)
{
    double x[2] = {1.5, -2};
    double next[2] = {1.5, -2};

    for (int k = 0; k < 200; k++) {
        double rate = 2 - 2 * next[0] - 3 * next[1] + 2 - 2 * x[0] - 3 * x[1];

        next[0] = x[0] + 0.05 * (next[1] + x[1]);
        next[1] = x[1] + 0.05 * rate;
    }
    for (int k = 0; k < 2; k++)
        EXPECT_NEAR(next_of("transfer c1 a 0 of=2 num=[2, 3] den=[1, 3, 2] period=0.1",
                            k == 0 ? "x1" : "x2"),
                    next[k], 1e-12);
    EXPECT_NEAR(next_of("transfer c1 a 0 of=2 num=[2, 3] den=[1, 3, 2] period=0.1", "held"),
                3 * 1.5 + 2 * -2, 1e-12);
}

/* a mass of 1 kg pushed with the force of the last instant: exact from one to the next */
static void sampled_control_moves_a_mass_in_parabolas(void)
{
    double s = 0, v = 0, previous = 0, force = 0;
    Kit kit = kit_new();

    for (int k = 0; k < 11; k++) {
        double h = k < 10 ? 0.1 : 0.05;

        force = 4 * (1 - s) + 4 * (1 - s - previous) / 0.1;
        previous = 1 - s;
        s += v * h + force * h * h / 2;
        v += force * h;
    }
    EXPECT_DONE(&kit, MASS "pd c1 a 0 ref=1 of=s Kp=4 Kd=4 period=0.1\n"
                           "actuator a1 s force=c1.v\ninit s = 0, s' = 0\n" RUN_FOR(1.05));
    EXPECT_NEAR(kit_value(&kit, "s"), s, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "s'"), v, 1e-9);
    EXPECT_NEAR(kit_value(&kit, "c1.v"), force, 1e-9);
    kit_free(&kit);
}

static void nobody_waits_for_endless_samples(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gain c1 a 0 of=2 k=1 period=1e-300\nresistor R1 a 0 5\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "would be sampled 1e+300 times in 1 s");
    EXPECT_DONE(&kit, "set c1.period = 0.01\nsimulate 1\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(blocks_of_signals_answer_a_step);
    RUN(outputs_stay_within_limits);
    RUN(integrator_stops_at_its_limit);
    RUN(transfer_functions_answer_a_step);
    RUN(transfer_function_has_any_order);
    RUN(pd_control_is_a_spring_and_a_damper);
    RUN(pd_control_needs_rates_of_both);
    RUN(rate_of_a_jump_is_refused);
    RUN(pid_control_integrates_the_error);
    RUN(pid_control_does_not_wind_up);
    RUN(sampled_blocks_hold_their_output);
    RUN(sampled_controllers_take_differences);
    RUN(sampled_transfer_function_goes_by_the_trapezoidal_rule);
    RUN(sampled_control_moves_a_mass_in_parabolas);
    RUN(nobody_waits_for_endless_samples);
    return test_end();
}

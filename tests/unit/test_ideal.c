/* test_ideal.c: ideal diodes and switches beside what stores: closed forms, and what is refused */
#include "../random.h"
#include "base/text.h"
#include "session_kit.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

/* an expression at an instant of the last run; also between rows, where it is interpolated */
static void expect_at(Kit *kit, const char *what, double t, double value, double within)
{
    char text[200];

    (void)snprintf(text, sizeof text, "expect %s ~ %.17g within %g at %.17g\n", what, value, within,
                   t);
    EXPECT_DONE(kit, text);
}

/* --- rectifiers --- */

/* v = V sin(wt) until the diode's current C v' + v/R ends, then v falls until the next wave meets
 * it */
static double peak_voltage(double t, double w, double V, double R, double C, bool full)
{
    double period = full ? PI / w : 2 * PI / w;
    double off = (PI - atan(w * R * C)) / w;
    double from = floor((t - off) / period) * period + off; /* the last end of conduction */
    double now = full ? fabs(sin(w * t)) : fmax(sin(w * t), 0);
    double left = t < off ? 0 : sin(w * off) * exp(-(t - from) / (R * C));

    return V * fmax(now, left);
}

static void a_capacitor_takes_the_peaks(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\ndiode D a b\ncapacitor C b 0 100 uF\n"
                      "resistor R b 0 100\nsimulate 0.1 every=20 us rtol=1e-10\n");
    for (int i = 0; i < 60; i++) { /* on rows and between them */
        double t = 0.1 * i / 60;

        expect_at(&kit, "b.v", t, peak_voltage(t, 100 * PI, 10, 100, 100e-6, false), 2e-8);
    }
    /* the diode's current where it begins: C v' jumps from 0 to what the wave asks for */
    EXPECT_DONE(&kit, "expect min(D.i) ~ 0 within 1e-9\nexpect max(D.v) ~ 0 within 1e-9\n");
    kit_free(&kit);
}

static const char bridge[] = "vsource V a b 10*sin(100*pi*t)\ndiode D1 a p\ndiode D2 b p\n"
                             "diode D3 0 a\ndiode D4 0 b\n";

static void a_bridge_smooths_both_halves(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, bridge);
    EXPECT_DONE(&kit, "capacitor C p 0 200 uF\nresistor R p 0 100\n"
                      "simulate 0.1 every=20 us rtol=1e-10\n");
    for (int i = 0; i < 60; i++) {
        double t = 0.1 * i / 60;

        expect_at(&kit, "p.v", t, peak_voltage(t, 100 * PI, 10, 100, 200e-6, true), 2e-8);
    }
    /* where all four are open nothing tells where the source stands against the load: in between */
    EXPECT_DONE(&kit, "expect (a.v + b.v) ~ p.v within 1e-9 at 6.1 ms\n");
    kit_free(&kit);
}

/* i = V/Z (sin(wt - phi) + sin(phi) exp(-t R/L)) until it ends, then nothing till the next wave */
static void a_coil_carries_on_behind_the_wave(void)
{
    const double w = 100 * PI, R = 10, L = 30e-3;
    const double Z = hypot(R, w * L), phi = atan2(w * L, R);
    double end = 1.2 * PI / w;
    Kit kit = kit_new();

    for (int i = 0; i < 60; i++) /* Newton's method */
        end -= (sin(w * end - phi) + sin(phi) * exp(-end * R / L)) /
               (w * cos(w * end - phi) - R / L * sin(phi) * exp(-end * R / L));
    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\ndiode D a b\ninductor L b c 30 mH\n"
                      "resistor R c 0 10\nsimulate 0.06 every=20 us rtol=1e-10\n");
    for (int i = 0; i < 60; i++) {
        double t = 0.06 * i / 60 + 1e-5, s = fmod(t, 0.02);
        double current = s < end ? 10 / Z * (sin(w * s - phi) + sin(phi) * exp(-s * R / L)) : 0;

        expect_at(&kit, "L.i", t, current, 1e-9);
        if (s > end)
            expect_at(&kit, "D.v", t, 10 * sin(w * s), 1e-9);
    }
    kit_free(&kit);
}

/* two diodes of six conduct: the load sees the largest difference of phases */
static void six_diodes_take_the_largest_difference(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "vsource E1 a n 100*sin(100*pi*t)\nvsource E2 b n 100*sin(100*pi*t - 2*pi/3)\n"
                "vsource E3 c n 100*sin(100*pi*t + 2*pi/3)\n"
                "diode D1 a p\ndiode D2 b p\ndiode D3 c p\n"
                "diode D4 0 a\ndiode D5 0 b\ndiode D6 0 c\n"
                "inductor L p m 10 mH\nresistor R m 0 10\nsimulate 0.1\n");
    for (int i = 1; i < 100; i++) { /* every other one in the last row before a diode takes over */
        const int even = i / 2;
        double t = 0.1 * even / 50 + 1e-5 + (i % 2) * 8e-4, e[3];
        const double shift[] = {0, -2 * PI / 3, 2 * PI / 3};

        for (int k = 0; k < 3; k++)
            e[k] = 100 * sin(100 * PI * t + shift[k]);
        expect_at(&kit, "p.v", t, fmax(e[0], fmax(e[1], e[2])) - fmin(e[0], fmin(e[1], e[2])),
                  1e-9);
    }
    EXPECT_DONE(&kit, "expect mean(p.v) ~ 300*sqrt(3)/pi within 1e-3\n");
    kit_free(&kit);
}

/* far less than a nearly ideal one would take, whose resistances make it stiff */
static void a_multiplier_doubles_twice(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E s 0 100*sin(100*pi*t)\nresistor RS s a0 10\n"
                      "capacitor C1 a0 a1 1 uF\ncapacitor C2 b1 0 1 uF\n"
                      "capacitor C3 a1 a2 1 uF\ncapacitor C4 b2 b1 1 uF\n"
                      "diode D1 0 a1\ndiode D2 a1 b1\ndiode D3 b1 a2\ndiode D4 a2 b2\n"
                      "simulate 5 every=0.01\nexpect b2.v ~ 400 within 0.2\n"
                      "expect C1.v ~ -100 within 0.1\nexpect C3.v ~ -200 within 0.1\n");
    kit_free(&kit);
}

/* --- converters --- */

typedef struct Buck {
    double E, L, C, R, period, duty;
} Buck;

/* x = (i, v) after a time, from L i' = e - v, C v' = i - v/R: both roots complex */
static void go(const Buck *b, double e, double t, double x[2])
{
    double a = 1 / (2 * b->R * b->C), w = sqrt(1 / (b->L * b->C) - a * a);
    double i0 = x[0] - e / b->R, v0 = x[1] - e; /* from the rest that it goes to */
    double decay = exp(-a * t), c = cos(w * t), s = sin(w * t);

    x[0] = e / b->R + decay * (i0 * c + (-v0 / b->L + a * i0) / w * s);
    x[1] = e + decay * (v0 * c + ((i0 - v0 / b->R) / b->C + a * v0) / w * s);
}

/* on, then through the diode until the period or the current ends, then the load alone */
static void buck_period(const Buck *b, double x[2])
{
    double rest = (1 - b->duty) * b->period;
    double on[2], end[2], low = 0, high = rest;

    go(b, b->E, b->duty * b->period, x);
    memcpy(on, x, sizeof on);
    go(b, 0, rest, x);
    if (x[0] >= 0)
        return;
    for (int k = 0; k < 100; k++) {
        double middle = (low + high) / 2;

        memcpy(end, on, sizeof end);
        go(b, 0, middle, end);
        *(end[0] > 0 ? &low : &high) = middle;
    }
    x[0] = 0;
    x[1] = end[1] * exp(-(rest - high) / (b->R * b->C));
}

static void expect_buck(double R, const char *load)
{
    const Buck b = {.E = 12, .L = 47e-6, .C = 10e-6, .R = R, .period = 1e-5, .duty = 0.4};
    double x[2] = {0, 0};
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "vsource E a 0 12\nswitch S a x when=t*1e5 - floor(t*1e5) < 0.4\ndiode D 0 x\n"
                "inductor L x o 47 uH\ncapacitor C o 0 10 uF\n");
    EXPECT_DONE(&kit, load);
    EXPECT_DONE(&kit, "simulate 1 ms every=5 us rtol=1e-10\n");
    for (int k = 1; k < 100; k++) {
        buck_period(&b, x);
        expect_at(&kit, "C.v", k * b.period, x[1], 1e-8);
        expect_at(&kit, "L.i", k * b.period, x[0], 1e-8);
    }
    EXPECT_DONE(&kit, "expect min(L.i) ~ 0 within 1e-9\n");
    kit_free(&kit);
}

static void a_buck_converter_goes_on_without_a_gap(void)
{
    expect_buck(5, "resistor R o 0 5\n");
}

static void a_buck_converter_rests_where_its_current_ends(void)
{
    expect_buck(100, "resistor R o 0 100\n");
}

/* what the coil of a flyback converter holds goes into the load, through the transformer */
/* Steps of the last run, from its report. */
static int steps_of_run(Kit *kit)
{
    const char *steps;

    EXPECT_DONE(kit, "show run\n");
    steps = kit->text != NULL ? strstr(kit->text, "steps") : NULL;
    return steps != NULL ? atoi(steps + strcspn(steps, "0123456789")) : -1;
}

/* A chopper whose duty a controller holds from sample to sample: what its condition compares jumps
 * with the time of the samples, and in between it follows time alone. */
static void expect_chopper(const char *parts, double on_switch, double on_diode)
{
    const double E = 24, Vf = 0.5, L = 1e-3, period = 1e-4, duty = 0.4;
    const double R1 = 0.8 + on_switch, R2 = 0.8 + on_diode;
    double current = 0;
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "Ts = 1e-4\nvsource V s 0 24\ninductor L s y 1 mH\nresistor R y x 0.8\n"
                      "gain c cc 0 of=0.4 k=1 period=Ts\n");
    EXPECT_DONE(&kit, parts);
    EXPECT_DONE(&kit, "init L.i = 0\nsimulate 0.005 every=1e-5 rtol=1e-10\n");
    for (int k = 1; k <= 50; k++) {
        current = E / R1 + (current - E / R1) * exp(-R1 / L * duty * period);
        expect_at(&kit, "L.i", (k - 1 + duty) * period, current, 1e-6);
        current = -Vf / R2 + (current + Vf / R2) * exp(-R2 / L * (1 - duty) * period);
        expect_at(&kit, "L.i", k * period, current, 1e-6);
    }
    EXPECT(steps_of_run(&kit) >= 100 && steps_of_run(&kit) <= 250);
    kit_free(&kit);
}

static void a_sampled_duty_holds_in_every_period(void)
{
    expect_chopper("switch S x 0 when=t/Ts - floor(t/Ts) < cc.v\ndiode D x s Vf=0.5\n", 0, 0);
    expect_chopper("switch S x 0 when=t/Ts - floor(t/Ts) < cc.v Ron=0.02 Roff=1e10\n"
                   "diode D x s Ron=0.01 Roff=1e10 Vf=0.5\n",
                   0.02, 0.01);
    expect_chopper("switch S x 0 when=t/Ts - floor(t/Ts) < cc.v\n"
                   "diode D x s Ron=0.01 Roff=1e10 Vf=0.5\n",
                   0, 0.01);
    expect_chopper("switch S x 0 when=t/Ts - floor(t/Ts) < cc.v Ron=0.02\n"
                   "diode D x s Ron=0.01 Vf=0.5\n",
                   0.02, 0.01);
}

/* Diodes with resistances that all begin at once: fifty behind each other, where what follows from
 * each leads through all others. */
static void many_diodes_with_resistances_run(void)
{
    char line[200];
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V n0 0 10*sin(2*pi*1e3*t)\n");
    for (int k = 1; k <= 50; k++) {
        (void)snprintf(line, sizeof line,
                       "resistor R%d n%d n%d 10\ndiode D%d n%d m%d Ron=0.1 Roff=1e7\n"
                       "capacitor C%d m%d 0 0.1 uF\nresistor L%d m%d 0 1e4\n",
                       k, k - 1, k, k, k, k, k, k, k, k);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "simulate 0.5 ms every=1e-5\nexpect (m1.v > m2.v) ~ 1 within 0\n"
                      "expect (m49.v > m50.v) ~ 1 within 0\n");
    kit_free(&kit);
}

/* a multiplier with such parameters of its diodes, and what it is loaded with */
static void build_multiplier(Kit *kit, int stages, const char *sides)
{
    char line[300];

    EXPECT_DONE(kit, "clear\nvsource V s0 0 100*sin(2*pi*1e3*t)\nresistor Rs s0 a0 10\n");
    for (int k = 1; k <= stages; k++) {
        (void)snprintf(line, sizeof line,
                       "capacitor Ca%d a%d a%d 1 uF\ndiode Da%d %s%d a%d %s\n"
                       "diode Db%d a%d b%d %s\ncapacitor Cb%d %s%d b%d 1 uF\n",
                       k, k - 1, k, k, k > 1 ? "b" : "", k - 1, k, sides, k, k, k, sides, k,
                       k > 1 ? "b" : "", k - 1, k);
        EXPECT_DONE(kit, line);
    }
    (void)snprintf(line, sizeof line, "resistor RL b%d 0 1e6\n", stages);
    EXPECT_DONE(kit, line);
}

/* Voltages of node equations in steps of 50 and 12.5 ns by an implicit method of second order
 * (SDIRK), which agree in all digits; they are some mV above those of ideal ones, where there are
 * many stages. Of ideal ones, with 10 uohm in steps of 3.1 and 1.6 ns, extrapolated. */
static void multipliers_end_where_fine_steps_do(void)
{
    Kit kit = kit_new();

    build_multiplier(&kit, 3, "Ron=0.1 Roff=1e7");
    EXPECT_DONE(&kit, "simulate 0.02 every=1e-4\nexpect b3.v ~ 440.352411 within 1e-5\n");
    EXPECT(steps_of_run(&kit) < 9000);
    EXPECT_DONE(&kit, "simulate 0.02 every=1e-4 rtol=1e-6 atol=1e-6\n"
                      "expect b3.v ~ 440.352411 within 1e-3\n");
    build_multiplier(&kit, 10, "Ron=0.1 Roff=1e7");
    EXPECT_DONE(&kit, "simulate 0.02 every=1e-4\nexpect b10.v ~ 439.864785 within 1e-5\n");
    EXPECT(steps_of_run(&kit) < 18000);
    EXPECT_DONE(&kit, "simulate 0.02 every=1e-4 rtol=1e-6 atol=1e-6\n"
                      "expect b10.v ~ 439.864785 within 1e-3\n"
                      "simulate 0.02 every=1e-4 rtol=1e-5 atol=1e-5\n"
                      "expect b10.v ~ 439.864785 within 5e-3\n");
    build_multiplier(&kit, 3, "");
    EXPECT_DONE(&kit, "simulate 0.02 every=1e-4\nexpect b3.v ~ 440.45945 within 1e-4\n");
    kit_free(&kit);
}

/* Thirty stages are charged through each other, and margins rise and fall by less than a nanovolt:
 * values of an implicit Euler integration with 1000 to 4000 steps, extrapolated. And a network that
 * is next to nothing all over where its source passes zero. */
static void diodes_tell_sides_where_next_to_nothing_is_across_them(void)
{
    char line[300];
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource V s0 0 100*sin(2*pi*1e3*t)\nresistor Rs s0 a0 10\n");
    for (int k = 1; k <= 30; k++) {
        (void)snprintf(line, sizeof line,
                       "capacitor Ca%d a%d a%d 1 uF\ndiode Da%d b%d a%d Ron=0.1 Roff=1e7\n"
                       "diode Db%d a%d b%d Ron=0.1 Roff=1e7\ncapacitor Cb%d b%d b%d 1 uF\n",
                       k, k - 1, k, k, k - 1, k, k, k, k, k, k - 1, k);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "resistor R0 b0 0 1 uohm\nresistor RL b30 0 1e6\nsimulate 2 us every=1e-7\n"
                      "expect a1.v ~ 0.119599618 within 1e-7\n"
                      "expect b1.v ~ 0.109538485 within 1e-7\n"
                      "expect b30.v ~ 0.114590464 within 1e-7\nclear\n");
    EXPECT_DONE(&kit, "w = 4218.326302954978\nvsource V0 s0 0 47.7388195585133*sin(w*t)\n"
                      "resistor RS s0 n8 310.312646343172\nresistor R1 n1 0 605.277369209202\n"
                      "resistor R2 n2 n1 3262.51682515\nresistor R3 n3 n1 2119.41599185089\n"
                      "resistor R4 n4 0 1262.94928549263\nresistor R5 n5 0 2458.94183719758\n"
                      "resistor R6 n6 n5 619.445865756496\nresistor R7 n7 n4 34570.6430\n"
                      "resistor R8 n8 n5 10868.0226241973\ncapacitor C9 n8 n3 209.66624525 nF\n"
                      "capacitor C10 n8 0 37.489396236 nF\n"
                      "switch S11 n2 m11 when=sin(w*t - 1.61732740712492) > -0.493754373492339 "
                      "Ron=0.0320674 Roff=1302954\nresistor RS11 m11 n6 1.16628951\n");
    EXPECT_DONE(&kit, "diode D12 n4 0 Ron=7.1267 Roff=1301987\n"
                      "diode D13 n5 n1 Ron=0.0675338 Roff=19736368\n"
                      "diode D14 n1 n8 Ron=1.26366 Roff=121745.8\n"
                      "diode D15 n2 n1 Ron=0.263188 Roff=198381.9\n"
                      "diode D16 n3 n8 Ron=0.707825 Roff=1867239\n"
                      "diode D17 n8 n1 Ron=0.0110009 Roff=68547645\n"
                      "diode D18 0 n2 Ron=5.08814 Roff=306305.9\n"
                      "diode D19 n4 n7 Ron=0.0369659 Roff=39960960\n"
                      "init C9.v = 6.47082507, C10.v = -12.5384536\n"
                      "simulate 3.4258436 ms every=0.57 ms rtol=1e-9 atol=1e-10\n");
    kit_free(&kit);
}

static void a_flyback_converter_hands_over_energy(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 12\ninductor LM a x 100 uH\ntransformer T a x 0 s n=2\n"
                      "switch S x 0 when=t*5e4 - floor(t*5e4) < 0.25\ndiode D s o\n"
                      "capacitor C o 0 100 uF\nresistor R o 0 100\ninit C.v = 11\n"
                      "simulate 0.05 every=5 us\n" /* the end of each pulse is a row */
                      /* half L i^2 a period, i = E duty period/L: V^2/R = power */
                      "expect max(LM.i) ~ 12*0.25*20e-6/100e-6 within 1e-6\n"
                      "expect o.v^2 ~ 100*5e4*0.5*100e-6*0.6^2 within 0.5\n");
    kit_free(&kit);
}

/* both diodes of the other diagonal take the current over where a bridge's switches let go */
static void diodes_take_over_from_switches(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                "vsource E p 0 100\nswitch S1 p a when=t < 1 [ms]\nswitch S4 b 0 when=t < 1 [ms]\n"
                "switch S2 a 0 when=t > 3 [ms]\nswitch S3 p b when=t > 3 [ms]\n"
                "diode D1 a p\ndiode D2 0 a\ndiode D3 b p\ndiode D4 0 b\n"
                "inductor L a m 10 mH\nresistor R m b 10\nsimulate 4 ms every=10 us\n"
                "i1 = 10*(1 - exp(-1))\n");
    /* from i1 towards -10 through D2 and D3, until it ends */
    EXPECT_DONE(&kit, "simulate 4 ms every=2 us rtol=1e-10\nexpect L.i ~ i1 within 1e-9 at 1 ms\n"
                      "expect L.i ~ (i1 + 10)*exp(-0.2) - 10 within 1e-9 at 1.2 ms\n"
                      "expect D2.i ~ (i1 + 10)*exp(-0.2) - 10 within 1e-9 at 1.2 ms\n"
                      "expect L.i ~ 0 within 1e-9 at 2 ms\nexpect D2.i ~ 0 within 1e-9 at 2 ms\n"
                      "expect L.i ~ -10*(1 - exp(-1)) within 1e-8 at 4 ms\n");
    kit_free(&kit);
}

/* --- what several share --- */

static void diodes_in_a_row_share_the_voltage(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 -9\ndiode D1 a b\ndiode D2 b c\ndiode D3 c d\n"
                      "inductor L d e 0.1\nresistor R e 0 10\nsimulate 1\n"
                      "expect D1.v ~ -3 within 1e-9\nexpect D2.v ~ -3 within 1e-9\n");
    kit_free(&kit);
}

static void diodes_side_by_side_share_the_current(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 5.7\nresistor R a b 10\ndiode D1 b 0 Vf=0.7\n"
                      "diode D2 b 0 Vf=0.7\ndiode D3 b 0 Vf=0.8\nsimulate 1\n"
                      "expect D1.i ~ 0.25 within 1e-9\nexpect D2.i ~ 0.25 within 1e-9\n"
                      "expect D3.i ~ 0 within 0\n");
    kit_free(&kit);
}

/* --- at random --- */

static const char *const nodes[] = {"0", "n1", "n2", "n3", "n4"};
enum { NODES = sizeof nodes / sizeof nodes[0] };

/* two different nodes, and where they stand in a statement */
static void random_ends(uint64_t *seed, char ends[16])
{
    int a = (int)(test_random(seed) % NODES);
    int b = (a + 1 + (int)(test_random(seed) % (NODES - 1))) % NODES;

    (void)snprintf(ends, 16, "%s %s", nodes[a], nodes[b]);
}

static void random_parts(Text *out, uint64_t *seed, const char *kind, char letter, int count,
                         double least, double most, const char *unit)
{
    char ends[16];

    for (int i = 0; i < count; i++) {
        random_ends(seed, ends);
        text_addf(out, "%s %c%d %s %.3g %s\n", kind, letter, i, ends,
                  test_uniform(seed, least, most), unit);
    }
}

/* A source behind a resistance, diodes that lead to every node, and a few parts anywhere.
 * The number of diodes. */
static int random_network(Text *out, uint64_t seed)
{
    int diodes = NODES + (int)(test_random(&seed) % 3);
    char ends[16];

    text_addf(out, "vsource E s 0 %.3g*sin(%.4g*t)\nresistor RS s n1 2\n",
              test_uniform(&seed, 5, 20), test_uniform(&seed, 100, 700));
    for (int i = 0; i < diodes; i++) {
        random_ends(&seed, ends);
        if (i < NODES && test_random(&seed) % 2 == 0)
            text_addf(out, "diode D%d %s %s\n", i, nodes[i % NODES], nodes[(i + 1) % NODES]);
        else
            text_addf(out, "diode D%d %s\n", i, ends);
    }
    random_parts(out, &seed, "resistor", 'R', 3, 10, 200, "ohm");
    random_parts(out, &seed, "capacitor", 'C', (int)(test_random(&seed) % 3), 10, 300, "uF");
    random_parts(out, &seed, "inductor", 'L', (int)(test_random(&seed) % 3), 5, 100, "mH");
    if (test_random(&seed) % 3 == 0) {
        random_ends(&seed, ends);
        text_addf(out, "switch S %s when=sin(%.4g*t) > 0.3\n", ends, test_uniform(&seed, 300, 900));
    }
    text_add(out, "simulate 0.05 every=0.0001\n");
    return diodes;
}

/* the least ("min") or largest ("max") value of a member of all diodes, in one pass over the run */
static double worst_of(Kit *kit, const char *which, const char *member, int diodes)
{
    Text item = {0};
    double value;

    text_addf(&item, "%s(", which);
    for (int i = 0; i < diodes - 1; i++)
        text_addf(&item, "%s(D%d.%s, ", which, i, member);
    text_addf(&item, "D%d.%s", diodes - 1, member);
    for (int i = 0; i < diodes; i++)
        text_add(&item, ")");
    value = kit_value(kit, item.at);
    text_free(&item);
    return value;
}

/* circuits and cutsets hold by the form of the equations: what is left are the diodes' laws */
static void diodes_keep_their_law_in_any_network(void)
{
    int solved = 0, refused = 0;

    for (uint64_t seed = 1; seed <= 80; seed++) {
        Kit kit = kit_new();
        Text text = {0};
        int diodes = random_network(&text, seed);

        if (kit_do(&kit, text.at) != CT_OK) {
            /* a switch may close on a charge, or open on a current */
            if (strstr(kit.error.message, "would jump") == NULL)
                printf("%s%s\n", text.at, kit.error.message);
            EXPECT_HOLDS(kit.error.message, "would jump");
            refused++;
        } else {
            solved++;
        }
        if (kit.error.message[0] == '\0') {
            EXPECT(worst_of(&kit, "min", "i", diodes) > -1e-5);
            EXPECT(worst_of(&kit, "max", "v", diodes) < 1e-5);
            EXPECT(worst_of(&kit, "max", "power", diodes) < 1e-5);
            EXPECT(worst_of(&kit, "min", "power", diodes) > -1e-5);
        }
        text_free(&text);
        kit_free(&kit);
    }
    EXPECT(solved >= 60);
    EXPECT(refused > 0);
}

/* --- what goes with it --- */

static void a_run_goes_on_where_it_ended(void)
{
    const char scene[] = "vsource E a 0 12\nswitch S a x when=t*1e5 - floor(t*1e5) < 0.4\n"
                         "diode D 0 x\ninductor L x o 47 uH\ncapacitor C o 0 10 uF\n"
                         "resistor R o 0 5\n";
    Kit kit = kit_new();

    EXPECT_DONE(&kit, scene);
    EXPECT_DONE(&kit, "simulate 204 us every=1 us\nresume 200 us\nsimulate 404 us every=1 us\n"
                      "expect L.i ~ run2.L.i within 1e-9\nexpect C.v ~ run2.C.v within 1e-9\n"
                      "expect run2.S.i ~ S.i within 1e-8 at 101 us\n");
    kit_free(&kit);
}

static void an_operating_point_chooses_the_sides(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, bridge);
    EXPECT_DONE(&kit, "set V.value = -10\ninductor L p q 1 mH\ncapacitor C q 0 1 mF\n"
                      "resistor R q 0 100\nop\nexpect D2.i ~ 0.1 within 1e-9\n"
                      "expect D3.i ~ 0.1 within 1e-9\nsimulate 0.01\nexpect q.v ~ 10 within 1e-8\n"
                      "expect min(L.i) ~ 0.1 within 1e-8\n");
    kit_free(&kit);
}

/* the equations that hold there, not those of another side */
static void linear_equations_are_those_of_the_instant(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 12\nswitch S a x when=t < 1 [ms]\ndiode D 0 x\n"
                      "inductor L x o 1 mH\nresistor R o 0 5\ninit L.i = 1\nsimulate 1.1 ms\n"
                      "linearize at=0.5 ms inputs=[E] outputs=[L.i]\n"
                      "expect linear.A(1,1) ~ -5000 within 1e-6\n"
                      "expect linear.B(1,1) ~ 1000 within 1e-6\n"
                      "linearize at=1.05 ms inputs=[E] outputs=[L.i]\n"
                      "expect linear.A(1,1) ~ -5000 within 1e-6\n"
                      "expect linear.B(1,1) ~ 0 within 1e-9\n");
    kit_free(&kit);
}

static void events_see_what_diodes_carry(void)
{
    const double w = 100 * PI, off = (PI - atan(w * 0.01)) / w, fall = 0.01 * log(9.5 / 9);
    const double first = off + 0.01 * log(10 * sin(w * off) / 9);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\ndiode D a b\ncapacitor C b 0 100 uF\n"
                      "resistor R b 0 100\nevent off when=D.i < 0.1 do=mark\n"
                      "event low when=C.v < 9 && t > 5 [ms] C.v=9.5\nsimulate 12 ms rtol=1e-10\n"
                      "show events\n");
    /* C w cos(wt) 10 + 0.1 sin(wt) = 0.1 */
    EXPECT_HOLDS(kit.text, "  off  0.005 s\n");
    EXPECT_HOLDS(kit.text, "low  11 times: 0.0065519851");
    expect_at(&kit, "C.v", 0.012, 9.5 * exp(-(0.012 - first - 10 * fall) / 0.01), 1e-8);
    EXPECT_DONE(&kit, "event low when=C.v > 9 C.v=9.5\n");
    EXPECT_FAILS(&kit, "simulate 12 ms\n", "event low: C.v follows from the rest");
    EXPECT_HOLDS(kit.error.message, "as ideal switches stand");
    kit_free(&kit);
}

/* S1 lays a resistor on the source, and its voltage is a function of time from then on */
static void what_a_switch_makes_a_function_of_time_is_followed(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\nswitch S1 a b when=t > 1 [ms]\n"
                      "resistor R1 b 0 100\nswitch S2 b c when=b.v > 5\nresistor R2 c 0 100\n"
                      "event high when=b.v > 5 do=mark\nevent late when=t > 4 [ms] do=mark\n"
                      "simulate 40 ms every=0.1 ms\n");
    for (int i = 0; i < 100; i++) {
        double t = 0.04 * i / 100 + 1e-5, wave = sin(100 * PI * t);

        expect_at(&kit, "S2.i", t, wave > 0.5 ? 0.1 * wave : 0, 1e-9);
    }
    EXPECT_DONE(&kit, "show events\n");
    EXPECT_HOLDS(kit.text, "high  2 times: 0.00166666666667 0.0216666666667 s");
    EXPECT_HOLDS(kit.text, "late  0.004 s");
    kit_free(&kit);
}

/* a second run at a tenth of the tolerance goes through the same phases */
static void the_error_of_a_run_is_told(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\ndiode D a b\ninductor L b c 30 mH\n"
                      "resistor R c 0 10\nsimulate 0.06 check=on\n");
    EXPECT_LACKS(kit.text, "not resolved");
    kit_free(&kit);
}

/* a motor's freewheeling diode: mechanics and network in one */
static void a_chopped_motor_keeps_its_energy(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, 0]\nbody m1 mass=1 inertia=0.01\n"
                      "revolute h ground m1\nvsource E a 0 24\n"
                      "switch S a x when=t*500 - floor(t*500) < 0.5\ndiode D 0 x\n"
                      "motor M h x 0 Kt=0.1 R=0.5 L=1 mH\ndamper B h d=1e-3\n"
                      "simulate 0.2 every=1 ms\n"
                      "expect min(M.i) ~ 0 within 1e-8\nexpect min(D.i) ~ 0 within 1e-8\n");
    kit_free(&kit);
}

/* --- refused --- */

/* a conductance below 0: the current that goes on is neither the diode's nor stops at any voltage
 */
static void a_network_without_sides_is_told_of(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "isource J 0 a if(t < 0.5, 1, -1)\nvccs G a 0 a 0 gain=-0.1\n"
                      "diode D a 0\n");
    EXPECT_FAILS(&kit, "simulate 1\n",
                 "at t = 0.5 s the network has no solution, whichever of D are closed");
    EXPECT_HOLDS(kit.error.hint, "Ron=");
    EXPECT_DONE(&kit, "expect D.i*D.v ~ 0 within 1e-9 at 0.4\n");
    kit_free(&kit);
}

static void a_changed_model_has_no_other_modes(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10*sin(100*pi*t)\ndiode D a b\ncapacitor C b 0 100 uF\n"
                      "resistor R b 0 100\nsimulate 3 ms\nset R.R = 50\n");
    EXPECT_FAILS(&kit, "resume 20 ms\n",
                 "equations that aren't made yet, of a model that has changed");
    EXPECT_HOLDS(kit.error.hint, "start a new run");
    kit_free(&kit);
}

static void efforts_of_drivers_pass_no_ideal_diode(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, 0]\nbody m1 mass=1 inertia=0.01\n"
                      "revolute h ground m1\nvsource E x 0 1\ndiode D x y\n"
                      "motor M h y 0 Kt=0.1 R=0.5 L=1 mH\ndriver K h = t^2 by=E\n");
    EXPECT_FAILS(&kit, "inverse 1\n", "can't be found through ideal switches");
    EXPECT_HOLDS(kit.error.hint, "Ron=");
    /* the way out that the hint tells: K' is 2 t, M' likewise 0.02, and D drops 0.01 M.i */
    EXPECT_DONE(&kit, "clear\nscene planar\ngravity [0, 0]\nbody m1 mass=1 inertia=0.01\n"
                      "revolute h ground m1\nvsource E x 0 1\ndiode D x y Ron=0.01 Roff=1e8\n"
                      "motor M h y 0 Kt=0.1 R=0.5 L=1 mH\ndriver K h = t^2 by=E\n"
                      "inverse 1\nexpect M.i ~ 0.2 within 1e-9\n"
                      "expect D.v ~ 0.002 within 1e-6\nkinematics 1\n");
    kit_free(&kit);
}

static void nothing_stored_may_jump(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10\nswitch S a b when=t > 1 [ms]\ncapacitor C b 0 1 uF\n"
                      "resistor R b 0 1 kohm\n");
    EXPECT_FAILS(&kit, "simulate 5 ms\n",
                 "S closes at t = 0.001 s, and C.v would jump from 0 to 10");
    EXPECT_HOLDS(kit.error.hint, "a resistance in that circuit");
    EXPECT_DONE(&kit, "clear\nvsource E a 0 10\nswitch S a b when=t < 1 [ms]\n"
                      "inductor L b c 1 mH\nresistor R c 0 10\n");
    EXPECT_FAILS(&kit, "simulate 5 ms\n", "S opens at t = 0.001 s, and L.i would jump from 0.99");
    EXPECT_HOLDS(kit.error.hint, "a diode for the current");
    /* as the hint says */
    EXPECT_DONE(&kit, "diode D 0 b\nsimulate 5 ms\n"
                      "expect L.i ~ (1 - exp(-10))*exp(-40) within 1e-9\n");
    EXPECT_DONE(&kit, "clear\nvsource E a 0 10\nswitch S a b when=t >= 0\ncapacitor C b 0 1 uF\n"
                      "init C.v = 3\n");
    EXPECT_FAILS(&kit, "simulate 5 ms\n", "contradict with S closed from the start: C.v = 3");
    EXPECT_HOLDS(kit.error.hint, "when=t > 0");
    /* as where it is joined for good, what wasn't given follows */
    EXPECT_DONE(&kit, "clear\nvsource E a 0 10\nswitch S a b when=t >= 0\ncapacitor C b 0 1 uF\n"
                      "simulate 5 ms\nexpect C.v ~ 10 within 1e-9\nclear\n"
                      "capacitor C1 a 0 1 uF\ncapacitor C2 b 0 3 uF\nswitch S a b when=t < 1\n"
                      "init C2.v = 2\nsimulate 1 ms\nexpect C1.v ~ 2 within 1e-9\n");
    EXPECT_DONE(&kit, "init C1.v = 6\n");
    EXPECT_FAILS(&kit, "simulate 1 ms\n",
                 "contradict with S closed from the start: C1.v = 6, C2.v = 2");
    /* as the hint says: what was given stands just before */
    EXPECT_DONE(&kit, "set S.when=t > 0\nsimulate 1 ms\nexpect C1.v ~ 3 within 1e-9\n");
    /* no state is left behind: an op-amp holds the capacitor's voltage */
    EXPECT_DONE(&kit, "clear\nvsource E a 0 1\nopamp U a m o\nswitch S1 o m when=t < 0.5\n"
                      "resistor R2 m o 1\nswitch S2 m b when=t > 0.5\ncapacitor C b 0 1\n"
                      "resistor R b 0 1\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "S2 closes at t = 0.5 s, and what is stored would jump");
    kit_free(&kit);
}

static void a_switch_that_contradicts_itself_is_named(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 10\nresistor R1 a b 1\nswitch S b 0 when=b.v > 4\n"
                      "resistor R2 b 0 4\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "S is neither closed nor open");
    EXPECT_DONE(&kit, "clear\nvsource E a 0 12\ndiode D 0 x\ninductor L x o 1 mH\n"
                      "resistor R o 0 5\nswitch S a x when=L.i < 1\n");
    EXPECT_FAILS(&kit, "simulate 0.01\n", "switches to and fro without end");
    EXPECT_HOLDS(kit.error.hint, "a gain with period=");
    /* as the hint says: 5 V of 12 on the average, or within what flows in 1 us */
    EXPECT_DONE(&kit, "gain g n 0 k=1 of=L.i period=1 us\nset S.when=g.v < 1\nsimulate 2 ms\n"
                      "expect L.i ~ 1 within 0.015\nclear\ninductor L x o 1 mH\n"
                      "resistor R o 0 5\nvsource E x 0 if(L.i < 1, 12, 0)\nsimulate 2 ms\n"
                      "expect L.i ~ 1 within 1e-9\nexpect E.v ~ 5 within 1e-6\n");
    kit_free(&kit);
}

static void sources_that_nothing_can_meet_are_refused(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "vsource E a 0 12\nswitch S1 a b when=t < 1\nswitch S2 b 0 when=t > 0.5\n"
                      "resistor R b 0 5\n");
    EXPECT_FAILS(&kit, "simulate 2\n", "form a circuit without resistance");
    EXPECT_HOLDS(kit.error.message, "at t = 0.5 s ");
    EXPECT_HOLDS(kit.error.message, "S1");
    EXPECT_HOLDS(kit.error.message, "S2");
    /* what there was till then is kept */
    EXPECT_DONE(&kit, "expect S1.i ~ 2.4 within 1e-12 at 0.4\n");
    EXPECT_DONE(&kit, "clear\nisource J 0 a 1\nswitch S a 0 when=t < 1\nresistor R b 0 1\n"
                      "switch S2 a b when=t < 0\n");
    EXPECT_FAILS(&kit, "simulate 2\n", "leave a current no way");
    EXPECT_DONE(&kit, "clear\nvsource E a 0 12\ndiode D a b\ninductor L b 0 1 mH\n"
                      "resistor R a 0 1\n"
                      "tree electrical E L\nset network tree\n");
    EXPECT_FAILS(&kit, "simulate 1\n", "D is ideal, and each side of it makes another tree");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_capacitor_takes_the_peaks);
    RUN(a_bridge_smooths_both_halves);
    RUN(a_coil_carries_on_behind_the_wave);
    RUN(six_diodes_take_the_largest_difference);
    RUN(a_multiplier_doubles_twice);
    RUN(a_buck_converter_goes_on_without_a_gap);
    RUN(a_buck_converter_rests_where_its_current_ends);
    RUN(a_sampled_duty_holds_in_every_period);
    RUN(many_diodes_with_resistances_run);
    RUN(multipliers_end_where_fine_steps_do);
    RUN(diodes_tell_sides_where_next_to_nothing_is_across_them);
    RUN(a_flyback_converter_hands_over_energy);
    RUN(diodes_take_over_from_switches);
    RUN(diodes_in_a_row_share_the_voltage);
    RUN(diodes_side_by_side_share_the_current);
    RUN(diodes_keep_their_law_in_any_network);
    RUN(a_run_goes_on_where_it_ended);
    RUN(an_operating_point_chooses_the_sides);
    RUN(linear_equations_are_those_of_the_instant);
    RUN(events_see_what_diodes_carry);
    RUN(what_a_switch_makes_a_function_of_time_is_followed);
    RUN(the_error_of_a_run_is_told);
    RUN(a_chopped_motor_keeps_its_energy);
    RUN(a_network_without_sides_is_told_of);
    RUN(a_changed_model_has_no_other_modes);
    RUN(efforts_of_drivers_pass_no_ideal_diode);
    RUN(nothing_stored_may_jump);
    RUN(a_switch_that_contradicts_itself_is_named);
    RUN(sources_that_nothing_can_meet_are_refused);
    return test_end();
}

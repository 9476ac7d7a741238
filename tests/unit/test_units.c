/* test_units.c: a unit of the wrong dimension is refused wherever it stands, and what is right or
 * can't be determined passes */
#include "session_kit.h"

#include <string.h>

#define SCENE                                                                                      \
    "scene planar\n"                                                                               \
    "body m1 mass=1 inertia=0.1\n"                                                                 \
    "body m2 mass=1 inertia=0.1\n"                                                                 \
    "revolute h1 ground m1\n"                                                                      \
    "prismatic s1 ground m2 axis=x\n"                                                              \
    "vsource V a 0 1\n"                                                                            \
    "resistor R a b 2\n"                                                                           \
    "inductor L b 0 3\n"                                                                           \
    "heatcap H warm 0 C=10\n"                                                                      \
    "g = 9.81; k = 3; r = 0.1 m; E0 = 12 V; w0 = 5 [rad/s]; f0 = 50 Hz; A0 = r^2\n"                \
    "E(x) = E0*sin(x); pull(x) = k*x; gap(x) = x - 1 mm; twice(x) = gap(x) + gap(x)\n"             \
    "output P = R.v*R.i, way = s1\n"                                                               \
    "pd C1 c1 0 ref=1 of=h1 Kp=1 Kd=1; resistor Rc c1 0 1\n"

#define RUN_SCENE SCENE "simulate 0.1 every=0.01\nlinearize inputs=[V] outputs=[L.i]\nmodes\n"

/* the statement fails there, and what it would have changed is as it was */
static void expect_refused(Kit *kit, const char *line, const char *message, int column)
{
    char *before = ct_save(kit->session);
    const int runs = ct_run_count(kit->session);
    const bool failed = kit_do(kit, line) == CT_FAILED;
    char *after = ct_save(kit->session);

    if (!failed || strstr(kit->error.message, message) == NULL || kit->error.column != column ||
        kit->error.width < 1 || strcmp(before, after) != 0 || ct_run_count(kit->session) != runs) {
        test_faults++;
        printf("%s\n  got    %d %s\n  wanted %d %s\n", line, kit->error.column,
               failed ? kit->error.message : "nothing", column, message);
    }
    ct_free(before);
    ct_free(after);
}

/* --- where units stand --- */

static const struct {
    const char *line;
    const char *message;
    int column;
} wrong[] = {
    /* behind items */
    {"print h1 [kg]", "h1 is in rad: it can't be shown in [kg]", 10},
    {"print h1, s1' [m]", "s1' is in m/s: it can't be shown in [m]", 15},
    {"print (2*k) , R.v + L.v [A]", "it can't be shown in [A]", 25},
    {"print max(h1) [V]", "max(h1) is in rad", 15},
    {"print run1.s1 [V]", "is in m", 15},
    {"print energy.total [V]", "is in N*m", 20},
    {"print model.dof [m]", "model.dof is a number: it can't be shown in [m]", 17},
    {"print modes.omega(1) [s]", "is in rad/s", 22},
    {"print modes.omega(1) [Hz]", "is in rad/s: it can't be shown in [Hz]", 22},
    {"print s1.fx [V]", "is in N", 13},
    {"print h1.effort [N]", "is in N*m", 17},
    {"print s1.effort [N*m]", "is in N:", 17},
    {"print a.v [A]", "is in V", 11},
    {"print H.T [W]", "is in K", 11},
    {"print warm.T' [K]", "is in K/s", 15},
    {"print m1.wz [m/s]", "is in rad/s", 13},
    {"print h1'' [rad/s]", "is in rad/s^2", 12},
    {"print P [V]", "P is in W", 9},
    {"print P' [W]", "is in W/s", 10},
    {"print (s1*h1')' [m/s]", "is in m*rad/s^2", 17},
    {"print sqrt(s1^2 + m1.x^2) [s]", "is in m", 27},
    {"print t [m]", "t is in s", 9},
    {"print h1' [Hz]", "it can't be shown in [Hz]", 11},
    {"print w0 [Hz]", "it can't be shown in [Hz]", 10},
    {"print linear.A(1,1) [s]", "linear.A(1, 1) is in 1/s", 21},
    {"table h1 s1 [A]", "s1 is in m", 13},
    {"table h1 every=1 m", "s expected for every, got m", 18},
    {"plot h1 s1 [V]", "s1 is in m", 12},
    {"plot h1 vs s1 [V]", "s1 is in m", 15},
    {"plot h1 vs t [V]", "t is in s", 14},
    {"show h1' [deg/s]", "a formula is in SI, not in [deg/s]", 10},
    {"show (h1*s1) [V]", "a formula is in SI, not in [V]", 14},
    {"export csv modes [kg]", "unknown name 'modes'", 12},
    {"export csv h1 [kg]", "h1 is in rad", 15},
    {"linearize inputs=[V] outputs=[h1 + s1]", "rad and m can't be added", 36},
    /* times, tolerances, frequencies */
    {"simulate 2 kg", "s expected for the time of a run, got kg", 12},
    {"simulate r", "got m", 10},
    {"simulate 1 every=0.1 kg", "s expected for every, got kg", 22},
    {"simulate 1 every=r", "s expected for every, got m", 18},
    {"simulate 1 rtol=1 s", "rtol has no unit, got s", 19},
    {"simulate 1 step=1 m method=rk4", "s expected for step, got m", 19},
    {"simulate 1 maxstep=1 m", "s expected for maxstep, got m", 22},
    {"simulate 1 atol=1 mm", "atol has no unit, got mm", 19},
    {"resume 1 V", "s expected for the time of a run", 10},
    {"kinematics 1 V", "s expected for the time of a run", 14},
    {"inverse 1 every=1 V", "s expected for every", 19},
    {"linearize at=2 kg", "s expected for an instant, got kg", 16},
    {"modes at=r", "s expected for an instant, got m", 10},
    {"bode from=1 kg", "from= is a frequency", 13},
    {"bode points=20 m", "points has no unit, got m", 16},
    {"bode from=1 to=r", "to= is a frequency", 16},
    {"print h1 at 2 kg", "s expected for an instant, got kg", 15},
    {"expect h1 > 0 at 2 kg", "s expected for an instant", 20},
    {"expect h1 ~ 3 V within 1", "rad and V can't be compared", 13},
    {"expect h1 ~ 0 within 1 mA", "rad and A can't be compared", 22},
    {"expect 1 ~ 1 V within 1 mA", "V and A can't be compared", 23},
    {"expect h1 > 3 kg", "rad and kg can't be compared", 13},
    /* values of the model */
    {"init s1 = 3 kg", "m expected for s1, got kg", 13},
    {"init s1 = r, s1' = r", "m/s expected for s1, got m", 20},
    {"guess h1 = E0", "rad expected for h1, got V", 12},
    {"init h1 = 2*(3 V), L.i = E0", "A expected for L.i, got V", 26},
    {"event e when=h1 > 3 kg do=stop", "rad and kg can't be compared", 19},
    {"event e when=t > r do=stop", "s and m can't be compared", 18},
    {"event e when=h1 > 1 s1=E0", "m expected for s1, got V", 24},
    {"event e when=h1 > 1 && 2 V < s1 do=mark", "V and m can't be compared", 24},
    {"driver D h1 = 3 V*sin(t)", "rad expected for value, got V", 15},
    {"gravity [0, -E0]", "m/s^2 expected for gravity, got V", 13},
    {"body q mass=r", "kg expected for mass, got m", 13},
    {"body q mass=2 [kg]*r", "kg expected for mass, got kg*m", 13},
    {"arm q m1 [r, E0]", "m expected for position, got V", 14},
    {"arm q m1 [r, 0]*E0", "m expected for position, got V*m", 10},
    {"arm q m1 [0, 0] rotation=z(r)", "rad expected for an angle, got m", 28},
    {"revolute q ground m2 axis=[r, E0, 0]", "m and V can't be components of axis", 31},
    {"actuator q s1 force=E0*t", "N expected for force, got V*s", 21},
    {"actuator q s1 force=30 deg*t", "N expected for force", 21},
    {"actuator q h1 torque=r*5 N*h1 + 3 V", "can't be added", 33},
    {"resistor q a b 1 V", "ohm expected for R, got V", 18},
    {"vsource q c 0 E0*R.v", "V expected for value", 15},
    {"vsource q c 0 E(3 m)", "in E: sin takes a number or an angle, not m", 15},
    {"vsource q c 0 pulse(t, 0, 1 V, 0, 0, 0, 1 m)", "s and m can't be", 41},
    {"vsource q c 0 pulse(t, 0, 1 A, 0, 0, 0, 1 ms)", "V expected for value, got A", 15},
    {"vsource q c 0 pwl(t, 0, 1 V, 1 s, 2 A)", "V and A can't be", 35},
    {"speedsource q c 0 50 Hz", "rad/s expected for value, got Hz", 22},
    {"speedsource q c 0 f0", "rad/s expected for value, got Hz", 19},
    {"init h1' = 50 Hz", "rad/s expected for h1, got Hz", 15},
    {"set R.R = 3 V", "ohm expected for R, got V", 13},
    {"set R.R = E0", "ohm expected for R, got V", 11},
    {"set m1.mass = r", "kg expected for mass, got m", 15},

    /* what is subtracted or added inside a block */
    {"pd q c 0 ref=1 V of=h1 Kp=1 Kd=1", "V and rad can't be subtracted", 21},
    {"pd q c 0 of=s1 ref=E0 Kp=1 Kd=1", "m and V can't be subtracted", 20},
    {"pid q c 0 ref=s1 of=h1 Kp=1 Ki=1", "m and rad can't be subtracted", 21},
    {"sum q c 0 of=[R.v, -s1]", "V and m can't be added", 20},
    {"set C1.ref = 3 kg", "rad and kg can't be subtracted", 14},
    {"output q = s1 + h1", "m and rad can't be added", 17},
    {"q = r + E0", "m and V can't be added", 9},
    {"q(x) = x + r + E0", "m and V can't be added", 16},
    /* sums, comparisons, arguments */
    {"print 3 V + 4 m", "V and m can't be added", 13},
    {"print 3 V - s1", "V and m can't be subtracted", 7},
    {"print s1 - (3 V)", "m and V can't be subtracted", 12},
    {"print h1 + s1", "rad and m can't be added", 12},
    {"print (h1 > s1)", "rad and m can't be compared", 13},
    {"print (r == E0)", "m and V can't be compared", 13},
    {"print sin(3 V)", "sin takes a number or an angle, not V", 11},
    {"print exp(s1 + r)", "exp takes a number or an angle, not m", 11},
    {"print log(E0)", "log takes a number", 11},
    {"print atan2(s1, E0)", "m and V can't be", 17},
    {"print min(r, 2, E0)", "m and V can't be", 17},
    {"print max(h1) + E0", "rad and V can't be added", 17},
    {"print if(h1 > 0, r, E0)", "m and V can't be", 21},
    {"print 2^r", "a power is a number, not m", 9},
    {"print t + r - E0", "m and V can't be subtracted", 15},
    {"print s1^2 + r", "m^2 and m can't be added", 14},
    {"print s1/r + E0", "a number and V can't be added", 14},
    {"print A0 + r", "m^2 and m can't be added", 12},
    {"print gap(3 V)", "in gap: V and m can't be subtracted", 7},
    {"print twice(3 V)", "in gap: V and m can't be subtracted", 7},
    {"print way + E0", "m and V can't be added", 13},
    {"print -(s1) + -E0", "m and V can't be added", 15},
    {"print run1.s1 - h1", "m and rad can't be subtracted", 17},
    {"print model.dof + r", "a number and m can't be added", 19},
};

static void a_wrong_unit_is_refused_under_a_caret(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, RUN_SCENE);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        expect_refused(&kit, wrong[i].line, wrong[i].message, wrong[i].column);
    kit_free(&kit);
}

/* what engineers write; each on the scene as it is */
static const char *const right[] = {
    "print h1 [deg], h1 [rev], h1' [rpm], h1'' [rev/s^2], s1' [km/hour], energy.total [J]",
    "print modes.omega(1) [rev/s], modes.damping(1), (modes.omega(1)/(2*pi)) [Hz]",
    "print R.power [mW], P [W], P' [W/s], t [ms], H.T [K], a.v [mV], h1.effort [N*m]",
    "print (g*m1.y) [kg], (k*s1) [N], pull(s1) [N], pull(r) [V], pull(r) + E0",
    "print (r*h1') [m/s], (r*h1) [mm], (s1'/h1') [m], (5 N*r) [N*m], (h1*2 [N*m/rad]) [N*m]",
    "print E(t) [V], E(h1), E(2*pi*1 kHz*t), E(f0*t), sin(t), exp(-t), sin(2*pi*f0*t), 2^t",
    "print sqrt(m1.x^2 + m1.y^2) [m], sqrt(2*g*r), sqrt(5 [N/m]/(2 kg)) + w0",
    "print min(s1, r, 3) [m], max(h1) + 3 deg, max(h1, 3), rms(R.i) [A], if(t > 1, r, s1) [m]",
    "print atan2(s1, r) [deg], atan(s1/r) + h1, s1/r + h1 + 1",
    "print sin(h1)*E0 + 2 V, r*sin(h1) + s1",
    "print mean(h1')*1 s + h1, h1 + 1, (h1 == pi), -r^2 + A0, (r^-1) [1/m]",
    "print A0^(1/2) [m], A0^0.5 + r",
    "print pulse(t, 0, 1 V, 0, 1 ms, 1 ms, 1 s, 2 s) [V], pwl(t, 0, 0, 1 s, 5 V) [V]",
    "print abs(r) + s1",
    "print 30 deg*t [deg], t + t^2, t - h1, (2 [m/s]*t) [m], sin(5 [rad/s]*t + 30 deg)",
    "print linear.A(1,1), constraint.error [m]",
    "plot (h1/2) [deg] s1 [mm] vs t [ms]",
    "table h1 every=10 ms",
    "export csv h1 [deg]",
    "bode from=1 to=1 kHz",
    "bode from=w0 to=f0*10",
    "simulate 0.1 s every=10 ms rtol=1e-6 atol=1e-8",
    "print h1 at 50 ms",
    "expect h1 ~ 0 deg within 1 rad at 0.1 s",
    "expect max(h1) < 1 && s1 < 1 m",
    "init s1 = r, s1' = 2*r, h1 = 30 deg, L.i = E0/2 [ohm], h1' = 60 rpm",
    "init h1 = atan2(r, 2*r), s1 = r*sin(30 deg)",
    "event e when=h1 > 3 deg && t > 10 ms s1'=-0.8*s1'",
    "event e when=t > h1 do=mark",
    "actuator q s1 force=-s1 - 3*s1'",
    "actuator q s1 force=-sign(s1')*5 N",
    "actuator q h1 torque=-2 [N*m/rad]*h1 + r*5 N",
    "actuator q h1 torque=-30*h1 - 5*h1'",
    "actuator q h1 torque=h1",
    "spring q m1 m2 k=100 [N/m] length=r",
    "spring q h1 k=2 [N*m/rad] rest=30 deg",
    "damper q h1 d=0.1 [N*m*s/rad]",
    "vsource q c 0 E0*sin(2*pi*f0*t) + 0.1 V*sin(t)",
    "vsource q c 0 3*(h1 - 0.5)",
    "vsource q c 0 10 V*t",
    "vsource q c 0 s1/r",
    "actuator q s1 force=ramp(t - 1 s)*2 N + (t - 10 ms)*1 N - sin(t - 0.1 s)*5 N",
    "resistor q a b E0/R.v",
    "simulate 0.1 s/1 s every=1 ms",
    "vsource q c 0 10 V + t - t^2",
    "print t + E0, t - r + t^2, t + 3 s, t - h1 + 30 deg",
    "vsource q c 0 h1",
    "resistor q a b E0/R.i",
    "capacitor q a 0 1 uF*(1 + q.v/E0)",
    "capacitor q a 0 (8.854 [pF/m])*(1 [m^2])/(2 mm - s1)",
    "diode q a 0 Is=1e-12 A n=1.5",
    "motor q h1 c 0 R=1 ohm L=1 mH Kt=0.1 [N*m/A] Kv=0.1 [V*s/rad] J=1 [g*m^2]",
    "torquesource q c 0 E0*(2 A)/w0",
    "speedsource q c 0 50 [1/s]",
    "speedsource q c 0 2*pi*f0",
    "revolute q ground m2 axis=[0, 0, r]",
    "arm q m1 [r, -r/2]",
    "arm q m1 [r, 0] + [0, 3 cm]",
    "gravity [0, -g]",
    "set R.R = E0/2 A",
    "pd q c 0 ref=30 deg of=h1 Kp=1 Kd=1; sum q2 d 0 of=[R.v, 2, 1 mV]",
    "pid q c 0 ref=sin(t) of=s1 Kp=1 Ki=1",
    "set C1.ref = r/(1 m)",
    "output q = R.v*R.i + 3 W, p = q/E0 + 2 A",
    "q(x, y) = x*y + 3 W",
    "d2 = 2*r; q = d2 + E0",
    "driver D h1 = 30 deg*sin(w0*t) + 2*pi*t",
    "driver D s1 = r*t^2 - 1 mm*t",
    "print table(\"none.csv\", 1)",
};

static void what_is_right_or_not_known_passes(void)
{
    Kit kit = kit_new();

    for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) {
        ct_clear(kit.session);
        EXPECT_DONE(&kit, RUN_SCENE);
        if (kit_do(&kit, right[i]) != CT_OK && strstr(kit.error.message, "none.csv") == NULL) {
            test_faults++;
            printf("%s\n  %d %s\n", right[i], kit.error.column, kit.error.message);
        }
    }
    kit_free(&kit);
}

/* --- later changes --- */

static void a_parameter_is_held_to_its_dimension_where_it_is_used(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, SCENE "q = 0.1 m\narm r5 m1 [q, 0]\np = 0.1\narm r6 m1 [p, 0]\n"
                            "w = q + 1 mm\ninit s1 = q\nu = 3 kg");
    expect_refused(&kit, "q = 0.1 kg", "what uses q would fail: m expected for position", 5);
    expect_refused(&kit, "p = 0.1 V", "what uses p would fail: m expected for position", 5);
    expect_refused(&kit, "q(x) = x", "'q' is already a parameter", 1);
    EXPECT_DONE(&kit, "q = 120 mm\nq = 0.2\nq = 3 m\np = 2 m\np = 1\nu = 3 V\n");
    EXPECT_NEAR(kit_value(&kit, "w"), 3.001, 1e-15);
    /* by way of another, and where only a start uses it */
    EXPECT_DONE(&kit, "z = 1 m; y = z; arm r7 m1 [y, 0]; x0 = 1 m; init s1 = x0");
    expect_refused(&kit, "z = 1 s", "what uses z would fail: m expected for position", 5);
    expect_refused(&kit, "x0 = 1 s", "what uses x0 would fail: m expected for s1", 6);
    EXPECT_DONE(&kit, "undo");
    kit_free(&kit);
}

static void a_law_or_output_is_held_to_its_dimension_where_it_is_used(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit,
                SCENE "F(x) = 3 V*x\nvsource W c 0 F(2)\nvsource W2 d 0 F(t)*1 [ohm]/1 [ohm]\n"
                      "output Q = R.v, Q2 = Q + 2 V");
    EXPECT_DONE(&kit, "F(x) = 3 V*sin(x)");
    expect_refused(&kit, "F(x) = 3 A*sin(x)", "what uses F would fail: V expected for value", 1);
    expect_refused(&kit, "output Q = R.i", "what uses Q would fail: A and V can't be added", 8);
    EXPECT_DONE(&kit, "output Q = L.v\nprint Q2 [V]");
    EXPECT_FAILS(&kit, "print Q2 [A]", "Q2 is in V");
    /* the same number in another unit is another law */
    EXPECT_DONE(&kit, "G(x) = 3 V*sin(x); print G(1) [V]; G(x) = 3 A*sin(x); print G(1) [A]");
    EXPECT_DONE(&kit, "output S = 3 V; output S = 3 A; print S [A]");
    EXPECT_FAILS(&kit, "print S [V]", "S is in A");
    kit_free(&kit);
}

/* a new dimension changes no equation: what was linearized and run is as it was */
static void a_change_of_dimension_reformulates_nothing(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, PENDULUM "linearize\nL = 1 m\nshow linear");
    EXPECT_LACKS(ct_remarks(kit.session), "tree");
    EXPECT_DONE(&kit, "simulate 0.1\nresume 0.1\nL = 2\nprint h\nundo\nprint L [m]");
    EXPECT_NEAR(kit_value(&kit, "L"), 1, 0);
    EXPECT_FAILS(&kit, "print L [kg]", "L is in m");
    EXPECT_DONE(&kit, "redo\nprint L [kg]");
    EXPECT_NEAR(kit_value(&kit, "L"), 2, 0);
    EXPECT_DONE(&kit, "undo\nundo\nprint L [kg]\nundo\nredo\nredo\nprint L [m]");
    EXPECT_FAILS(&kit, "print L [kg]", "L is in m");
    kit_free(&kit);
}

/* long laws in long laws: no deeper than a stack goes, and what is near is still seen */
static void deep_laws_end(void)
{
    enum { TERMS = 900, LAWS = 100 };
    Kit kit = kit_new();
    static char line[4 * TERMS + 200];

    EXPECT_DONE(&kit, "f0(x) = x + 3 V");
    for (int i = 1; i <= LAWS; i++) {
        int length = snprintf(line, sizeof line, "f%d(x) = f%d(x)", i, i - 1);

        for (int k = 0; k < TERMS; k++)
            length += snprintf(line + length, sizeof line - (size_t)length, "+0");
        EXPECT_DONE(&kit, line);
    }
    (void)snprintf(line, sizeof line, "print f%d(1)", LAWS);
    EXPECT_DONE(&kit, line);
    EXPECT_FAILS(&kit, "print f2(1 m)", "in f0: m and V");
    kit_free(&kit);
}

/* what axes say */
static void expect_unit(Kit *kit, const char *item, const char *unit)
{
    char line[200];
    ct_statement *statement = NULL;
    char *got = NULL;

    (void)snprintf(line, sizeof line, "print %s", item);
    EXPECT(ct_parse(&(ct_cursor){.text = line, .line = 1}, false, &statement, &kit->error) ==
           CT_OK);
    got = ct_unit(kit->session, ct_operand(statement, 0));
    EXPECT_TEXT(got != NULL ? got : "", unit);
    ct_free(got);
    ct_statement_free(statement);
}

static void the_unit_of_an_item_is_told_where_it_is_known(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, RUN_SCENE);
    expect_unit(&kit, "h1", "rad");
    expect_unit(&kit, "h1''", "rad/s^2");
    expect_unit(&kit, "r*h1'", "m/s");
    expect_unit(&kit, "run1.s1'", "m/s");
    expect_unit(&kit, "max(R.i)^2", "A^2");
    expect_unit(&kit, "R.v*R.i", "W");
    expect_unit(&kit, "P'", "W/s");
    expect_unit(&kit, "h1.effort*h1'", "W");
    expect_unit(&kit, "C(h1)", "");
    expect_unit(&kit, "E(s1)", "V");
    expect_unit(&kit, "2*s1", "");
    expect_unit(&kit, "s1/r", "");
    expect_unit(&kit, "nothing", "");
    expect_unit(&kit, "s1 + h1", "");
    /* where another coordinate supplies a motion, the effort is along that */
    EXPECT_DONE(&kit, "driver D1 h1 = 1 - cos(t) by=s1\ndriver D2 s1 = sin(t) by=h1\n");
    expect_unit(&kit, "D1.effort", "N");
    expect_unit(&kit, "D2.effort", "N*m");
    kit_free(&kit);
}

/* deflections and turns, forces and moments of a section, of the last run and of a run by name */
static void what_a_beam_tells_at_a_place_has_its_unit(void)
{
    static const struct {
        const char *item, *unit;
    } told[] = {
        {"b1.u(0.5)", "m"},        {"b1.v(0.5)", "m"},       {"b1.w(L)", "m"},
        {"b1.phi(1)", "rad"},      {"b1.axial(0)", "N"},     {"b1.sheary(0)", "N"},
        {"b1.shearz(0)", "N"},     {"b1.torsion(0)", "N*m"}, {"b1.bendingy(0)", "N*m"},
        {"b1.bendingz(0)", "N*m"}, {"run1.b1.w(1)", "m"},    {"max(b1.bendingy(0))", "N*m"},
        {"2*b1.w(1)/L", ""},       {"b1.bending(0)", ""},
    };
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "L = 1 m\nbeam b1 length=L mass_per_length=2 EIz=100 EIy=50 GJ=10 "
                      "inertia_per_length=[0.1, 0, 0] "
                      "modes=[0, 2, 2, 1]\nweld w1 ground b1\nsimulate 0.01");
    for (size_t i = 0; i < sizeof told / sizeof told[0]; i++)
        expect_unit(&kit, told[i].item, told[i].unit);
    expect_refused(&kit, "print b1.w(1) [N]", "b1.w(1) is in m", 15);
    expect_refused(&kit, "print b1.w(1 kg)", "b1.w takes a place in m, not kg", 12);
    expect_refused(&kit, "print b1.w(1) + b1.axial(1)", "m and N can't be added", 17);
    EXPECT_DONE(&kit, "print b1.w(500 mm) [mm]");
    EXPECT_DONE(&kit, "info b1");
    EXPECT_HOLDS(kit.text, "b1.w(x) [m]");
    EXPECT_HOLDS(kit.text, "b1.bendingy(x) [N*m]");
    EXPECT_LACKS(kit.text, "b1.bending(x)");
    kit_free(&kit);
}

/* rows of A and B are rates of states, of C and D outputs; columns states and inputs */
static void entries_of_linear_equations_have_units_of_their_own(void)
{
    static const struct {
        const char *entry;
        const char *right;
        const char *wrong;
    } entries[] = {
        {"linear.A(1,2)", "[1/s*s]", "[1/s]"},
        {"linear.A(2,1)", "[1/s^2]", "[1/s]"},
        {"linear.A(3,3)", "[1/ms]", "[V]"},
        {"linear.B(2,1)", "[rad/s^2/N/m]", "[rad/s^2/N]"},
        {"linear.B(3,2)", "[A/s/V]", "[A/s]"},
        {"linear.C(1,1)", "[1]", "[m]"},
        {"linear.C(2,1)", "[m/s^2/rad]", "[m/s]"},
        {"linear.C(3,3)", "[W/A]", "[W]"},
        {"linear.D(2,1)", "[m/s^2/N/m]", "[1/kg]"},
        {"linear.D(3,2)", "[W/V]", "[W/A]"},
    };
    Kit kit = kit_new();
    char line[100];

    EXPECT_DONE(&kit, PENDULUM "actuator u h torque=0\nvsource V a 0 1\nresistor R a b 2\n"
                               "inductor L1 b 0 1 mH\nequilibrium\n"
                               "linearize inputs=[u, V] outputs=[h, m.ax, R.v*R.i]");
    for (size_t i = 0; i < sizeof entries / sizeof entries[0]; i++) {
        (void)snprintf(line, sizeof line, "print %s %s", entries[i].entry, entries[i].right);
        EXPECT_DONE(&kit, line);
        (void)snprintf(line, sizeof line, "print %s %s", entries[i].entry, entries[i].wrong);
        EXPECT_FAILS(&kit, line, "it can't be shown in");
    }
    kit_free(&kit);
}

/* laws that call each other twice over are looked into once for each kind of argument */
static void nested_laws_take_no_longer_than_they_are_long(void)
{
    Kit kit = kit_new();
    char line[200];

    EXPECT_DONE(&kit, "f0(x) = x + 1 V");
    for (int i = 1; i <= 200; i++) {
        (void)snprintf(line, sizeof line, "f%d(x) = 0.5*f%d(x) + 0.5*f%d(x)", i, i - 1, i - 1);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_NEAR(kit_value(&kit, "f40(3 V)"), 4, 1e-12);
    EXPECT_FAILS(&kit, "print f20(3 m)", "in f0: m and V");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_wrong_unit_is_refused_under_a_caret);
    RUN(what_is_right_or_not_known_passes);
    RUN(a_parameter_is_held_to_its_dimension_where_it_is_used);
    RUN(a_law_or_output_is_held_to_its_dimension_where_it_is_used);
    RUN(a_change_of_dimension_reformulates_nothing);
    RUN(the_unit_of_an_item_is_told_where_it_is_known);
    RUN(what_a_beam_tells_at_a_place_has_its_unit);
    RUN(entries_of_linear_equations_have_units_of_their_own);
    RUN(deep_laws_end);
    RUN(nested_laws_take_no_longer_than_they_are_long);
    return test_end();
}

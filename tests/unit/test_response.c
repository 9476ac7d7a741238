/* test_response.c: transfer functions and equivalents in symbols, against results by hand */
#include "session_kit.h"

#include "base/text.h"

/* what a network answers to `ask` is that text */
static void expect_shown(const char *network, const char *ask, const char *wanted)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, network);
    EXPECT_DONE(&kit, ask);
    EXPECT_TEXT(kit.text, wanted);
    kit_free(&kit);
}

#define DIVIDER                                                                                    \
    "R1 = 1 kohm; R2 = 2 kohm; C = 1 uF\n"                                                         \
    "vsource V1 in 0 5\nresistor Ra in out R1\nresistor Rb out 0 R2\ncapacitor Ca out 0 C\n"

static void a_divider_is_as_by_hand(void)
{
    expect_shown(DIVIDER, "show transfer out.v V1 symbolic\n",
                 "out.v/V1 = R2/(R1*R2*C*s + R1 + R2)\n");
    expect_shown(DIVIDER, "show transfer Ca.i V1 symbolic\n",
                 "Ca.i/V1 = R2*C*s/(R1*R2*C*s + R1 + R2)\n");
    expect_shown(DIVIDER, "show thevenin out 0\n",
                 "v = E - Z i, v from out to 0, i out of the network at out\n"
                 "E/V1 = R2/(R1*R2*C*s + R1 + R2)\n"
                 "Z = R1*R2/(R1*R2*C*s + R1 + R2)\n");
    expect_shown(DIVIDER, "show norton out 0\n",
                 "i = J - Y v, v from out to 0, i out of the network at out\n"
                 "J/V1 = 1/R1\n"
                 "Y = (R1*R2*C*s + R1 + R2)/(R1*R2)\n");
}

/* open-circuit voltage R4/(R2 + R4) - R3/(R1 + R3), turned round; R1 || R3 + R2 || R4 */
static void a_bridge_has_an_equivalent(void)
{
    expect_shown("R1=1;R2=2;R3=3;R4=4\nvsource V p 0 1\nresistor A p a R1\nresistor B p b R2\n"
                 "resistor D a 0 R3\nresistor F b 0 R4\n",
                 "show thevenin a b\n",
                 "v = E - Z i, v from a to b, i out of the network at a\n"
                 "E/V = (R2*R3 - R1*R4)/((R1 + R3)*(R2 + R4))\n"
                 "Z = (R1*(R2*(R3 + R4) + R3*R4) + R2*R3*R4)/((R1 + R3)*(R2 + R4))\n");
}

static void filters_are_as_in_books(void)
{
    /* two equal stages of a ladder */
    expect_shown("R=1;C=1\nvsource V a 0 1\nresistor R1 a b R\ncapacitor C1 b 0 C\n"
                 "resistor R2 b c R\ncapacitor C2 c 0 C\n",
                 "show transfer c.v V symbolic\n", "c.v/V = 1/(R^2*C^2*s^2 + 3*R*C*s + 1)\n");
    /* the same behind a follower: a square */
    expect_shown("R=1;C=1\nvsource V a 0 1\nresistor R1 a b R\ncapacitor C1 b 0 C\n"
                 "opamp U b d d\nresistor R2 d c R\ncapacitor C2 c 0 C\n",
                 "show transfer c.v V symbolic\n", "c.v/V = 1/(R*C*s + 1)^2\n");
    /* Sallen and Key (1955) */
    expect_shown("R1=1;R2=1;C1=1;C2=1\nvsource V a 0 1\nresistor Ra a b R1\nresistor Rb b c R2\n"
                 "capacitor Ca b out C1\ncapacitor Cb c 0 C2\nopamp U c out out\n",
                 "show transfer out.v V symbolic\n",
                 "out.v/V = 1/(R1*R2*C1*C2*s^2 + C2*(R1 + R2)*s + 1)\n");
    /* a bridged T */
    expect_shown("R=1;C1=1;C2=1\nvsource V a 0 1\nresistor Ra a b R\nresistor Rb b c R\n"
                 "capacitor Ca a c C1\ncapacitor Cb b 0 C2\n",
                 "show transfer c.v V symbolic\n",
                 "c.v/V = (R^2*C1*C2*s^2 + 2*R*C1*s + 1)/(R^2*C1*C2*s^2 + R*(2*C1 + C2)*s + 1)\n");
    /* an integrator; its output is a source of voltage */
    expect_shown("R=1;C=1\nvsource V a 0 1\nresistor Ra a b R\ncapacitor Ca b out C\n"
                 "opamp U 0 b out\nresistor Rl out 0 5\n",
                 "show thevenin out 0\n",
                 "v = E - Z i, v from out to 0, i out of the network at out\n"
                 "E/V = -1/(R*C*s)\nZ = 0\n");
}

static void coupled_coils_and_controlled_sources_take_part(void)
{
    expect_shown("R=1;Q=1;L1=1;L2=1;M=0.5\nvsource V a 0 1\nresistor Ra a b R\n"
                 "inductor La b 0 L1\ninductor Lb c 0 L2\ncoupling K La Lb M=M\n"
                 "resistor Rc c 0 Q\n",
                 "show transfer c.v V symbolic\n",
                 "c.v/V = Q*M*s/((L1*L2 - M^2)*s^2 + (R*L2 + Q*L1)*s + R*Q)\n");
    /* a transistor's model with the capacitance from output to input */
    expect_shown("g=0.1;R=1;Q=1;C=1\nvsource V in 0 1\nresistor Rg in x R\n"
                 "vccs G out 0 x 0 gain=g\nresistor Rd out 0 Q\ncapacitor Cx x out C\n",
                 "show norton out 0\n",
                 "i = J - Y v, v from out to 0, i out of the network at out\n"
                 "J/V = (C*s - g)/(R*C*s + 1)\n"
                 "Y = (C*(g*R*Q + R + Q)*s + 1)/(Q*(R*C*s + 1))\n");
    expect_shown("n=2;C=1;R=1\nvsource V a 0 1\nresistor Ra a b R\ntransformer T b 0 c 0 n=n\n"
                 "capacitor Ca c 0 C\n",
                 "show transfer c.v V symbolic\n", "c.v/V = n/(C*R*s + n^2)\n");
}

static void other_domains_have_equivalents(void)
{
    expect_shown("A=1;R=2\npump P a 0 pressure=5\npipe Q a b R=R\ntank T b 0 A=1\n",
                 "show thevenin b 0\n",
                 "p = E - Z flow, p from b to 0, flow out of the network at b\n"
                 "E/P = 9810/(R*s + 9810)\nZ = 9810*R/(R*s + 9810)\n");
    expect_shown("k=1;d=2;J=3\ntorquesource T a 0 5\nflywheel F a 0 J=J\nshaft S a b k=k d=0\n"
                 "flywheel G b 0 J=J\n",
                 "show norton a 0\n",
                 "torque = J - Y w, w from a to 0, torque out of the network at a\n"
                 "J/T = 1\nY = J*s*(J*s^2 + 2*k)/(J*s^2 + k)\n");
    expect_shown("R=1;C=2\nheatsource H a 0 5\nheatcap M a 0 C=C\nheatres N a b R=R\n"
                 "tempsource A b 0 300\n",
                 "show thevenin a 0\n",
                 "T = E - Z heat, T from a to 0, heat out of the network at a\n"
                 "E/H = R/(R*C*s + 1)\nE/A = 1/(R*C*s + 1)\nZ = R/(R*C*s + 1)\n");
}

/* numbers are exact on the way: what cancels does, whatever the digits */
static void numbers_are_not_rounded_on_the_way(void)
{
    expect_shown("vsource V a 0 1\nresistor R1 a b 0.869178219437658\n"
                 "resistor R2 b 0 0.869178219437658\nresistor R3 a c 0.434589109718829\n"
                 "resistor R4 c 0 0.434589109718829\n",
                 "show transfer (b.v - c.v) V symbolic\n", "(b.v - c.v)/V = 0\n");
    expect_shown("vsource V a 0 1\nresistor R1 a b 4.7 kohm\ncapacitor C1 b 0 2.2 nF\n",
                 "show transfer b.v V symbolic\n", "b.v/V = 1/(1.034e-5*s + 1)\n");
}

static void it_is_written_in_other_notations(void)
{
    expect_shown(DIVIDER, "show transfer out.v V1 symbolic as latex\n",
                 "\\begin{align*}\n\\frac{\\mathrm{out}.v}{V_{1}} &= "
                 "\\frac{R_{2}}{R_{1}\\,R_{2}\\,C s + R_{1} + R_{2}}\n\\end{align*}\n");
    expect_shown(DIVIDER, "show transfer out.v V1 symbolic as c\n",
                 "H = R2/(R1*R2*C*s + R1 + R2);\n");
    expect_shown(DIVIDER, "show thevenin out 0 as python\n",
                 "# v = E - Z i, v from out to 0, i out of the network at out\n"
                 "E_V1 = R2/(R1*R2*C*s + R1 + R2);\nZ = R1*R2/(R1*R2*C*s + R1 + R2);\n");
    /* a parameter called s keeps its name */
    expect_shown("s = 2\nvsource V a 0 1\nresistor R1 a b s\ncapacitor C1 b 0 3\n",
                 "show transfer b.v V symbolic\n", "b.v/V = 1/(3*s*p + 1)\n");
}

static void the_model_stays_as_it_was(void)
{
    Kit kit = kit_new();
    char *before, *after;

    EXPECT_DONE(&kit, DIVIDER);
    before = ct_save(kit.session);
    EXPECT_DONE(&kit, "show thevenin out 0\nshow norton in out\n");
    after = ct_save(kit.session);
    EXPECT_TEXT(after, before);
    ct_free(before);
    ct_free(after);
    EXPECT_DONE(&kit, "set Ra.R = 3\nshow norton out 0\n");
    EXPECT_HOLDS(kit.text, "J/V1 = 1/3");
    kit_free(&kit);
}

/* --- what is refused --- */

static void expect_refused(const char *network, const char *ask, const char *message,
                           const char *hint)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, network);
    EXPECT(kit_do(&kit, ask) != CT_OK);
    EXPECT_TEXT(kit.error.message, message);
    EXPECT_HOLDS(kit.error.hint, hint);
    EXPECT(kit.error.column > 0);
    kit_free(&kit);
}

static void what_has_no_answer_is_refused_with_the_way_out(void)
{
    static const char diode[] = "vsource V a 0 1\nresistor R a b 1\ndiode D b 0 Is=1e-14\n";

    expect_refused(diode, "show thevenin b 0", "the network is not linear: see the equation of D",
                   "linearize");
    expect_refused(diode, "show transfer b.v V symbolic",
                   "the network is not linear: see the equation of D", "linearize");
    expect_refused(DIVIDER, "show thevenin", "an equivalent is that of two terminals, or of frames",
                   "show thevenin out 0");
    expect_refused(DIVIDER, "show norton out",
                   "an equivalent is that of two terminals, or of frames", "show norton out 0");
    expect_refused(DIVIDER, "show thevenin out out", "an equivalent is that of two terminals", "");
    expect_refused(DIVIDER, "show thevenin ot 0", "no terminal is called 'ot'",
                   "did you mean 'out'?");
    expect_refused(DIVIDER, "show thevenin out 0 in",
                   "an equivalent is that of two terminals, or of frames", "");
    expect_refused(DIVIDER, "show norton in 0",
                   "the v between in and 0 is given, whatever flows: there is no Norton equivalent",
                   "show thevenin in 0");
    expect_refused("isource I a 0 1\n", "show thevenin a 0",
                   "nothing lets the i between a and 0 follow: there is no Thevenin equivalent",
                   "show norton a 0");
    expect_refused(DIVIDER, "show transfer out.v Ra symbolic", "Ra is no independent source", "V1");
    expect_refused(DIVIDER, "show transfer out.v symbolic",
                   "a transfer function in symbols has an output and an input",
                   "show transfer C1.v V1");
    expect_refused(DIVIDER, "show transfer out.v V1' symbolic", "an input is a source's name", "");
    expect_refused(DIVIDER, "show transfer (out.v*out.v) V1 symbolic",
                   "the network is not linear: see the equation of (out.v*out.v)", "linearize");
    expect_refused("vsource V a 0 1\nresistor R a b 1 + 0.5*sin(t)\nresistor Q b 0 1\n",
                   "show transfer b.v V symbolic", "the equation of R varies with time by itself",
                   "linearize at=");
    expect_refused(DIVIDER "pump P x 0 pressure=1\npipe Q x y R=1\ntank T y 0 A=1\n",
                   "show thevenin out x", "'x' is a terminal of another domain", "");
}

/* n stages: more products than anybody reads */
static void an_answer_without_end_is_refused(void)
{
    Text text = {0};
    Kit kit = kit_new();

    text_add(&text, "vsource V n0 0 1\n");
    for (int i = 0; i < 14; i++)
        text_addf(&text, "R%d = 1; C%d = 1\nresistor r%d n%d n%d R%d\ncapacitor c%d n%d 0 C%d\n", i,
                  i, i, i, i + 1, i, i, i + 1, i);
    EXPECT_DONE(&kit, text.at);
    EXPECT(kit_do(&kit, "show transfer n14.v V symbolic") != CT_OK);
    EXPECT_TEXT(kit.error.message, "n14.v has more than 20000 terms in symbols");
    EXPECT_HOLDS(kit.error.hint, "give parts numbers");
    text_free(&text);
    kit_free(&kit);
}

int main(void)
{
    RUN(a_divider_is_as_by_hand);
    RUN(a_bridge_has_an_equivalent);
    RUN(filters_are_as_in_books);
    RUN(coupled_coils_and_controlled_sources_take_part);
    RUN(other_domains_have_equivalents);
    RUN(numbers_are_not_rounded_on_the_way);
    RUN(it_is_written_in_other_notations);
    RUN(the_model_stays_as_it_was);
    RUN(what_has_no_answer_is_refused_with_the_way_out);
    RUN(an_answer_without_end_is_refused);
    return test_end();
}

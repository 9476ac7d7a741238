/* test_session_derivation.c: `show derivation` of the paper's examples, as the paper has them */
#include "session_kit.h"

#define PLANAR_CRANK                                                                               \
    "scene planar\ngravity [0, -9.81]\nL4 = 0.08\nL5 = 0.12\nL6 = 0.25\nL7 = 0.35\n"               \
    "body m1 mass=2 inertia=0.01\nbody m2 mass=1.2 inertia=0.03\nbody m3 mass=3 inertia=0.01\n"    \
    "arm r4 m1 [-L4, 0]\narm r5 m1 [L5, 0]\narm r6 m2 [L6, 0]\narm r7 m2 [-L7, 0]\n"               \
    "revolute h8 ground r4\nrevolute h9 r5 r6\nrevolute h10 m3 r7\n"                               \
    "prismatic s11 ground m3 axis=x\n"

#define ROBOT                                                                                      \
    "L6 = 0.15\nL7 = 0.25\nL8 = 0.20\nL9 = 0.22\nI2z = 0.052\nI3z = 0.031\n"                       \
    "body m1 mass=4 inertia=[0.05, 0.05, 0.05]\nbody m2 mass=3 inertia=[0.004, 0.05, I2z]\n"       \
    "body m3 mass=2 inertia=[0.003, 0.03, I3z]\narm r6 m1 [L6, 0, 0] rotation=x(90 deg)\n"         \
    "arm r7 m2 [-L7, 0, 0]\narm r8 m2 [L8, 0, 0]\narm r9 m3 [-L9, 0, 0]\n"                         \
    "revolute h12 ground m1 axis=z\nrevolute h13 r6 r7 axis=z\nrevolute h14 r8 r9 axis=z\n"        \
    "virtual revolute vh16 r6 m3 axis=z\ntree joint\n"

static Kit dd_kit(void)
{
    const ct_hooks hooks = {.columns = 0};

    return (Kit){.session = ct_session_new(&hooks)};
}

/* equations 4 to 6: the circuit of h9 in the paper's order */
static void one_tree_gives_two_constraints(void)
{
    Kit kit = dd_kit();

    EXPECT_DONE(&kit, PLANAR_CRANK "tree h8 h10 s11\nshow derivation h9");
    EXPECT_HOLDS(kit.text, "r(h9) = r(r6) - r(r7) + r(h10) + r(s11) - r(h8) + r(r4) - r(r5), the "
                           "circuit of h9 in the translation tree");
    EXPECT_HOLDS(kit.text, "r(r5) = [L5, 0] in m1, turned by h8");
    EXPECT_HOLDS(kit.text, "on x of ground, along which it carries a force");
    EXPECT_HOLDS(kit.text, "vanish      +h10, -h8: their ends stay together");
    EXPECT_HOLDS(kit.text, "  +r6 = L6*cos(h10)\n  -r7 = L7*cos(h10)\n  +s11 = s11\n"
                           "  +r4 = -L4*cos(h8)\n  -r5 = -L5*cos(h8)\n"
                           "constraints(1) = s11 - (L4 + L5)*cos(h8) + (L6 + L7)*cos(h10)\n");
    EXPECT_HOLDS(kit.text, "+s11: square to that direction");
    EXPECT_HOLDS(kit.text, "constraints(2) = (L6 + L7)*sin(h10) - (L4 + L5)*sin(h8)\n");
    /* equations 1 and 2 begin at ground */
    EXPECT_DONE(&kit, "show derivation m2");
    EXPECT_HOLDS(kit.text, "theta(m2) = theta(s11) + theta(h10) - theta(r7), the circuit of m2");
    EXPECT_HOLDS(kit.text, "w(m2) = w(s11) + w(h10) - w(r7), the circuit of m2");
    /* equation 8 on paper */
    EXPECT_DONE(&kit, "show equations as latex");
    EXPECT_HOLDS(kit.text, "\\lambda_{1}");
    kit_free(&kit);
}

/* equation 7: the circuit of s11, projected on the normal of its axis */
static void two_trees_give_one(void)
{
    Kit kit = dd_kit();

    EXPECT_DONE(&kit, PLANAR_CRANK "tree translation h8 h9 h10\ntree rotation h8 h10 s11\n"
                                   "show derivation s11");
    EXPECT_HOLDS(kit.text, "r(s11) = r(h8) - r(r4) + r(r5) + r(h9) - r(r6) + r(r7) - r(h10)");
    EXPECT_HOLDS(kit.text, "on y of ground");
    EXPECT_HOLDS(kit.text, "constraints(1) = (L4 + L5)*sin(h8) - (L6 + L7)*sin(h10)\n");
    EXPECT_DONE(&kit, "show derivation h9");
    EXPECT_HOLDS(kit.text, "F(m2) + F(m3) + F(h9) + F(s11) = 0, the cutset of h9");
    EXPECT_DONE(&kit, "show derivation constraints(1) as latex");
    EXPECT_HOLDS(kit.text, "$\\underline{r}_{\\mathrm{s11}} = ");
    EXPECT_HOLDS(kit.text, "\\begin{align*}");
    kit_free(&kit);
}

static void entries_of_m_tell_what_moves(void)
{
    Kit kit = dd_kit();

    EXPECT_DONE(&kit, ROBOT "show derivation mass(2,2)");
    EXPECT_HOLDS(kit.text, "T(m2) + T(m3) + T(h13) + T(vh16) = 0, the cutset of h13");
    EXPECT_HOLDS(kit.text, "vh16: virtual, carries nothing");
    EXPECT_HOLDS(kit.text,
                 "m3 moves [0, L7 + L8, 0] of m2 + [0, L9, 0] of m3, turns about z of m3");
    EXPECT_HOLDS(kit.text, "  m2 m v.v = 3*L7^2\n  m2 w.I.w = I2z\n");
    EXPECT_HOLDS(kit.text, "  m3 w.I.w = I3z\n");
    EXPECT_DONE(&kit, "show derivation mass(2,3)");
    EXPECT_HOLDS(kit.text, "  m3 m v.v = 2*L9*(L9 + (L7 + L8)*cos(h14))\n  m3 w.I.w = I3z\n");
    EXPECT_DONE(&kit, "tree + vh16 - h14\nshow derivation mass(2,2)");
    EXPECT_HOLDS(kit.text, "T(m2) + T(h13) - T(h14) = 0, the cutset of h13");
    EXPECT_HOLDS(kit.text, "m3 moves [0, L7 + L8, 0] of m2\n");
    EXPECT_HOLDS(kit.text, "  m3 m v.v = 2*(L7 + L8)^2\n");
    EXPECT_DONE(&kit, "show derivation mass(2,3)");
    EXPECT_HOLDS(kit.text, "  m3 m v.v = 2*L9*(L7 + L8)*cos(h13 - vh16)\n"
                           "mass(2,3) = 2*L9*(L7 + L8)*cos(h13 - vh16)\n");
    kit_free(&kit);
}

/* equations 16 and 17 */
static void motors_couple_two_graphs(void)
{
    Kit kit = dd_kit();

    EXPECT_DONE(&kit, "scene planar\nR7 = 1.2\nLa = 0.05\nKv = 0.8\nbody m1 mass=2 inertia=0.03\n"
                      "arm p1 m1 [-0.2, 0]\nrevolute J1 ground p1 coord=theta1\n"
                      "motor M7 J1 a 0 R=R7 L=La Kt=Kv Kv=Kv\nvsource V1 a 0 24\n"
                      "show derivation M7");
    EXPECT_HOLDS(kit.text, "M7.v = R7*M7.i + La*M7.i' + Kv*theta1', the law of M7");
    EXPECT_HOLDS(kit.text, "v(M7) = v(V1)");
    EXPECT_HOLDS(kit.text, "V1.v = 24, the law of V1");
    EXPECT_HOLDS(kit.text, "La*M7.i' = 24 - R7*M7.i - Kv*theta1'");
    EXPECT_DONE(&kit, "show derivation theta1");
    EXPECT_HOLDS(kit.text, "  M7 effort = Kv*M7.i\n");
    kit_free(&kit);
}

static void the_microphone_follows_its_circuit(void)
{
    Kit kit = dd_kit();

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\neA = 5e-5\ns0 = 0.05\nR = 10\nL = 1\n"
                      "body m5 mass=0.1 inertia=0\nprismatic s ground m5 axis=y\n"
                      "spring k6 s k=200\ndamper d6 s d=0.8\nvsource E4 a 0 8*sin(t)\n"
                      "resistor R1 a b R\ninductor L3 b c L\nplatecap C2 s c 0 C=eA/(s0 - s)\n"
                      "tree electrical E4 R1 L3\nshow derivation");
    EXPECT_HOLDS(kit.text, "F(m5) + F(s) + F(k6) + F(d6) + F(C2) = 0, the cutset of s");
    EXPECT_HOLDS(kit.text, "  k6 effort = -200*s\n  d6 effort = -0.8*s'\n  C2 effort = ");
    EXPECT_HOLDS(kit.text, "C2.i = eA*C2.v*s'/(s0 - s)^2 + eA*C2.v'/(s0 - s), the law of C2");
    EXPECT_HOLDS(kit.text, "v(C2) = v(E4) - v(R1) - v(L3)");
    EXPECT_HOLDS(kit.text, "R1.v = R*R1.i, the law of R1");
    EXPECT_HOLDS(kit.text, "i(R1) = i(C2)");
    kit_free(&kit);
}

/* entries are picked as behind `show` itself, or as they are printed */
static void numbers_behind_a_block_are_an_entry(void)
{
    Kit kit = kit_new();
    char *called;

    EXPECT_DONE(&kit, ROBOT "show derivation mass(2,3)");
    called = kit.text;
    kit.text = NULL;
    EXPECT_DONE(&kit, "show derivation mass 2 3");
    EXPECT(called != NULL && kit.text != NULL && strcmp(called, kit.text) == 0);
    ct_free(called);
    EXPECT_DONE(&kit, "show derivation forces 1");
    EXPECT_FAILS(&kit, "show derivation mass 2", "a row and a column");
    EXPECT_FAILS(&kit, "show derivation mass 2 3 1", "a row and a column");
    EXPECT_FAILS(&kit, "show derivation mass 2 9", "columns 1 to");
    EXPECT_FAILS(&kit, "show derivation mass(2,3) 1", "at a time");
    EXPECT_FAILS(&kit, "show derivation 2 3", "at a time");
    EXPECT_FAILS(&kit, "show derivation mass h13", "at a time");
    EXPECT_FAILS(&kit, "show derivation h13 2", "no block");
    EXPECT_FAILS(&kit, "show derivation (h13) 2", "derivation");
    kit_free(&kit);
}

int main(void)
{
    RUN(numbers_behind_a_block_are_an_entry);
    RUN(one_tree_gives_two_constraints);
    RUN(two_trees_give_one);
    RUN(entries_of_m_tell_what_moves);
    RUN(motors_couple_two_graphs);
    RUN(the_microphone_follows_its_circuit);
    return test_end();
}

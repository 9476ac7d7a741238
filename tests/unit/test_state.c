/* test_state.c: state equations in symbols, against closed forms and against linearize */
#include "session_kit.h"

#include "formulate/reduced/state_space.h"
#include "session/session_impl.h"

/* --- closed forms --- */

static void a_series_circuit_reads_as_by_hand(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "R = 10; L = 1 mH; C = 1 uF\nvsource E1 a 0 sin(t)\nresistor R1 a b R\n"
                      "inductor L1 b c L\ncapacitor C1 c 0 C\nshow state\n");
    EXPECT_TEXT(kit.text, "x' = A x + B u\n"
                          "x  L1.i, C1.v\n"
                          "u  E1\n"
                          "A     L1.i  C1.v\n"
                          "L1.i  -R/L  -1/L\n"
                          "C1.v   1/C     0\n"
                          "B      E1\n"
                          "L1.i  1/L\n"
                          "C1.v    0\n");
    EXPECT_DONE(&kit, "show state as c\n");
    EXPECT_TEXT(kit.text, "/* x: L1.i, C1.v */\n"
                          "/* u: E1 */\n"
                          "double A[2][2] = {{0}};\n"
                          "A[0][0] = -R/L;\n"
                          "A[0][1] = -1.0/L;\n"
                          "A[1][0] = 1.0/C;\n"
                          "double B[2][1] = {{0}};\n"
                          "B[0][0] = 1.0/L;\n");
    EXPECT_DONE(&kit, "show state as matlab\n");
    EXPECT_HOLDS(kit.text, "A = zeros(2, 2);\nA(1,1) = -R/L;\n");
    EXPECT_DONE(&kit, "show state as latex\n");
    EXPECT_HOLDS(kit.text, "&= \\begin{bmatrix} -\\frac{R}{L} & -\\frac{1}{L} \\\\ ");
    EXPECT_HOLDS(kit.text, "&\\quad + \\begin{bmatrix} \\frac{1}{L} \\\\ 0 \\end{bmatrix} "
                           "\\begin{bmatrix} E_{1} \\end{bmatrix}\n");
    kit_free(&kit);
}

/* (Ca + Cb) v' = Ca E' - v/R + I for the voltage of the capacitor at the datum */
static void a_circuit_of_capacitors_and_sources_holds_a_rate_of_the_source(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "Ca = 1; Cb = 2; R = 4\nvsource E1 a 0 10*sin(t)\ncapacitor C1 a b Ca\n"
                      "capacitor C2 b 0 Cb\nresistor R1 b 0 R\nisource I1 0 b 1\n"
                      "tree C2 E1\nshow state\n");
    EXPECT_TEXT(kit.text, "x' = A x + B u + B1 u'\n"
                          "x  C2.v\n"
                          "u  E1, I1\n"
                          "A                 C2.v\n"
                          "C2.v  -1/(R*(Ca + Cb))\n"
                          "B     E1           I1\n"
                          "C2.v   0  1/(Ca + Cb)\n"
                          "B1             E1'  I1'\n"
                          "C2.v  Ca/(Ca + Cb)    0\n");
    kit_free(&kit);
}

/* a source that follows another variable is part of A */
static void a_controlled_source_is_no_input(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "k = 2; R = 1; C = 1\nvsource E1 a 0 1\ncapacitor C1 b 0 C\n"
                      "vsource E2 c a -k*C1.v\nresistor R1 c b R\nshow state\n");
    EXPECT_HOLDS(kit.text, "u  E1\n");
    EXPECT_HOLDS(kit.text, "C1.v  -(k + 1)/(R*C)\n");
    kit_free(&kit);
}

/* --- the same as linearize finds in numbers --- */

static double now(void *context, Expr symbol)
{
    return model_parameter_value(context, symbol);
}

static bool agrees(Kit *kit, Expr symbolic, double wanted, double scale)
{
    Model *model = kit->session->model;
    double got = expr_evaluate(symbolic, now, model);

    if (fabs(got - wanted) <= 1e-11 * scale)
        return true;
    printf("got %.17g, wanted %.17g\n", got, wanted);
    return false;
}

static double largest(const double *at, int count)
{
    double most = 0;

    for (int i = 0; i < count; i++)
        most = fmax(most, fabs(at[i]));
    return most;
}

/* whether the network has state equations; they are then compared */
static bool is_as_linearized(Kit *kit)
{
    StateSpace *space = NULL;
    const Linear *linear;
    Scene scene = {0};
    Diag diag = {0};
    bool same = true;
    Status status = model_scene(kit->session->model, &scene, &diag);

    if (status == OK)
        status = state_space_new(&scene, NULL, &space, &diag);
    scene_free(&scene);
    if (status != OK || kit_do(kit, "linearize inputs=[E1, I1]\n") != CT_OK) {
        state_space_free(space);
        return false;
    }
    linear = kit->session->linear;
    EXPECT(linear->states == space->states && space->inputs == 2);
    for (int i = 0; same && i < space->states * space->states; i++)
        same = agrees(kit, space->a[i], linear->a[i],
                      largest(linear->a, space->states * space->states));
    for (int i = 0; same && !space->has[1] && i < space->states * 2; i++)
        same = agrees(kit, space->b[0][i], linear->b[i], largest(linear->b, space->states * 2));
    EXPECT(same);
    state_space_free(space);
    return true;
}

enum { NODES = 5, PARTS = 9 };

/* one of each source and a few parts between random nodes, all values parameters */
static void make_network(Kit *kit, uint64_t *random)
{
    static const char *const kinds[] = {"resistor", "resistor", "capacitor", "inductor"};
    char line[200];

    EXPECT_DONE(kit, "vsource E1 n1 0 0\nisource I1 0 n2 0\n");
    for (int i = 0; i < PARTS; i++) {
        const int from = (int)(test_random(random) % NODES);
        const int to = (from + 1 + (int)(test_random(random) % (NODES - 1))) % NODES;
        const char *kind = i < NODES ? kinds[0] : kinds[test_random(random) % 4];

        /* the first ones tie all nodes together */
        (void)snprintf(line, sizeof line, "p%d = %.6g\n%s X%d n%d n%d p%d\n", i,
                       test_uniform(random, 0.5, 2), kind, i, i < NODES ? i : from,
                       i < NODES ? (i + 1) % NODES : to, i);
        EXPECT_DONE(kit, line);
    }
    EXPECT_DONE(kit, "resistor R0 n0 0 p0\n");
}

static void random_networks_are_as_linearized(void)
{
    uint64_t random = 20261121;
    int compared = 0;

    for (int k = 0; k < 60; k++) {
        Kit kit = kit_new();

        make_network(&kit, &random);
        compared += is_as_linearized(&kit);
        kit_free(&kit);
    }
    EXPECT(compared >= 30);
}

/* --- what has none --- */

static void what_is_no_linear_network_is_refused_by_name(void)
{
    /* clang-format off */
    static const struct { const char *model, *message, *hint; } wrong[] = {
        {PENDULUM, "there is no network", "voltages of capacitors"},
        {"vsource E1 a 0 1\nresistor R1 a 0 1\n", "the network has no states", "voltages of capacitors"},
        {"vsource E1 a 0 1\ncapacitor C1 b 0 1\nresistor R1 a b 1 + C1.v^2\n",
         "the network is not linear: see the equation of C1", "linearize"},
        {PENDULUM "vsource V1 a 0 1\nmotor M1 h a 0 R=1 L=0.1 Kt=0.5\n",
         "the equation of M1 holds motion of the mechanism", "linearize"},
    };
    /* clang-format on */

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, wrong[i].model);
        EXPECT(kit_do(&kit, "show state") == CT_FAILED);
        EXPECT_HOLDS(kit.error.message, wrong[i].message);
        EXPECT_HOLDS(kit.error.hint, wrong[i].hint);
        EXPECT(kit.error.column == 6);
        kit_free(&kit);
    }
}

/* every node tied to every other by a resistor */
static void a_dense_mesh_is_left_to_numbers(void)
{
    Kit kit = kit_new();
    char line[100];

    EXPECT_DONE(&kit, "vsource E1 n0 0 0\ncapacitor C1 n1 0 1\n");
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < i; j++) {
            (void)snprintf(line, sizeof line, "r%d%d = 1\nresistor R%d%d n%d n%d r%d%d\n", i, j, i,
                           j, i, j, i, j);
            EXPECT_DONE(&kit, line);
        }
    EXPECT(kit_do(&kit, "show state") == CT_FAILED);
    EXPECT_HOLDS(kit.error.message, "too many equations of the network are coupled");
    EXPECT_HOLDS(kit.error.hint, "'linearize' solves them in numbers");
    kit_free(&kit);
}

static void a_ladder_is_listed_entry_by_entry(void)
{
    Kit kit = kit_new();
    char line[100];

    EXPECT_DONE(&kit, "R = 1; C = 2\nvsource E1 n0 0 0\n");
    for (int i = 1; i <= 50; i++) {
        (void)snprintf(line, sizeof line, "resistor R%d n%d n%d R\ncapacitor C%d n%d 0 C\n", i,
                       i - 1, i, i, i);
        EXPECT_DONE(&kit, line);
    }
    EXPECT_DONE(&kit, "show state\n");
    EXPECT_HOLDS(kit.text, "A(1,1) = -2/(R*C)\nA(1,2) = 1/(R*C)\nA(2,1) = 1/(R*C)\n");
    EXPECT_HOLDS(kit.text, "A(50,50) = -1/(R*C)\n");
    kit_free(&kit);
}

int main(void)
{
    RUN(a_series_circuit_reads_as_by_hand);
    RUN(a_circuit_of_capacitors_and_sources_holds_a_rate_of_the_source);
    RUN(a_controlled_source_is_no_input);
    RUN(random_networks_are_as_linearized);
    RUN(what_is_no_linear_network_is_refused_by_name);
    RUN(a_dense_mesh_is_left_to_numbers);
    RUN(a_ladder_is_listed_entry_by_entry);
    return test_end();
}

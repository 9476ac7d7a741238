/* test_chains.c: rest, linear equations and modes of long chains, of which a run writes no mass
 * matrix out: against closed forms and differences */
#include "session_kit.h"

#include "base/text.h"

/* points of equal masses on massless rods of equal lengths */
static void add_points(Text *text, int count)
{
    text_add(text, "scene planar\ngravity [0, -9.81]\n");
    for (int i = 1; i <= count; i++) {
        text_addf(text, "body m%d mass=1 inertia=0\narm p%d m%d [0, 1]\n", i, i, i);
        text_addf(text, i == 1 ? "revolute h1 ground p1\n" : "revolute h%d m%d p%d\n", i, i - 1, i);
    }
}

/* their squares over g/l are the zeros of Laguerre's polynomial of that order (D. Bernoulli) */
static void a_long_chain_has_the_modes_of_laguerre(void)
{
    enum { COUNT_OF = 150 };
    Text text = {0};
    Kit kit = kit_new();
    const double n = COUNT_OF;
    double sum = 0, squares = 0;

    add_points(&text, COUNT_OF);
    text_add(&text, "tree joint\nmodes\n");
    EXPECT_DONE(&kit, text.at);
    for (int i = 1; i <= COUNT_OF; i++) {
        char name[40];
        double omega, zero;

        (void)snprintf(name, sizeof name, "modes.omega(%d)", i);
        omega = kit_value(&kit, name);
        zero = omega * omega / 9.81;
        sum += zero;
        squares += zero * zero;
        if (i == 1) { /* L = sum of (n over k) (-x)^k/k! */
            double term = 1, value = 1;

            for (int k = 1; k < 30; k++)
                value += term *= -zero * (n - k + 1) / (k * (double)k);
            EXPECT_NEAR(value, 0, 1e-9);
        }
    }
    EXPECT_NEAR(sum, n * n, 1e-9 * n * n);
    EXPECT_NEAR(squares, n * n * (2 * n - 1), 1e-9 * 2 * n * n * n);
    kit_free(&kit);
    text_free(&text);
}

/* h_row'' at the start with an angle or a rate moved */
static double start_acceleration(Kit *kit, int row, int column, const char *rate, double value)
{
    char text[80], name[20];

    (void)snprintf(text, sizeof text, "init h%d%s = %.17g\nassemble\n", column, rate, value);
    (void)snprintf(name, sizeof name, "h%d''", row);
    EXPECT_DONE(kit, text);
    return kit_value(kit, name);
}

/* of so many bodies that a run does without M written out */
static void a_long_chain_in_motion_has_the_slopes_of_its_accelerations(void)
{
    enum { COUNT_OF = 20 };
    static const int places[][2] = {{1, 1}, {2, 1}, {7, 8}, {12, 5}, {20, 20}, {19, 17}};
    Text text = {0};
    Kit kit = kit_new();
    double at[2][COUNT_OF];
    uint64_t seed = 11;

    add_points(&text, COUNT_OF);
    text_add(&text, "tree joint\n");
    for (int i = 0; i < COUNT_OF; i++) {
        at[0][i] = test_uniform(&seed, -0.3, 0.3);
        at[1][i] = test_uniform(&seed, -0.3, 0.3);
        text_addf(&text, "spring k%d h%d k=3 d=0.2\ninit h%d = %.17g, h%d' = %.17g\n", i + 1, i + 1,
                  i + 1, at[0][i], i + 1, at[1][i]);
    }
    text_add(&text, "linearize\n");
    EXPECT_DONE(&kit, text.at);
    for (size_t k = 0; k < sizeof places / sizeof places[0]; k++)
        for (int by = 0; by < 2; by++) {
            const int row = places[k][0], column = places[k][1];
            const char *rate = by == 0 ? "" : "'";
            const double h = 1e-4, was = at[by][column - 1];
            char entry[40];

            (void)snprintf(entry, sizeof entry, "linear.A(%d,%d)", COUNT_OF + row,
                           by * COUNT_OF + column);
            const double slope = kit_value(&kit, entry);
            const double ahead = start_acceleration(&kit, row, column, rate, was + h);
            const double back = start_acceleration(&kit, row, column, rate, was - h);

            (void)start_acceleration(&kit, row, column, rate, was);
            EXPECT_DONE(&kit, "linearize\n");
            EXPECT_NEAR(slope, (ahead - back) / (2 * h), 1e-4 * (1 + fabs(slope)));
        }
    kit_free(&kit);
    text_free(&text);
}

/* Pulled aside at its end, each rod stands along what it carries: tan = pull/weight below. */
static void a_long_chain_rests_along_what_it_carries(void)
{
    enum { COUNT_OF = 120 };
    Text text = {0};
    Kit kit = kit_new();
    double turned = 0;

    add_points(&text, COUNT_OF);
    text_addf(&text, "tree joint\nforce pull m%d [200, 0]\n", COUNT_OF);
    for (int i = 1; i <= COUNT_OF; i++)
        text_addf(&text, "init h%d = %g\n", i, 0.02 * (i % 3 - 1));
    text_add(&text, "equilibrium\n");
    EXPECT_DONE(&kit, text.at);
    for (int i = 1; i <= COUNT_OF; i++) {
        char name[20];

        (void)snprintf(name, sizeof name, "h%d", i);
        turned += kit_value(&kit, name);
        EXPECT_NEAR(turned, atan(200 / (9.81 * (COUNT_OF - i + 1))), 1e-9);
    }
    kit_free(&kit);
    text_free(&text);
}

int main(void)
{
    RUN(a_long_chain_has_the_modes_of_laguerre);
    RUN(a_long_chain_in_motion_has_the_slopes_of_its_accelerations);
    RUN(a_long_chain_rests_along_what_it_carries);
    return test_end();
}

/* test_rattleback.c: an ellipsoid that reverses its spin, against equations of its own
 *
 * In axes of the body, with the upward normal u, the angular velocity w and rho from the centre of
 * mass to the point of contact,
 *
 *     u' = -w x u,   rho = (0, 0, h) - A^2 u/|A u|,   v = -w x rho
 *     J w' + m rho x (w' x rho) = -w x J w + m rho x (w x v - w x rho' + g u)
 *
 * in fixed steps of Runge and Kutta. Figures of T. R. Kane and D. A. Levinson, Int. J. Non-Linear
 * Mech. 17 (1982), 175. */
#include "../family/vectors.h"
#include "session_kit.h"

#include <math.h>

#define G 9.81

typedef struct Stone {
    double mass, h, semiaxes[3];
    M inertia;
} Stone;

static const Stone stone = {
    1, 0.01, {0.2, 0.03, 0.02}, {{{2e-4, -2e-5, 0}, {-2e-5, 1.6e-3, 0}, {0, 0, 1.7e-3}}}};

/* rho, and its rate at the rate of u */
static V contact_from(V u, V u_rate, V *rate)
{
    double size = 0, growth = 0;
    V rho;

    for (int i = 0; i < 3; i++) {
        size += pow(stone.semiaxes[i] * u.at[i], 2);
        growth += pow(stone.semiaxes[i], 2) * u.at[i] * u_rate.at[i];
    }
    size = sqrt(size);
    for (int i = 0; i < 3; i++) {
        const double square = stone.semiaxes[i] * stone.semiaxes[i];

        rho.at[i] = -square * u.at[i] / size;
        rate->at[i] = -square * (u_rate.at[i] - u.at[i] * growth / (size * size)) / size;
    }
    rho.at[2] += stone.h;
    return rho;
}

/* a x = b by Cramer's rule */
static V solve(const M *a, V b)
{
    const V c[3] = {{{a->at[0][0], a->at[1][0], a->at[2][0]}},
                    {{a->at[0][1], a->at[1][1], a->at[2][1]}},
                    {{a->at[0][2], a->at[1][2], a->at[2][2]}}};
    const double whole = dot(c[0], cross(c[1], c[2]));

    return (V){{dot(b, cross(c[1], c[2])) / whole, dot(c[0], cross(b, c[2])) / whole,
                dot(c[0], cross(c[1], b)) / whole}};
}

static void rates(V u, V w, V *u_rate, V *w_rate)
{
    const V zero = {{0}};
    M whole = stone.inertia;
    V rho, rho_rate, v, push;

    *u_rate = plus(zero, -1, cross(w, u));
    rho = contact_from(u, *u_rate, &rho_rate);
    v = plus(zero, -1, cross(w, rho));
    push = plus(plus(cross(w, v), -1, cross(w, rho_rate)), G, u);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            whole.at[i][j] += stone.mass * ((i == j) * dot(rho, rho) - rho.at[i] * rho.at[j]);
    *w_rate = solve(&whole, plus(plus(zero, stone.mass, cross(rho, push)), -1,
                                 cross(w, apply(&stone.inertia, w))));
}

static void run(V *u, V *w, double time, int steps)
{
    const double h = time / steps, weight[4] = {h / 6, h / 3, h / 3, h / 6},
                 at[4] = {0, h / 2, h / 2, h};

    for (int i = 0; i < steps; i++) {
        V u_rate = {{0}}, w_rate = {{0}}, u_sum = *u, w_sum = *w;

        for (int k = 0; k < 4; k++) {
            rates(plus(*u, at[k], u_rate), plus(*w, at[k], w_rate), &u_rate, &w_rate);
            u_sum = plus(u_sum, weight[k], u_rate);
            w_sum = plus(w_sum, weight[k], w_rate);
        }
        *u = u_sum;
        *w = w_sum;
    }
}

static bool is_near(double got, double expected, double within)
{
    const bool near = fabs(got - expected) <= within * (1 + fabs(expected));

    if (!near)
        (void)fprintf(stderr, "%.15g, expected %.15g\n", got, expected);
    return near;
}

/* tilted by half a degree it is spun against its preference, rattles, and spins the other way */
static void a_rattleback_reverses(void)
{
    static const char *const ways[] = {"", "form embedded\n"};
    static const char *const own[3] = {"s.Wx", "s.Wy", "s.Wz"};
    const double tilt = 0.5 * M_PI / 180;
    V u = {{-sin(tilt), 0, cos(tilt)}}, w = {{0, 0, -5}};
    char text[500];

    run(&u, &w, 5, 200000);
    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();

        (void)snprintf(text, sizeof text,
                       "gravity [0, 0, -9.81]\n"
                       "body s mass=1 inertia=[2e-4, 1.6e-3, 1.7e-3, -2e-5, 0, 0]\n"
                       "arm hub s [0, 0, 0.01]\nroll r ground hub semiaxes=[0.2, 0.03, 0.02]\n"
                       "init s.x = 0, s.y = 0, s.q1 = 0, s.q2 = %.17g, s.q3 = 0\n"
                       "init s.Wx = 0, s.Wy = 0, s.Wz = -5\n",
                       sin(tilt / 2));
        EXPECT_DONE(&kit, text);
        EXPECT_DONE(&kit, ways[i]);
        EXPECT_DONE(&kit, "simulate 5 rtol=1e-12 atol=1e-13\n");
        for (int k = 0; k < 3; k++)
            EXPECT(is_near(kit_value(&kit, own[k]), w.at[k], 1e-8));
        EXPECT(kit_value(&kit, "s.Wz") > 4);
        EXPECT(
            is_near(kit_value(&kit, "energy.total"), kit_value(&kit, "energy.total at 0"), 1e-10));
        EXPECT(is_near(kit_value(&kit, "r.z"), 0, 1e-12));
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(a_rattleback_reverses);
    return test_end();
}

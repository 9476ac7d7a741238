/* test_contact.c: contacts that open and slip, in the plane and in space, against closed forms */
#include "session_kit.h"

#include "base/memory.h"
#include "base/text.h"

#define G 9.81
#define DISC                                                                                       \
    "scene planar; gravity [0, -9.81]\nbody disc mass=2 inertia=0.04\n"                            \
    "init disc.x = 0, disc.theta = 0, disc.y' = 0, disc.theta' = 0\n"
#define BLOCK                                                                                      \
    "scene planar; gravity [0, -9.81]\nbody block mass=2 inertia=2/12*(0.2^2 + 0.8^2)\n"           \
    "arm p block [-0.1, -0.4]; arm q block [0.1, -0.4]\n"
#define WIDE                                                                                       \
    "scene planar; gravity [0, -9.81]\nbody block mass=2 inertia=2/12*(0.2^2 + 0.8^2)\n"           \
    "arm p block [-0.4, -0.1]; arm q block [0.4, -0.1]\n"
#define BALL                                                                                       \
    "gravity [0, 0, -9.81]\nbody ball mass=2 inertia=[0.032, 0.032, 0.032] euler=zxz\n"            \
    "init ball.x = 0, ball.y = 0, ball.a1 = 0, ball.a2 = 1, ball.a3 = 0\n"
#define ROD "scene planar; gravity [0, -9.81]\nbody rod1 mass=1 inertia=1/3\narm p rod1 [-1, 0]\n"

static const char *const methods[] = {"dop853", "bdf", "radau", "adams"};

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within * (1 + fabs(expected));
}

/* the integral of f from 0 to 1, by Gauss's rule of five points in 40 parts */
static double integrate(double (*f)(double s, const double *at), const double *at)
{
    static const double x[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                               0.9061798459386640};
    static const double weight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                    0.4786286704993665, 0.2369268850561891};
    double sum = 0;

    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 5; k++)
            sum += weight[k] / 80 * f((i + (1 + x[k]) / 2) / 40, at);
    return sum;
}

/* The block rocks about p: I w'' = -m g R sin(alpha - theta). With theta = a (1 - s^2) the time to
 * theta = 0 is the integral of 2 a s/w over s. at: a, alpha, sqrt(m g R/I) */
static double rocking(double s, const double *at)
{
    const double theta = at[0] * (1 - s * s);

    return 2 * at[0] * s / (at[2] * sqrt(2 * (cos(at[1] - at[0]) - cos(at[1] - theta))));
}

/* A ladder of length 2: w^2 = 3/2 g (sin a - sin theta). With theta = a - (a - b) s^2 the time from
 * a to b is the integral of 2 (a - b) s/w. at: a, b */
static double sliding_down(double s, const double *at)
{
    const double way = at[0] - at[1], theta = at[0] - way * s * s;

    return 2 * way * s / sqrt(1.5 * G * (sin(at[0]) - sin(theta)));
}

/* a disc of m r^2/2 slides with 3 m/s: it rolls after v/(3 mu g), with two thirds of v */
static void a_disc_slides_and_then_rolls(void)
{
    const double mu = 0.2, v = 3, rolls = v / (3 * mu * G);
    const double way = v * rolls - mu * G * rolls * rolls / 2;

    for (int i = 0; i < COUNT(methods); i++)
        for (int is_roll = 0; is_roll < 2; is_roll++)
            for (int is_free = 0; is_free < 2; is_free++) {
                Kit kit = kit_new();
                char text[400];

                (void)snprintf(text, sizeof text,
                               DISC "%s c ground disc radius=0.2 mu=0.2\n%s"
                                    "init disc.y = 0.2, disc.x' = 3\n"
                                    "simulate 2 method=%s rtol=1e-11 atol=1e-11\n",
                               is_roll ? "roll" : "contact", is_free ? "tree absolute\n" : "",
                               methods[i]);
                EXPECT_DONE(&kit, text);
                EXPECT(is_near(kit_value(&kit, "disc.x"), way + 2 * v / 3 * (2 - rolls), 1e-8));
                EXPECT(is_near(kit_value(&kit, "disc.theta' "), -2 * v / 3 / 0.2, 1e-9));
                EXPECT(is_near(kit_value(&kit, "c.lost"), 2 * v * v / 2 / 3, 1e-8));
                EXPECT(is_near(kit_value(&kit, "c.fn"), 2 * G, 1e-12));
                EXPECT(is_near(kit_value(&kit, "c.ft"), 0, 1e-10));
                EXPECT(is_near(kit_value(&kit, "c.ft at 0.3"), -mu * 2 * G, 1e-12));
                EXPECT(is_near(kit_value(&kit, "c.bound at 0.3"), mu * 2 * G, 1e-12));
                kit_free(&kit);
            }
}

/* a block on a slope: its friction holds it up to the static bound, beyond it slides with the
 * kinetic one */
static void a_block_on_a_slope(void)
{
    static const double angle[] = {0.2, 0.345, 0.36, 0.5};
    const double mu = 0.3, ratio = 1.2;

    for (int i = 0; i < COUNT(angle); i++) {
        const bool slides = tan(angle[i]) > mu * ratio;
        const double a = slides ? G * (sin(angle[i]) - mu * cos(angle[i])) : 0;
        Kit kit = kit_new();
        char text[700];

        (void)snprintf(text, sizeof text,
                       "a = %.17g\n" WIDE "arm slope ground [0, 0] rotation=z(-a)\n"
                       "contact c1 slope p mu=0.3 static=1.2\ncontact c2 slope q mu=0.3 "
                       "static=1.2\ninit block.theta = -a, block.theta' = 0, block.x = 0, "
                       "block.x' = 0\ninit block.y = 0.1/cos(a), block.y' = 0\n"
                       "simulate 1.5\n",
                       angle[i]);
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "block.x"), a * 1.5 * 1.5 / 2 * cos(angle[i]), 1e-10));
        EXPECT(is_near(kit_value(&kit, "c1.fn + c2.fn"), 2 * G * cos(angle[i]), 1e-11));
        EXPECT(is_near(kit_value(&kit, "c1.ft + c2.ft"),
                       -2 * G * (slides ? mu * cos(angle[i]) : sin(angle[i])), 1e-11));
        /* the moment of what rubs at 0.1 m is that of the normal forces at 0.4 m */
        EXPECT(is_near(kit_value(&kit, "0.4*(c2.fn - c1.fn) + 0.1*(c1.ft + c2.ft)"), 0, 1e-10));
        kit_free(&kit);
    }
}

/* a coefficient that is a law: with a condition of its own, and below 0, where nothing rubs */
static void a_coefficient_is_a_law(void)
{
    static const struct {
        const char *mu;
        double speed;
    } laws[] = {{"if(p0 == 1, 0.2, 0.4)", 3 - 0.2 * G},
                {"if(p0 == 2, 0.2, 0.1)", 3 - 0.1 * G},
                {"0.3 - t", 3 - 0.3 * 0.3 * G / 2},
                {"0.2*t", 3 - 0.1 * G}};

    for (int i = 0; i < 2 * COUNT(laws); i++) {
        Kit kit = kit_new();
        char text[400];

        (void)snprintf(
            text, sizeof text,
            "p0 = 1\nscene planar; gravity [0, -9.81]\nbody m mass=2 inertia=0.1\n"
            "planarjoint j ground m\ncontact c ground m mu=%s%s\ninit j.s1 = 0, j.s2 = 0, "
            "j.theta = 0, j.s1' = -3, j.s2' = 0, j.theta' = 0\nsimulate 1 rtol=1e-11\n",
            laws[i / 2].mu, i % 2 == 0 ? "" : " static=1.3");
        EXPECT_DONE(&kit, text);
        EXPECT(is_near(kit_value(&kit, "j.s1'"), -laws[i / 2].speed, 1e-9));
        EXPECT(kit_value(&kit, "c.lost") > 0);
        kit_free(&kit);
    }
}

/* what stands on two corners isn't braced between them, and is held as long as both together can */
static void a_block_stands_on_two_corners(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, WIDE "contact c1 ground p mu=0.3\ncontact c2 ground q mu=0.3\n"
                           "force F block [t, 0]\ninit block.x = 0, block.y = 0.1, "
                           "block.theta = 0\ninit block.x' = 0, block.y' = 0, block.theta' = 0\n"
                           "simulate 7\n");
    EXPECT(fabs(kit_value(&kit, "c1.ft at 0")) < 1e-12);
    EXPECT(fabs(kit_value(&kit, "c2.ft at 0")) < 1e-12);
    EXPECT(is_near(kit_value(&kit, "c1.ft + c2.ft at 3"), -3, 1e-12));
    /* slides from 0.3*2 g = 5.886 N on */
    EXPECT(is_near(kit_value(&kit, "block.x at 5.8"), 0, 1e-12));
    EXPECT(is_near(kit_value(&kit, "block.x"), pow(7 - 0.6 * G, 3) / 6 / 2, 1e-8));
    kit_free(&kit);
}

/* a ladder without friction leaves the wall where its head is at 2/3 of its height */
static void a_ladder_leaves_the_wall(void)
{
    static const char *const trees[] = {"", "tree absolute\n", "tree absolute\nform embedded\n"};
    const double a = 70 * acos(-1.0) / 180, b = asin(2 * sin(a) / 3);
    const double leaves = integrate(sliding_down, (double[]){a, b});

    for (int i = 0; i < COUNT(trees); i++) {
        Kit kit = kit_new();
        char text[800];

        (void)snprintf(text, sizeof text,
                       "scene planar; gravity [0, -9.81]\nbody ladder mass=3 inertia=1\n"
                       "arm foot ladder [1, 0]; arm head ladder [-1, 0]\n"
                       "contact floor ground foot\ncontact wall ground head normal=x\n%s"
                       "init ladder.theta = -70 deg, ladder.x = cos(70 deg), "
                       "ladder.y = sin(70 deg)\n"
                       "init ladder.x' = 0, ladder.y' = 0, ladder.theta' = 0\n"
                       "simulate 0.9 rtol=1e-11\n",
                       trees[i]);
        EXPECT_DONE(&kit, text);
        (void)snprintf(text, sizeof text, "ladder.theta at %.17g", leaves);
        EXPECT(is_near(kit_value(&kit, text), -b, 1e-9));
        (void)snprintf(text, sizeof text, "wall.fn at %.17g", leaves - 1e-6);
        EXPECT(kit_value(&kit, text) > 0 && kit_value(&kit, text) < 1e-3);
        (void)snprintf(text, sizeof text, "wall.gap at %.17g", leaves + 1e-3);
        EXPECT(kit_value(&kit, text) > 0);
        (void)snprintf(text, sizeof text, "wall.fn at %.17g", leaves + 1e-6);
        EXPECT(kit_value(&kit, text) == 0);
        kit_free(&kit);
    }
}

/* a belt with 2 m/s takes a box along: friction loses as much as it gains */
static void a_belt_takes_a_box_along(void)
{
    const double same = 2 / (0.3 * G);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, WIDE "body belt mass=1 inertia=1\nprismatic s ground belt axis=x\n"
                           "driver D s = 2*t\ncontact c1 belt p mu=0.3\ncontact c2 belt q mu=0.3\n"
                           "init block.x = 0, block.y = 0.1, block.theta = 0\n"
                           "init block.x' = 0, block.y' = 0, block.theta' = 0\nsimulate 2\n");
    EXPECT(is_near(kit_value(&kit, "block.x'"), 2, 1e-12));
    EXPECT(is_near(kit_value(&kit, "block.x"), 4 - same, 1e-9));
    EXPECT(is_near(kit_value(&kit, "c1.lost + c2.lost"), 4, 1e-9));
    kit_free(&kit);
}

/* a box slides on four corners in a direction of its own, and comes to rest as a block does */
static void a_box_slides_on_four_corners(void)
{
    const double speed = hypot(1, 0.5), way = speed * speed / (2 * 0.3 * G);
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "gravity [0, 0, -9.81]\nbody b mass=2 inertia=[0.05, 0.06, 0.07]\n"
                      "arm a1 b [0.3, 0.2, -0.1]; arm a2 b [-0.3, 0.2, -0.1]\n"
                      "arm a3 b [-0.3, -0.2, -0.1]; arm a4 b [0.3, -0.2, -0.1]\n"
                      "contact c1 ground a1 mu=0.3\ncontact c2 ground a2 mu=0.3\n"
                      "contact c3 ground a3 mu=0.3\ncontact c4 ground a4 mu=0.3\n"
                      "init b.x = 0, b.y = 0, b.z = 0.1, b.q1 = 0, b.q2 = 0, b.q3 = 0\n"
                      "init b.x' = 1, b.y' = 0.5, b.z' = 0, b.wx = 0, b.wy = 0, b.wz = 0\n"
                      "simulate 1 rtol=1e-10\n");
    EXPECT(is_near(kit_value(&kit, "b.x"), way / speed, 1e-8));
    EXPECT(is_near(kit_value(&kit, "b.y"), 0.5 * way / speed, 1e-8));
    EXPECT(is_near(kit_value(&kit, "c1.fn + c2.fn + c3.fn + c4.fn"), 2 * G, 1e-10));
    EXPECT(is_near(kit_value(&kit, "c1.lost + c2.lost + c3.lost + c4.lost"), speed * speed, 1e-8));
    kit_free(&kit);
}

/* One impact: of a disc of m r^2/2 the slip s changes by 3 p/m where the friction's impulse is p.
 * It is that which stops s, or mu times the normal one, (1 + e) m v. */
static void friction_takes_part_in_an_impact(void)
{
    static const double mu[] = {0, 0.05, 0.3}, spin[] = {-20, 5, 40};
    const double e = 0.7, fall = sqrt(2 * G * 0.8), t = 0.99 * fall / G + 0.1;

    for (int i = 0; i < COUNT(mu); i++)
        for (int k = 0; k < COUNT(spin); k++) {
            const double normal = (1 + e) * 2 * fall, slip = 1.5 + 0.2 * spin[k];
            const double most = mu[i] * normal, stops = 2 * fabs(slip) / 3;
            const double p = copysign(fmin(most, stops), -slip);
            Kit kit = kit_new();
            char text[500];

            (void)snprintf(text, sizeof text,
                           DISC
                           "contact c ground disc radius=0.2 e=0.7 mu=%g\n"
                           "init disc.y = 1, disc.x' = 1.5, disc.theta' = %g\nsimulate %.17g\n",
                           mu[i], spin[k], t);
            EXPECT_DONE(&kit, text);
            EXPECT(is_near(kit_value(&kit, "disc.x'"), 1.5 + p / 2, 1e-10));
            EXPECT(is_near(kit_value(&kit, "disc.theta'"), spin[k] + 0.2 * p / 0.04, 1e-10));
            EXPECT(is_near(kit_value(&kit, "disc.y'"), e * fall - G * (t - fall / G), 1e-9));
            kit_free(&kit);
        }
}

/* Between floor and wall without friction each impact turns one component round. */
static void a_ball_in_a_corner(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, DISC "contact floor ground disc radius=0.2 e=0.5\n"
                           "contact wall ground disc radius=0.2 normal=x e=0.8\n"
                           "init disc.x = 0.7, disc.y = 1.2, disc.x' = -1\nsimulate 0.6\n");
    /* floor at sqrt(2/g) = 0.4515 s, wall at 0.5 s */
    EXPECT(is_near(kit_value(&kit, "disc.x'"), 0.8, 1e-12));
    EXPECT(is_near(kit_value(&kit, "disc.x"), 0.2 + 0.8 * 0.1, 1e-9));
    EXPECT(is_near(kit_value(&kit, "disc.y'"), 0.5 * sqrt(2 * G) - G * (0.6 - sqrt(2 / G)), 1e-9));
    kit_free(&kit);
}

static void a_ball_comes_to_rest(void)
{
    static const double e[] = {0.5, 0.8, 0.95};
    static const double rests[] = {1.35457092295719, 4.06371276887158, 17.6094219984435};

    for (int i = 0; i < COUNT(e); i++) {
        Kit kit = kit_new();
        const char *report;
        char text[300];

        (void)snprintf(text, sizeof text,
                       DISC "contact c ground disc radius=0.2 e=%g mu=0.3\n"
                            "init disc.y = 1.2, disc.x' = 0\nsimulate %g\n",
                       e[i], rests[i] + 1);
        EXPECT_DONE(&kit, text);
        report = strstr(ct_remarks(kit.session), "at rest from t = ");
        EXPECT(report != NULL);
        if (report != NULL)
            EXPECT(is_near(strtod(report + strlen("at rest from t = "), NULL), rests[i], 1e-8));
        EXPECT(is_near(kit_value(&kit, "c.fn"), 2 * G, 1e-11));
        EXPECT(fabs(kit_value(&kit, "c.gap")) < 1e-10);
        kit_free(&kit);
    }
}

/* rocking: the instant of the impact, and Housner's ratio of rates at it, 1 - 3/2 sin^2 alpha */
static void a_block_rocks(void)
{
    const double R = sqrt(0.1 * 0.1 + 0.4 * 0.4), alpha = atan2(0.1, 0.4), a = 0.1;
    const double inertia = 2.0 / 12 * (0.2 * 0.2 + 0.8 * 0.8) + 2 * R * R;
    const double rate = sqrt(2 * G * R / inertia),
                 fall = integrate(rocking, (double[]){a, alpha, rate});
    const double before = rate * sqrt(2 * (cos(alpha - a) - cos(alpha)));
    const double ratio = 1 - 1.5 * sin(alpha) * sin(alpha);
    Kit kit = kit_new();
    char text[80];

    EXPECT_DONE(&kit, BLOCK "contact c1 ground p mu=1\ncontact c2 ground q mu=1\n"
                            "init block.theta = 0.1, block.theta' = 0, c1.gap = 0\n"
                            "init block.x = 0, block.x' = 0, block.y' = 0\n"
                            "simulate 1 rtol=1e-11 atol=1e-12\n");
    (void)snprintf(text, sizeof text, "block.theta' at %.17g", fall * (1 - 1e-11));
    EXPECT(is_near(kit_value(&kit, text), -before, 1e-8));
    (void)snprintf(text, sizeof text, "block.theta at %.17g", fall);
    EXPECT(fabs(kit_value(&kit, text)) < 1e-9);
    (void)snprintf(text, sizeof text, "block.theta' at %.17g", fall + 1e-9);
    EXPECT(is_near(kit_value(&kit, text), -before * ratio, 1e-7));
    kit_free(&kit);
}

/* a sphere slides in any direction and then rolls: after 2 s/(7 mu g), s the slip at the start */
static void a_sphere_slides_and_then_rolls(void)
{
    const double mu = 0.2, r = 0.2;

    for (int i = 0; i < COUNT(methods); i++) {
        Kit kit = kit_new();
        char text[400];
        double vx, vy, wx, wy, sx, sy, slip, rolls;

        (void)snprintf(text, sizeof text,
                       BALL "contact c ground ball radius=0.2 mu=0.2\ninit ball.z = 0.2, "
                            "ball.z' = 0, ball.x' = 3, ball.y' = 1\ninit ball.a1' = 2, "
                            "ball.a2' = 1, ball.a3' = -3\n"
                            "simulate 2 method=%s rtol=1e-10 atol=1e-10\n",
                       methods[i]);
        EXPECT_DONE(&kit, text);
        wx = kit_value(&kit, "ball.wx at 0");
        wy = kit_value(&kit, "ball.wy at 0");
        sx = 3 - r * wy;
        sy = 1 + r * wx;
        slip = hypot(sx, sy);
        rolls = 2 * slip / (7 * mu * G);
        vx = 3 - mu * G * rolls * sx / slip;
        vy = 1 - mu * G * rolls * sy / slip;
        EXPECT(is_near(kit_value(&kit, "ball.x'"), vx, 1e-8));
        EXPECT(is_near(kit_value(&kit, "ball.y'"), vy, 1e-8));
        EXPECT(is_near(kit_value(&kit, "ball.wx"), -vy / r, 1e-8));
        EXPECT(is_near(kit_value(&kit, "ball.x"),
                       3 * rolls - mu * G * rolls * rolls / 2 * sx / slip + vx * (2 - rolls),
                       1e-7));
        EXPECT(is_near(kit_value(&kit, "c.fx at 0.1"), -mu * 2 * G * sx / slip, 1e-9));
        EXPECT(fabs(kit_value(&kit, "c.ft")) < 1e-8);
        kit_free(&kit);
    }
}

/* The same at an impact in space: of a sphere of 2/5 m r^2 the slip changes by 7/2 p/m. */
static void friction_takes_part_in_an_impact_in_space(void)
{
    static const double mu[] = {0.02, 0.5};
    const double e = 0.5, fall = sqrt(2 * G * 0.5), t = fall / G + 0.05;

    for (int i = 0; i < COUNT(mu); i++) {
        Kit kit = kit_new();
        char text[400];
        double sx, sy, slip, p;

        (void)snprintf(text, sizeof text,
                       BALL "contact c ground ball radius=0.2 e=0.5 mu=%g\ninit ball.z = 0.7, "
                            "ball.z' = 0, ball.x' = 3, ball.y' = 1\ninit ball.a1' = 2, "
                            "ball.a2' = 1, ball.a3' = -3\nsimulate %.17g rtol=1e-11\n",
                       mu[i], t);
        EXPECT_DONE(&kit, text);
        sx = 3 - 0.2 * kit_value(&kit, "ball.wy at 0");
        sy = 1 + 0.2 * kit_value(&kit, "ball.wx at 0");
        slip = hypot(sx, sy);
        p = fmin(mu[i] * (1 + e) * 2 * fall, 2 * 2 * slip / 7);
        EXPECT(is_near(kit_value(&kit, "ball.x'"), 3 - p / 2 * sx / slip, 1e-9));
        EXPECT(is_near(kit_value(&kit, "ball.y'"), 1 - p / 2 * sy / slip, 1e-9));
        EXPECT(is_near(kit_value(&kit, "ball.z'"), e * fall - G * 0.05, 1e-9));
        kit_free(&kit);
    }
}

/* Five equal discs in a row, without friction. Apart by a little each takes over the speed; in
 * contact all take part by Poisson's law: -3/5 and 2/5 of it (e = 1). */
static void balls_in_a_row(void)
{
    static const double apart[] = {1e-3, 0};

    for (int i = 0; i < 2; i++) {
        Kit kit = kit_new();
        Text text = {0};

        text_add(&text, "scene planar\n");
        for (int k = 1; k <= 5; k++) {
            text_addf(&text, "body b%d mass=0.3 inertia=1e-3\nprismatic s%d ground b%d axis=x\n", k,
                      k, k);
            text_addf(&text, "init s%d = %.17g, s%d' = %d\n", k,
                      k == 1 ? -0.3 : (k - 1) * (0.2 + apart[i]), k, k == 1 ? 2 : 0);
        }
        for (int k = 1; k < 5; k++)
            text_addf(&text, "contact c%d b%d b%d dome=0.1 radius=0.1 e=1\n", k, k, k + 1);
        text_add(&text, "simulate 1\n");
        EXPECT_DONE(&kit, text.at);
        EXPECT(is_near(kit_value(&kit, "s1'"), i == 0 ? 0 : -1.2, 1e-11));
        EXPECT(is_near(kit_value(&kit, "s3'"), i == 0 ? 0 : 0.8, 1e-11));
        EXPECT(is_near(kit_value(&kit, "s5'"), i == 0 ? 2 : 0.8, 1e-11));
        text_free(&text);
        kit_free(&kit);
    }
}

/* on a linear spring it stays for half a period and comes back with the same speed */
static void a_compliant_contact_pushes_only(void)
{
    const double w = sqrt(1e4 / 2), half = acos(-1.0) / w;
    Kit kit = kit_new();
    char text[300];

    (void)snprintf(text, sizeof text,
                   "scene planar\nbody m mass=2 inertia=0.1\nprismatic s ground m axis=y\n"
                   "contact c ground m k=1e4\ninit s = 0.1, s' = -1\nsimulate %.17g rtol=1e-11\n",
                   0.1 + half + 0.3);
    EXPECT_DONE(&kit, text);
    EXPECT(is_near(kit_value(&kit, "s'"), 1, 1e-8));
    EXPECT(is_near(kit_value(&kit, "s"), 0.3, 1e-8));
    EXPECT(kit_value(&kit, "c.fn") == 0);
    (void)snprintf(text, sizeof text, "c.fn at %.17g", 0.1 + half / 2);
    EXPECT(is_near(kit_value(&kit, text), 1e4 / w, 1e-8));
    kit_free(&kit);
}

/* A rod of half length 1 m slips with mu = 1.8 at theta = 1: its normal force would have to be
 * below 0 to keep it down (Painleve). */
static void a_rod_jams(void)
{
    Kit kit = kit_new();

    EXPECT_FAILS(&kit,
                 ROD "contact c ground p mu=1.8\n"
                     "init rod1.theta = 1, rod1.theta' = 0, c.gap = 0, rod1.x = 0\n"
                     "init rod1.x' = -3, rod1.y' = 0\nsimulate 1\n",
                 "no motion leads on");
    kit_free(&kit);
}

/* The same with mu = 0.5 slips: m y'' = N - m g with the acceleration of the point 0. */
static void a_rod_slips(void)
{
    const double th = 1, mu = 0.5, a = 1 + 3 * cos(th) * (cos(th) - mu * sin(th));
    Kit kit = kit_new();

    EXPECT_DONE(&kit, ROD "contact c ground p mu=0.5\n"
                          "init rod1.theta = 1, rod1.theta' = 0, c.gap = 0, rod1.x = 0\n"
                          "init rod1.x' = -3, rod1.y' = 0\nsimulate 0.01\n");
    EXPECT(is_near(kit_value(&kit, "c.fn at 0"), G / a, 1e-11));
    EXPECT(is_near(kit_value(&kit, "c.ft at 0"), mu * G / a, 1e-11));
    kit_free(&kit);
}

static void what_contact_refuses(void)
{
    static const struct {
        const char *text, *message;
    } wrong[] = {
        {"contact c ground m axle=z\n", "axle= has no effect without radius="},
        {"contact c ground m radius=-1\n", "radius"},
        {"contact c ground m e=1.5\n", "e=1.5 is not between 0 and 1"},
        {"contact c ground m e=0.5 k=1e4\n", "takes e= or k=, not both"},
        {"contact c ground m damping=1\n", "damping= has no effect without k="},
        {"contact c ground m exponent=1.5\n", "exponent= has no effect without k="},
        {"contact c ground m k=-1\n", "k"},
        {"contact c ground m static=1.2\n", "static= has no effect without mu="},
        {"contact c ground m mu=0.2 static=0.5\n", "the static coefficient is not below"},
        {"contact c ground m mu=-0.2\n", "mu"},
        {"contact c ground m bowl=1 dome=1 radius=0.1\n", "exclude each other"},
        {"contact c ground m bowl=0.1 radius=0.2\n", "the ball does not fit into the bowl"},
        {"contact c ground m normal=z\n", "it leaves the plane"},
        {"contact c ground m semiaxes=[1, 1, 1]\n", "an ellipsoid rolls in a spatial scene"},
        {"contact c ground nobody\n", "nobody"},
        {"contact c ground\n", "expected a place"},
        {"contact c ground m offset=1\n", "has no key 'offset'"},
        {"roll r ground m radius=0.1 mu=0.3 offset=1\n", "offset= and mu= exclude each other"},
        {"roll r ground m radius=0.1 static=1.2\n", "static= has no effect without mu="},
        {"roll r ground m mu=0.3\n", "needs its radius"},
    };

    for (int i = 0; i < COUNT(wrong); i++) {
        Kit kit = kit_new();

        EXPECT_DONE(&kit, "scene planar\nbody m mass=1 inertia=1\n");
        EXPECT_FAILS(&kit, wrong[i].text, wrong[i].message);
        kit_free(&kit);
    }
}

int main(void)
{
    RUN(a_disc_slides_and_then_rolls);
    RUN(a_block_on_a_slope);
    RUN(a_coefficient_is_a_law);
    RUN(a_block_stands_on_two_corners);
    RUN(a_ladder_leaves_the_wall);
    RUN(a_belt_takes_a_box_along);
    RUN(a_box_slides_on_four_corners);
    RUN(friction_takes_part_in_an_impact);
    RUN(a_ball_in_a_corner);
    RUN(a_ball_comes_to_rest);
    RUN(a_block_rocks);
    RUN(a_sphere_slides_and_then_rolls);
    RUN(friction_takes_part_in_an_impact_in_space);
    RUN(balls_in_a_row);
    RUN(a_compliant_contact_pushes_only);
    RUN(a_rod_jams);
    RUN(a_rod_slips);
    RUN(what_contact_refuses);
    return test_end();
}

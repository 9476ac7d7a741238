/* test_beams.c: how runs of elastic beams begin, and what they cost */
#include "session_kit.h"

static bool is_near(double got, double expected, double within)
{
    return fabs(got - expected) <= within;
}

/* A slider-crank whose rod is two welded beams of 0.2 m, with a told speed of the crank alone. */
static ct_status slider_crank(Kit *kit, const char *basis, const char *then)
{
    char text[1024];

    (void)snprintf(text, sizeof text,
                   "scene planar\nbody crank mass=1 inertia=1e-3\narm pin crank [0.1, 0]\n"
                   "beam a length=0.2 mass_per_length=0.4 EIz=20 modes=[0, 4] basis=%s\n"
                   "arm mid a at=0.2\n"
                   "beam b length=0.2 mass_per_length=0.4 EIz=20 modes=[0, 4] basis=%s\n"
                   "arm end b at=0.2\nbody slider mass=0.5 inertia=1e-3\n"
                   "revolute h1 ground crank\nrevolute h2 pin a\nweld w mid b\n"
                   "revolute h3 end slider\nprismatic s ground slider axis=x\n"
                   "init h1 = 90 deg, h1' = 40\nguess s = 0.4\n%s",
                   basis, basis, then);
    return kit_do(kit, text);
}

/* What a told speed leaves open is for the joints: the rod begins as a rigid one does, which at
 * this angle moves along its path without turning, 4 m/s with crank pin and slider. */
static void shapes_begin_at_rest_in_any_basis(void)
{
    static const char *const bases[] = {"legendre", "taylor", "chebyshev"};
    const double energy = 1e-3 * 40 * 40 / 2 + (0.4 * 0.4 + 0.5) * 4 * 4 / 2;

    for (int i = 0; i < 3; i++) {
        Kit kit = kit_new();

        EXPECT(slider_crank(&kit, bases[i], "assemble\n") == CT_OK);
        EXPECT(is_near(kit_value(&kit, "energy.kinetic at 0"), energy, 1e-9));
        EXPECT(kit_value(&kit, "a.v1' at 0") == 0);
        EXPECT(kit_value(&kit, "b.v4' at 0") == 0);
        EXPECT(is_near(kit_value(&kit, "s' at 0"), -4, 1e-9));
        kit_free(&kit);
    }
}

/* a told speed of a shape stays, and where nothing else can move, the shapes do */
static void shapes_move_where_they_are_told_or_have_to(void)
{
    Kit kit = kit_new();

    EXPECT(slider_crank(&kit, "legendre", "init a.v1' = 3\nassemble\n") == CT_OK);
    EXPECT(is_near(kit_value(&kit, "a.v1' at 0"), 3, 1e-12));
    EXPECT(kit_value(&kit, "b.v1' at 0") == 0);
    EXPECT_DONE(&kit, "clear\nscene planar\n"
                      "beam b length=1 mass_per_length=1 EIz=1 modes=[0, 2]\nweld w ground b\n"
                      "arm tip b at=1\ninit tip.vy = 2\nassemble\n");
    EXPECT(is_near(kit_value(&kit, "tip.vy at 0"), 2, 1e-9));
    kit_free(&kit);
}

/* nor do positions: a rod begins in its loop as bent as it is told, by one of its shapes alone */
static void shapes_that_are_not_told_stay_straight(void)
{
    Kit kit = kit_new();

    EXPECT(slider_crank(&kit, "taylor", "init a.v1 = 0.02\nassemble\n") == CT_OK);
    EXPECT(is_near(kit_value(&kit, "a.v1 at 0"), 0.02, 1e-15));
    EXPECT(kit_value(&kit, "a.v2 at 0") == 0);
    EXPECT(kit_value(&kit, "b.v1 at 0") == 0);
    EXPECT(is_near(kit_value(&kit, "slider.y at 0"), 0, 1e-12));
    kit_free(&kit);
}

static double steps_of(const Kit *kit)
{
    ct_figures figures;

    return ct_run_figures(kit->session, 0, &figures) ? (double)figures.steps : NAN;
}

/* An error of a shape counts by how far it bends the beam: its fastest modes, which hardly move
 * anything, don't set the steps of an implicit method. */
static void tolerances_are_of_deflections(void)
{
    Kit kit = kit_new();
    double place, speed;

    EXPECT(slider_crank(&kit, "legendre", "simulate 0.05 rtol=1e-8\n") == CT_OK);
    place = kit_value(&kit, "mid.y");
    speed = kit_value(&kit, "crank.theta'");
    EXPECT_DONE(&kit, "simulate 0.05 rtol=1e-4 method=radau\n");
    EXPECT(steps_of(&kit) < 2000); /* 3112 with the same for all coordinates */
    EXPECT(is_near(kit_value(&kit, "mid.y"), place, 2e-5));
    EXPECT(is_near(kit_value(&kit, "crank.theta'"), speed, 1e-3 * speed));
    kit_free(&kit);
}

/* additions and multiplications of M and F of a hinged beam, shared ones once in each of the two */
static double operations_of(int shapes)
{
    Kit kit = kit_new();
    char text[256];
    double add = NAN, multiply = NAN;
    const char *total;

    (void)snprintf(text, sizeof text,
                   "scene planar\nbeam b length=1.3 mass_per_length=2 EIz=100 modes=[0, %d]\n"
                   "revolute h ground b\ncount\n",
                   shapes);
    EXPECT_DONE(&kit, text);
    total = kit.text != NULL ? strstr(kit.text, "total") : NULL;
    if (total == NULL ||
        sscanf(total, "total %*f %*f %*f %lf %lf", &add, &multiply) != 2) /* NOLINT(cert-err34-c) */
        EXPECT(false);
    kit_free(&kit);
    return add + multiply;
}

/* 19.5 times for 4 times the shapes, since every entry of M is a sum of its own; 25 times 3249
 * where the shortening was formed by a sum over pairs at each of Gauss's points. */
static void operations_grow_little_faster_than_pairs_of_shapes(void)
{
    const double few = operations_of(4), many = operations_of(16);

    EXPECT(few < 1300);
    EXPECT(many < 24000);
    EXPECT(operations_of(8) < 4.2 * few);
}

/* x is the place along the beam, whatever else has that name inside or outside */
static void sections_vary_in_a_subsystem(void)
{
    Kit kit = kit_new();

    EXPECT_DONE(&kit, "scene planar\nx = 7\nsubsystem blade frames=[a]\nE = 100\nx = 3\n"
                      "beam b length=1 mass_per_length=2 - x EIz=E*(1 - x/2)^3 modes=[0, 3]"
                      " load=[0, t*x^2]\nweld w a b\nend\nuse blade one a=ground\n"
                      "use blade two a=ground E=400\nmodes\n");
    EXPECT(is_near(kit_value(&kit, "modes.omega(2)"), 2 * kit_value(&kit, "modes.omega(1)"), 1e-9));
    EXPECT_DONE(&kit, "simulate 1 rtol=1e-9 atol=1e-12\n");
    EXPECT(is_near(kit_value(&kit, "one.w.fy at 0"), 0, 1e-12));
    /* the load less what is left of momentum */
    EXPECT(fabs(kit_value(&kit, "one.b.v(1)") / kit_value(&kit, "two.b.v(1)") - 4) < 0.4);
    kit_free(&kit);
}

/* What a point of a beam does is the sum over its shapes, whose rates the run tells; and a rate
 * adds up to what has changed. */
static void points_have_rates(void)
{
    Kit kit = kit_new();
    double changed;

    EXPECT_DONE(&kit, "scene planar\ngravity [0, -9.81]\nbeam b length=1 mass_per_length=1 EA=1e4 "
                      "EIz=1 modes=[1, 3]\nrevolute h ground b\n"
                      "simulate 0.1 every=1e-4 rtol=1e-10 atol=1e-12\n");
    changed = kit_value(&kit, "b.v(0.7)") - kit_value(&kit, "b.v(0.7) at 0");
    EXPECT(fabs(changed) > 0.01);
    EXPECT(is_near(0.1 * kit_value(&kit, "mean(b.v(0.7)')"), changed, 1e-8));
    changed = kit_value(&kit, "b.v(0.7)'") - kit_value(&kit, "b.v(0.7)' at 0");
    EXPECT(is_near(0.1 * kit_value(&kit, "mean(b.v(0.7)'')"), changed, 1e-6));
    kit_free(&kit);
}

int main(void)
{
    RUN(points_have_rates);
    RUN(shapes_begin_at_rest_in_any_basis);
    RUN(shapes_move_where_they_are_told_or_have_to);
    RUN(shapes_that_are_not_told_stay_straight);
    RUN(tolerances_are_of_deflections);
    RUN(operations_grow_little_faster_than_pairs_of_shapes);
    RUN(sections_vary_in_a_subsystem);
    return test_end();
}

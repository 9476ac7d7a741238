/* test_surface_sides.c: directions in which surfaces with one bound are left */
#include "algebra/surface_sides.h"

#include "test.h"

#include <math.h>

enum { ROWS = 3 };

typedef struct Slip { /* a + B s */
    int n;
    double a[ROWS], b[ROWS][ROWS];
    bool has_loads;
} Slip;

static bool slip_at(void *context, const double *signs, double *out)
{
    const Slip *slip = context;

    for (int i = 0; i < slip->n; i++) {
        out[i] = slip->a[i];
        for (int k = 0; k < slip->n; k++)
            out[i] += slip->b[i][k] * signs[k];
    }
    return true;
}

static bool find(Slip *slip, SurfaceSide *at, bool insists)
{
    double room[SURFACE_SIDES_ROOM(ROWS)];
    int integers[SURFACE_SIDES_INTEGERS(ROWS)];

    for (int i = 0; i < slip->n && !slip->has_loads; i++) {
        at[i].left = 1;
        at[i].load = -1;
    }
    return surface_sides_find(at, slip->n, slip_at, slip, insists, 1, room, integers);
}

/* a mass of 1 on two directions, a bound of 5 on the force */
static Slip puck(double x, double y)
{
    return (Slip){2, {x, y}, {{-5, 0}, {0, -5}}, false};
}

static void a_load_within_the_bound_sticks(void)
{
    Slip slip = puck(3, 3.9);
    SurfaceSide at[2] = {{.bound = 1, .cone = 2}, {.bound = 1, .cone = -1}};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 0 && at[1].side == 0);
    EXPECT_NEAR(at[0].sign, 0.6, 1e-14);
    EXPECT_NEAR(at[1].sign, 0.78, 1e-14);
}

static void a_load_beyond_the_bound_slips_along_itself(void)
{
    Slip slip = puck(-6, 8);
    SurfaceSide at[2] = {{.bound = 1.5, .cone = 2}, {.bound = 1.5, .cone = -1}};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1 && at[1].side == 1);
    EXPECT_NEAR(at[0].sign, -0.6, 1e-14);
    EXPECT_NEAR(at[1].sign, 0.8, 1e-14);
}

/* two inertias: the acceleration, and not the load, is along the force */
static void a_body_of_two_inertias_slips_along_its_acceleration(void)
{
    Slip slip = {2, {6, 8}, {{-5, 0}, {0, -2}}, false};
    SurfaceSide at[2] = {{.bound = 1, .cone = 2}, {.bound = 1, .cone = -1}};
    double out[ROWS] = {0};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1);
    EXPECT_NEAR(hypot(at[0].sign, at[1].sign), 1, 1e-13);
    (void)slip_at(&slip, (double[ROWS]){at[0].sign, at[1].sign}, out);
    EXPECT_NEAR(out[0] * at[1].sign, out[1] * at[0].sign, 1e-12);
    EXPECT(out[0] * at[0].sign + out[1] * at[1].sign > 0);
}

static void a_bound_that_is_just_met_is_left_in_its_direction(void)
{
    Slip slip = puck(3, 4);
    SurfaceSide at[2] = {{.bound = 1, .cone = 2, .side = 1, .ends = true},
                         {.bound = 1, .cone = -1, .side = 1, .ends = true}};

    EXPECT(find(&slip, at, true));
    EXPECT(at[0].side == 1);
    EXPECT_NEAR(at[0].sign, 0.6, 1e-12);
    EXPECT_NEAR(at[1].sign, 0.8, 1e-12);
}

static void what_slips_already_keeps_its_direction(void)
{
    Slip slip = puck(0, 0);
    SurfaceSide at[2] = {{.bound = 1, .cone = 2, .off = -4}, {.bound = 1, .cone = -1, .off = 3}};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1 && at[1].side == 1);
    EXPECT_NEAR(at[0].sign, -0.8, 1e-14);
    EXPECT_NEAR(at[1].sign, 0.6, 1e-14);
}

/* a surface alone beside a cone: a brake that holds what the cone's bound can't */
static void a_surface_alone_is_found_with_a_cone(void)
{
    Slip slip = {3, {6, 8, 6}, {{-5, 0, -9}, {0, -5, 0}, {-5, 0, -9}}, false};
    SurfaceSide at[3] = {{.bound = 1, .cone = 2}, {.bound = 1, .cone = -1}, {.bound = 1}};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1 && at[2].side == 0);
    EXPECT_NEAR(at[0].sign, 0, 1e-10);
    EXPECT_NEAR(at[1].sign, 1, 1e-10);
    EXPECT_NEAR(at[2].sign, 2.0 / 3, 1e-10);
}

/* A block of mass 2 on a plane: 0 is the contact with h = -y, 1 and 2 are its friction. */
static Slip block(double x, double y)
{
    return (Slip){3, {x, 9.81, y}, {{-0.5, 0, 0}, {0, -0.5, 0}, {0, 0, -0.5}}, .has_loads = true};
}

static SurfaceSide friction_of(int load, int cone)
{
    return (SurfaceSide){.bound = 0.3, .left = 0.2, .load = load, .cone = cone};
}

static SurfaceSide normal(void)
{
    return (SurfaceSide){.is_unilateral = true, .left = 1, .load = -1};
}

/* mu N = 0.2*19.62: a = x - 0.2*9.81 beyond 0.3*9.81 */
static void friction_is_bounded_by_its_load(void)
{
    Slip slip = {2, {2.9, 9.81}, {{-0.5, 0}, {0, -0.5}}, .has_loads = true};
    SurfaceSide sticks[2] = {friction_of(1, 0), normal()},
                slides[2] = {friction_of(1, 0), normal()};

    EXPECT(find(&slip, sticks, false));
    EXPECT(sticks[0].side == 0 && sticks[1].side == 0);
    EXPECT_NEAR(sticks[0].sign, 5.8, 1e-13);
    EXPECT_NEAR(sticks[1].sign, 19.62, 1e-13);
    slip.a[0] = 3;
    EXPECT(find(&slip, slides, false));
    EXPECT(slides[0].side == 1 && slides[1].side == 0);
    EXPECT_NEAR(slides[0].sign, 3.924, 1e-13);
}

/* a rod that slips with friction which presses it on: N (1 - 0.2 mu') = 10 */
static void friction_changes_its_own_load(void)
{
    Slip slip = {2, {6, 10}, {{-1, 0}, {1, -1}}, .has_loads = true};
    SurfaceSide at[2] = {friction_of(1, 0), normal()};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1);
    EXPECT_NEAR(at[1].sign, 12.5, 1e-12);
    EXPECT_NEAR(at[0].sign, 2.5, 1e-12);
}

static void what_opens_has_no_friction(void)
{
    Slip slip = {2, {3, -1}, {{-1, 0}, {0, -1}}, .has_loads = true};
    SurfaceSide at[2] = {friction_of(1, 0), normal()};

    EXPECT(find(&slip, at, false));
    EXPECT(at[1].side == -1);
    EXPECT_NEAR(at[0].sign, 0, 1e-14);
}

static void friction_in_a_plane_is_bounded_by_its_load(void)
{
    Slip slip = block(1.8, 2.4);
    SurfaceSide at[3] = {friction_of(1, 0), normal(), friction_of(1, 0)};
    Slip turned = {
        3, {1.8, 2.4, 9.81}, {{-0.5, 0, 0}, {0, -0.5, 0}, {0, 0, -0.5}}, .has_loads = true};
    SurfaceSide cone[3] = {friction_of(2, 2), friction_of(2, -1), normal()};

    EXPECT(find(&slip, at, false)); /* each alone is within its bound, */
    EXPECT(at[0].side == 0 && at[2].side == 0);
    EXPECT(find(&turned, cone, false)); /* both together are not */
    EXPECT(cone[0].side == 1 && cone[2].side == 0);
    EXPECT_NEAR(cone[0].sign, 0.6, 1e-10);
    EXPECT_NEAR(cone[1].sign, 0.8, 1e-10);
    EXPECT_NEAR(cone[2].sign, 19.62, 1e-10);
}

int main(void)
{
    RUN(a_load_within_the_bound_sticks);
    RUN(a_load_beyond_the_bound_slips_along_itself);
    RUN(a_body_of_two_inertias_slips_along_its_acceleration);
    RUN(a_bound_that_is_just_met_is_left_in_its_direction);
    RUN(what_slips_already_keeps_its_direction);
    RUN(a_surface_alone_is_found_with_a_cone);
    RUN(friction_is_bounded_by_its_load);
    RUN(friction_changes_its_own_load);
    RUN(what_opens_has_no_friction);
    RUN(friction_in_a_plane_is_bounded_by_its_load);
    return test_end();
}

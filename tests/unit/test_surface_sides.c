/* test_surface_sides.c: directions in which surfaces with one bound are left */
#include "algebra/surface_sides.h"

#include "test.h"

#include <math.h>

enum { ROWS = 3 };

typedef struct Slip { /* a + B s */
    int n;
    double a[ROWS], b[ROWS][ROWS];
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

    return surface_sides_find(at, slip->n, slip_at, slip, insists, 1, room, integers);
}

/* a mass of 1 on two directions, a bound of 5 on the force */
static Slip puck(double x, double y)
{
    return (Slip){2, {x, y}, {{-5, 0}, {0, -5}}};
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
    Slip slip = {2, {6, 8}, {{-5, 0}, {0, -2}}};
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
    Slip slip = {3, {6, 8, 6}, {{-5, 0, -9}, {0, -5, 0}, {-5, 0, -9}}};
    SurfaceSide at[3] = {{.bound = 1, .cone = 2}, {.bound = 1, .cone = -1}, {.bound = 1}};

    EXPECT(find(&slip, at, false));
    EXPECT(at[0].side == 1 && at[2].side == 0);
    EXPECT_NEAR(at[0].sign, 0, 1e-10);
    EXPECT_NEAR(at[1].sign, 1, 1e-10);
    EXPECT_NEAR(at[2].sign, 2.0 / 3, 1e-10);
}

int main(void)
{
    RUN(a_load_within_the_bound_sticks);
    RUN(a_load_beyond_the_bound_slips_along_itself);
    RUN(a_body_of_two_inertias_slips_along_its_acceleration);
    RUN(a_bound_that_is_just_met_is_left_in_its_direction);
    RUN(what_slips_already_keeps_its_direction);
    RUN(a_surface_alone_is_found_with_a_cone);
    return test_end();
}

/* test_joints.c: what the steps of each joint make of its coordinates, and what joints refuse
 *
 * A pose is the position r and the rotation R (row by row, head to tail) at the end of the
 * steps. They are put together here by Rodrigues' formula and compared with matrices
 * written down by hand. */
#include "test_model.h"

typedef struct Pose {
    double r[3];
    double R[9];
} Pose;

static void times(const double A[9], const double B[9], double out[9])
{
    for (int i = 0; i < 9; i++) {
        out[i] = 0;
        for (int k = 0; k < 3; k++)
            out[i] += A[i / 3 * 3 + k] * B[3 * k + i % 3];
    }
}

/* about u by a: R = 1 + sin a S + (1 - cos a) S^2 */
static void turn(const double u[3], double a, double R[9])
{
    const double S[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    double square[9];

    times(S, S, square);
    for (int i = 0; i < 9; i++)
        R[i] = (i % 4 == 0) + sin(a) * S[i] + (1 - cos(a)) * square[i];
}

/* of unit length: (p0^2 - e.e) 1 + 2 e e^T + 2 p0 S(e) */
static void parameters(const double p[4], double R[9])
{
    double e = p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    const double S[9] = {0, -p[3], p[2], p[3], 0, -p[1], -p[2], p[1], 0};

    for (int i = 0; i < 9; i++)
        R[i] = (i % 4 == 0) * (p[0] * p[0] - e) + 2 * p[1 + i / 3] * p[1 + i % 3] + 2 * p[0] * S[i];
}

static void axis_of(const Model *model, const Step *step, double u[3])
{
    for (int i = 0; i < 3; i++)
        u[i] = model_number(model, step->axis[i]);
}

static Steps steps_of(const Model *model, const char *name)
{
    const Instance *part = model_find(model, name);
    Steps steps;

    part->row->steps(part, model_arena(model), model_is_planar(model), &steps);
    return steps;
}

static Pose pose_at(const Model *model, const char *name, const double q[])
{
    Steps steps = steps_of(model, name);
    Pose pose = {{0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    double u[3];

    for (int k = 0; k < steps.shift_count; k++) {
        const Step *shift = &steps.shift[k];

        axis_of(model, shift, u);
        for (int i = 0; i < 3; i++)
            pose.r[i] += model_number(model, shift->scale) * q[shift->coordinate] * u[i];
    }
    for (int k = 0; k < steps.turn_count; k++) {
        const Step *step = &steps.turn[k];
        Pose before = pose;
        double R[9];

        axis_of(model, step, u);
        turn(u, model_number(model, step->scale) * q[step->coordinate], R);
        times(before.R, R, pose.R);
    }
    if (steps.quaternion)
        parameters(q + steps.first_parameter, pose.R);
    return pose;
}

static void expect_pose(Pose got, const double r[3], const double R[9])
{
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(got.r[i], r[i], 1e-14);
    for (int i = 0; i < 9; i++)
        EXPECT_NEAR(got.R[i], R[i], 1e-14);
}

/* --- halves --- */

/* theory 2: coordinates of each half, and freedoms */
static const struct {
    const char *text;
    int shifts, turns;
    bool quaternion;
    int freedom[2];
    const char *coordinates;
} halves[] = {
    {"revolute j a b", 0, 1, false, {0, 1}, " j"},
    {"prismatic j a b", 1, 0, false, {1, 0}, " j"},
    {"cylindrical j a b", 1, 1, false, {1, 1}, " j.s j.theta"},
    {"universal j a b", 0, 2, false, {0, 2}, " j.a1 j.a2"},
    {"spherical j a b", 0, 0, true, {0, 3}, " j.q0 j.q1 j.q2 j.q3"},
    {"spherical j a b euler=xyz", 0, 3, false, {0, 3}, " j.a1 j.a2 j.a3"},
    {"screw j a b pitch=1", 1, 1, false, {1, 1}, " j.theta"},
    {"planarjoint j a b", 2, 1, false, {2, 1}, " j.s1 j.s2 j.theta"},
    {"weld j a b", 0, 0, false, {0, 0}, ""},
    {"free j a b", 3, 0, true, {3, 3}, " j.x j.y j.z j.q0 j.q1 j.q2 j.q3"},
    {"free j a b euler=zyx", 3, 3, false, {3, 3}, " j.x j.y j.z j.a1 j.a2 j.a3"},
    {"body j mass=1", 3, 0, true, {3, 3}, " j.x j.y j.z j.q0 j.q1 j.q2 j.q3"},
    {"body j mass=1 euler=zxz", 3, 3, false, {3, 3}, " j.x j.y j.z j.a1 j.a2 j.a3"},
};

static Model *model_with(const char *statement)
{
    Text text = {0};
    Model *model;

    text_addf(&text, "body a mass=1\nbody b mass=1\n%s", statement);
    model = model_of(text.at);
    text_free(&text);
    return model;
}

static void each_half_has_its_freedoms(void)
{
    for (int i = 0; i < COUNT(halves); i++) {
        Model *model = model_with(halves[i].text);
        const Instance *j = model_find(model, "j");
        Steps steps = steps_of(model, "j");
        Text names = {0};
        int freedom[2];
        int count;

        steps_freedom(&steps, freedom);
        EXPECT(steps.shift_count == halves[i].shifts && steps.turn_count == halves[i].turns);
        EXPECT(steps.quaternion == halves[i].quaternion);
        EXPECT(freedom[0] == halves[i].freedom[0] && freedom[1] == halves[i].freedom[1]);
        (void)instance_coords(j, false, &count);
        EXPECT(count == j->coord_count);
        text_add(&names, "");
        for (int c = 0; c < count; c++)
            text_addf(&names, " %s", j->coord[c]);
        EXPECT_TEXT(names.at, halves[i].coordinates);
        text_free(&names);
        model_free(model);
    }
}

/* a coordinate belongs to the half whose step it moves; a screw's one to the rotation */
static void coordinates_belong_to_the_half_of_their_step(void)
{
    for (int i = 0; i < COUNT(halves); i++) {
        Model *model = model_with(halves[i].text);
        const Instance *j = model_find(model, "j");
        Steps steps = steps_of(model, "j");

        for (int k = 0; k < steps.turn_count; k++)
            EXPECT(j->coord_rotation[steps.turn[k].coordinate] &&
                   j->coord_kind[steps.turn[k].coordinate] == COORDINATE_ANGLE);
        for (int k = 0; k < steps.shift_count; k++)
            EXPECT(j->coord_rotation[steps.shift[k].coordinate] ==
                   (strcmp(j->row->name, "screw") == 0));
        for (int k = 0; steps.quaternion && k < 4; k++)
            EXPECT(j->coord_kind[steps.first_parameter + k] == COORDINATE_PARAMETER);
        model_free(model);
    }
}

static void virtual_joints_enter_trees_where_they_are_free(void)
{
    for (int i = 0; i < COUNT(halves); i++) {
        Text text = {0};
        Model *model;
        const Instance *j;

        if (strncmp(halves[i].text, "body", 4) == 0)
            continue;
        text_addf(&text, "virtual %s", halves[i].text);
        model = model_with(text.at);
        j = model_find(model, "j");
        EXPECT(j->is_virtual);
        for (int half = 0; half < 2; half++)
            EXPECT(graph_edge(model_graph(model), j->edge)->branching[half] ==
                   (halves[i].freedom[half] > 0 ? BRANCH_UNCHOSEN : BRANCH_NEVER));
        EXPECT_BRANCHES(model, TREE_TRANSLATION, "a b");
        EXPECT_BRANCHES(model, TREE_ROTATION, "a b");
        model_free(model);
        text_free(&text);
    }
}

static void screws_are_branches_of_both_trees_or_of_none(void)
{
    Model *model = model_of("body a mass=1\nbody b mass=1\nrevolute h ground a\n"
                            "prismatic p a b axis=x\nscrew s ground b pitch=1\n"
                            "screw r ground a pitch=2\nscrew w a b pitch=3");

    EXPECT_BRANCHES(model, TREE_TRANSLATION, "s r");
    EXPECT_BRANCHES(model, TREE_ROTATION, "s r");
    model_free(model);
}

/* --- poses --- */

static void cylindrical_joints_shift_and_turn_by_themselves(void)
{
    Model *model = model_of("body b mass=1\ncylindrical j ground b axis=-y\n"
                            "cylindrical k ground b axis=[1, 2, 2]\ncylindrical l ground b");
    double s = sin(0.7);
    double c = cos(0.7);
    const double q[] = {0.3, 0.7};
    Pose k = pose_at(model, "k", q);

    expect_pose(pose_at(model, "j", q), (double[]){0, -0.3, 0},
                (double[]){c, 0, -s, 0, 1, 0, s, 0, c});
    expect_pose(pose_at(model, "l", q), (double[]){0, 0, 0.3},
                (double[]){c, -s, 0, s, c, 0, 0, 0, 1});
    /* the axis stays, the trace is 1 + 2 cos, the skew part sin times the axis */
    for (int i = 0; i < 3; i++) {
        double u[] = {1 / 3., 2 / 3., 2 / 3.};

        EXPECT_NEAR(k.r[i], 0.3 * u[i], 1e-15);
        EXPECT_NEAR(k.R[3 * i] * u[0] + k.R[3 * i + 1] * u[1] + k.R[3 * i + 2] * u[2], u[i], 1e-15);
        EXPECT_NEAR(k.R[(i + 2) % 3 * 3 + (i + 1) % 3] - k.R[(i + 1) % 3 * 3 + (i + 2) % 3],
                    2 * s * u[i], 1e-15);
    }
    EXPECT_NEAR(k.R[0] + k.R[4] + k.R[8], 1 + 2 * c, 1e-15);
    model_free(model);
}

static void universal_joints_turn_about_the_tails_axis_first(void)
{
    Model *model =
        model_of("p = 0.4\nbody b mass=1\nuniversal j ground b\n"
                 "universal k ground b axes=[-x, -y] coords=[eta, beta]\n"
                 "universal m ground b axes=[[cos(p), sin(p), 0], [-sin(p), cos(p), 0]]\n"
                 "universal n ground b axes=[[p, 2, 0], [-2, p, 0]]");
    const double q[] = {0.5, -1.1};
    double sa = sin(q[0]);
    double ca = cos(q[0]);
    double sb = sin(q[1]);
    double cb = cos(q[1]);
    const double zero[3] = {0};
    const double z_turn[] = {cos(0.4), -sin(0.4), 0, sin(0.4), cos(0.4), 0, 0, 0, 1};
    const double z_back[] = {cos(0.4), sin(0.4), 0, -sin(0.4), cos(0.4), 0, 0, 0, 1};
    const double xy[] = {cb, 0, sb, sa * sb, ca, -sa * cb, -ca * sb, sa, ca * cb};
    double R[9];
    double turned[9];

    expect_pose(pose_at(model, "j", q), zero, xy);
    expect_pose(pose_at(model, "k", q), zero,
                (double[]){cb, 0, -sb, sa * sb, ca, sa * cb, ca * sb, -sa, ca * cb});
    EXPECT_TEXT(model_find(model, "k")->coord[1], "beta");
    /* m is j in axes turned about z */
    times(z_turn, xy, R);
    times(R, z_back, turned);
    expect_pose(pose_at(model, "m", q), zero, turned);
    model_free(model);
}

/* theory 2: shift u h theta/(2 pi), turn u theta */
static void screws_shift_by_their_pitch_in_a_turn(void)
{
    Model *model = model_of("h = 0.02\nbody b mass=1\nscrew j ground b pitch=h axis=x\n"
                            "screw k ground b pitch=-5 mm axis=y coord=phi");
    const double turns[] = {2 * M_PI * 3};
    const double part[] = {0.9};
    double s = sin(0.9);
    double c = cos(0.9);

    expect_pose(pose_at(model, "j", turns), (double[]){0.06, 0, 0},
                (double[]){1, 0, 0, 0, 1, 0, 0, 0, 1});
    expect_pose(pose_at(model, "j", part), (double[]){0.02 * 0.9 / (2 * M_PI), 0, 0},
                (double[]){1, 0, 0, 0, c, -s, 0, s, c});
    expect_pose(pose_at(model, "k", part), (double[]){0, -0.005 * 0.9 / (2 * M_PI), 0},
                (double[]){c, 0, s, 0, 1, 0, -s, 0, c});
    EXPECT_TEXT(model_find(model, "k")->coord[0], "phi");
    model_free(model);
}

/* --- sequences --- */

static const char *const sequences[] = {"zxz", "zyz", "xyx", "xzx", "yxy", "yzy",
                                        "xyz", "xzy", "yxz", "yzx", "zxy", "zyx"};

static void elementary(char axis, double a, double R[9])
{
    const double x[] = {1, 0, 0, 0, cos(a), -sin(a), 0, sin(a), cos(a)};
    const double y[] = {cos(a), 0, sin(a), 0, 1, 0, -sin(a), 0, cos(a)};
    const double z[] = {cos(a), -sin(a), 0, sin(a), cos(a), 0, 0, 0, 1};

    memcpy(R, axis == 'x' ? x : axis == 'y' ? y : z, 9 * sizeof *R);
}

static void twelve_sequences_turn_about_their_axes_in_order(void)
{
    const double q[] = {0.4, 0.5, 0.6, 1.2, -0.7, 2.3};
    uint64_t random = 3;

    for (int i = 0; i < COUNT(sequences); i++) {
        Text text = {0};
        Model *model;
        double R[4][9];
        double angle[6];
        const char *axes = sequences[i];

        for (int k = 0; k < 3; k++)
            angle[k] = q[k];
        for (int k = 0; k < 3; k++) {
            angle[3 + k] = test_uniform(&random, -3, 3);
            elementary(axes[k], angle[3 + k], R[k]);
        }
        times(R[0], R[1], R[3]);
        times(R[3], R[2], R[0]);
        text_addf(&text,
                  "body b mass=1 euler=%s\nspherical s ground b euler=%s\n"
                  "free f ground b euler=%s",
                  axes, axes, axes);
        model = model_of(text.at);
        expect_pose(pose_at(model, "s", angle + 3), (double[]){0, 0, 0}, R[0]);
        expect_pose(pose_at(model, "f", angle), q, R[0]);
        expect_pose(pose_at(model, "b", angle), q, R[0]);
        model_free(model);
        text_free(&text);
    }
}

/* Goldstein's x convention, transposed (body to space) */
static void euler_angles_are_the_classical_ones(void)
{
    Model *model = model_of("body b mass=1\nspherical s ground b euler=zxz");
    const double q[] = {0.3, 0.8, -1.3};
    double sf = sin(q[0]), cf = cos(q[0]);
    double st = sin(q[1]), ct = cos(q[1]);
    double sp = sin(q[2]), cp = cos(q[2]);

    expect_pose(pose_at(model, "s", q), (double[]){0, 0, 0},
                (double[]){cp * cf - ct * sf * sp, -sp * cf - ct * sf * cp, st * sf,
                           cp * sf + ct * cf * sp, -sp * sf + ct * cf * cp, -st * cf, sp * st,
                           cp * st, ct});
    model_free(model);
}

/* scalar part first: cos and sin of half the angle */
static void parameters_come_first_where_nothing_is_said(void)
{
    Model *model = model_of("body b mass=1\nspherical s ground b\nfree f ground b");
    const double q[] = {1, 2, 3, cos(0.35), 0, sin(0.35), 0};
    double c = cos(0.7);
    double s = sin(0.7);
    const double R[] = {c, 0, s, 0, 1, 0, -s, 0, c};

    EXPECT(steps_of(model, "s").first_parameter == 0);
    EXPECT(steps_of(model, "f").first_parameter == 3);
    expect_pose(pose_at(model, "s", q + 3), (double[]){0, 0, 0}, R);
    expect_pose(pose_at(model, "f", q), q, R);
    expect_pose(pose_at(model, "b", q), q, R);
    model_free(model);
}

/* --- what is refused --- */

/* clang-format off */
static const struct {
    const char *text;
    int column;
    const char *message;
    const char *hint;
} wrong[] = {
    {"universal q a b axes=x",               22, "axes are two axes", "axes=[x, y]"},
    {"universal q a b axes=[x, y, z]",       22, "axes are two axes", ""},
    {"universal q a b axes=[x, [0, 0, 0]]",  26, "axes is zero", ""},
    {"universal q a b axes=[x, x]",          22, "the axes of q stand at 0 deg", "square arms"},
    {"universal q a b axes=[x, [1, 1, 0]]",  22, "the axes of q stand at 45 deg", "square arms"},
    {"universal q a b axes=[x, [p, 1, 0]]",  22, "the axes of q stand at 45 deg", "square arms"},
    {"universal q a b axis=x",               17, "'universal' has no key 'axis'", "axes"},
    {"universal q a b coord=c1",             17, "'universal' has no key 'coord'", "coords"},
    {"universal q a b coords=[c1]",          24, "universal has 2 coordinates, 1 named", "coords="},
    {"cylindrical q a b axes=[x, y]",        19, "'cylindrical' has no key 'axes'", "axis"},
    {"cylindrical q a b axis=[0, 0, 0]",     24, "axis is zero", ""},
    {"screw q a b",                          12, "screw q needs pitch=", "one full turn"},
    {"screw q a b pitch=5 deg",              21, "m expected for pitch, got deg", ""},
    {"screw q a b pitch=5 [mm/rev]",         21, "m expected for pitch, got [mm/rev]", ""},
    {"screw q a b pitch=1 coords=[c1, c2]",  21, "'screw' has no key 'coords'", "coord"},
    {"spherical q a b euler=zzx",            23, "euler= is one of parameters|zxz|", ""},
    {"spherical q a b euler=3",              23, "euler= is one of parameters|zxz|", ""},
    {"spherical q a b coords=[c1, c2, c3]",  24, "spherical has 4 coordinates, 3 named", ""},
    {"spherical q a b euler=xyz coords=[c1, c2, c3, c4]", 34, "spherical has 3 coordinates, 4 named", ""},
    {"spherical q a b axis=x",               17, "'spherical' has no key 'axis'", "euler"},
    {"driver q s.q0 = t",                    10, "s.q0 is an Euler parameter", ""},
    {"driver q r.q1 = t",                    10, "spherical r has no variable 'q1'", ""},
    {"body q mass=q.a1 euler=xyz",           13, "body q has no variable 'a1'", ""},
    {"set s.euler = xyz",                     5, "s.euler decides which coordinates s has", "delete s"},
    {"set f.euler = parameters",              5, "f.euler decides which coordinates f has", "delete f"},
    {"set u.axes = [x, x]",                   0, "the axes of u stand at 0 deg", ""},
    {NULL, 0, NULL, NULL},
}, wrong_in_plane[] = {
    {"cylindrical q a b axis=x",              1, "a cylindrical joint leaves the plane", "revolute or prismatic"},
    {"universal q a b",                       1, "a universal joint leaves the plane", "revolute serves"},
    {"spherical q a b euler=zyx",             1, "a spherical joint leaves the plane", "revolute serves"},
    {"screw q a b pitch=1",                   1, "a screw joint leaves the plane", "revolute or prismatic"},
    {"virtual spherical q a b",               9, "a spherical joint leaves the plane", "revolute serves"},
    {"body q mass=1 euler=zxz",              21, "q turns about z alone", "spatial scenes"},
    {"free q a b euler=zxz",                 18, "q turns about z alone", "spatial scenes"},
    {"set a.euler = zxz",                     0, "a turns about z alone", "spatial scenes"},
    {NULL, 0, NULL, NULL},
};
/* clang-format on */

static void expect_refused(const char *base, const char *text, int column, const char *message,
                           const char *hint)
{
    Model *model = model_of(base);
    Diag diag = {0};
    bool right = apply_text(model, text, &diag) != OK && strstr(diag.message, message) != NULL &&
                 strstr(diag.hint, hint) != NULL && (column == 0 || diag.place.column == column);

    EXPECT(right);
    if (!right)
        printf("  %s\n  %d: %s (%s)\n", text, diag.place.column, diag.message, diag.hint);
    model_free(model);
}

static void wrong_joints_are_refused_where_they_are_wrong(void)
{
    for (int i = 0; wrong[i].text != NULL; i++)
        expect_refused("p = 1\nbody a mass=1\nbody b mass=1\nspherical s ground a\n"
                       "spherical r ground b euler=zxz\nfree f a b euler=zyx\nuniversal u a b",
                       wrong[i].text, wrong[i].column, wrong[i].message, wrong[i].hint);
    for (int i = 0; wrong_in_plane[i].text != NULL; i++)
        expect_refused("scene planar\nbody a mass=1\nbody b mass=1", wrong_in_plane[i].text,
                       wrong_in_plane[i].column, wrong_in_plane[i].message, wrong_in_plane[i].hint);
}

static void sequences_of_a_kind_can_be_changed(void)
{
    Model *model = model_of("body b mass=1 euler=zxz\nset b.euler = xyz");
    double u[3];
    Steps steps = steps_of(model, "b");

    axis_of(model, &steps.turn[0], u);
    EXPECT(u[0] == 1 && u[2] == 0);
    EXPECT_TEXT(model_find(model, "b")->coord[3], "b.a1");
    model_free(model);
}

int main(void)
{
    RUN(each_half_has_its_freedoms);
    RUN(coordinates_belong_to_the_half_of_their_step);
    RUN(virtual_joints_enter_trees_where_they_are_free);
    RUN(screws_are_branches_of_both_trees_or_of_none);
    RUN(cylindrical_joints_shift_and_turn_by_themselves);
    RUN(universal_joints_turn_about_the_tails_axis_first);
    RUN(screws_shift_by_their_pitch_in_a_turn);
    RUN(twelve_sequences_turn_about_their_axes_in_order);
    RUN(euler_angles_are_the_classical_ones);
    RUN(parameters_come_first_where_nothing_is_said);
    RUN(wrong_joints_are_refused_where_they_are_wrong);
    RUN(sequences_of_a_kind_can_be_changed);
    return test_end();
}

/* family_moved.c: what events set, what drivers drive and what was told of speeds, in any trees
 *
 * Random scenes of scenes.h stand still, as nothing pulls on them. An event puts all joints
 * elsewhere at once, or one of them with loops to follow; poses after it come from jointed.h. */
#include "moving.h"

#define MOMENT 1e-4 /* s: of a difference, whose error is about its square */
#define SLOW   1e-6 /* m/s, rad/s */

/* --- events --- */

/* three angles of a chord can't be set: their body's attitude is */
static void set_joint(const Scene *s, int number, const double *c, const Pose *body, Scene *out)
{
    const Joint *j = &s->joint[number];

    for (int k = 0; k < j->count && j->kind != SPHERICAL_ANGLES; k++)
        write(out, " j%d%s=%.17g", number, coordinate_name(j, k), c[k]);
    for (int k = 0; k < 4 && j->kind == SPHERICAL_ANGLES; k++)
        write(out, " b%d.q%d=%.17g", number, k, body->q[k]);
}

static Verdict all_set_member(Member *m)
{
    static Scene s, out;
    double c[BODIES][MOST_COORDINATES] = {0}, off;
    Pose now[BODIES] = {0}, bodies[BODIES] = {0};
    Kit kit = kit_new();

    make_scene(m, &s, TREES);
    for (int i = 0; i < s.bodies; i++)
        draw_coordinates(m, &s.joint[i], c[i]);
    stand(&s, c, now);
    out.length = 0;
    write(&out, "%s", s.text);
    write_trees(m, &s, pick(m, 4), &out);
    report_poses(&s, &out);
    write(&out, "event e when=t>0.5");
    for (int i = 0; i < s.bodies; i++)
        set_joint(&s, i, c[i], &now[i], &out);
    write(&out, "\nsimulate 1\n");
    off = kit_do(&kit, out.text) == CT_OK ? 0 : NAN;
    if (isnan(off))
        tell(m, "%s\n", kit.error.message);
    for (int i = 0; i < s.bodies && !isnan(off); i++)
        bodies[i] = read_body(&kit, &s, i);
    if (!isnan(off)) {
        off = off_bodies(m, &s, bodies, now);
        off = worst(off, off_consistent(m, &kit, &s, bodies));
    }
    kit_free(&kit);
    if (!(off < NEAR) || m->told)
        tell(m, "%s", out.text);
    return off < NEAR ? AGREES : isnan(off) ? REFUSED : DISAGREES;
}

/* --- speeds --- */

/* velocity and angular velocity in ground axes, from poses on either side */
static void differentiate(const Pose *low, const Pose *high, double moment, double out[6])
{
    const double back[4] = {low->q[0], -low->q[1], -low->q[2], -low->q[3]};
    double turn[4] = {0};

    multiply(high->q, back, turn);
    for (int k = 0; k < 3; k++) {
        out[k] = (high->r[k] - low->r[k]) / (2 * moment);
        out[3 + k] = turn[k + 1] * (turn[0] < 0 ? -1 : 1) / moment;
    }
}

static double speeds_off(Member *m, const Scene *s, double (*are)[6], double (*belong)[6])
{
    double off = 0;

    for (int i = 0; i < s->bodies; i++)
        for (int k = 0; k < 6; k++) {
            const double wrong = fabs(are[i][k] - belong[i][k]);

            if (!(wrong < SLOW))
                tell(m, "b%d: %c%c is %.9g, not %.9g\n", i, k < 3 ? 'v' : 'w', 'x' + k % 3,
                     are[i][k], belong[i][k]);
            off = worst(off, wrong);
        }
    return off;
}

/* assemble in one choice of trees; false: refused */
static bool start(Member *m, const Scene *s, int choice, const Speeds *speeds, double (*out)[6])
{
    static Scene text;
    Kit kit = kit_new();
    bool sound;

    text.length = 0;
    write(&text, "%s", s->text);
    write_trees(m, s, choice, &text);
    report_poses(s, &text);
    for (int i = 0; i < s->joints; i++)
        if (speeds[i].told)
            report_speeds(&s->joint[i], i, &speeds[i], &text);
    write(&text, "assemble\n");
    sound = kit_do(&kit, text.text) == CT_OK;
    if (!sound)
        tell(m, "%s\n", kit.error.message);
    for (int i = 0; i < s->bodies && sound; i++)
        read_speeds(&kit, s, i, out[i]);
    tell(m, "%s", strstr(text.text, "tree "));
    kit_free(&kit);
    return sound;
}

/* Some joints are told, the others rest against each other. */
static Verdict resting_member(Member *m)
{
    static Scene s;
    Speeds speeds[JOINTS] = {0};
    double are[BODIES][6] = {0}, belong[BODIES][6] = {0};
    Pose low[BODIES] = {0}, high[BODIES] = {0};

    make_scene(m, &s, TREES);
    for (int i = 0; i < s.bodies; i++)
        if (pick(m, 2) == 0)
            draw_speeds(m, &s.joint[i], &speeds[i]);
    go_on(&s, speeds, -MOMENT, low);
    go_on(&s, speeds, MOMENT, high);
    for (int i = 0; i < s.bodies; i++)
        differentiate(&low[i], &high[i], MOMENT, belong[i]);
    tell(m, "%s", m->told ? s.text : "");
    for (int choice = 0; choice < 3; choice++)
        if (!start(m, &s, choice, speeds, are) || !(speeds_off(m, &s, are, belong) < SLOW))
            return DISAGREES;
    return AGREES;
}

/* One joint is told, loops and all else follow, in every tree alike. */
static Verdict following_member(Member *m)
{
    static Scene s;
    Speeds speeds[JOINTS] = {0};
    double first[BODIES][6] = {0}, are[BODIES][6] = {0};
    bool sound;
    int told;

    make_scene(m, &s, WITH_LOOPS);
    told = pick(m, s.joints);
    draw_speeds(m, &s.joint[told], &speeds[told]);
    tell(m, "%s", m->told ? s.text : "");
    sound = start(m, &s, 0, speeds, first);
    for (int choice = 1; choice < 3; choice++) {
        if (start(m, &s, choice, speeds, are) != sound)
            return DISAGREES;
        if (sound && !(speeds_off(m, &s, are, first) < SLOW))
            return DISAGREES;
    }
    return sound ? AGREES : REFUSED;
}

/* --- drivers --- */

/* a driver for every coordinate, each at a rate of its own */
static int write_drivers(Member *m, const Scene *s, Speeds *speeds, Scene *out)
{
    int count = 0;

    for (int i = 0; i < s->bodies; i++) {
        const Joint *j = &s->joint[i];

        draw_speeds(m, j, &speeds[i]);
        for (int k = 0; k < j->count; k++)
            write(out, "driver D%d j%d%s = %.17g + %.17g*t\n", count++, i, coordinate_name(j, k),
                  j->c[k], speeds[i].rate[k]);
    }
    return count;
}

/* Driven bodies are where their joints' coordinates put them, from the start to the end. */
static bool is_driven_right(Member *m, const Scene *s, int choice, const char *drivers,
                            const Speeds *speeds)
{
    static const char *const runs[] = {"kinematics", "inverse"};
    static Scene out;
    Pose belong[BODIES] = {0}, bodies[BODIES] = {0};
    Kit kit = kit_new();
    double off = 0;

    out.length = 0;
    write(&out, "%s", s->text);
    write_trees(m, s, choice, &out);
    write(&out, "%s%s 0.5 every=0.1\n", drivers, runs[pick(m, 2)]);
    go_on(s, speeds, 0.5, belong);
    if (kit_do(&kit, out.text) != CT_OK) {
        tell(m, "%s\n", kit.error.message);
        off = NAN;
    }
    for (int i = 0; i < s->bodies && !isnan(off); i++)
        bodies[i] = read_body(&kit, s, i);
    if (!isnan(off)) {
        off = off_bodies(m, s, bodies, belong);
        off = worst(off, off_consistent(m, &kit, s, bodies));
    }
    if (!(off < NEAR) || m->told)
        tell(m, "%s", out.text);
    kit_free(&kit);
    return off < NEAR;
}

static Verdict driven_member(Member *m)
{
    static Scene s, drivers;
    Speeds speeds[BODIES] = {0};

    make_scene(m, &s, DRIVEN);
    drivers.length = 0;
    drivers.text[0] = '\0';
    if (write_drivers(m, &s, speeds, &drivers) == 0)
        return AGREES;
    for (int choice = 0; choice < 3; choice++)
        if (!is_driven_right(m, &s, choice, drivers.text, speeds))
            return DISAGREES;
    return AGREES;
}

/* One coordinate is driven, loops follow, and what is free is moved by that; false: refused. */
static bool follow_driver(Member *m, const Scene *s, int choice, const char *driver, Pose *bodies)
{
    static Scene text;
    Kit kit = kit_new();
    bool sound;

    text.length = 0;
    write(&text, "%s", s->text);
    write_trees(m, s, choice, &text);
    report_poses(s, &text);
    write(&text, "%s\nsimulate 0.1 every=0.02 rtol=1e-10 atol=1e-10\n", driver);
    sound = kit_do(&kit, text.text) == CT_OK;
    if (!sound)
        tell(m, "%s\n", kit.error.message);
    for (int i = 0; i < s->bodies && sound; i++)
        bodies[i] = read_body(&kit, s, i);
    if (sound && !(off_consistent(m, &kit, s, bodies) < NEAR)) {
        tell(m, "open\n");
        bodies[0].r[0] = NAN;
    }
    tell(m, "%s%s\n", strstr(text.text, "tree "), kit.text != NULL ? kit.text : "");
    kit_free(&kit);
    return sound;
}

/* Loops follow a driver alike in every tree, with all joints where their bodies stand. What can't
 * be driven, as loops hold it, or leaves bodies undetermined is refused in all trees. */
static Verdict driven_loops_member(Member *m)
{
    static Scene s;
    Pose first[BODIES] = {0}, bodies[BODIES] = {0};
    char driver[80];
    int number, k = 0;
    bool sound;

    make_scene(m, &s, WITH_LOOPS);
    number = pick(m, s.joints);
    while (k < s.joint[number].count && is_lifted(&s.joint[number], k))
        k++;
    if (k == s.joint[number].count)
        return REFUSED;
    (void)snprintf(driver, sizeof driver, "driver D j%d%s = %.17g + %.17g*t", number,
                   coordinate_name(&s.joint[number], k), s.joint[number].c[k],
                   between(m, -5, 5)); /* now and then past a dead centre */
    tell(m, "%s%s\n", s.text, driver);
    sound = follow_driver(m, &s, 0, driver, first);
    if (sound && isnan(first[0].r[0]))
        return DISAGREES;
    for (int choice = 1; choice < 3; choice++) {
        if (follow_driver(m, &s, choice, driver, bodies) != sound)
            return DISAGREES;
        if (sound && !(off_bodies(m, &s, bodies, first) < 1e-6))
            return DISAGREES;
    }
    return sound ? AGREES : REFUSED;
}

static const Family families[] = {
    {"joints_of_which_no_speed_was_told_rest", 30, 0, 0, resting_member},
    {"bodies_move_alike_in_all_trees", 30, 0.6, 0, following_member},
    {"driven_bodies_are_where_their_joints_put_them", 20, 0, 0, driven_member},
    {"loops_follow_a_driver_alike_in_all_trees", 30, 0.8, 0, driven_loops_member},
    {"an_event_puts_all_joints_where_it_says", 20, 0, 0, all_set_member},
};

int main(int argc, char **argv)
{
    (void)test_faults;
    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

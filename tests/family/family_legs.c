/* family_legs.c: planar robots of many legs, whose elimination goes leg by leg, against absolute
 * coordinates, where each pin has rows of its own; and these and bodies with many spatial arms on
 * one thread against the same on several, digit by digit
 *
 * Links are drawn so that legs reach their pins bent at random; a platform that moves soon
 * stretches some of them. */
#include "../unit/session_kit.h"
#include "family.h"
#include "script.h"

enum { MOST = 30 };

/* the bends of a leg of these links over that distance */
static void write_guess(Member *member, Script *s, int leg, double angle, double distance,
                        const double *link)
{
    const double a = link[0], b = link[1], d = distance;
    const double at_base = acos((a * a + d * d - b * b) / (2 * a * d));
    const double at_knee = acos((a * a + b * b - d * d) / (2 * a * b));
    const double side = member_one_of(member, 2) == 0 ? 1 : -1;

    write_line(s, "guess leg%d.th1 = %.17g, leg%d.th2 = %.17g", leg, angle + side * at_base, leg,
               side * (at_knee - acos(-1)));
}

static void write_leg(Member *member, Script *s, int leg, int legs)
{
    const double turn = 2 * acos(-1) * (leg + member_between(member, -0.3, 0.3)) / legs;
    const double base[2] = {cos(turn), sin(turn)};
    const double pin[2] = {0.3 * cos(turn + member_between(member, -1, 1)),
                           0.3 * sin(turn + member_between(member, -1, 1))};
    const double distance = hypot(pin[0] - base[0], pin[1] - base[1]);
    const double link[2] = {distance * member_between(member, 0.55, 0.9),
                            distance * member_between(member, 0.55, 0.9)};

    write_line(s, "arm g%d ground [%.17g, %.17g]", leg, base[0], base[1]);
    write_line(s, "arm p%d m [%.17g, %.17g]", leg, pin[0], pin[1]);
    write_line(s, "use leg leg%d A=g%d L1=%.17g L2=%.17g M2=%.17g", leg, leg, link[0], link[1],
               member_decades(member, 0.1, 10));
    write_line(s, "revolute h%d leg%d.B p%d", leg, leg, leg);
    write_guess(member, s, leg, atan2(pin[1] - base[1], pin[0] - base[0]), distance, link);
}

static void write_robot(Member *member, Script *s, int legs)
{
    write_line(s, "scene planar; gravity [0, -9.81]");
    write_line(s, "body m mass=8 inertia=0.3");
    write_line(s, "subsystem leg frames=[A, B]");
    write_line(s, "L1 = 0.4; L2 = 0.6; M2 = 1");
    write_line(s, "body l1 mass=2 inertia=0.04; body l2 mass=M2 inertia=0.05*M2");
    write_line(s, "arm a1 l1 [-L1/2, 0]; arm k1 l1 [L1/2, 0]");
    write_line(s, "arm k2 l2 [-L2/2, 0]; arm B l2 [L2/2, 0]");
    write_line(s, "revolute th1 A a1; revolute th2 k1 k2");
    write_line(s, "end");
    for (int leg = 0; leg < legs; leg++)
        write_leg(member, s, leg, legs);
}

/* the platform and the joints of each leg */
static void write_tree(Script *s, int legs)
{
    char tree[16 * 2 * MOST + 8];
    size_t length = (size_t)snprintf(tree, sizeof tree, "tree m");

    for (int leg = 0; leg < legs; leg++)
        length +=
            (size_t)snprintf(tree + length, sizeof tree - length, " leg%d.th1 leg%d.th2", leg, leg);
    write_line(s, "%s", tree);
}

static bool agree(Member *member, Kit *of, const char *const *asked, int count, double scale,
                  double bound)
{
    bool same = true;

    for (int k = 0; k < count && same; k++) {
        const double one = kit_value(&of[0], asked[k]), other = kit_value(&of[1], asked[k]);

        /* an effort that a singular position makes infinite has no mean in either tree */
        if (isnan(one) && isnan(other) && strcmp(of[0].error.message, of[1].error.message) == 0)
            continue;
        same = keeps(member, asked[k], fabs(one - other) / fmax(scale, fabs(other)), bound);
    }
    return same;
}

/* the same text after its own tree, and in absolute coordinates */
static Verdict in_both_trees(Member *member, int legs, const char *robot, const char *line,
                             const char *const *asked, int count, double scale, double bound)
{
    static Script tree;
    Kit of[2] = {kit_new(), kit_new()};
    Verdict verdict = REFUSED;

    tree.length = 0;
    write_tree(&tree, legs);
    if (kit_do(&of[0], robot) == CT_OK && kit_do(&of[1], robot) == CT_OK &&
        kit_do(&of[0], tree.text) == CT_OK && kit_do(&of[1], "tree absolute\n") == CT_OK &&
        kit_do(&of[0], line) == CT_OK && kit_do(&of[1], line) == CT_OK)
        verdict = agree(member, of, asked, count, scale, bound) ? AGREES : DISAGREES;
    if (verdict != AGREES || member->told)
        tell(member, "%s%s%s%s\n%s\n", robot, tree.text, line, of[0].error.message,
             of[1].error.message);
    kit_free(&of[0]);
    kit_free(&of[1]);
    return verdict;
}

static Verdict they_move_as_in_absolute_coordinates(Member *member)
{
    static const char *const asked[] = {"m.x", "m.y", "m.theta", "leg0.th1", "leg1.th2'", "m.vx"};
    static Script robot;
    const int legs = 7 + member_one_of(member, 10);

    robot.length = 0;
    write_robot(member, &robot, legs);
    write_line(&robot, "init m.vx = %.17g, m.wz = %.17g", member_between(member, -1, 1),
               member_between(member, -3, 3));
    return in_both_trees(member, legs, robot.text, "simulate 0.2 every=0.1 rtol=1e-11 atol=1e-12\n",
                         asked, (int)(sizeof asked / sizeof asked[0]), 1, 1e-6);
}

static Verdict efforts_are_those_in_absolute_coordinates(Member *member)
{
    static const int counts[] = {3, 6, 12, MOST};
    static const char *const asked[] = {"D0.effort",       "D1.effort", "D2.effort",
                                        "min(D0.effort)",  "h1.fx",     "h2.fy",
                                        "mean(D2.effort)", "leg1.th2''"};
    static const char *const along[] = {"x", "y", "theta"};
    static Script robot;
    const int legs = counts[member->number % 4];

    robot.length = 0;
    write_robot(member, &robot, legs);
    for (int k = 0; k < 3; k++)
        write_line(&robot, "driver D%d m.%s = %.17g*sin(%.17g*t) by=leg%d.th1", k, along[k],
                   member_between(member, 0.01, 0.04), member_between(member, 1, 4), k);
    return in_both_trees(member, legs, robot.text, "inverse 0.2 every=0.1\n", asked,
                         (int)(sizeof asked / sizeof asked[0]), 100, 1e-8);
}

/* --- on several threads --- */

/* a free body with arms of two links each, chains with motors in their joints */
static void write_arms(Member *member, Script *s, int arms)
{
    write_line(s, "gravity [0, 0, -9.81]");
    write_line(s, "body m mass=8 inertia=[1, 2, 3]");
    write_line(s, "subsystem limb frames=[A]");
    write_line(s, "k = 5; M2 = 1");
    write_line(
        s, "body l1 mass=2 inertia=[0.04, 0.05, 0.06]; body l2 mass=M2 inertia=[0.1, 0.2, 0.2]");
    write_line(s, "arm a1 l1 [-0.3, 0, 0.1]; arm k1 l1 [0.3, 0.1, 0]; arm k2 l2 [-0.2, 0, 0]");
    write_line(s, "universal th A a1 axes=[y, z]; spherical el k1 k2");
    write_line(s, "spring sp th.a1 k=k rest=0.2");
    write_line(s, "end");
    for (int i = 0; i < arms; i++) {
        const double turn = 2 * acos(-1) * i / arms;

        write_line(s, "arm p%d m [%.17g, %.17g, %.17g]", i, cos(turn), sin(turn),
                   member_between(member, -0.2, 0.2));
        write_line(s, "use limb arm%d A=p%d k=%.17g M2=%.17g", i, i, member_between(member, 1, 9),
                   member_decades(member, 0.3, 3));
        write_line(s, "init arm%d.th.a1 = %.17g, arm%d.th.a2' = %.17g", i,
                   member_between(member, -0.5, 0.5), i, member_between(member, -2, 2));
    }
}

/* numbers of all rows, as they are written; "" where a line fails */
static char *rows_on(Kit *kit, int threads, const char *model, const char *line)
{
    char set[40];
    char *out;

    (void)snprintf(set, sizeof set, "set jobs %d\n", threads);
    if (kit_do(kit, set) != CT_OK || kit_do(kit, model) != CT_OK || kit_do(kit, line) != CT_OK ||
        kit_do(kit, "export csv\n") != CT_OK || kit->text == NULL)
        return NULL;
    out = kit->text;
    kit->text = NULL;
    return out;
}

/* the same text of numbers, and of what a program of such a model is said to be */
static Verdict on_any_threads(Member *member, const char *model, const char *line)
{
    static const int threads[] = {2, 3, 8};
    Kit one = kit_new();
    char *wanted = rows_on(&one, 1, model, line);
    bool same = true, shares = false;

    for (int i = 0; i < 3 && same; i++) {
        Kit kit = kit_new();
        char *rows = rows_on(&kit, threads[i], model, line);

        same = wanted != NULL ? rows != NULL && strcmp(rows, wanted) == 0
                              : rows == NULL && strcmp(kit.error.message, one.error.message) == 0;
        shares = shares || (kit_do(&kit, "show program") == CT_OK && kit.text != NULL &&
                            strstr(kit.text, " parts at the same time") != NULL);
        if (!same || member->told)
            tell(member, "set jobs %d\n%s%s%s\n%s\n", threads[i], model, line, one.error.message,
                 kit.error.message);
        ct_free(rows);
        kit_free(&kit);
    }
    if (!shares)
        tell(member, "no threads are made use of\n");
    ct_free(wanted);
    kit_free(&one);
    return !same || !shares ? DISAGREES : wanted != NULL ? AGREES : REFUSED;
}

static Verdict threads_leave_every_digit_as_it_is(Member *member)
{
    static const char *const lines[] = {
        "simulate 0.4 every=0.02\n", "simulate 0.1 every=0.05 method=radau\n",
        "simulate 0.2 every=0.1 check=on\n", "simulate 0.1 every=0.05 method=rk4 step=1e-3\n"};
    static Script script;
    const char *line = lines[member_one_of(member, 4)];

    script.length = 0;
    if (member_one_of(member, 4) == 0)
        write_line(&script, "set evaluator native");
    if (member_one_of(member, 2) == 0) {
        write_arms(member, &script, 16 + member_one_of(member, 10));
        return on_any_threads(member, script.text, line);
    }
    {
        const int legs = 22 + member_one_of(member, 9);

        write_robot(member, &script, legs);
        write_tree(&script, legs);
    }
    return on_any_threads(member, script.text, line);
}

static Verdict threads_leave_efforts_as_they_are(Member *member)
{
    static const char *const along[] = {"x", "y", "theta"};
    static Script script;
    const int legs = 24 + member_one_of(member, 7);

    script.length = 0;
    write_robot(member, &script, legs);
    for (int k = 0; k < 3; k++)
        write_line(&script, "driver D%d m.%s = %.17g*sin(%.17g*t) by=leg%d.th1", k, along[k],
                   member_between(member, 0.01, 0.04), member_between(member, 1, 4), k);
    write_tree(&script, legs);
    return on_any_threads(member, script.text, "inverse 0.2 every=0.01\n");
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"they_move_as_in_absolute_coordinates", 6, 0.2, 0, they_move_as_in_absolute_coordinates},
        {"efforts_are_those_in_absolute_coordinates", 8, 0.2, 0,
         efforts_are_those_in_absolute_coordinates},
        {"threads_leave_every_digit_as_it_is", 6, 0.5, 0, threads_leave_every_digit_as_it_is},
        {"threads_leave_efforts_as_they_are", 2, 0.5, 0, threads_leave_efforts_as_they_are},
    };

    return family_main(families, (int)(sizeof families / sizeof families[0]), argc, argv);
}

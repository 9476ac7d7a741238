/* family_stress_runs.c: stiffness, bad guesses, loops that can't close, impacts, forces without a
 * value, and the same run again */
#include "stress.h"

/* --- 7: when stability, and not accuracy, cuts the steps --- */

static double steps_of(Member *member, Kit *kit, double tolerance, const char *method)
{
    const char *at;
    double steps = NAN;

    if (do_line(member, kit, "simulate 1 every=1 rtol=%g method=%s", tolerance, method) == CT_OK &&
        kit_do(kit, "show run") == CT_OK && (at = strstr(kit->text, "\nsteps")) != NULL)
        (void)sscanf(at + strlen("\nsteps"), "%lf", &steps);
    return steps;
}

/* Steps that a tolerance a hundred times finer leaves as many (within a tenth) are cut by
 * stability; those it makes half more, by accuracy (its order, 8, makes 1.78 times of them); in
 * between either may be said. */
static Verdict hand_over_is_right(Member *member, const Script *script)
{
    Kit kit = kit_new();
    const double tolerance = draw_one_of(member, 2) ? 1e-5 : 1e-8;
    Verdict verdict = DISAGREES;

    if (do_script(member, &kit, script) == CT_OK) {
        const double ratio = steps_of(member, &kit, tolerance / 10, "dop853") /
                             steps_of(member, &kit, tolerance * 10, "dop853");
        const double alone = steps_of(member, &kit, tolerance, "dop853");
        const double own = steps_of(member, &kit, tolerance, "auto");
        const bool is_handed = kit.text != NULL && strstr(kit.text, "radau") != NULL;

        tell(member, "two decades of tolerance: %.3g times the steps; %s\n", ratio,
             is_handed ? "handed over" : "not handed over");
        if (!isnan(own) && !isnan(ratio) &&
            (is_handed ? ratio <= 1.5 || own < alone : ratio >= 1.1))
            verdict = AGREES;
    }
    kit_free(&kit);
    return verdict;
}

static Verdict what_stability_limits_is_handed_over(Member *member)
{
    static Script s;
    const double k = draw_decades(member, 2, 8);

    s.length = 0;
    write_line(&s, "scene planar\nbody a mass=1 inertia=1\nbody b mass=1 inertia=1");
    write_line(&s, "revolute h ground a\nrevolute g a b\ntorque T a sin(t)");
    write_line(&s, "spring k1 g k=%.17g\ndamper d1 g d=%.17g", k, 1.4 * sqrt(k));
    return hand_over_is_right(member, &s);
}

/* L i' + i = sin(t) from 0; below 1e-5 s the explicit method would take a million steps */
static Verdict time_constants_of_coils_are_handed_over(Member *member)
{
    static Script s;
    const double l = draw_decades(member, -7, -1);
    const double current = (sin(1) - l * cos(1) + l * exp(-1 / l)) / (1 + l * l);
    Kit kit = kit_new();
    Verdict verdict = AGREES;

    s.length = 0;
    write_line(&s, "vsource V1 a 0 sin(t)\nresistor R1 a b 1\ninductor L2 b 0 %.17g", l);
    if (l > 1e-5)
        verdict = hand_over_is_right(member, &s);
    if (do_script(member, &kit, &s) != CT_OK ||
        !keeps(member, "steps", steps_of(member, &kit, 1e-6, "auto"), 500) ||
        !keeps(member, "current", fabs(kit_value(&kit, "L2.i") - current), 1e-4))
        verdict = DISAGREES;
    kit_free(&kit);
    return verdict;
}

/* --- 10: bad guesses --- */

/* a crank of 0.3 m, a coupler of 0.9 m, a rocker of 0.8 m, 1 m of ground between; every coordinate
 * is guessed up to `off` wrong. Whether coupler and rocker bend the way that they did. */
static Verdict bend_is_kept(Member *member, double off)
{
    static const char *const trees[] = {"", "tree absolute", "cotree h2"};
    const double phi = draw(member, 0, 6.28);
    const double tx = 0.3 * cos(phi), ty = 0.3 * sin(phi), dx = 1 - tx, dy = -ty;
    const double square = dx * dx + dy * dy, along = (0.81 - 0.64 + square) / (2 * square);
    const double across = sqrt(0.81 / square - along * along);
    const double px = tx + along * dx - across * dy, py = ty + along * dy + across * dx;
    const double coupler = atan2(py - ty, px - tx), rocker = atan2(py, px - 1);
    const double right[13] = {
        tx / 2, ty / 2, phi, (tx + px) / 2, (ty + py) / 2, coupler,         (1 + px) / 2,
        py / 2, rocker, phi, coupler - phi, rocker,        rocker - coupler};
    static const char *const names[13] = {"c.x",     "c.y", "c.theta", "k.x",     "k.y",
                                          "k.theta", "b.x", "b.y",     "b.theta", "h1",
                                          "h2",      "h3",  "h4"};
    static Script s;
    Kit kit = kit_new();
    bool kept;

    s.length = 0;
    write_line(&s, "scene planar\narm g ground [1, 0]\nbody c mass=1 inertia=1");
    write_line(&s, "arm ca c [-0.15, 0]; arm cb c [0.15, 0]\nbody k mass=1 inertia=1");
    write_line(&s, "arm ka k [-0.45, 0]; arm kb k [0.45, 0]\nbody b mass=1 inertia=1");
    write_line(&s, "arm ba b [-0.4, 0]; arm bb b [0.4, 0]");
    write_line(&s, "revolute h1 ground ca; revolute h2 cb ka; revolute h3 g ba; revolute h4 kb bb");
    write_line(&s, "%s", trees[member->number % COUNT(trees)]);
    for (int i = 0; i < 13; i++)
        write_line(&s, "guess %s=%.17g", names[i], right[i] + draw(member, -off, off));
    write_line(&s, "assemble");
    kept = do_script(member, &kit, &s) == CT_OK &&
           sin(kit_value(&kit, "b.theta") - kit_value(&kit, "k.theta")) * sin(rocker - coupler) > 0;
    kit_free(&kit);
    return kept ? AGREES : DISAGREES;
}

static Verdict guesses_off_by_a_tenth_keep_their_bend(Member *member)
{
    return bend_is_kept(member, 0.1);
}

static Verdict guesses_off_by_three_tenths_keep_their_bend(Member *member)
{
    return bend_is_kept(member, 0.3);
}

static Verdict guesses_off_by_one_keep_their_bend(Member *member)
{
    return bend_is_kept(member, 1);
}

/* --- 11: loops that can't close --- */

static Verdict a_loop_too_long_does_not_run(Member *member)
{
    static Script s;
    Kit kit = kit_new();
    const int rods = 1 + draw_one_of(member, 5), longest = draw_one_of(member, rods + 1);
    double length[6], others = 0;
    bool refused;

    for (int i = 0; i <= rods; i++) {
        length[i] = draw(member, 0.3, 2);
        others += i == longest ? 0 : length[i];
    }
    length[longest] = 1.001 * others;
    s.length = 0;
    write_line(&s, "scene planar\narm g ground [%.17g, 0]", length[rods]);
    for (int i = 0; i < rods; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "b%d", i);
        write_rod(&s, name, 1, length[i]);
        if (i == 0)
            write_line(&s, "revolute h0 ground b0a");
        else
            write_line(&s, "revolute h%d b%db b%da", i, i - 1, i);
    }
    write_line(&s, "revolute h%d b%db g", rods, rods - 1);
    if (draw_one_of(member, 2) == 0)
        write_line(&s, "tree absolute");
    else
        write_line(&s, "cotree h%d", draw_one_of(member, rods + 1));
    for (int i = 0; i < rods; i++)
        write_line(&s, "guess h%d = %.17g", i, draw(member, -1, 1));
    write_line(&s, "simulate 1");
    refused = do_script(member, &kit, &s) != CT_OK && strchr(kit.error.message, 'h') != NULL &&
              (strstr(kit.error.message, "can't be put together") != NULL ||
               strstr(kit.error.message, "can't be assembled") != NULL) &&
              isnan(kit_value(&kit, "max(h0)")); /* there is no run */
    kit_free(&kit);
    return refused ? AGREES : DISAGREES;
}

/* --- 12: impacts --- */

#define AT_REST "at rest from t = "

/* A ball let go at h: leaps shorter by e each pile up at sqrt(2h/g) (1 + e)/(1 - e), and it rests.
 */
static Verdict impacts_that_pile_up_come_to_rest(Member *member)
{
    static Script s;
    Kit kit = kit_new();
    const double h = draw_decades(member, -1, 1), e = draw(member, 0.3, 0.85);
    const double end = sqrt(2 * h / 9.81) * (1 + e) / (1 - e);
    const char *report;
    Verdict verdict = DISAGREES;

    s.length = 0;
    write_line(&s, "scene planar\ngravity [0, -9.81]\nbody m1 mass=%.17g", draw(member, 0.2, 5));
    write_line(&s, "prismatic s1 ground m1 axis=y\nevent hit when=s1 < 0 s1'=%.17g*s1'", -e);
    write_line(&s, "init s1 = %.17g\nsimulate %.17g", h, 2 * end);
    if (do_script(member, &kit, &s) == CT_OK &&
        (report = strstr(ct_remarks(kit.session), AT_REST)) != NULL &&
        keeps(member, "the end", fabs(strtod(report + strlen(AT_REST), NULL) - end) / end, 1e-7) &&
        keeps(member, "the rest", fabs(kit_value(&kit, "s1")) / h, 1e-9))
        verdict = AGREES;
    kit_free(&kit);
    return verdict;
}

/* Several masses run into a wall at one instant, which is the start, a row of output or neither;
 * each leaves as its own event says. */
static Verdict impacts_at_one_instant_all_count(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "adams", "bdf", "ida"};
    static Script s;
    Kit kit = kit_new();
    const int count = 1 + draw_one_of(member, 4), when = draw_one_of(member, 3);
    const double at = when == 0 ? 0 : 0.25 * (1 + draw_one_of(member, 3));
    double gone[4], speed[4];
    Verdict verdict = AGREES;

    s.length = 0;
    write_line(&s, "scene planar\ngravity [0, 0]");
    for (int i = 0; i < count; i++) {
        const double u = draw(member, 1, 5), e = draw(member, 0.2, 0.9);

        speed[i] = e * u;
        gone[i] = (1 - at) * e * u;
        write_line(&s, "body b%d mass=%.17g\nprismatic s%d ground b%d axis=x", i,
                   draw(member, 0.5, 3), i, i);
        write_line(&s, "init s%d = %.17g, s%d' = %.17g", i, at * u, i, -u);
        write_line(&s, "event e%d when=s%d < 0 s%d'=%.17g*s%d'", i, i, i, -e, i);
    }
    write_line(&s, "simulate 1 every=%g method=%s", when == 1 ? 0.25 : 0.3,
               draw_word(member, methods, COUNT(methods)));
    if (do_script(member, &kit, &s) != CT_OK)
        verdict = DISAGREES;
    for (int i = 0; i < count && verdict == AGREES; i++) {
        char name[16];

        (void)snprintf(name, sizeof name, "s%d", i);
        if (!keeps(member, name, fabs(kit_value(&kit, name) - gone[i]), 1e-6))
            verdict = DISAGREES;
        (void)snprintf(name, sizeof name, "s%d'", i);
        if (!keeps(member, name, fabs(kit_value(&kit, name) - speed[i]), 1e-6))
            verdict = DISAGREES;
    }
    kit_free(&kit);
    return verdict;
}

/* --- 14: a force that becomes no number --- */

static Verdict a_force_without_a_value_stops_the_run(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "adams", "bdf", "ida", "rk4"};
    static const char *const forces[] = {"sqrt(rest(t))", "log(rest(t)^3)", "rest(t)^0.3",
                                         "asin(1 - rest(t))"};
    static Script s;
    Kit kit = kit_new();
    const double end = draw(member, 0.2, 0.9);
    const bool turns = draw_one_of(member, 2) == 0;
    const char *method = draw_word(member, methods, COUNT(methods));
    double t = NAN;
    Verdict verdict = DISAGREES;

    s.length = 0;
    write_line(&s, "scene planar\nbody a mass=%.17g inertia=1\n%s s ground a %s",
               draw(member, 0.3, 3), turns ? "revolute" : "prismatic", turns ? "" : "axis=x");
    write_line(&s, "actuator G s %s=3*t\ninit s' = 1", turns ? "torque" : "force");
    write_line(&s, "rest(t) = %.17g - t", end);
    write_line(&s, "actuator F s %s=%s", turns ? "torque" : "force",
               draw_word(member, forces, COUNT(forces)));
    write_line(&s, "simulate 1 every=0.01 method=%s", method);
    if (do_script(member, &kit, &s) != CT_OK &&
        strstr(kit.error.message, "F has no value from there on") != NULL &&
        strstr(kit.error.hint, "max(..., 0)") != NULL &&
        sscanf(kit.error.message, "at t = %lf", &t) == 1 &&
        keeps(member, "its time", fabs(t - end), strcmp(method, "rk4") == 0 ? 0.011 : 1e-6) &&
        !isnan(kit_value(&kit, "s")))
        verdict = AGREES;
    kit_free(&kit);
    return verdict;
}

/* --- 15: the same again --- */

static Verdict a_run_repeats_to_the_last_byte(Member *member)
{
    static const char *const methods[] = {"auto", "dop853", "radau", "adams", "bdf", "ida", "rk4"};
    static const char *const models[] = {
        SLIDER_CRANK CRANK_START, SLIDER_CRANK "tree absolute\n" CRANK_START,
        MOTOR_ARM "init theta = 1\n", ANDREWS "tree absolute\n",
        "vsource V s0 0 10*sin(300*t)\nresistor R s0 a 5\ndiode D a b Is=1e-12\n"
        "capacitor C b 0 1e-3\nresistor RL b 0 100\n"};
    const char *model = draw_word(member, models, COUNT(models));
    const char *method = draw_word(member, methods, COUNT(methods));
    const double time = strstr(model, "jE6") != NULL ? 0.01 : 0.3;
    char *first = NULL;
    Verdict verdict = AGREES;

    for (int pass = 0; pass < 3 && verdict == AGREES; pass++) { /* the third in the second's */
        static Kit kit;

        if (pass < 2) {
            kit = kit_new();
            if (kit_do(&kit, model) != CT_OK)
                verdict = DISAGREES;
        }
        if (do_line(member, &kit, "simulate %g every=%g method=%s", time, time / 30, method) !=
                CT_OK ||
            kit_do(&kit, "export csv") != CT_OK || kit.text == NULL ||
            (pass > 0 && strcmp(kit.text, first) != 0))
            verdict = DISAGREES;
        if (pass == 0) {
            first = kit.text;
            kit.text = NULL;
        }
        if (pass != 1 || verdict != AGREES)
            kit_free(&kit);
    }
    tell(member, "%s", model);
    ct_free(first);
    return verdict;
}

int main(int argc, char **argv)
{
    static const Family families[] = {
        {"what_stability_limits_is_handed_over", 6, 0, 0, what_stability_limits_is_handed_over},
        {"time_constants_of_coils_are_handed_over", 6, 0, 0,
         time_constants_of_coils_are_handed_over},
        {"guesses_off_by_a_tenth_keep_their_bend", 30, 0, 0.01,
         guesses_off_by_a_tenth_keep_their_bend},
        {"guesses_off_by_three_tenths_keep_their_bend", 30, 0, 0.05,
         guesses_off_by_three_tenths_keep_their_bend},
        {"guesses_off_by_one_keep_their_bend", 30, 0, 0.15, guesses_off_by_one_keep_their_bend},
        /* 11 */ {"a_loop_too_long_does_not_run", 8, 0, 0, a_loop_too_long_does_not_run},
        /* 12 */ {"impacts_that_pile_up_come_to_rest", 12, 0, 0, impacts_that_pile_up_come_to_rest},
        {"impacts_at_one_instant_all_count", 12, 0, 0, impacts_at_one_instant_all_count},
        {"a_force_without_a_value_stops_the_run", 4, 0, 0, a_force_without_a_value_stops_the_run},
        /* 15 */ {"a_run_repeats_to_the_last_byte", 8, 0, 0, a_run_repeats_to_the_last_byte},
    };

    return family_main(families, COUNT(families), argc, argv);
}
